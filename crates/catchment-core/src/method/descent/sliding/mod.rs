//! Motion from event to event, for tight fits.
//!
//! ```text
//!     q₀ ──── s·u ────▶ q₁      the contacts that carry the body are kept, all others stay open
//!             │
//!             ├ met     a contact closes: its gap falls through 0
//!             └ lost    a foot leaves its feature, or the feature stops supporting the normal
//! ```
//!
//! A step between walls that ignores events within it loses contacts that carry the body, and later contacts
//! then compensate in height, not in the other errors. Each step therefore ends at the first event:
//!
//! 1. Active contacts are those that touch and are supported. Without active contacts the half moves straight
//!    down to the next one.
//! 2. The direction is the closest one to straight down that no active contact forbids (the minimum-norm
//!    point of the gradients, see [`super::projection`]), evaluated at the midpoint of the step; a step that
//!    bends is halved.
//! 3. Newton's method brings the carrying contacts back to contact ([`correction`]).
//! 4. If a contact was met or lost within the step, the step ends there ([`event`]).
//!
//! Heights are not reset and walls have no margin: contacts touch to rounding, and between events the error
//! is that of the midpoint rule, third order in the step.
//!
//! Not promised: a continuation if the halves are caught in an overlap that no contact explains, or if flush
//! contacts alternate without end. Then one plain step is made as for pairs without tight fits.

mod correction;
mod event;

use super::coulomb::{Contacts, STILL, Tangents};
use super::holding::BORDER;
use super::motion::{Motion, State};
use super::projection::Vector;
use super::step::{Advance, Pace};
use crate::acceptance::Outcome;
use crate::contact::{Contact, FLUSH, Meeting};
use event::Reached;
use glam::{DMat3, DVec2};

/// A gap below this touches, in D: above the residual of a landing, far below a gap that would change a
/// direction.
const ACTIVE: f64 = 2.0 * LANDING;
/// A contact has landed if its gap is this close to 0, in D: above the inexactness of coplanar facets of
/// drawn pieces.
const LANDING: f64 = 1e-9;
/// Largest overlap that still counts as contact, in D: that of a height rounded on a steep slope. Deeper
/// overlaps were passed.
const DEEPEST: f64 = 1e-7;
/// Sine by which a feature may fail to support a normal: that of faces that lie flush.
const SUPPORT: f64 = FLUSH;

/// Largest change of the direction, 1 in its largest part, from the start of a step to its middle.
const BEND: f64 = 0.05;
/// Steps are not halved below this share of the longest for the sake of the direction: edges that are nearly parallel turn at any scale.
const LEAST_SHARE: f64 = 1e-6;
/// After an event the next step is tried with this multiple of the last length, at least this share of the
/// longest: each trial tests all features nearby.
const FURTHER: f64 = 4.0;
const LEAST_TRY: f64 = 0.25;
/// Largest distance beyond the border at which a lost contact is left, in D or as a sine: below the
/// resolution of a landing.
const FAR_SIDE: f64 = 1e-9;
/// A contact met at the very start of a step is added, at most this often: the corners of two faces.
const MOST_BLOCKERS: usize = 8;
/// The contacts that will carry are brought to touch within this before a step, in D: landings on contacts close
/// together, whose correction is longer than their gap.
const SETTLED: f64 = 1e-6;

/// A step shorter than this crawls, in D: far below a facet, above the residual of a landing.
const CRAWL: f64 = 1e-5;
/// After so many such steps in a row contacts alternate without an end: more than any two faces have corners.
const MOST_CRAWLS: usize = 32;

/// Buffers of a sliding motion.
#[derive(Debug, Default)]
pub(super) struct Sliding {
    /// Pose at which the elements are those required by [`SUPPORT`].
    looked: Option<(DMat3, DVec2)>,
    /// How many steps in a row have crawled.
    crawls: usize,
    /// Which of the active contacts carry the body.
    carrying: Vec<usize>,
    /// Contacts at the end of a trial step.
    touched: Vec<(Contact, Meeting)>,
    rows: Vec<Vector>,
    tangents: Vec<Tangents>,
    gaps: Vec<f64>,
}

impl Sliding {
    /// Discards the last results: the pose, or the elements, have changed.
    pub(super) const fn forget(&mut self) {
        (self.looked, self.crawls) = (None, 0);
    }
}

