//! Regions of the plane: polygons with holes, on a lattice.
//!
//! ```text
//!   ┌──────────┐
//!   │  ┌────┐  │   ┌───┐        parts: 2, holes: 1
//!   │  └────┘  │   └───┘        a border belongs to its region
//!   └──────────┘
//! ```
//!
//! Corners are integer multiples of [`UNIT`], 2⁻³² of the unit of length, and sums of such points are exactly
//! such points. Crossings of outlines are decided in integers (`i_overlay`), so regions that only touch stay
//! that way; a crossing of two sides is rounded to the lattice. A region may also have parts without area,
//! points and segments.

use glam::DVec2;
use i_triangle::i_overlay::core::fill_rule::FillRule;
use i_triangle::i_overlay::core::overlay::{IntOverlayOptions, Overlay, ShapeType};
use i_triangle::i_overlay::core::overlay_rule::OverlayRule;
use i_triangle::i_overlay::core::solver::Solver;
use i_triangle::i_overlay::i_float::int::point::IntPoint;

/// Distance of neighbouring points of the lattice, in mm or D: 2⁻³² ≈ 2.3e-10.
pub const UNIT: f64 = 1.0 / (1u64 << 32) as f64;
/// Largest coordinate, in mm or D: sums of two stay exact in double precision.
pub const REACH: f64 = (1u64 << 20) as f64;

/// A point of the lattice.
pub(super) type Node = IntPoint<i64>;
/// Outlines of a part, the outer outline first.
pub(super) type Part = Vec<Vec<Node>>;

/// A closed set of points of the plane: polygons with holes, segments and points.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Region {
    pub(super) parts: Vec<Part>,
    /// Segments and, with both ends equal, points.
    pub(super) thin: Vec<[Node; 2]>,
}

/// The nearest point of the lattice.
pub(super) fn node(p: DVec2) -> Node {
    let snapped = |v: f64| (v / UNIT).round() as i64;
    Node::new(snapped(p.x), snapped(p.y))
}

/// Position of a point of the lattice.
pub(super) fn place(p: Node) -> DVec2 {
    DVec2::new(p.x as f64, p.y as f64) * UNIT
}

/// Twice the signed area of the triangle a, b, c, in lattice units.
pub(super) fn turn(a: Node, b: Node, c: Node) -> i128 {
    let d = |p: Node, q: Node| (i128::from(q.x) - i128::from(p.x), i128::from(q.y) - i128::from(p.y));
    let ((ux, uy), (vx, vy)) = (d(a, b), d(a, c));
    ux * vy - uy * vx
}

/// Twice the signed area of an outline, in lattice units.
fn doubled(outline: &[Node]) -> i128 {
    let Some(&origin) = outline.first() else { return 0 };
    outline.windows(2).map(|w| turn(origin, w[0], w[1])).sum()
}

/// Whether an outline encloses no more than rounding can make: thinner than a few units of the lattice.
fn is_sliver(outline: &[Node]) -> bool {
    /// Widest sliver, in lattice units: the error of a crossing is one unit, and so is that of its
    /// neighbours.
    const THIN: f64 = 8.0;
    let around: f64 = sides(outline).map(|[a, b]| place(a).distance(place(b))).sum::<f64>() / UNIT;
    doubled(outline).abs() as f64 <= THIN * around
}

/// The sides of an outline.
pub(super) fn sides(outline: &[Node]) -> impl Iterator<Item = [Node; 2]> + '_ {
    (0..outline.len()).map(|k| [outline[k], outline[(k + 1) % outline.len()]])
}

/// Result of the overlay of outlines.
fn overlaid(subject: &[Vec<Node>], clip: &[Vec<Node>], rule: OverlayRule, fill: FillRule) -> Vec<Part> {
    let capacity = subject.iter().chain(clip).map(Vec::len).sum();
    let mut overlay = Overlay::<i64>::new_custom(capacity, IntOverlayOptions::default(), Solver::default());
    overlay.add_source(subject, ShapeType::Subject);
    overlay.add_source(clip, ShapeType::Clip);
    Region::of_parts(overlay.overlay(rule, fill)).parts
}

impl Region {
    /// The points inside an odd number of closed outlines. Their direction does not matter.
    pub fn of_outlines(outlines: &[Vec<DVec2>]) -> Self {
        Self::filled(outlines, FillRule::EvenOdd)
    }

    /// The points that outlines wind around more often counter-clockwise than clockwise.
    pub(super) fn of_chains(outlines: &[Vec<DVec2>]) -> Self {
        Self::filled(outlines, FillRule::Positive)
    }

