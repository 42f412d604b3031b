//! Record of a trial: position, time, speed and contacts of the half.
//!
//! ```text
//!   released ──▶ · · · falling · · · ▼ first contact ── · bounces, slides · ──▶ end
//!   0 D                                                                       path length in the ρ-metric
//! ```
//!
//! A waypoint is stored if the half has moved by a step of the path, if contacts begin or end, and at both
//! ends. Contacts are those that exerted force in the step before.

use super::engine::{Engine, Fall};
use crate::acceptance::Outcome;
use crate::exec::{Cancelled, Exec};
use crate::method::descent::{Touch, Trajectory, Waypoint};
use crate::pose::PoseError;
use glam::{DMat3, DVec3};

/// Record of a trial.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    /// From the release to the end; empty if the halves pass each other by.
    pub moments: Vec<DropMoment>,
    /// How it ended.
    pub outcome: Outcome,
}

/// A waypoint of a trial.
#[derive(Debug, Clone, PartialEq)]
pub struct DropMoment {
    /// Time since release, in s.
    pub time: f64,
    /// Position and contacts.
    pub waypoint: Waypoint,
}

impl Path {
    /// The same without times: from the release on.
    pub fn trajectory(&self) -> Trajectory {
        let waypoints = self.moments.iter().map(|moment| moment.waypoint.clone()).collect();
        Trajectory { waypoints, outcome: self.outcome }
    }
}

/// Way between two moments that are kept, in D: a hundred of them to a face.
const STEP: f64 = 0.01;

/// Follows a trial and records it.
pub(super) fn trace(engine: &Engine<'_>, error: &PoseError, exec: &Exec) -> Result<Path, Cancelled> {
    let mut moments: Vec<DropMoment> = Vec::new();
    let mut travelled = 0.0;
    let mut before: Option<(DVec3, DMat3)> = None;
    let mut latest: Option<DropMoment> = None;
    let mut touched = false;
    let mut seen = |step: usize, fall: &Fall<'_>| {
        let (cor, rotation) = fall.place();
        if let Some((from, turned)) = &before {
            travelled += (cor - *from).length().hypot(engine.turn(turned, &rotation));
        }
        before = Some((cor, rotation));
        let touches: Vec<Touch> = fall.contacts();
        let changes = touches.is_empty() == touched;
        touched = !touches.is_empty();
        let error = engine.end(Outcome::Undecided, cor, &rotation).error;
        let moment = DropMoment {
            time: engine.time(step),
            waypoint: Waypoint { error, height: cor.z, travelled, touches },
        };
        let last = moments.last().map_or(f64::NEG_INFINITY, |moment| moment.waypoint.travelled);
        if changes || travelled - last >= STEP {
            moments.push(moment);
            latest = None;
        } else {
            latest = Some(moment);
        }
    };
    let end = engine.watch(error, exec, &mut seen)?;
    moments.extend(latest);
    Ok(Path { moments, outcome: end.outcome })
}
