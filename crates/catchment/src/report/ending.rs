//! What holds a half where its motion ended: the height there, and the features that touch.
//!
//! The half is lowered anew with its last pose error: a half that had come to rest under something lies lower than that.

use crate::acceptance::Outcome;
use crate::connector::Side;
use crate::contact::{Features, Nearby};
use crate::method::descent::End;
use crate::pose::{CorPose, PoseError};
use crate::problem::Problem;
use serde::Serialize;

/// Gaps up to this touch, in D: what the end of any method leaves, far below what is made.
const TOUCHING: f64 = 1e-4;

/// What touches at the end of a motion: two features, and where.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct EndContact {
    /// The feature of the fixed half, in words.
    fixed: String,
    /// The feature of the moving half, in words.
    moving: String,
    /// Where they touch, in the world frame, in D.
    point_d: [f64; 3],
}

/// Tells of one end after another; keeps its buffers.
pub(super) struct Endings<'a> {
    problem: &'a Problem,
    features: Features,
    nearby: Nearby<'a>,
    /// What was told last: halves that dock rest in one pose, as a rule.
    last: Option<(PoseError, Option<Ending>)>,
}

/// The height of the COR, in D, and what touches.
type Ending = (f64, Vec<EndContact>);

impl<'a> Endings<'a> {
    pub(super) fn new(problem: &'a Problem) -> Self {
        let pair = problem.pair();
        Self { problem, features: Features::of(pair), nearby: pair.about(TOUCHING), last: None }
    }

    /// z of the COR at first contact with the last pose error, in D, and what touches there, each pair of features once; none where nothing
    /// carries the half any more.
    pub(super) fn of(&mut self, end: &End) -> Option<Ending> {
        if end.outcome == Outcome::Missed {
            return None;
        }
        if let Some((error, told)) = &self.last
            && *error == end.error
        {
            return told.clone();
        }
        let told = self.at(&end.error);
        self.last = Some((end.error, told.clone()));
        told
    }

    fn at(&mut self, error: &PoseError) -> Option<Ending> {
        let height = self.nearby.height(error)?;
        let alignment = self.problem.alignment();
        let pose = CorPose::from_error(error, alignment.center_of_rotation, alignment.free);
        let mut met = Vec::new();
        self.nearby.turn(&pose.rotation, pose.lateral, TOUCHING, TOUCHING);
        self.nearby.contacts(pose.lateral.extend(height), TOUCHING, &mut met);
        let mut pairs: Vec<[u32; 2]> = Vec::new();
        let mut contacts = Vec::new();
        for (contact, meeting) in &met {
            let pair = self.features.meeting(contact, meeting, &pose.rotation);
            if !pairs.contains(&pair) {
                pairs.push(pair);
                let [fixed, moving] = [(Side::Fixed, pair[0]), (Side::Moving, pair[1])]
                    .map(|(side, number)| self.features.get(side, number).name());
                contacts.push(EndContact { fixed, moving, point_d: contact.point.to_array() });
            }
        }
        Some((height, contacts))
    }
}

/// Contacts in words, the same pair said once: `corner of wall and flat on slope of 45°; …`, the moving half's feature first.
pub(super) fn words(contacts: &[EndContact]) -> String {
    let mut said: Vec<String> = Vec::new();
    for EndContact { fixed, moving, .. } in contacts {
        let words = format!("{moving} on {fixed}");
        if !said.contains(&words) {
            said.push(words);
        }
    }
    said.join("; ")
}
