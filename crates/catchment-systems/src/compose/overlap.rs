//! The overlap of two regions as a function of the position of the second, and a bound on it around a
//! position.
//!
//! ```text
//!   O(d) = Σ O_ij(d)        over pairs of convex polygons, O_ij = area of their intersection
//!
//!   √O_ij is concave on its support (Brunn and Minkowski), so with the gradient ∇ of O_ij at d, for every δ
//!
//!   O_ij(d + δ) ≤ (√O_ij + ∇·δ / 2√O_ij)² = O_ij + ∇·δ + (∇·δ)² / 4 O_ij
//!   O_ij(d + δ) ≤ area of A_i ∩ (B_j + d, its sides moved outwards for a square of side 2·max|δ| about any point)
//! ```
//!
//! The gradient is the sum of the sides of the intersection that belong to the second polygon, each as its
//! length along its outer normal. If sides of both polygons coincide `O_ij` has a kink, and either choice
//! bounds it. Linear terms of pairs add up with their signs, so that they cancel near the maximum; the second
//! bound serves pairs with little or no overlap.

use super::region::{Node, Region, place};
use super::sum::convex_parts;
use glam::DVec2;

/// The overlap of the two regions when the second is moved by d: area of A ∩ (B + d), from their convex polygons.
///
/// It is the convolution of the indicator functions of A and −B: 0 outside the Minkowski sum of the two, and its integral over
/// all d is area(A)·area(B).
#[derive(Debug, Clone)]
pub struct RegionOverlap {
    first: Vec<Convex>,
    second: Vec<Convex>,
}

/// An overlap with its bounds around a position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Around {
    /// At the place.
    pub(super) value: f64,
    /// At most, at all places no farther off along either axis.
    pub(super) at_most: f64,
}

/// A convex polygon, counter-clockwise, with its area and the rectangle around it.
#[derive(Debug, Clone)]
struct Convex {
    corners: Vec<DVec2>,
    area: f64,
    low: DVec2,
    high: DVec2,
}

/// The intersection of two convex polygons.
#[derive(Debug, Clone, Copy, Default)]
struct Common {
    area: f64,
    /// Change of the area with the place of the second.
    gradient: DVec2,
}

/// A corner of an intersection, and whether the side that begins there belongs to the second polygon.
#[derive(Debug, Clone, Copy, Default)]
struct Corner {
    x: f64,
    y: f64,
    of_second: bool,
}

/// Room for the corners of what is left of a polygon, before a cut and after it.
type Scratch = [Vec<Corner>; 2];

// Nearly all time of a search for the largest overlap is spent here. Plain loops over numbers: this package is compiled without
// optimisation, where every call of an iterator or of a vector's operator stays a call.
impl Convex {
    fn of(part: &[Node]) -> Self {
        let corners: Vec<DVec2> = part.iter().map(|p| place(*p)).collect();
        let ends = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let (low, high) = corners.iter().fold(ends, |(low, high), p| (low.min(*p), high.max(*p)));
        let next = corners.iter().cycle().skip(1);
        let area = corners.iter().zip(next).map(|(p, q)| p.perp_dot(*q)).sum::<f64>() / 2.0;
        Self { corners, area, low, high }
    }

    /// Whether the rectangles around the two come within `near` of each other, with the other moved by d.
    fn is_near(&self, other: &Self, d: DVec2, near: f64) -> bool {
        self.low.x <= other.high.x + d.x + near
            && self.low.y <= other.high.y + d.y + near
            && other.low.x + d.x <= self.high.x + near
            && other.low.y + d.y <= self.high.y + near
    }

    /// The intersection with another polygon that is moved by d, and grown: each of its sides is moved
    /// outwards, so that a square with half the side `grown` about every point of it is inside.
    fn common(&self, other: &Self, d: DVec2, grown: f64, [rest, kept]: &mut Scratch) -> Common {
        if !self.is_near(other, d, grown) {
            return Common::default();
        }
        let (own, sides): (&[DVec2], &[DVec2]) = (&self.corners, &other.corners);
        let mut count = own.len();
        rest.clear();
        rest.extend(own.iter().map(|p| Corner { x: p.x, y: p.y, of_second: false }));
        let mut k = 0;
        while k < sides.len() {
            let (from, to) = (sides[k], sides[if k + 1 < sides.len() { k + 1 } else { 0 }]);
            let side = Side { x: from.x + d.x, y: from.y + d.y, along: [to.x - from.x, to.y - from.y] };
            if kept.len() < 2 * count {
                kept.resize(2 * count, Corner::default());
            }
            count = side.cut(&rest[..count], grown, kept);
            std::mem::swap(rest, kept);
            if count < 3 {
                return Common::default();
            }
            k += 1;
        }
        let corners: &[Corner] = &rest[..count];
        let (x, y) = (corners[0].x, corners[0].y);
        let (mut area, mut gradient) = (0.0, DVec2::ZERO);
        k = 0;
        while k < count {
            let (here, next) = (corners[k], corners[if k + 1 < count { k + 1 } else { 0 }]);
            area += 0.5 * ((here.x - x) * (next.y - y) - (here.y - y) * (next.x - x));
            if here.of_second {
                gradient.x += next.y - here.y;
                gradient.y -= next.x - here.x;
            }
            k += 1;
        }
        if area > 0.0 { Common { area, gradient } } else { Common::default() }
    }
}