    fn filled(outlines: &[Vec<DVec2>], fill: FillRule) -> Self {
        let nodes: Vec<Vec<Node>> = outlines.iter().map(|o| o.iter().map(|p| node(*p)).collect()).collect();
        Self { parts: overlaid(&nodes, &[], OverlayRule::Subject, fill), thin: Vec::new() }
    }

    /// The points inside any of these outlines, for any direction.
    pub(super) fn of_nodes(outlines: &[Vec<Node>]) -> Self {
        let forward: Vec<Vec<Node>> = outlines
            .iter()
            .map(|o| if doubled(o) < 0 { o.iter().rev().copied().collect() } else { o.clone() })
            .collect();
        Self { parts: overlaid(&forward, &[], OverlayRule::Subject, FillRule::NonZero), thin: Vec::new() }
    }

    /// Parts that an overlay made, without the slivers that rounding made.
    pub(super) fn of_parts(mut parts: Vec<Part>) -> Self {
        parts.retain(|part| part.first().is_some_and(|outer| !is_sliver(outer)));
        for part in &mut parts {
            part.retain(|outline| !is_sliver(outline));
        }
        Self { parts, thin: Vec::new() }
    }

    /// A single point.
    pub fn point(p: DVec2) -> Self {
        Self { parts: Vec::new(), thin: vec![[node(p); 2]] }
    }

    /// The segment between two points.
    pub fn segment(a: DVec2, b: DVec2) -> Self {
        Self { parts: Vec::new(), thin: vec![[node(a), node(b)]] }
    }

    /// An axis-parallel rectangle.
    pub fn rectangle(low: DVec2, high: DVec2) -> Self {
        Self::of_outlines(&[vec![low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)]])
    }

    /// Everything that lies in any of the regions.
    pub fn union<'a>(regions: impl IntoIterator<Item = &'a Self>) -> Self {
        let (mut outlines, mut thin) = (Vec::new(), Vec::new());
        for region in regions {
            outlines.extend(region.nodes().map(<[Node]>::to_vec));
            thin.extend(region.thin.iter().copied());
        }
        Self { parts: overlaid(&outlines, &[], OverlayRule::Subject, FillRule::NonZero), thin }
    }

    fn clipped(&self, other: &Self, rule: OverlayRule) -> Self {
        let [own, clip] = [self, other].map(|r| r.nodes().map(<[Node]>::to_vec).collect::<Vec<_>>());
        Self { parts: overlaid(&own, &clip, rule, FillRule::NonZero), thin: Vec::new() }
    }

    /// The part of this region outside the other, with its border. Parts without area are removed.
    #[must_use]
    pub fn minus(&self, other: &Self) -> Self {
        self.clipped(other, OverlayRule::Difference)
    }

    /// The intersection of both. Parts without area are removed.
    #[must_use]
    pub fn intersection(&self, other: &Self) -> Self {
        self.clipped(other, OverlayRule::Intersect)
    }

    /// All outlines: outer outlines counter-clockwise, holes clockwise.
    pub(super) fn nodes(&self) -> impl Iterator<Item = &[Node]> {
        self.parts.iter().flatten().map(Vec::as_slice)
    }

    /// All outlines, in mm or D: outer outlines counter-clockwise, holes clockwise, the holes of a part after
    /// its outer outline.
    pub fn outlines(&self) -> Vec<Vec<DVec2>> {
        self.nodes().map(|outline| outline.iter().map(|p| place(*p)).collect()).collect()
    }

    /// Whether nothing is in it.
    pub fn is_empty(&self) -> bool {
        self.parts.is_empty() && self.thin.is_empty()
    }

    /// Its area, in mm² or D².
    pub fn area(&self) -> f64 {
        self.nodes().map(doubled).sum::<i128>() as f64 / 2.0 * UNIT * UNIT
    }

    /// Length of all its outlines, in mm or D.
    pub fn perimeter(&self) -> f64 {
        self.nodes().flat_map(sides).map(|[a, b]| place(a).distance(place(b))).sum()
    }

    /// How many connected polygons it has.
    pub fn parts(&self) -> usize {
        self.parts.len()
    }

    /// How many holes they have together.
    pub fn holes(&self) -> usize {
        self.parts.iter().map(|part| part.len() - 1).sum()
    }

    /// How many corners all outlines have together.
    pub fn corners(&self) -> usize {
        self.nodes().map(<[Node]>::len).sum()
    }

    /// The smallest rectangle around it: its lowest and its highest corner.
    pub fn bounds(&self) -> Option<[DVec2; 2]> {
        let mut all = self.nodes().flatten().chain(self.thin.iter().flatten()).map(|p| place(*p));
        let first = all.next()?;
        Some(all.fold([first; 2], |[low, high], p| [low.min(p), high.max(p)]))
    }

    /// Whether a point lies in it or on its border; the point is rounded to the lattice.
    pub fn contains(&self, point: DVec2) -> bool {
        let p = node(point);
        let mut inside = false;
        for [a, b] in self.nodes().flat_map(sides) {
            if on(p, [a, b]) {
                return true;
            }
            if (a.y > p.y) != (b.y > p.y) {
                let left = turn(a, b, p) > 0;
                inside ^= left == (b.y > a.y);
            }
        }
        inside || self.thin.iter().any(|segment| on(p, *segment))
    }

    /// Every point moved by a map that keeps straight lines straight, such as a turn. The result is rounded to the lattice.
    #[must_use]
    pub fn mapped(&self, map: impl Fn(DVec2) -> DVec2) -> Self {
        let moved = |p: Node| node(map(place(p)));
        let outlines: Vec<Vec<Node>> = self.nodes().map(|o| o.iter().map(|p| moved(*p)).collect()).collect();
        let thin = self.thin.iter().map(|ends| ends.map(moved)).collect();
        Self { parts: overlaid(&outlines, &[], OverlayRule::Subject, FillRule::EvenOdd), thin }
    }

    /// The region turned counter-clockwise about the origin, by radians.
    #[must_use]
    pub fn turned(&self, angle: f64) -> Self {
        if angle == 0.0 { self.clone() } else { self.mapped(|p| DVec2::from_angle(angle).rotate(p)) }
    }

    /// Every point through the origin to the other side: −A, which is a half turn.
    #[must_use]
    pub fn reflected(&self) -> Self {
        self.mapped(|p| -p)
    }
}

