//! Overlap of the halves: whether some point lies inside both.
//!
//! ```text
//!      B ┌───────────────┐            the overlap of two solids has a corner on a convex edge of one of them, A;
//!        │      A        │            from this corner the edge runs inside the other, B, or along its surface with
//!   ●────┼──●────────┼───●            the material of A on the inner side
//!        └──┼────────┼───┘
//!           cuts: crossings of the edge and B's facets      witness: the middle of a part, moved by MARGIN into A
//! ```
//!
//! Both solids are *open*: surfaces that only touch, or that lie in one plane with the material on opposite
//! sides, share no point. If both halves end in the same plane with the material on the same side (extruded
//! profiles of equal width, mated), edges of A run along facets of B or meet them on their borders. No border
//! rule is needed then, because a *witness* decides: a point that lies inside A and inside B. If an edge
//! passes through the middle of a facet, the crossing itself is the proof, and no witness is needed.
//!
//! Not promised: overlaps thinner than about [`MARGIN`], and a half that lies wholly inside the other, are
//! not detected.

use super::Pair;
use super::hold::inside;
use super::plan::Plan;
use super::shape::{Ridge, Shape, Span};
use crate::tolerance::ROUNDING;
use glam::{DMat3, DVec3};

/// Depth from which on halves overlap rather than touch, in D.
pub(super) const MARGIN: f64 = 3e-7;
/// Parts of an edge shorter than this hold no witness, in D.
const SHORT: f64 = 4.0 * MARGIN;
/// Of an edge between facets that enclose less than 12° a witness is moved no further than that of 12°: a sine.
const SHARP: f64 = 0.02;

/// Transforms between the frames of the two halves.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frames {
    rotation: DMat3,
    back: DMat3,
    position: DVec3,
}

impl Frames {
    pub(super) fn new(rotation: &DMat3, position: DVec3) -> Self {
        Self { rotation: *rotation, back: rotation.transpose(), position }
    }

    /// A ridge of the moving half in the frame of the fixed half.
    fn placed(&self, moving: &Shape, ridge: &Ridge) -> Segment {
        let ends = ridge.ends.map(|k| self.rotation * moving.at(k) + self.position);
        Segment { ends, normals: ridge.normals.map(|n| self.rotation * n) }
    }

    /// A ridge of the fixed half in the frame of the moving half.
    fn seen(&self, fixed: &Shape, ridge: &Ridge) -> Segment {
        let ends = ridge.ends.map(|k| self.back * (fixed.at(k) - self.position));
        Segment { ends, normals: ridge.normals.map(|n| self.back * n) }
    }

    /// Whether a ridge of the moving shape and a facet of the fixed shape prove an overlap.
    pub(super) fn moving_enters(&self, moving: &Shape, ridge: u32, fixed: &Shape, facet: u32) -> bool {
        let segment = self.placed(moving, &moving.ridges[ridge as usize]);
        let in_moving = |p: DVec3| moving.encloses(self.back * (p - self.position));
        match segment.meets(fixed, facet) {
            Crossing::Through => true,
            Crossing::Border(_) => segment.enters(fixed, in_moving),
            Crossing::None => false,
        }
    }

    /// Whether a ridge of the fixed shape and a facet of the moving shape prove an overlap.
    pub(super) fn fixed_enters(&self, fixed: &Shape, ridge: u32, moving: &Shape, facet: u32) -> bool {
        let segment = self.seen(fixed, &fixed.ridges[ridge as usize]);
        let in_fixed = |p: DVec3| fixed.encloses(self.rotation * p + self.position);
        match segment.meets(moving, facet) {
            Crossing::Through => true,
            Crossing::Border(_) => segment.enters(moving, in_fixed),
            Crossing::None => false,
        }
    }
}

impl Pair {
    /// Whether the halves overlap with the COR at `position` and the moving half at `rotation`.
    pub(crate) fn overlaps(&self, rotation: &DMat3, position: DVec3) -> bool {
        match &self.trees {
            Some(trees) => trees.overlap(self, rotation, position, None),
            None => self.overlaps_by_plan(rotation, position),
        }
    }

    /// The same without trees.
    pub(super) fn overlaps_by_plan(&self, rotation: &DMat3, position: DVec3) -> bool {
        let frames = Frames::new(rotation, position);
        self.moving_shapes.iter().any(|moving| {
            self.fixed_shapes.iter().any(|fixed| {
                let in_moving = |p: DVec3| moving.encloses(frames.back * (p - position));
                let in_fixed = |p: DVec3| fixed.encloses(*rotation * p + position);
                moving.ridges.iter().any(|r| frames.placed(moving, r).enters(fixed, in_moving))
                    || fixed.ridges.iter().any(|r| frames.seen(fixed, r).enters(moving, in_fixed))
            })
        })
    }
}

/// A convex edge of A in the frame of B.
struct Segment {
    ends: [DVec3; 2],
    /// Outward normals of the facets of A beside it.
    normals: [DVec3; 2],
}

/// How a segment meets a facet.
enum Crossing {
    /// Not, or from outside.
    None,
    /// Through its middle.
    Through,
    /// On its border, in its plane or with an end, and A may lie partly inside B there; with the position of
    /// the cut, as a share of the segment's length.
    Border(Option<f64>),
}

impl Segment {
    fn plan(&self) -> Plan {
        Plan::around(self.ends.iter().map(|p| p.truncate())).widened(MARGIN)
    }

