//! On which side of a plane does a point lie? The exact answer.
//!
//! ```text
//!   normal_j = (−1)^j · det(rows p_i − p_0, without column j)        side of q = sign Σ_j normal_j (q_j − p_0j)
//! ```
//!
//! Points are rounded to a lattice of [`SPACING`], so that coordinates are whole numbers, sums of points are exact, and
//! sums that ought to be coplanar are. A plane's normal is computed once, in whole numbers of up to 384 bits, and
//! rounded once; the sign for a point is first tried with the rounded normal, whose error is below
//! [`ROUNDING`] times the sum of its terms' sizes, and computed in whole numbers where that does not decide.
//!
//! Sizes: coordinates are below [`REACH`] / [`SPACING`] = 2^50, those of a sum of two below 2^51, differences
//! below 2^52. By Hadamard's inequality a k × k minor is below k^(k/2) · 2^(52 k), and with k ≤ 6 that is
//! below 2^(64 k − 1): it fits k words with its sign.

use super::{MAX_DIMENSION, Point};
use std::cmp::Ordering;

/// Distance between neighbouring lattice points: 2⁻⁴⁰ ≈ 9e-13 D or rad, 4 000 times the rounding of a coordinate of
/// order 1, so that rounding makes no lattice points of its own.
pub(super) const SPACING: f64 = 1.0 / (1u64 << 40) as f64;
/// Largest coordinate of a point: a thousand times any connector, and what keeps minors in their words.
pub(super) const REACH: f64 = 1024.0;
/// Relative error of the rounded side: the normal's components are each off by less than 10 units of 2⁻⁵³ (rounding
/// six words, squares, sum, root, quotient), products and their sum by less than 7 more, and 17 < 32.
const ROUNDING: f64 = 32.0 * (f64::EPSILON / 2.0);

/// A point in units of [`SPACING`].
pub(super) type Lattice = [i64; MAX_DIMENSION];

/// A signed whole number, lowest word first, two's complement.
type Wide = [u64; MAX_DIMENSION];

