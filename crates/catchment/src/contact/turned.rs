//! The pair at one rotation, as a list of elements: where a lowered half is stopped, and what touches there.

use super::brute::SEAM;
use super::candidates::Candidates;
use super::element::{Element, Meeting};
use super::shape::Shape;
use super::{Contact, Pair};
use glam::{DMat3, DVec2, DVec3};

/// Below this z-component a normal counts as horizontal: such a facet has no height of its own, its rim
/// speaks for it. Slopes beyond 10⁹ cannot be told from a wall in double precision.
pub(super) const VERTICAL: f64 = 1e-9;

/// A pair, a rotation, and what can touch there.
#[derive(Debug, Clone)]
pub(super) struct Turned<'a> {
    pub(super) pair: &'a Pair,
    rotation: DMat3,
    pub(super) elements: Vec<Element>,
}

impl<'a> Turned<'a> {
    /// Not turned yet: nothing touches.
    pub(super) fn new(pair: &'a Pair) -> Self {
        Self { pair, rotation: DMat3::IDENTITY, elements: Vec::new() }
    }

    /// Replaces the elements by those among `candidates` at `rotation`.
    pub(super) fn turn(&mut self, rotation: &DMat3, candidates: &Candidates, slack: f64, lowest: f64) {
        self.rotation = *rotation;
        candidates.try_at(self.pair, rotation, slack, lowest, &mut self.elements);
    }

    /// Where a half lowered from `ceiling`, not from far above, is stopped; and whether something above the ceiling
    /// would have stopped it earlier. A half that has slid under an overhang, or beside a wall, is there.
    pub(super) fn height_below(&self, lateral: DVec2, ceiling: f64) -> (Option<f64>, bool) {
        let mut highest = f64::NEG_INFINITY;
        let mut covered = false;
        for element in &self.elements {
            if element.normal.z <= VERTICAL {
                continue;
            }
            let z = element.height(lateral);
            let counts = if z > ceiling { !covered } else { z > highest };
            if counts && self.foot(element, lateral.extend(z), SEAM).is_some() {
                if z > ceiling {
                    covered = true;
                } else {
                    highest = z;
                }
            }
        }
        (highest.is_finite().then_some(highest), covered)
    }

    /// Everything that touches, or is closer than `reach` along its normal, with the COR at `position`; a foot may lie
    /// beyond the border of its feature by `seam`.
    pub(super) fn contacts(
        &self,
        position: DVec3,
        reach: f64,
        seam: f64,
    ) -> impl Iterator<Item = (Contact, Meeting)> + '_ {
        self.elements.iter().filter_map(move |element| {
            let gap = element.gap(position);
            // Deeper than `reach` the halves are not near each other along this normal: they passed.
            if gap.abs() > reach {
                return None;
            }
            let point = self.foot(element, position, seam)?;
            self.is_exposed(element, point, position)
                .then_some((Contact { gap, normal: element.normal, point }, element.meeting))
        })
    }

    /// Whether an edge of one half pierces a facet of the other with the COR at `position`: they overlap, by more than
    /// touching.
    pub(super) fn is_pierced(&self, position: DVec3) -> bool {
        let back = self.rotation.transpose();
        let fixed_in_moving = |p: DVec3| back * (p - position);
        let moving_in_fixed = |p: DVec3| self.rotation * p + position;
        self.pair.fixed_shapes.iter().any(|fixed| {
            self.pair.moving_shapes.iter().any(|moving| {
                fixed.pierces(moving, fixed_in_moving) || moving.pierces(fixed, moving_in_fixed)
            })
        })
    }

    fn foot(&self, element: &Element, position: DVec3, seam: f64) -> Option<DVec3> {
        let [f, m] = element.meeting.shapes.map(|s| s as usize);
        element.foot(&self.pair.fixed_shapes[f], &self.pair.moving_shapes[m], &self.rotation, position, seam)
    }

    /// Whether the contact lies on the surface of both solids, not on a wall between two pieces of one.
    fn is_exposed(&self, element: &Element, point: DVec3, position: DVec3) -> bool {
        let [fixed, moving] = element.meeting.shapes;
        let back = self.rotation.transpose();
        let seen = point + element.normal * element.gap(position) - position;
        !is_covered(&self.pair.fixed_shapes, fixed, point, element.normal)
            && !is_covered(&self.pair.moving_shapes, moving, back * seen, back * -element.normal)
    }
}

/// How far outside its own surface a contact looks for another piece of the same solid, in D.
const LOOK: f64 = 1e-7;
/// How far around a contact the surface of its piece is looked at, and how far above, in D: above the distance by which a foot may overshoot
/// its feature, and flat enough for walls that flare.
const AROUND: f64 = 1e-6;
const BESIDE: f64 = 5e-8;
/// By how much a point must be inside a piece, in D.
const WITHIN: f64 = 1e-10;

/// Whether a point of the surface of one convex piece, `normal` its tangent plane there, is inside the solid that the pieces make.
///
/// ```text
///        ╱ upper piece          ×  just above: within another piece, so covered;
///    ──·╱──────────── ×         ·  at the rim where a piece ends that is covered up to there: above it is nothing,
///      │ lower piece               but all of its surface around is covered, so it is no ledge
/// ```
fn is_covered(shapes: &[Shape], own: u32, point: DVec3, normal: DVec3) -> bool {
    if shapes.len() < 2 {
        return false;
    }
    let others = || shapes.iter().enumerate().filter(|(s, _)| *s as u32 != own).map(|(_, shape)| shape);
    // As a rule nothing else is near, and one look tells.
    if !others().any(|shape| shape.contains(point, -AROUND)) {
        return false;
    }
    if others().any(|shape| shape.contains(point + normal * LOOK, WITHIN)) {
        return true;
    }
    let (side, across) = normal.any_orthonormal_pair();
    let mut any = false;
    for k in 0..8 {
        let (sine, cosine) = (std::f64::consts::FRAC_PI_4 * f64::from(k)).sin_cos();
        let near = point + (side * cosine + across * sine) * AROUND;
        // Along a rim the point itself may overshoot it: only what is well inside counts.
        if shapes[own as usize].contains(near - normal * AROUND, 0.25 * AROUND) {
            if !others().any(|shape| shape.contains(near + normal * BESIDE, WITHIN)) {
                return false;
            }
            any = true;
        }
    }
    any
}