/// A side of the second polygon: where it begins, and from there to its end.
struct Side {
    x: f64,
    y: f64,
    along: [f64; 2],
}

impl Side {
    /// The part of a convex polygon left of the side, which is moved outwards for a square of half side `grown`: its corners are
    /// the first of `kept`, which has room for twice as many; returns how many there are.
    fn cut(&self, polygon: &[Corner], grown: f64, kept: &mut [Corner]) -> usize {
        let (x, y, [along_x, along_y]) = (self.x, self.y, self.along);
        let outwards = grown * (along_x.abs() + along_y.abs());
        let mut found = 0;
        let first = along_x * (polygon[0].y - y) - along_y * (polygon[0].x - x) + outwards;
        let (mut here, mut k) = (first, 0);
        while k < polygon.len() {
            let is_last = k + 1 == polygon.len();
            let (corner, next) = (polygon[k], polygon[if is_last { 0 } else { k + 1 }]);
            let there =
                if is_last { first } else { along_x * (next.y - y) - along_y * (next.x - x) + outwards };
            if here >= 0.0 {
                kept[found] = corner;
                found += 1;
            }
            if (here >= 0.0) != (there >= 0.0) {
                let share = here / (here - there);
                // At an exit from the half-plane the side of the second polygon begins; at an entry the polygon's
                // own side continues.
                kept[found] = Corner {
                    x: corner.x * (1.0 - share) + next.x * share,
                    y: corner.y * (1.0 - share) + next.y * share,
                    of_second: here >= 0.0 || corner.of_second,
                };
                found += 1;
            }
            here = there;
            k += 1;
        }
        found
    }
}

impl RegionOverlap {
    /// Of two regions.
    pub fn new(a: &Region, b: &Region) -> Self {
        let parts = |region: &Region| convex_parts(region).iter().map(|part| Convex::of(part)).collect();
        Self { first: parts(a), second: parts(b) }
    }

    /// Number of pairs of convex polygons for a value.
    pub(super) fn pairs(&self) -> usize {
        self.first.len() * self.second.len()
    }

    /// Area of A ∩ (B + d).
    pub fn at(&self, d: DVec2) -> f64 {
        let mut scratch = Scratch::default();
        let mut of =
            |b: &Convex| self.first.iter().map(|a| a.common(b, d, 0.0, &mut scratch).area).sum::<f64>();
        self.second.iter().map(&mut of).sum()
    }

    /// Area of A ∩ (B + d), and the most it is at places no farther from d than `half` along either axis.
    pub(super) fn around(&self, d: DVec2, half: f64) -> Around {
        // Roundings of some dozens of terms are far below this share.
        const ROUNDING: f64 = 1e-10;
        let mut scratch = Scratch::default();
        let (mut value, mut gradient, mut bent, mut rough, mut together) = (0.0, DVec2::ZERO, 0.0, 0.0, 0.0);
        for b in &self.second {
            for a in &self.first {
                if !a.is_near(b, d, half) {
                    continue;
                }
                let found = a.common(b, d, 0.0, &mut scratch);
                value += found.area;
                let grown = a.common(b, d, half, &mut scratch).area.min(a.area.min(b.area));
                let most = (grown - found.area).max(0.0);
                let turn = half * found.gradient.abs().element_sum();
                let bend = 0.25 * turn * turn / found.area;
                if found.area > 0.0 && bend < most {
                    gradient += found.gradient;
                    bent += bend;
                } else {
                    rough += most;
                }
                together += most;
            }
        }
        let at_most = value + (half * gradient.abs().element_sum() + bent + rough).min(together);
        Around { value, at_most: at_most * (1.0 + ROUNDING) }
    }
}