/// Whether a point lies on a segment.
fn on(p: Node, [a, b]: [Node; 2]) -> bool {
    let between = |lo: i64, hi: i64, v: i64| lo.min(hi) <= v && v <= lo.max(hi);
    between(a.x, b.x, p.x) && between(a.y, b.y, p.y) && turn(a, b, p) == 0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(side: f64) -> Vec<DVec2> {
        let h = side / 2.0;
        [(-h, -h), (h, -h), (h, h), (-h, h)].map(|(x, y)| DVec2::new(x, y)).to_vec()
    }

    #[test]
    fn a_ring_has_a_hole_and_borders_belong_to_it() {
        let region = Region::of_outlines(&[ring(3.0), ring(1.0)]);
        assert_eq!((region.parts(), region.holes(), region.corners()), (1, 1, 8));
        assert_eq!((region.area(), region.perimeter()), (8.0, 16.0));
        for (x, y, inside) in
            [(0.0, 0.0, false), (0.5, 0.0, true), (1.0, 0.0, true), (1.5, 1.5, true), (1.6, 0.0, false)]
        {
            assert_eq!(region.contains(DVec2::new(x, y)), inside, "{x} {y}");
        }
        assert_eq!(region.bounds(), Some([DVec2::splat(-1.5), DVec2::splat(1.5)]));
        let island = Region::of_outlines(&[ring(3.0), ring(2.0), ring(1.0)]);
        assert_eq!((island.parts(), island.holes(), island.area()), (2, 1, 6.0));
    }

    #[test]
    fn regions_are_joined_and_cut_exactly_where_they_touch() {
        let left = Region::rectangle(DVec2::ZERO, DVec2::new(1.0, 2.0));
        let right = Region::rectangle(DVec2::new(1.0, 0.0), DVec2::new(2.0, 2.0));
        let both = Region::union([&left, &right]);
        assert_eq!((both.parts(), both.corners(), both.area()), (1, 4, 4.0));
        assert_eq!(both.minus(&left), right);
        assert!(left.intersection(&right).is_empty());
        assert_eq!(both.turned(std::f64::consts::PI), both.reflected());
        assert_eq!(both.reflected().bounds(), Some([DVec2::splat(-2.0), DVec2::ZERO]));
    }

    #[test]
    fn a_half_turn_leaves_the_lattice_alone() {
        let far = Region::rectangle(DVec2::splat(1000.1), DVec2::splat(2000.7));
        assert_eq!(far.turned(std::f64::consts::PI), far.reflected());
    }
}