impl Motion<'_> {
    /// Finds the active contacts and moves the body out of their overlaps.
    pub(super) fn feel(&mut self, state: &State) -> State {
        self.look(state);
        self.nearby.contacts_within(state.cor, DEEPEST, BORDER, &mut self.contacts);
        self.contacts.retain(|(contact, _)| contact.gap <= ACTIVE);
        self.corrected(state, &[], DEEPEST).unwrap_or(*state)
    }

    /// A step from `state`, with its active contacts known, to its first event.
    pub(super) fn slide(&mut self, state: &State, pace: &mut Pace) -> Advance {
        let mut state = *state;
        for _ in 0..=MOST_BLOCKERS {
            if self.sliding.crawls > MOST_CRAWLS {
                break;
            }
            if self.contacts.is_empty() {
                return self.drop_down(&state);
            }
            let Some(start) = self.direction(&state).filter(|u| !self.is_too_gentle(&state, u, lateral(u)))
            else {
                return Advance::Ended(Outcome::Jammed, state);
            };
            let carrying = std::mem::take(&mut self.sliding.carrying);
            state = self.corrected(&state, &carrying, SETTLED).unwrap_or(state);
            self.sliding.carrying = carrying;
            if self.lets_go(&state) {
                continue;
            }
            let step = self.straight(&state, &start, pace.step.min(self.settings.step));
            match self.until_event(&state, &start, step) {
                Reached::At(next, length) => {
                    let least = self.settings.step * LEAST_TRY;
                    let further = if length < step { (FURTHER * length).max(least) } else { f64::INFINITY };
                    pace.step = further.min(2.0 * step);
                    self.crawl(length);
                    return Advance::Moved(next, length * lateral(&start));
                }
                Reached::Blocked(Some(blocker)) => self.contacts.push(blocker),
                Reached::Blocked(None) => break,
            }
        }
        // If no event can be followed, a plain step passes the place.
        let mut plain = Pace::new(self.settings.step);
        self.sliding.forget();
        self.turn(&state.rotation, state.cor.truncate(), plain.step);
        self.gather(&state, plain.step);
        self.advance(&state, &mut plain)
    }

    /// Counts how many steps in a row crawl, the last of this length.
    const fn crawl(&mut self, length: f64) {
        self.sliding.crawls = if length < CRAWL { self.sliding.crawls + 1 } else { 0 };
    }

    /// Removes the contacts that are no longer on their features at `state`, to which a correction has moved
    /// the body; returns whether one of them carried it.
    fn lets_go(&mut self, state: &State) -> bool {
        let mut contacts = std::mem::take(&mut self.contacts);
        let lost = |(contact, meeting): &(Contact, Meeting)| {
            let contact = self.pair.contact(contact, meeting, &state.rotation, state.cor);
            self.hold(&contact, meeting, state) < -FAR_SIDE
        };
        let carried = self.sliding.carrying.iter().any(|&k| lost(&contacts[k]));
        if carried {
            contacts.retain(|contact| !lost(contact));
        }
        self.contacts = contacts;
        carried
    }

    /// Moves to `state`, unless the last query was there.
    fn look(&mut self, state: &State) {
        let here = (state.rotation, state.cor.truncate());
        if self.sliding.looked != Some(here) {
            self.sliding.looked = Some(here);
            let (_, near) = self.horizon(self.settings.step);
            self.nearby.turn(&here.0, here.1, SUPPORT, near);
        }
    }

    /// Lowers the body to the next contact below it.
    fn drop_down(&mut self, state: &State) -> Advance {
        // Faces may land flush, so contacts that nearly support count, too.
        self.sliding.looked = None;
        self.turn(&state.rotation, state.cor.truncate(), self.settings.step);
        let Some(z) = self.nearby.height_below(state.cor.truncate(), state.cor.z).0 else {
            return Advance::Ended(Outcome::Missed, *state);
        };
        if z >= state.cor.z {
            // Something stops the body and nothing touches it.
            return Advance::Ended(Outcome::Undecided, *state);
        }
        let landed = State { cor: state.cor.truncate().extend(z), ..*state };
        self.crawl(state.cor.z - z);
        if !self.overlaps(&landed) {
            return Advance::Moved(landed, 0.0);
        }
        // Rims have crossed on the way without a contact between them.
        match self.until_event(state, &self.push(state), state.cor.z - z) {
            Reached::At(next, _) => Advance::Moved(next, 0.0),
            Reached::Blocked(_) => Advance::Ended(Outcome::Undecided, *state),
        }
    }

    /// The longest of `step`, its half, its quarter … to whose middle the direction hardly turns from `start`.
    fn straight(&mut self, state: &State, start: &Vector, mut step: f64) -> f64 {
        while step > self.settings.step * LEAST_SHARE {
            let middle = self.moved(state, &start.map(|x| 0.5 * step * x));
            if self.direction(&middle).is_some_and(|u| difference(&u, start) <= BEND) {
                break;
            }
            step *= 0.5;
        }
        step
    }

    /// Direction of the body at `state` by the active contacts, regardless of borders, with its larger
    /// component scaled to 1: its lateral part (ρ-metric) or its fall. Stores the carrying contacts. `None`
    /// at rest.
    fn direction(&mut self, state: &State) -> Option<Vector> {
        let axes = self.axes(state);
        let mut rows = std::mem::take(&mut self.sliding.rows);
        let mut tangents = std::mem::take(&mut self.sliding.tangents);
        rows.clear();
        tangents.clear();
        for (before, meeting) in &self.contacts {
            let contact = self.pair.contact(before, meeting, &state.rotation, state.cor);
            rows.push(self.row(&contact, state, &axes));
            tangents.extend(self.tangents(&contact, state, &axes));
        }
        let contacts = Contacts { rows: &rows, tangents: &tangents, friction: self.settings.friction };
        let (push, touching) = (self.push(state), |_| 0.0);
        let u = self
            .coulomb
            .displacement(&mut self.projection, &push, contacts, touching, 1.0)
            .unwrap_or_default();
        (self.sliding.rows, self.sliding.tangents) = (rows, tangents);
        self.sliding.carrying.clear();
        self.sliding.carrying.extend_from_slice(self.coulomb.pressed());
        let size = lateral(&u).max(u[2].abs());
        (size > STILL).then(|| u.map(|x| x / size))
    }
}

/// Length of a displacement in the ρ-metric.
fn lateral(u: &Vector) -> f64 {
    u.iter().enumerate().filter(|(k, _)| *k != 2).map(|(_, x)| x * x).sum::<f64>().sqrt()
}

/// Distance between two directions.
fn difference(a: &Vector, b: &Vector) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}
