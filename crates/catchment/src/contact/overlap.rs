//! Whether the halves overlap, found near by near.
//!
//! ```text
//!         moving ridge ╲                 an edge of one passes through a facet of the other by more than THROUGH,
//!      ─────────────────╳───── fixed     at both of its ends and to all sides of the point where it does
//!                        ╲
//! ```
//!
//! Between non-convex halves an overlap need not show as a contact with a negative gap: where two rims cross at the foot
//! of both edges, neither edge supports the normal any more. Only convex edges are tried: a reflex one lies at the bottom of
//! a valley, where convex edges of the other half have passed before.
//!
//! The same answer as [`Nearby::is_pierced`](super::Nearby::is_pierced) where facets are larger than the overlap, at the cost of
//! what is near in plan view.

use super::Pair;
use super::plan::Plan;
use super::shape::Shape;
use crate::pose::Dof;
use glam::{DMat3, DVec3};

/// What counts as through rather than touching, in D.
const THROUGH: f64 = 1e-6;

impl Pair {
    /// Whether the halves overlap with the COR at `position` and the moving half at `rotation`; `placed` is scratch for the
    /// moving vertices.
    pub(crate) fn overlaps(&self, rotation: &DMat3, position: DVec3, placed: &mut Vec<DVec3>) -> bool {
        match &self.trees {
            Some(trees) => trees.is_passed(self, rotation, position),
            None => self.overlaps_by_plan(rotation, position, placed),
        }
    }

    /// The same without trees.
    pub(super) fn overlaps_by_plan(
        &self,
        rotation: &DMat3,
        position: DVec3,
        placed: &mut Vec<DVec3>,
    ) -> bool {
        self.moving_shapes.iter().any(|moving| {
            placed.clear();
            let between = Between::new(self, moving, rotation, position);
            placed.extend(moving.vertices.iter().map(|v| between.placed(*v)));
            let whole = Plan::around(placed.iter().map(|p| p.truncate()));
            self.fixed_shapes
                .iter()
                .filter(|fixed| fixed.plans.facets.bounds().meets(&whole))
                .any(|fixed| pierce(fixed, moving, placed, rotation))
        })
    }
}

/// From the frame of one half to that of the other, for a moving shape of a pair.
///
/// Halves that move in the plane of x and z often end in the same two planes, where the edges of one pass the facets of the other on their
/// borders, which is no passing through. So there a moving shape that is drawn along y between two planes is looked at as a little narrower: it lies
/// within itself, so that nothing overlaps that did not.
#[derive(Debug, Clone, Copy)]
pub(super) struct Between {
    rotation: DMat3,
    back: DMat3,
    position: DVec3,
    /// What becomes of y: its factor, and what is added.
    narrow: [f64; 2],
}

impl Between {
    pub(super) fn new(pair: &Pair, moving: &Shape, rotation: &DMat3, position: DVec3) -> Self {
        let is_planar = pair.alignment.free.iter().all(|dof| matches!(dof, Dof::X | Dof::Pitch));
        let narrow = moving.narrow.filter(|_| is_planar).unwrap_or([1.0, 0.0]);
        Self { rotation: *rotation, back: rotation.transpose(), position, narrow }
    }

    /// Where a point of the moving shape is.
    pub(super) fn placed(&self, mut p: DVec3) -> DVec3 {
        p.y = self.narrow[0] * p.y + self.narrow[1];
        self.rotation * p + self.position
    }

    /// Where the moving shape sees a point of the fixed half.
    pub(super) fn seen(&self, p: DVec3) -> DVec3 {
        let mut p = self.back * (p - self.position);
        p.y = (p.y - self.narrow[1]) / self.narrow[0];
        p
    }
}

fn pierce(fixed: &Shape, moving: &Shape, placed: &[DVec3], rotation: &DMat3) -> bool {
    let at = |k: u32| placed[k as usize];
    let top = fixed.vertices.iter().map(|v| v.z).fold(f64::NEG_INFINITY, f64::max);
    // What is above the fixed shape, or beside it, cannot reach into it.
    let near = |ids: &[u32], bounds: &Plan| {
        let plan = Plan::around(ids.iter().map(|&k| at(k).truncate()));
        (ids.iter().any(|&k| at(k).z <= top) && bounds.meets(&plan)).then_some(plan)
    };
    let mut found = false;
    for ridge in &moving.ridges {
        let Some(plan) = near(&ridge.ends, fixed.plans.facets.bounds()) else { continue };
        let ends = ridge.ends.map(at);
        fixed.plans.facets.visit(&plan, |k| {
            let facet = &fixed.facets[k as usize];
            let corners = || facet.corners.iter().map(|&c| fixed.at(c));
            found = found || passes(ends, facet.normal, corners);
        });
        if found {
            return true;
        }
    }
    for facet in &moving.facets {
        let Some(plan) = near(&facet.corners, fixed.plans.ridges.bounds()) else { continue };
        let normal = *rotation * facet.normal;
        fixed.plans.ridges.visit(&plan, |k| {
            let ends = fixed.ridges[k as usize].ends.map(|c| fixed.at(c));
            let corners = || facet.corners.iter().map(|&c| at(c));
            found = found || passes(ends, normal, corners);
        });
        if found {
            return true;
        }
    }
    false
}

/// Whether the segment between `ends` passes through a convex polygon of this unit normal.
pub(super) fn passes<I: Iterator<Item = DVec3> + Clone>(
    ends: [DVec3; 2],
    normal: DVec3,
    corners: impl Fn() -> I,
) -> bool {
    let Some(origin) = corners().next() else { return false };
    let [above, below] = ends.map(|p| normal.dot(p - origin));
    if above.min(below) > -THROUGH || above.max(below) < THROUGH {
        return false;
    }
    let point = ends[0] + (ends[1] - ends[0]) * (above / (above - below));
    let next = corners().cycle().skip(1);
    corners().zip(next).all(|(p, q)| normal.dot((q - p).normalize_or_zero().cross(point - p)) > THROUGH)
}
