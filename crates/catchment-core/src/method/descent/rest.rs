//! The end of a motion with the contacts that carry the half there, as the explanation of a jam.

use super::coulomb::Contacts;
use super::holding::BORDER;
use super::motion::{Motion, MotionObserver, State, Until};
use super::projection::{Vector, dot};
use super::{DescentSettings, End, Follower, Pair};
use crate::acceptance::Outcome;
use crate::contact::{Contact, Meeting};
use crate::pose::PoseError;
use crate::tolerance;

/// Gaps up to this touch at rest, in D: motions keep a hundredth of it clear of walls, and end before flush faces have closed to the last; no
/// fit is as close.
pub const TOUCHING: f64 = tolerance::TOUCHING;
/// The same where a half was set down onto what carries it.
const SET_DOWN: f64 = 1e-7;

/// How hard a half is pushed down onto what carries it, in D: hollows whose curvature is below its inverse are found.
const PUSH: f64 = 0.05;
/// How far it comes at most, in the ρ-metric and z together, in D: what motions end short of.
const FARTHEST: f64 = 1e-3;
/// Passes of Newton's method at most, and the last displacement, in D.
const PASSES: usize = 24;
const EXACT: f64 = 1e-11;
/// Feet may lie so many times as far beyond the borders of their features as the half moved last, down to [`BORDER`].
const BESIDE: f64 = 4.0;

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
    /// Gaps up to this touched, in D: [`TOUCHING`], and less where the half was set down onto what carries it.
    pub touching: f64,
}

/// Keeps the last state of a motion alone.
#[derive(Debug, Default)]
struct Last {
    state: Option<State>,
    contacts: Vec<(Contact, Meeting)>,
}

impl MotionObserver for Last {
    fn see(&mut self, motion: &Motion, state: &State, _: f64) -> Option<Outcome> {
        self.state = Some(*state);
        self.contacts.clear();
        self.contacts.extend(motion.contacts.iter().filter(|(contact, _)| contact.gap <= TOUCHING));
        None
    }
}

impl Follower<'_> {
    /// Follows one pose until it has come to rest, also in the seat, as [`Follower::rest`] does, and keeps what carries it there.
    pub fn come_to_rest(&mut self, error: &PoseError) -> Rest {
        self.end_of(error, Until::AtRest)
    }

    /// Follows one pose until it is known what becomes of it, as [`Follower::follow`] does, and keeps what carried it last: where it
    /// jams, where it rests.
    pub fn settle(&mut self, error: &PoseError) -> Rest {
        self.end_of(error, Until::Known)
    }

    fn end_of(&mut self, error: &PoseError, until: Until) -> Rest {
        let mut last = Last::default();
        let End { outcome, error, .. } = self.0.follow(error, until, &mut last);
        let rests = outcome == Outcome::Jammed || outcome == Outcome::Aligned && until == Until::AtRest;
        let down = last.state.filter(|_| rests).and_then(|state| self.0.set_down(&state));
        match down {
            Some(state) => Rest {
                outcome,
                error: self.0.error_of(&state),
                height: Some(state.cor.z),
                contacts: self
                    .0
                    .contacts
                    .iter()
                    .filter(|(contact, _)| contact.gap <= SET_DOWN)
                    .copied()
                    .collect(),
                touching: SET_DOWN,
            },
            None => Rest {
                outcome,
                error,
                height: last.state.map(|state| state.cor.z),
                contacts: last.contacts,
                touching: TOUCHING,
            },
        }
    }
}

impl Motion<'_> {
    /// Sets a half that has come to rest down onto all that carries it, by Newton's method: motions end where what is left of the way is short, some of it
    /// not yet touched. `None` where that does not end near by, as on ground that is level but for its facets.
    ///
    /// [`Motion::contacts`] are those there.
    fn set_down(&mut self, state: &State) -> Option<State> {
        // In the mated pose itself halves of many facets touch all over, exactly.
        if self.settings.slope_threshold > 0.0 || self.is_home(state) {
            return None;
        }
        let (mut state, mut moved, mut seam) = (*state, 0.0, TOUCHING);
        for _ in 0..PASSES {
            let push = self.push.at(&state).map(|part| PUSH * part);
            self.turn(&state.rotation, state.cor.truncate(), FARTHEST);
            self.nearby.contacts_within(state.cor, 2.0 * TOUCHING, seam, &mut self.contacts);
            // What overlaps beyond the border of its features does not.
            let pair = self.pair;
            let is_on = |contact: &Contact, meeting: &Meeting| {
                pair.hold(contact, meeting, &state.rotation, state.cor).foot >= -BORDER
            };
            self.contacts.retain(|(contact, meeting)| {
                contact.gap >= 0.0 || contact.gap >= -TOUCHING && is_on(contact, meeting)
            });
            let axes = self.axes(&state);
            let rows: Vec<Vector> =
                self.contacts.iter().map(|(contact, _)| self.row(contact, &state, &axes)).collect();
            let tangents: Vec<_> = self
                .contacts
                .iter()
                .filter_map(|(contact, _)| self.tangents(contact, &state, &axes))
                .collect();
            let Self { projection, coulomb, contacts, settings, .. } = self;
            let all = Contacts { rows: &rows, tangents: &tangents, friction: settings.friction };
            let u = coulomb.displacement(projection, &push, all, |k| contacts[k].0.gap, PUSH)?;
            let length = dot(&u, &u).sqrt();
            if length <= EXACT && seam <= BORDER {
                return Some(state);
            }
            seam = (BESIDE * length).clamp(BORDER, seam);
            moved += length;
            if moved > FARTHEST {
                return None;
            }
            state = self.moved(&state, &u);
        }
        None
    }
}

/// Follows one pose until it is known what becomes of it, and keeps what carried it last.
pub fn settle(pair: &Pair, error: &PoseError, settings: &DescentSettings) -> Rest {
    Follower::new(pair, settings).settle(error)
}
