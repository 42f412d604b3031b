//! Exact side of a point relative to a plane.
//!
//! ```text
//!   normal_j = (−1)^j · det(rows p_i − p_0, without column j)        side of q = sign Σ_j normal_j (q_j − p_0j)
//! ```
//!
//! Points are rounded to a lattice of [`SPACING`], so that coordinates are integers, sums of points are
//! exact, and sums that should be coplanar are. The normal is computed in floating point, and the same sums
//! with all signs positive bound its error (Shewchuk, *Adaptive precision floating-point arithmetic*, 1997,
//! explains such filters). Only if the bound does not decide, the normal is computed in integers of up to 384
//! bits, once per plane.
//!
//! Sizes: coordinates are below [`REACH`] / [`SPACING`] = 2^50, those of a sum of two below 2^51, differences
//! below 2^52, which floating point holds exactly. By Hadamard's inequality a k × k minor is below k^(k/2) ·
//! 2^(52 k), and with k ≤ 6 that is below 2^(64 k − 1): it fits k words with its sign.

use super::{MAX_DIMENSION, PolytopePoint};
use std::cell::OnceCell;
use std::cmp::Ordering;

/// Distance between neighbouring lattice points: 2⁻⁴⁰ ≈ 9e-13 D or rad, 4 000 times the rounding of a coordinate of
/// order 1, so that rounding makes no lattice points of its own.
pub(super) const SPACING: f64 = 1.0 / (1u64 << 40) as f64;
/// Largest coordinate of a point: a thousand times any connector, and the limit at which minors fit their
/// words.
pub(super) const REACH: f64 = 1024.0;
/// Error of a rounded side, relative to the sum of its terms with all signs positive. A term is rounded k
/// times at the k-th row and at most 5 rows are expanded, the first of which is exact: 14 units of 2⁻⁵³;
/// scaling, the last product and its sum add 10 more, and the rest up to 32 covers the rounding of the bound
/// itself.
const ROUNDING: f64 = 32.0 * (f64::EPSILON / 2.0);
/// A normal that is not known to be right to this is rounded from whole numbers: 2⁻⁴⁴ moves no point within reach of
/// order 1 by a unit of the lattice.
const TILT: f64 = 256.0 * f64::EPSILON;

/// A point in units of [`SPACING`].
pub(super) type Lattice = [i64; MAX_DIMENSION];

/// A signed whole number, lowest word first, two's complement.
type Wide = [u64; MAX_DIMENSION];

/// The lattice point next to `point`, or `None` if a coordinate is NaN or out of reach. Coordinates beyond
/// the dimension become 0.
pub(super) fn snapped(dimension: usize, point: &PolytopePoint) -> Option<Lattice> {
    let mut lattice = [0; MAX_DIMENSION];
    for (to, from) in lattice.iter_mut().zip(point).take(dimension) {
        if !within_reach(*from) {
            return None;
        }
        *to = (from / SPACING).round_ties_even() as i64;
    }
    Some(lattice)
}

/// Is this a coordinate that a point may have?
pub(super) fn within_reach(coordinate: f64) -> bool {
    (-REACH..=REACH).contains(&coordinate)
}

/// A lattice point's coordinates; exact.
pub(super) fn coordinates(lattice: &Lattice) -> PolytopePoint {
    lattice.map(|c| c as f64 * SPACING)
}

/// The differences `a` − `b` as numbers, exact.
pub(super) fn difference(a: &Lattice, b: &Lattice) -> PolytopePoint {
    std::array::from_fn(|j| (a[j] - b[j]) as f64)
}

/// An oriented plane through lattice points.
pub(super) struct Plane {
    dimension: usize,
    corners: [Lattice; MAX_DIMENSION],
    /// The unit normal, pointing away from the points below; after [`Self::refine`] accurate to [`TILT`].
    pub(super) unit: PolytopePoint,
    /// Its components with all signs positive, which bound its error.
    bound: PolytopePoint,
    /// Length of the whole-number normal: (dimension − 1)! times the measure of the simplex it was made from.
    pub(super) size: f64,
    /// All signs of the normal's components are turned.
    turned: bool,
    /// The minors that are the normal's components up to their signs, once they were needed.
    minors: OnceCell<Box<[Wide; MAX_DIMENSION]>>,
}

