//! Where a motion ends, with what carries the half there: for people who ask why it jams.

use super::motion::{Motion, State, Until, Watch};
use super::{Follower, Pair, Settings};
use crate::acceptance::Outcome;
use crate::contact::{Contact, Meeting};
use crate::pose::PoseError;

/// Gaps up to this touch at rest, in D: motions keep a hundredth of it clear of walls, and end before flush faces have closed to the last; no
/// fit is as close.
pub const TOUCHING: f64 = 1e-4;

/// The end of a motion.
#[derive(Debug, Clone, PartialEq)]
pub struct Rest {
    /// How it ended.
    pub outcome: Outcome,
    /// The last pose error.
    pub error: PoseError,
    /// z of the COR in the world frame where it was last in contact, in D; `None` where the halves never met.
    pub height: Option<f64>,
    /// What touched there, by features.
    pub contacts: Vec<(Contact, Meeting)>,
}

/// Keeps the last state of a motion alone.
#[derive(Debug, Default)]
struct Last {
    height: Option<f64>,
    contacts: Vec<(Contact, Meeting)>,
}

impl Watch for Last {
    fn see(&mut self, motion: &Motion, state: &State, _: f64) -> Option<Outcome> {
        self.height = Some(state.cor.z);
        self.contacts.clear();
        self.contacts.extend(motion.contacts.iter().filter(|(contact, _)| contact.gap <= TOUCHING));
        None
    }
}

impl Follower<'_> {
    /// Follows one pose until it has come to rest, also in the seat, as [`Follower::rest`] does, and keeps what carries it there.
    pub fn come_to_rest(&mut self, error: &PoseError) -> Rest {
        let mut last = Last::default();
        let (outcome, error) = self.0.follow(error, Until::AtRest, &mut last);
        Rest { outcome, error, height: last.height, contacts: last.contacts }
    }

    /// Follows one pose until it is known what becomes of it, as [`Follower::follow`] does, and keeps what carried it last: where it
    /// jams, where it rests.
    pub fn settle(&mut self, error: &PoseError) -> Rest {
        let mut last = Last::default();
        let (outcome, error) = self.0.follow(error, Until::Known, &mut last);
        Rest { outcome, error, height: last.height, contacts: last.contacts }
    }
}

/// Follows one pose until it is known what becomes of it, and keeps what carried it last.
pub fn settle(pair: &Pair, error: &PoseError, settings: &Settings) -> Rest {
    Follower::new(pair, settings).settle(error)
}
