//! Convex polygons of the plane, and the area that two of them have in common.
//!
//! ```text
//!        ┌─────────┐
//!        │    ┌────┼────┐       O(d) = area of A ∩ (B + d)
//!      A │    │ O  │    │
//!        └────┼────┘    │ B + d       ∇O = Σ length · outer normal, over the sides of A ∩ (B + d) that are sides of B
//!             └─────────┘
//! ```
//!
//! By Sutherland and Hodgman: A is cut by one side of B after the other.

use glam::DVec2;

/// A convex polygon, counter-clockwise, with its area and the rectangle around it.
#[derive(Debug, Clone)]
pub struct ConvexPolygon {
    corners: Vec<DVec2>,
    area: f64,
    low: DVec2,
    high: DVec2,
}

/// The intersection of two convex polygons.
#[derive(Debug, Clone, Copy, Default)]
pub struct Common {
    /// 0 where the two do not overlap.
    pub area: f64,
    /// Change of the area with the place of the second.
    pub gradient: DVec2,
}

/// A corner of an intersection, and whether the side that begins there belongs to the second polygon.
#[derive(Debug, Clone, Copy)]
struct Corner {
    at: DVec2,
    of_second: bool,
}

/// Room for the corners of what is left of a polygon, before a cut and after it: reused from one intersection to the next.
#[derive(Debug, Default)]
pub struct Scratch([Vec<Corner>; 2]);

impl ConvexPolygon {
    /// Of its corners, counter-clockwise.
    pub fn new(corners: Vec<DVec2>) -> Self {
        let ends = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let (low, high) = corners.iter().fold(ends, |(low, high), p| (low.min(*p), high.max(*p)));
        let next = corners.iter().cycle().skip(1);
        let area = corners.iter().zip(next).map(|(p, q)| p.perp_dot(*q)).sum::<f64>() / 2.0;
        Self { corners, area, low, high }
    }

    /// Its area.
    pub fn area(&self) -> f64 {
        self.area
    }

    /// Whether the rectangles around the two come within `near` of each other, with the other moved by d.
    pub fn is_near(&self, other: &Self, d: DVec2, near: f64) -> bool {
        self.low.x <= other.high.x + d.x + near
            && self.low.y <= other.high.y + d.y + near
            && other.low.x + d.x <= self.high.x + near
            && other.low.y + d.y <= self.high.y + near
    }

    /// The intersection with another polygon that is moved by d, and grown: each of its sides is moved
    /// outwards, so that a square with half the side `grown` about every point of it is inside.
    pub fn common(&self, other: &Self, d: DVec2, grown: f64, Scratch([rest, kept]): &mut Scratch) -> Common {
        if !self.is_near(other, d, grown) {
            return Common::default();
        }
        rest.clear();
        rest.extend(self.corners.iter().map(|p| Corner { at: *p, of_second: false }));
        for (k, from) in other.corners.iter().enumerate() {
            let to = other.corners[(k + 1) % other.corners.len()];
            cut(rest, *from + d, to - *from, grown, kept);
            std::mem::swap(rest, kept);
            if rest.len() < 3 {
                return Common::default();
            }
        }
        let first = rest[0].at;
        let (mut area, mut gradient) = (0.0, DVec2::ZERO);
        for (k, here) in rest.iter().enumerate() {
            let next = rest[if k + 1 < rest.len() { k + 1 } else { 0 }];
            area += 0.5 * (here.at - first).perp_dot(next.at - first);
            if here.of_second {
                gradient.x += next.at.y - here.at.y;
                gradient.y -= next.at.x - here.at.x;
            }
        }
        if area > 0.0 { Common { area, gradient } } else { Common::default() }
    }
}

/// The part of a convex polygon left of a side of the second, which begins at a place and goes `along`, and is moved outwards
/// for a square of half side `grown`.
fn cut(polygon: &[Corner], begin: DVec2, along: DVec2, grown: f64, kept: &mut Vec<Corner>) {
    kept.clear();
    let outwards = grown * (along.x.abs() + along.y.abs());
    let left = |corner: &Corner| along.perp_dot(corner.at - begin) + outwards;
    let first = left(&polygon[0]);
    let mut here = first;
    for (k, corner) in polygon.iter().enumerate() {
        let next = polygon.get(k + 1);
        let there = next.map_or(first, left);
        if here >= 0.0 {
            kept.push(*corner);
        }
        if (here >= 0.0) != (there >= 0.0) {
            let share = here / (here - there);
            // At an exit from the half-plane the side of the second polygon begins; at an entry the polygon's
            // own side continues.
            kept.push(Corner {
                at: corner.at * (1.0 - share) + next.unwrap_or(&polygon[0]).at * share,
                of_second: here >= 0.0 || corner.of_second,
            });
        }
        here = there;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(side: f64) -> ConvexPolygon {
        let corners = [(0.0, 0.0), (side, 0.0), (side, side), (0.0, side)];
        ConvexPolygon::new(corners.map(|(x, y)| DVec2::new(x, y)).to_vec())
    }

    /// Two squares overlap as a product of tents; the gradient is the slope of the product.
    #[test]
    fn squares_overlap_as_tents() {
        let (one, two, mut scratch) = (square(1.0), square(2.0), Scratch::default());
        for (x, y) in [(0.25, 0.5), (-0.5, -1.75), (0.75, -0.5), (-1.0, 0.25)] {
            let found = one.common(&two, DVec2::new(x, y), 0.0, &mut scratch);
            // Of [0, 1] ∩ [d, d + 2]: its length and its slope.
            let tent = |d: f64| {
                if d > 0.0 {
                    (1.0 - d, -1.0)
                } else if d < -1.0 {
                    (d + 2.0, 1.0)
                } else {
                    (1.0, 0.0)
                }
            };
            let ((across, dx), (along, dy)) = (tent(x), tent(y));
            assert!((found.area - across * along).abs() < 1e-15, "{x} {y}: {found:?}");
            let slope = DVec2::new(dx * along, dy * across);
            // At d = −1 the tent has a kink, and either slope is its gradient.
            let is_kink = x == -1.0;
            assert!(is_kink || (found.gradient - slope).length() < 1e-15, "{x} {y}: {found:?} {slope}");
        }
        assert_eq!(one.common(&two, DVec2::new(1.5, 0.0), 0.0, &mut scratch).area, 0.0);
        // Grown by a square of half side 1 it reaches over half of the first.
        assert_eq!(one.common(&two, DVec2::new(1.5, 0.0), 1.0, &mut scratch).area, 0.5);
        assert_eq!((one.area(), two.area()), (1.0, 4.0));
    }
}
