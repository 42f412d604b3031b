//! Contacts in the last state of a motion.
//!
//! ```text
//!        ▁▁▁▁▁
//!     ▏  ▔▔▔▔▏      first contact from above at the last error: on the overhang
//!     ▏    ▄ ▏      the state the motion ended in: under it
//!     ▏▁▁▁▁▁▁▏
//! ```
//!
//! Contacts are those of that state, including undersides, not those of first contact from above at the same
//! error. Bodies of a rigid-body engine overlap under contact force
//! ([`Follow::give`](crate::method::Follow::give)): they are raised by that overlap before contacts are
//! listed.

use crate::connector::HalfRole;
use crate::contact::{Contact, Features, Meeting, Nearby};
use crate::method::Method;
use crate::method::descent::End;
use crate::pose::{CorPose, PoseError};
use crate::problem::Problem;
use crate::tolerance::TOUCHING;
use serde::Serialize;

/// Contacts steeper than this (z of their normal) are walls: no lift takes an overlap with them away.
const WALL: f64 = 0.05;

/// A contact at the end of a motion: two features and their contact point.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct EndContact {
    /// Description of the feature of the fixed half.
    pub fixed: String,
    /// Description of the feature of the moving half.
    pub moving: String,
    /// Contact point in the world frame, in D.
    pub point_d: [f64; 3],
}

/// Lists the contacts of ends in sequence; keeps its buffers.
pub struct EndContacts<'a> {
    problem: &'a Problem,
    features: Features,
    nearby: Nearby<'a>,
    /// Overlap of the halves under contact force, in D.
    give: f64,
    /// The last result: docked halves usually rest in the same pose.
    last: Option<(PoseError, f64, Vec<EndContact>)>,
    met: Vec<(Contact, Meeting)>,
}

impl<'a> EndContacts<'a> {
    /// For the ends that a method finds for a problem.
    pub fn new(problem: &'a Problem, method: &Method) -> Self {
        let pair = problem.pair();
        let mut nearby = pair.about(TOUCHING);
        nearby.look_under();
        let give = method.follows().map_or(0.0, crate::method::PoseMethod::give);
        Self { problem, features: Features::of(pair), nearby, give, last: None, met: Vec::new() }
    }

    /// The contacts in the last state of a motion, each pair of features once; empty if it missed.
    pub fn of(&mut self, end: &End) -> Vec<EndContact> {
        let Some(height) = end.height else { return Vec::new() };
        if let Some((error, z, contacts)) = &self.last
            && (*error, *z) == (end.error, height)
        {
            return contacts.clone();
        }
        let contacts = self.at(&end.error, height);
        self.last = Some((end.error, height, contacts.clone()));
        contacts
    }

