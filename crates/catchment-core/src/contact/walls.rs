//! Detects steep walls of a mated pair that face each other closely: a peg in its hole, a pin in its socket,
//! a plug under a lip.
//!
//! ```text
//!      moving
//!     ╲      │ M                 n_F·n_M ≤ −cos 45°         the walls face each other
//!   ───╲     │←─gap─→│ F         |n_z| ≤ STEEP              both are steep
//!       ╲____│       │           −SLIP ≤ gap ≤ NEAR         M is in front of F, and within reach
//!                    │ fixed
//! ```
//!
//! Without such walls the half sinks onto slopes that centre it, and small errors of its motion decay.
//! Between walls they do not: a contact with the opposite wall changes the motion.

use super::plan::{Plan, PlanTree};
use super::shape::Shape;
use crate::design::Alignment;
use crate::pose::Dof;
use crate::tolerance;
use glam::DVec3;

/// Walls have normals within this sine of the horizontal. Motions of pegs with up to 7° of draft (0.12) have
/// to be followed from event to event; wider cones centre themselves.
const STEEP: f64 = 0.15;
/// Walls face each other if the cosine between their normals is below this: 45°.
const FACING: f64 = -0.7;
/// Wider gaps are no fit, in D: several steps of a motion go into them.
const NEAR: f64 = 0.1;
/// By this much mated walls may overlap, in D: drawings rounded to four digits.
const SLIP: f64 = tolerance::TOUCHING;

/// Whether walls of the two halves face each other closely when mated.
pub(super) fn are_close(fixed: &[Shape], moving: &[Shape], alignment: &Alignment) -> bool {
    // Mated, the face centres coincide: the COR is at −cor.
    let cor = DVec3::new(0.0, 0.0, -alignment.center_of_rotation);
    let free = |dof| f64::from(u8::from(alignment.free.contains(dof)));
    let across = DVec3::new(free(Dof::X), free(Dof::Y), 0.0);
    let walls = |shapes: &[Shape], place: DVec3| -> Vec<Wall> {
        let of = |shape: &Shape| -> Vec<Wall> {
            let steep = shape.facets.iter().filter(|f| {
                // Along a locked error nothing comes closer.
                f.normal.z.abs() <= STEEP && (f.normal * across).length() >= -FACING
            });
            steep.map(|f| Wall::of(f.normal, f.corners.iter().map(|&k| shape.at(k) + place))).collect()
        };
        shapes.iter().flat_map(of).collect()
    };
    let moving = walls(moving, cor);
    if moving.is_empty() {
        return false;
    }
    let plans = PlanTree::over(moving.iter().map(Wall::plan));
    walls(fixed, DVec3::ZERO)
        .iter()
        .any(|fixed| plans.any(&fixed.plan().widened(NEAR), |k| fixed.faces(&moving[k as usize])))
}

/// A steep facet.
struct Wall {
    normal: DVec3,
    low: DVec3,
    high: DVec3,
}

impl Wall {
    fn of(normal: DVec3, corners: impl Iterator<Item = DVec3>) -> Self {
        let none = Self { normal, low: DVec3::INFINITY, high: DVec3::NEG_INFINITY };
        corners.fold(none, |w, p| Self { low: w.low.min(p), high: w.high.max(p), ..w })
    }

    fn plan(&self) -> Plan {
        Plan::around([self.low, self.high].into_iter().map(DVec3::truncate))
    }

    /// Whether `other` is in front of this wall, and within reach.
    fn faces(&self, other: &Self) -> bool {
        self.normal.dot(other.normal) <= FACING
            && (self.low - NEAR).cmple(other.high).all()
            && (other.low - NEAR).cmple(self.high).all()
            && {
                let gap = self.normal.dot((other.low + other.high) / 2.0 - (self.low + self.high) / 2.0);
                (-SLIP..=NEAR).contains(&gap)
            }
    }
}