impl Plane {
    /// The plane through the first `dimension` of `corners`, with `below` below it; `None` if those lie in a
    /// lower-dimensional subspace or `below` lies on it.
    pub(super) fn new(dimension: usize, corners: &[Lattice; MAX_DIMENSION], below: &Lattice) -> Option<Self> {
        let (mut unit, mut bound) = rough_normal(dimension, corners);
        // At most 2^313, so the square does not overflow. If it vanishes, the side is always computed
        // exactly.
        let size = super::dot(&unit, &unit).sqrt();
        if size > 0.0 {
            unit = unit.map(|c| c / size);
            bound = bound.map(|c| c / size);
        } else {
            bound = [f64::INFINITY; MAX_DIMENSION];
        }
        let mut plane =
            Self { dimension, corners: *corners, unit, bound, size, turned: false, minors: OnceCell::new() };
        match plane.side(below) {
            Ordering::Less => {}
            Ordering::Equal => return None,
            Ordering::Greater => {
                plane.turned = true;
                plane.unit = plane.unit.map(|c| -c);
            }
        }
        Some(plane)
    }

    /// A point on the plane.
    pub(super) fn through(&self) -> &Lattice {
        &self.corners[0]
    }

    /// Makes the unit normal right to [`TILT`].
    pub(super) fn refine(&mut self) {
        if ROUNDING * self.bound.iter().sum::<f64>() <= TILT {
            return;
        }
        let mut normal = [0.0; MAX_DIMENSION];
        for (j, (c, minor)) in normal.iter_mut().zip(self.minors()).enumerate().take(self.dimension) {
            *c = if (j % 2 == 1) == self.turned { rounded(minor) } else { -rounded(minor) };
        }
        self.size = super::dot(&normal, &normal).sqrt();
        self.unit = normal.map(|c| c / self.size);
    }

    /// Distance of a point above the plane in units of [`SPACING`], rounded.
    pub(super) fn height(&self, point: &Lattice) -> f64 {
        super::dot(&self.unit, &difference(point, self.through()))
    }

    /// Above (greater), on or below the plane; exact.
    pub(super) fn side(&self, point: &Lattice) -> Ordering {
        self.side_and_height(point).0
    }

    /// [`Self::side`] and [`Self::height`] at once.
    pub(super) fn side_and_height(&self, point: &Lattice) -> (Ordering, f64) {
        let (mut height, mut size) = (0.0, 0.0);
        let offsets = difference(point, self.through());
        for ((unit, bound), offset) in self.unit.iter().zip(&self.bound).zip(&offsets) {
            height += unit * offset;
            size += bound * offset.abs();
        }
        let side = if height > ROUNDING * size {
            Ordering::Greater
        } else if height < -ROUNDING * size {
            Ordering::Less
        } else {
            self.exact_side(point)
        };
        (side, height)
    }

    fn exact_side(&self, point: &Lattice) -> Ordering {
        let (mut sum, through) = ([0; MAX_DIMENSION], self.through());
        for (j, minor) in self.minors().iter().enumerate().take(self.dimension) {
            let factor = point[j] - through[j];
            let factor = if (j % 2 == 1) == self.turned { factor } else { -factor };
            add_product(&mut sum, factor, minor, self.dimension);
        }
        extend(&mut sum, self.dimension);
        if is_negative(&sum) {
            Ordering::Less
        } else if sum == [0; MAX_DIMENSION] {
            Ordering::Equal
        } else {
            Ordering::Greater
        }
    }

    fn minors(&self) -> &[Wide; MAX_DIMENSION] {
        self.minors.get_or_init(|| Box::new(exact_minors(self.dimension, &self.corners)))
    }
}

/// The normal, not yet turned or scaled, and its components with all signs positive.
fn rough_normal(dimension: usize, corners: &[Lattice; MAX_DIMENSION]) -> (PolytopePoint, PolytopePoint) {
    let all = (1usize << dimension) - 1;
    // Indexed by the set of columns; expanded row by row.
    let mut minors = [(0.0, 0.0); 1 << MAX_DIMENSION];
    minors[0] = (1.0, 1.0);
    for columns in 1..all {
        let row = columns.count_ones() as usize;
        let (mut minor, mut bound) = (0.0, 0.0);
        let (mut rest, mut sign) = (columns, if row.is_multiple_of(2) { -1.0 } else { 1.0 });
        while rest != 0 {
            let column = rest.trailing_zeros() as usize;
            rest &= rest - 1;
            let factor = sign * (corners[row][column] - corners[0][column]) as f64;
            let (smaller, smaller_bound) = minors[columns ^ 1 << column];
            minor += factor * smaller;
            bound += factor.abs() * smaller_bound;
            sign = -sign;
        }
        minors[columns] = (minor, bound);
    }
    let (mut normal, mut bounds) = ([0.0; MAX_DIMENSION], [0.0; MAX_DIMENSION]);
    for column in 0..dimension {
        let (minor, bound) = minors[all ^ 1 << column];
        normal[column] = if column.is_multiple_of(2) { minor } else { -minor };
        bounds[column] = bound;
    }
    (normal, bounds)
}

