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
#[derive(Debug, Clone, Copy)]
struct Corner {
    at: DVec2,
    of_second: bool,
}

impl Convex {
    fn of(part: &[Node]) -> Self {
        let corners: Vec<DVec2> = part.iter().map(|p| place(*p)).collect();
        let ends = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let (low, high) = corners.iter().fold(ends, |(low, high), p| (low.min(*p), high.max(*p)));
        let area = sides(&corners).map(|[p, q]| p.perp_dot(q)).sum::<f64>() / 2.0;
        Self { corners, area, low, high }
    }

    /// Whether the rectangles around the two come within `near` of each other, with the other moved by d.
    fn is_near(&self, other: &Self, d: DVec2, near: f64) -> bool {
        let near = DVec2::splat(near);
        self.low.cmple(other.high + d + near).all() && (other.low + d).cmple(self.high + near).all()
    }

    /// The intersection with another polygon that is moved by d, and grown: each of its sides is moved
    /// outwards, so that a square with half the side `grown` about every point of it is inside.
    fn common(&self, other: &Self, d: DVec2, grown: f64) -> Common {
        if !self.is_near(other, d, grown) {
            return Common::default();
        }
        let mut rest: Vec<Corner> =
            self.corners.iter().map(|p| Corner { at: *p, of_second: false }).collect();
        let mut kept = Vec::with_capacity(self.corners.len() + other.corners.len());
        for [from, to] in sides(&other.corners) {
            cut(&rest, from + d, to - from, grown, &mut kept);
            std::mem::swap(&mut rest, &mut kept);
            if rest.len() < 3 {
                return Common::default();
            }
        }
        let mut found = Common::default();
        for (k, corner) in rest.iter().enumerate() {
            let next = rest[(k + 1) % rest.len()].at;
            found.area += 0.5 * (corner.at - rest[0].at).perp_dot(next - rest[0].at);
            if corner.of_second {
                let along = next - corner.at;
                found.gradient += DVec2::new(along.y, -along.x);
            }
        }
        if found.area > 0.0 { found } else { Common::default() }
    }
}

/// The sides of a closed outline.
fn sides(corners: &[DVec2]) -> impl Iterator<Item = [DVec2; 2]> + '_ {
    (0..corners.len()).map(|k| [corners[k], corners[(k + 1) % corners.len()]])
}

/// The part of a convex polygon left of a side of the second, which is moved outwards for a square of half
/// side `grown`.
fn cut(polygon: &[Corner], from: DVec2, along: DVec2, grown: f64, kept: &mut Vec<Corner>) {
    let outwards = grown * along.abs().element_sum();
    let left = |p: DVec2| along.perp_dot(p - from) + outwards;
    kept.clear();
    let first = left(polygon[0].at);
    let mut there = first;
    for (k, corner) in polygon.iter().enumerate() {
        let here = there;
        let next = polygon[(k + 1) % polygon.len()];
        there = if k + 1 < polygon.len() { left(next.at) } else { first };
        if here >= 0.0 {
            kept.push(*corner);
        }
        if (here >= 0.0) != (there >= 0.0) {
            let at = corner.at.lerp(next.at, here / (here - there));
            // At an exit from the half-plane the side of the second polygon begins; at an entry the polygon's
            // own side continues.
            kept.push(Corner { at, of_second: here >= 0.0 || corner.of_second });
        }
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
        self.second.iter().map(|b| self.first.iter().map(|a| a.common(b, d, 0.0).area).sum::<f64>()).sum()
    }

    /// Area of A ∩ (B + d), and the most it is at places no farther from d than `half` along either axis.
    pub(super) fn around(&self, d: DVec2, half: f64) -> Around {
        // Roundings of some dozens of terms are far below this share.
        const ROUNDING: f64 = 1e-10;
        let (mut value, mut gradient, mut bent, mut rough, mut together) = (0.0, DVec2::ZERO, 0.0, 0.0, 0.0);
        for b in &self.second {
            for a in &self.first {
                if !a.is_near(b, d, half) {
                    continue;
                }
                let found = a.common(b, d, 0.0);
                value += found.area;
                let grown = a.common(b, d, half).area.min(a.area.min(b.area));
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