    fn at(&mut self, error: &PoseError, height: f64) -> Vec<EndContact> {
        let alignment = self.problem.alignment();
        let pose = CorPose::from_error(error, alignment.center_of_rotation, alignment.free);
        let deep = self.give.max(TOUCHING);
        self.nearby.turn(&pose.rotation, pose.lateral, deep, deep);
        let mut cor = pose.lateral.extend(height);
        if self.give > 0.0 {
            self.nearby.contacts(cor, self.give, &mut self.met);
            let carrying = self.met.iter().filter(|(contact, _)| contact.normal.z > WALL);
            cor.z += carrying.map(|(contact, _)| -contact.gap / contact.normal.z).fold(0.0, f64::max);
        }
        self.nearby.contacts(cor, deep, &mut self.met);
        let mut pairs: Vec<[u32; 2]> = Vec::new();
        let mut contacts = Vec::new();
        for (contact, meeting) in self.met.iter().filter(|(contact, _)| contact.gap <= TOUCHING) {
            let pair = self.features.meeting(contact, meeting, &pose.rotation);
            if !pairs.contains(&pair) {
                pairs.push(pair);
                let [fixed, moving] = [(HalfRole::Fixed, pair[0]), (HalfRole::Moving, pair[1])]
                    .map(|(side, number)| self.features.get(side, number).name());
                contacts.push(EndContact { fixed, moving, point_d: contact.point.to_array() });
            }
        }
        contacts
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::acceptance::Outcome;
    use crate::design::SourceText;
    use crate::exec::Exec;
    use crate::problem::Draft;

    /// A V-notch; beside it a slope of 26.6° that leads down under a roof, to a wall. The tip of 45° and width 0.4 starts at x = 0.35 just clear of the roof.
    fn beside_a_roof() -> Problem {
        let piece = |outline: &[[f64; 2]]| {
            let corners =
                outline.iter().flat_map(|[x, z]| [format!("[{x}, -0.2, {z}]"), format!("[{x}, 0.2, {z}]")]);
            format!("[{}]", corners.collect::<Vec<_>>().join(", "))
        };
        let fixed = [
            piece(&[[-0.5, -0.2], [0.0, -0.2], [0.0, 0.0], [-0.5, 0.5]]),
            piece(&[[0.0, -0.2], [0.3, -0.2], [0.3, 0.3], [0.0, 0.0]]),
            piece(&[[0.3, -0.2], [0.9, -0.2], [0.9, 0.0], [0.3, 0.3]]),
            piece(&[[0.9, -0.2], [1.0, -0.2], [1.0, 1.1], [0.9, 1.1]]),
            piece(&[[0.6, 0.9], [0.9, 0.9], [0.9, 1.1], [0.6, 1.1]]),
        ];
        let moving = piece(&[[-0.2, 0.0], [0.2, 0.0], [0.0, 0.2]]);
        let text = format!(
            "[connector]\nwidth = 1.0\nface_height = 0.1\n[connector.fixed]\npieces = [{}]\n[connector.moving]\npieces = [{moving}]\n\
             [alignment]\nfree = [\"x\"]\n[errors]\nx = 0.9\n",
            fixed.join(", ")
        );
        Draft::read(SourceText::new("roof.toml", text)).and_then(Draft::build).unwrap()
    }

    /// The tip slides from z = 0.275 down to the wall at x = 0.7, with the slope at 0.1; the face centre lies
    /// 0.1 above the tip, and the frame 0.1 below the face centre of the fixed half: z = 0.1. First contact
    /// from above at x = 0.7 is on the roof, at z = 1.1.
    #[test]
    fn a_half_that_slid_under_a_roof_is_reported_where_it_lies() {
        let problem = beside_a_roof();
        let pose = PoseError { x: 0.35, ..PoseError::default() };
        for (name, exact) in [("descent", 1e-5), ("drop", 5e-3)] {
            let method = name.parse().unwrap();
            let (_, ends) = problem.follow_by(&method, &[pose], &Exec::new()).unwrap();
            let end = ends[0];
            assert_eq!(end.outcome, Outcome::Jammed);
            assert!((end.error.x - 0.7).abs() < exact, "{name}: {end:?}");
            assert!((end.height.unwrap() - 0.1).abs() < exact, "{name}: {end:?}");
            let contacts = EndContacts::new(&problem, &method).of(&end);
            let names = |contact: &EndContact| format!("{} {}", contact.moving, contact.fixed);
            let touching = contacts.iter().map(names).collect::<Vec<_>>().join("; ");
            assert!(touching.contains("slope of 27°") && touching.contains("wall"), "{name}: {touching}");
            assert!(contacts.iter().all(|contact| contact.point_d[2] < 0.3), "{name}: {contacts:?}");
            let first = problem.pair().about(0.01).height(&end.error).unwrap();
            assert!(first > 0.9, "{name}: {first}");
        }
    }

    /// Whatever is called aligned lies in the seat: no higher than its depth above the mated pose.
    #[test]
    fn aligned_poses_end_in_the_seat() {
        let problem = beside_a_roof();
        let poses: Vec<PoseError> =
            (0..600).map(|k| PoseError { x: -0.9 + 0.003 * f64::from(k), ..PoseError::default() }).collect();
        let ends = problem.follow_many(&poses, &Exec::new()).unwrap();
        let aligned: Vec<f64> =
            ends.iter().filter(|end| end.outcome == Outcome::Aligned).filter_map(|end| end.height).collect();
        // The tip lands on the slopes of the notch from −0.7 to 0.3.
        assert!(aligned.len() > 250, "{}", aligned.len());
        let depth = problem.alignment().docked.depth;
        let highest = problem.pair().mated_height() + depth;
        assert!(aligned.iter().all(|height| *height <= highest));
        assert!(ends.iter().all(|end| end.height.is_none() == (end.outcome == Outcome::Missed)));
    }
}
