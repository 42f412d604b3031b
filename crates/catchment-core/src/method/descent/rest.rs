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
/// The same for a half that was set down onto its contacts, in D: above [`EXACT`] and the inexactness of
/// coplanar facets.
const SET_DOWN: f64 = 1e-7;

/// Depth by which a half is pushed down onto its contacts, in D: finds hollows whose curvature is below its
/// inverse.
const PUSH: f64 = 0.05;
/// Largest displacement of this, in the ρ-metric and z combined, in D: the distance that motions leave at
/// their end.
const FARTHEST: f64 = 1e-3;
/// Passes of Newton's method at most, and the last displacement, in D: above the rounding of its equations.
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
    /// z of the COR in the world frame at the last contact, in D; `None` if the halves never met.
    pub height: Option<f64>,
    /// The contacts there, by features.
    pub contacts: Vec<(Contact, Meeting)>,
    /// Largest gap that counts as contact, in D: [`TOUCHING`], and less if the half was set down onto its
    /// contacts.
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
    /// Follows a pose until it has come to rest, even in the seat, as [`Follower::rest`] does, and keeps the
    /// contacts that carry it there.
    pub fn come_to_rest(&mut self, error: &PoseError) -> Rest {
        self.end_of(error, Until::AtRest)
    }

    /// Follows a pose until its outcome is known, as [`Follower::follow`] does, and keeps its last carrying
    /// contacts: for a jam those at its rest.
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
    /// Sets a half at rest down onto all its contacts, by Newton's method: motions end when the remaining
    /// distance is short, with some contacts not yet closed. `None` if the iteration does not end nearby, as
    /// on ground that is level except for its facets.
    ///
    /// [`Motion::contacts`] are then the contacts there.
    fn set_down(&mut self, state: &State) -> Option<State> {
        // In the mated pose itself halves of many facets touch all over, exactly.
        if self.settings.slope_threshold > 0.0 || self.is_home(state) {
            return None;
        }
        let (mut state, mut moved, mut seam) = (*state, 0.0, TOUCHING);
        for _ in 0..PASSES {
            let push = self.push(&state).map(|part| PUSH * part);
            self.turn(&state.rotation, state.cor.truncate(), FARTHEST);
            self.nearby.contacts_within(state.cor, 2.0 * TOUCHING, seam, &mut self.contacts);
            // An overlap beyond the border of a contact's features does not count.
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

/// Follows a pose until its outcome is known, and keeps its last carrying contacts.
pub fn settle(pair: &Pair, error: &PoseError, settings: &DescentSettings) -> Rest {
    Follower::new(pair, settings).settle(error)
}
