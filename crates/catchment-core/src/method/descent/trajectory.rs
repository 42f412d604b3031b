//! The trajectory of a pose, for pictures and explanations.

use crate::acceptance::Outcome;
use crate::pose::PoseError;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// A contact point of the halves.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Touch {
    /// Position in the world frame, in D.
    #[serde(rename = "point_d")]
    #[cfg_attr(feature = "schema", schemars(with = "[f64; 3]"))]
    pub point: DVec3,
    /// Contact normal: unit vector from the fixed half to the moving half.
    #[cfg_attr(feature = "schema", schemars(with = "[f64; 3]"))]
    pub normal: DVec3,
}

/// A waypoint of a motion.
#[derive(Debug, Clone, PartialEq)]
pub struct Waypoint {
    /// The pose error.
    pub error: PoseError,
    /// z of the COR in the world frame, in D.
    pub height: f64,
    /// Path length travelled since first contact, in the ρ-metric, in D.
    pub travelled: f64,
    /// The contacts.
    pub touches: Vec<Touch>,
}

/// The motion of a pose from first contact to its end.
#[derive(Debug, Clone, PartialEq)]
pub struct Trajectory {
    /// From first contact on; empty when the halves never meet.
    pub waypoints: Vec<Waypoint>,
    /// How it ended.
    pub outcome: Outcome,
}