/// The minors of the dimension − 1 rows of differences to the first point, each without one column. Expanded
/// along the last row, for all sets of columns from small to large.
fn exact_minors(dimension: usize, corners: &[Lattice; MAX_DIMENSION]) -> [Wide; MAX_DIMENSION] {
    let all = (1usize << dimension) - 1;
    let mut minors = [[0; MAX_DIMENSION]; 1 << MAX_DIMENSION];
    minors[0] = [1, 0, 0, 0, 0, 0];
    for columns in 1..all {
        let rows = columns.count_ones() as usize;
        let (mut minor, mut rest, mut negative) = ([0; MAX_DIMENSION], columns, rows.is_multiple_of(2));
        while rest != 0 {
            let column = rest.trailing_zeros() as usize;
            rest &= rest - 1;
            let factor = corners[rows][column] - corners[0][column];
            let factor = if negative { -factor } else { factor };
            add_product(&mut minor, factor, &minors[columns ^ 1 << column], rows);
            negative = !negative;
        }
        extend(&mut minor, rows);
        minors[columns] = minor;
    }
    let mut result = [[0; MAX_DIMENSION]; MAX_DIMENSION];
    for (column, minor) in result.iter_mut().enumerate().take(dimension) {
        *minor = minors[all ^ 1 << column];
    }
    result
}

fn is_negative(number: &Wide) -> bool {
    number[MAX_DIMENSION - 1] >> 63 == 1
}

/// Fills the words beyond the first `words`, which hold the number, with its sign.
fn extend(number: &mut Wide, words: usize) {
    let negative = number[words - 1] >> 63 == 1;
    number[words..].fill(if negative { u64::MAX } else { 0 });
}

/// `sum` += `factor` · `number`, in the first `words` words.
fn add_product(sum: &mut Wide, factor: i64, number: &Wide, words: usize) {
    // −(−1 − s + p) − 1 = s − p: to subtract, add to the complement.
    let flip = if factor < 0 { u64::MAX } else { 0 };
    let (factor, mut carry) = (u128::from(factor.unsigned_abs()), 0u128);
    for (word, digit) in sum.iter_mut().zip(number).take(words) {
        // (2^64 − 1)² + 2 (2^64 − 1) < 2^128.
        let total = factor * u128::from(*digit) + u128::from(*word ^ flip) + carry;
        *word = total as u64 ^ flip;
        carry = total >> 64;
    }
}

/// The nearest `f64`, or a neighbour of it.
fn rounded(number: &Wide) -> f64 {
    let negative = is_negative(number);
    let mut size = *number;
    if negative {
        size = [0; MAX_DIMENSION];
        add_product(&mut size, -1, number, MAX_DIMENSION);
    }
    let size = size.iter().rev().fold(0.0, |high, word| high * 18_446_744_073_709_551_616.0 + *word as f64);
    if negative { -size } else { size }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wide_products_have_the_right_sign() {
        let mut sum = [0; MAX_DIMENSION];
        add_product(&mut sum, -7, &[1, 0, 0, 0, 0, 0], 1);
        extend(&mut sum, 1);
        assert!(is_negative(&sum));
        assert_eq!(rounded(&sum), -7.0);
        let minus_seven = sum;
        add_product(&mut sum, -3, &minus_seven, MAX_DIMENSION);
        assert_eq!(rounded(&sum), 14.0);
        add_product(&mut sum, i64::MIN, &[0, 1, 0, 0, 0, 0], MAX_DIMENSION);
        assert_eq!(rounded(&sum), 14.0 - 2f64.powi(127));
    }

    #[test]
    fn a_unit_of_the_lattice_decides_the_side_in_every_dimension() {
        let far = 1i64 << 50;
        for dimension in 1..=MAX_DIMENSION {
            // The plane x_0 + … = far through the far points of the axes, and points one unit off the plane.
            let mut points = [[0; MAX_DIMENSION]; MAX_DIMENSION];
            for (axis, point) in points.iter_mut().enumerate().take(dimension) {
                point[axis] = far;
            }
            let plane = Plane::new(dimension, &points, &[0; MAX_DIMENSION]).unwrap();
            let mut on = [far / 3; MAX_DIMENSION];
            on[dimension..].fill(0);
            on[0] = far - on[1..].iter().sum::<i64>();
            assert_eq!(plane.side(&on), Ordering::Equal, "{dimension}");
            for (change, side) in [(1, Ordering::Greater), (-1, Ordering::Less)] {
                let mut point = on;
                point[dimension - 1] += change;
                assert_eq!(plane.side(&point), side, "{dimension}");
            }
        }
    }
}