/// The lattice point next to `point`, or none where a coordinate is no number or out of reach. What is beyond the
/// dimension becomes 0.
pub(super) fn snapped(dimension: usize, point: &Point) -> Option<Lattice> {
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
pub(super) fn coordinates(lattice: &Lattice) -> Point {
    lattice.map(|c| c as f64 * SPACING)
}

/// The differences `a` − `b` as numbers, exact.
pub(super) fn difference(a: &Lattice, b: &Lattice) -> Point {
    std::array::from_fn(|j| (a[j] - b[j]) as f64)
}

/// An oriented plane through lattice points.
pub(super) struct Plane {
    dimension: usize,
    pub(super) through: Lattice,
    /// Minors; the signs that belong to them are (−1)^j, all turned when `turned`.
    minors: [Wide; MAX_DIMENSION],
    turned: bool,
    /// The unit normal, pointing away from what lies below; its components are right to 10 units of 2⁻⁵³.
    pub(super) unit: Point,
    /// Length of the whole-number normal: (dimension − 1)! times the measure of the simplex it was made from.
    pub(super) size: f64,
}

impl Plane {
    /// The plane through the first `dimension` of `points`, with `below` below it; none where those points lie in
    /// something flatter or `below` lies on it. `minors` is scratch.
    pub(super) fn new(
        dimension: usize,
        points: &[Lattice; MAX_DIMENSION],
        below: &Lattice,
        minors: &mut Minors,
    ) -> Option<Self> {
        let mut plane = Self {
            dimension,
            through: points[0],
            minors: minors.of(dimension, points),
            turned: false,
            unit: [0.0; MAX_DIMENSION],
            size: 0.0,
        };
        for (j, (unit, minor)) in plane.unit.iter_mut().zip(&plane.minors).enumerate().take(dimension) {
            *unit = if j % 2 == 0 { rounded(minor) } else { -rounded(minor) };
        }
        // At most 2^313: its square is a number.
        plane.size = plane.unit.iter().map(|c| c * c).sum::<f64>().sqrt();
        if plane.size == 0.0 {
            return None;
        }
        plane.unit = plane.unit.map(|c| c / plane.size);
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

    /// Distance of a point above the plane in units of [`SPACING`], rounded.
    pub(super) fn height(&self, point: &Lattice) -> f64 {
        super::dot(&self.unit, &difference(point, &self.through))
    }

    /// Above (greater), on or below the plane; exact.
    pub(super) fn side(&self, point: &Lattice) -> Ordering {
        let (mut height, mut size) = (0.0, 0.0);
        for (unit, difference) in self.unit.iter().zip(difference(point, &self.through)) {
            let term = unit * difference;
            height += term;
            size += term.abs();
        }
        if height.abs() > ROUNDING * size {
            return if height > 0.0 { Ordering::Greater } else { Ordering::Less };
        }
        let mut sum = [0; MAX_DIMENSION];
        for (j, minor) in self.minors.iter().enumerate().take(self.dimension) {
            let factor = point[j] - self.through[j];
            add_product(&mut sum, if (j % 2 == 1) == self.turned { factor } else { -factor }, minor);
        }
        if is_negative(&sum) {
            Ordering::Less
        } else if sum == [0; MAX_DIMENSION] {
            Ordering::Equal
        } else {
            Ordering::Greater
        }
    }
}

/// Scratch: the minors of the first rows, by the set of their columns.
pub(super) struct Minors([Wide; 1 << MAX_DIMENSION]);

impl Minors {
    pub(super) fn new() -> Self {
        Self([[0; MAX_DIMENSION]; 1 << MAX_DIMENSION])
    }

    /// The minors of the dimension − 1 rows of differences to the first point, leaving out one column each. Expanded along the last row, for
    /// all sets of columns from small to large.
    fn of(&mut self, dimension: usize, points: &[Lattice; MAX_DIMENSION]) -> [Wide; MAX_DIMENSION] {
        let all = (1usize << dimension) - 1;
        self.0[0] = [1, 0, 0, 0, 0, 0];
        for columns in 1..all {
            let rows = columns.count_ones() as usize;
            let (mut minor, mut rest, mut negative) = ([0; MAX_DIMENSION], columns, rows.is_multiple_of(2));
            while rest != 0 {
                let column = rest.trailing_zeros() as usize;
                rest &= rest - 1;
                let factor = points[rows][column] - points[0][column];
                add_product(
                    &mut minor,
                    if negative { -factor } else { factor },
                    &self.0[columns ^ 1 << column],
                );
                negative = !negative;
            }
            self.0[columns] = minor;
        }
        let mut found = [[0; MAX_DIMENSION]; MAX_DIMENSION];
        for (column, minor) in found.iter_mut().enumerate().take(dimension) {
            *minor = self.0[all ^ 1 << column];
        }
        found
    }
}

fn is_negative(number: &Wide) -> bool {
    number[MAX_DIMENSION - 1] >> 63 == 1
}

/// `sum` += `factor` · `number`, modulo 2^384.
fn add_product(sum: &mut Wide, factor: i64, number: &Wide) {
    // −(−1 − s + p) − 1 = s − p: to subtract, add to the complement.
    let flip = if factor < 0 { u64::MAX } else { 0 };
    let (factor, mut carry) = (u128::from(factor.unsigned_abs()), 0u128);
    for (word, digit) in sum.iter_mut().zip(number) {
        // (2^64 − 1)² + 2 (2^64 − 1) < 2^128.
        let total = factor * u128::from(*digit) + u128::from(*word ^ flip) + carry;
        *word = total as u64 ^ flip;
        carry = total >> 64;
    }
}

/// The nearest `f64`, or one of its next neighbours.
fn rounded(number: &Wide) -> f64 {
    let negative = is_negative(number);
    let mut size = *number;
    if negative {
        size = [0; MAX_DIMENSION];
        add_product(&mut size, -1, number);
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
        add_product(&mut sum, -7, &[1, 0, 0, 0, 0, 0]);
        assert!(is_negative(&sum));
        assert_eq!(rounded(&sum), -7.0);
        let minus_seven = sum;
        add_product(&mut sum, -3, &minus_seven);
        assert_eq!(rounded(&sum), 14.0);
        add_product(&mut sum, i64::MIN, &[0, 1, 0, 0, 0, 0]);
        assert_eq!(rounded(&sum), 14.0 - 2f64.powi(127));
    }

    #[test]
    fn a_unit_of_the_lattice_decides_the_side_in_every_dimension() {
        let far = 1i64 << 50;
        for dimension in 1..=MAX_DIMENSION {
            // The plane x_0 + … = far through the axes' far points, and points one unit beside it.
            let mut points = [[0; MAX_DIMENSION]; MAX_DIMENSION];
            for (axis, point) in points.iter_mut().enumerate().take(dimension) {
                point[axis] = far;
            }
            let plane = Plane::new(dimension, &points, &[0; MAX_DIMENSION], &mut Minors::new()).unwrap();
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