    /// Whether A overlaps B along this edge of A; `in_a` is the test whether a point, in the frame of B, lies
    /// inside A.
    fn enters(&self, b: &Shape, in_a: impl Fn(DVec3) -> bool) -> bool {
        let (plan, span) = (self.plan(), Span::of(self.ends.into_iter()).widened(MARGIN));
        if !b.plans.facets.bounds().meets(&plan) || !b.span.meets(&span) {
            return false;
        }
        let (mut cuts, mut may_enter) = (Vec::new(), false);
        let through = b.plans.facets.any(&plan, |facet| {
            if !b.spans[facet as usize].meets(&span) {
                return false;
            }
            match self.meets(b, facet) {
                Crossing::None => {}
                Crossing::Through => return true,
                Crossing::Border(cut) => {
                    may_enter = true;
                    cuts.extend(cut);
                }
            }
            false
        });
        through || may_enter && self.has_witness(cuts, |p| b.encloses(p) && in_a(p))
    }

    /// Meeting of this edge with a facet of B.
    fn meets(&self, b: &Shape, facet: u32) -> Crossing {
        let normal = b.facets[facet as usize].normal;
        let level = b.levels[facet as usize];
        let heights = self.ends.map(|p| normal.dot(p) - level);
        let (low, high) = (heights[0].min(heights[1]), heights[0].max(heights[1]));
        if low > MARGIN || high < -MARGIN {
            return Crossing::None;
        }
        if high <= MARGIN && low >= -MARGIN {
            // In the plane: whether any material of A is on the inner side.
            let along = (self.ends[1] - self.ends[0]).normalize_or_zero();
            let [left, right] = self.normals;
            let lowest = left.cross(along).dot(normal).min(along.cross(right).dot(normal));
            let leads_in = lowest < -SHARP && self.overlaps_facet(b, facet);
            return if leads_in { Crossing::Border(None) } else { Crossing::None };
        }
        if low >= -MARGIN {
            return Crossing::None;
        }
        let share = (heights[0] / (heights[0] - heights[1])).clamp(0.0, 1.0);
        let inside = inside(b, facet, self.ends[0].lerp(self.ends[1], share));
        let is_through = high > MARGIN;
        if inside < -MARGIN {
            Crossing::None
        } else if is_through && inside > MARGIN {
            Crossing::Through
        } else {
            Crossing::Border(is_through.then_some(share))
        }
    }

    /// Whether a segment in a facet's plane has a point in common with the facet.
    fn overlaps_facet(&self, b: &Shape, facet: u32) -> bool {
        let normal = b.facets[facet as usize].normal;
        let (mut from, mut to) = (0.0_f64, 1.0_f64);
        for side in b.sides_of(facet) {
            let inward = normal.cross(side.along);
            let [start, end] = self.ends.map(|e| inward.dot(e - side.from) + MARGIN);
            if start < 0.0 && end < 0.0 {
                return false;
            }
            if start < 0.0 {
                from = from.max(start / (start - end));
            } else if end < 0.0 {
                to = to.min(start / (start - end));
            }
        }
        from < to
    }

    /// Whether the middle of some part between cuts, moved into A, is inside both.
    fn has_witness(&self, mut cuts: Vec<f64>, inside_both: impl Fn(DVec3) -> bool) -> bool {
        let [start, end] = self.ends;
        let [left, right] = self.normals;
        let inward = -(left + right) * (MARGIN / (1.0 + left.dot(right)).max(SHARP));
        let length = start.distance(end);
        cuts.extend([0.0, 1.0]);
        cuts.sort_unstable_by(f64::total_cmp);
        cuts.windows(2).any(|part| {
            (part[1] - part[0]) * length > SHORT
                && inside_both(start.lerp(end, 0.5 * (part[0] + part[1])) + inward)
        })
    }
}

impl Shape {
    /// Whether a point is inside the solid: its surface winds once around the vertical line upwards from the
    /// point.
    ///
    /// A vertical line that passes an edge is counted by exactly one of its two facets, because both use the
    /// same numbers for the decision.
    fn encloses(&self, point: DVec3) -> bool {
        let mut winds = 0;
        self.plans.facets.visit(&Plan::around([point.truncate()].into_iter()), |k| {
            let (facet, level) = (&self.facets[k as usize], self.levels[k as usize]);
            let up = facet.normal.z;
            // Above the point, and over it in plan view.
            // No vertical line crosses an upright facet.
            if up.abs() > ROUNDING && (level - facet.normal.dot(point)) * up > 0.0 && self.is_over(k, point) {
                winds += if up > 0.0 { 1 } else { -1 };
            }
        });
        winds > 0
    }

    /// Whether a facet covers a point in plan view, by the number of its sides that a line along +x crosses.
    fn is_over(&self, facet: u32, point: DVec3) -> bool {
        let corners = &self.facets[facet as usize].corners;
        let mut covers = false;
        for (k, &a) in corners.iter().enumerate() {
            let b = corners[(k + 1) % corners.len()];
            // The same for both facets beside the side.
            let (a, b) = (self.at(a.min(b)), self.at(a.max(b)));
            if (a.y > point.y) != (b.y > point.y) {
                let x = a.x + (b.x - a.x) * ((point.y - a.y) / (b.y - a.y));
                covers ^= x > point.x;
            }
        }
        covers
    }
}
