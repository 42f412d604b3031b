//! The first event within a step.
//!
//! ```text
//!   f(s)   gap of a contact that closes, or hold of an active contact
//!     │╲
//!     │  ╲            clear        false position between the last clear length and the first that
//!   0 ┼────╲×──────── s            passes an event, until the event is located
//!     │      ╲        passed
//! ```
//!
//! A new contact is located within its tolerance, on the open side of 0 if possible: nearly parallel edges
//! that overlap by 10⁻⁹ D seem to pass through each other's facets. A lost contact is left on the far side of
//! its border, so that it is not active again. At every tried length the step is recomputed: direction at its
//! own midpoint, then correction.

use super::super::holding::BORDER;
use super::super::motion::{Motion, State};
use super::super::projection::Vector;
use super::{FAR_SIDE, LANDING, SUPPORT};
use crate::contact::{Contact, Meeting, chord};
use crate::tolerance::ROUNDING;

/// Most trials of a step: bisection alone takes some 35 to [`ROUNDING`].
const MOST_TRIALS: usize = 60;
/// Number of trials for an event alone between two trials with all features: further trials are useless for
/// events that jump.
const NARROWINGS: usize = 8;
/// A correction may move a body by this share of its step, and by this much in D, before it is not trusted.
const TRUSTED_SHARE: f64 = 0.1;
const TRUSTED: f64 = 1e-6;
/// A contact that blocks a step at its start is added if it is this close, in D: as far as a correction is
/// trusted.
const CLOSE: f64 = 1e-6;
/// A feature that was open by less than this share of its overlap before a step had been passed earlier,
/// behind a wall.
const PASSED_BEFORE: f64 = 0.25;
/// Largest closing of a relevant gap, as a multiple of the largest displacement of the body, with room for
/// edges, whose feet move, too.
const CLOSED_BY: f64 = 2.0;
/// For halves of many facets, for which the reach of a step contains most of a part, overlaps are searched
/// only down to this depth, in D: deeper overlaps are detected by edges that pass through facets, and the
/// step is halved.
const DEEPEST_MET: f64 = 2e-3;
/// False position keeps off the ends of its interval by this share of it.
const EDGE: f64 = 1e-6;

/// End of a step.
pub(super) enum Reached {
    /// Here, after this length.
    At(State, f64),
    /// Nowhere: this is met at once, if it is known.
    Blocked(Option<(Contact, Meeting)>),
}

/// Result of a step of some length.
enum Trial {
    /// No contact met or lost; and whether the halves were tested for overlap, with a negative result.
    Clear(State, bool),
    /// A contact overlaps, or a carrying contact is lost; and whether the halves were tested for overlap.
    Passed(State, Event, bool),
    /// The contacts that carry cannot be kept.
    Failed,
    /// The halves overlap, and no contact in reach explains it.
    Overlaps,
}

/// Possible events of two features.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    /// They meet: the gap falls through 0.
    Met,
    /// They part: the hold falls through 0.
    Lost,
}

/// A function of a step's length that falls through 0.
#[derive(Clone, Copy)]
struct Event {
    contact: Contact,
    meeting: Meeting,
    kind: Kind,
}

/// An event between a clear length and a length that passes it, with the values there for false position.
#[derive(Clone, Copy)]
struct Bracket {
    event: Event,
    clear: f64,
    passed: f64,
    /// Which end moved last. The value of an end that stays twice is halved (Illinois), lest it stay forever.
    last: Option<End>,
}

#[derive(Clone, Copy, PartialEq)]
enum End {
    Clear,
    Passed,
}

impl Bracket {
    fn clear_at(&mut self, value: f64) {
        if self.last == Some(End::Clear) {
            self.passed *= 0.5;
        }
        (self.clear, self.last) = (value, Some(End::Clear));
    }

    fn passed_at(&mut self, value: f64) {
        if self.last == Some(End::Passed) {
            self.clear *= 0.5;
        }
        (self.passed, self.last) = (value, Some(End::Passed));
    }

    /// Expected position of the event, as a share of the distance from the clear length to the other.
    fn share(&self) -> f64 {
        if self.clear > 0.0 && self.passed < 0.0 {
            (self.clear / (self.clear - self.passed)).clamp(EDGE, 1.0 - EDGE)
        } else {
            0.5
        }
    }

    /// Whether a step that ends at this value of the event's function ends on the event.
    fn lands(&self, value: f64) -> bool {
        match self.event.kind {
            Kind::Met => (-1.5 * LANDING..=LANDING).contains(&value),
            Kind::Lost => (-0.5 * FAR_SIDE..0.5 * FAR_SIDE).contains(&value),
        }
    }
}

impl Motion<'_> {
    /// Moves from `state`, with the direction `start`, by `step`, or to the first event before.
    pub(super) fn until_event(&mut self, state: &State, start: &Vector, step: f64) -> Reached {
        let (mut low, mut clear) = (0.0, *state);
        let (mut high, mut at) = (step, step);
        let mut bracket: Option<Bracket> = None;
        // Test overlap at the end of the step; once the halves overlap, test it at every length.
        let mut wary = false;
        for _ in 0..MOST_TRIALS {
            let trial = self.attempt(state, start, at, wary);
            let ends = match &trial {
                Trial::Clear(next, _) => match &bracket {
                    Some(b) => b.event.kind == Kind::Met && b.lands(self.value(&b.event, next)),
                    None => at >= high,
                },
                Trial::Passed(next, event, _) => {
                    event.kind == Kind::Lost && self.value(event, next) >= -0.5 * FAR_SIDE
                }
                Trial::Failed | Trial::Overlaps => false,
            };
            match trial {
                Trial::Clear(next, tested) | Trial::Passed(next, _, tested) if ends => {
                    if tested || !self.overlaps(&next) {
                        return Reached::At(next, at);
                    }
                    (low, clear, high, bracket, wary) = (0.0, *state, at, None, true);
                }
                Trial::Clear(next, _) => {
                    (low, clear) = (at, next);
                    if let Some(bracket) = &mut bracket {
                        let value = self.value(&bracket.event, &next);
                        bracket.clear_at(value);
                    }
                }
                Trial::Passed(next, event, _) => {
                    let value = self.value(&event, &next);
                    high = at;
                    match &mut bracket {
                        Some(b) if b.event.meeting == event.meeting && b.event.kind == event.kind => {
                            b.passed_at(value);
                        }
                        _ => {
                            let clear = self.value(&event, &clear);
                            bracket = Some(Bracket { event, clear, passed: value, last: None });
                        }
                    }
                }
                Trial::Overlaps if !wary => {
                    // A length that seemed clear may overlap, too.
                    (low, clear, high, bracket, wary) = (0.0, *state, at, None, true);
                }
                Trial::Failed | Trial::Overlaps => {
                    high = at;
                    bracket = None;
                }
            }
            if high - low < ROUNDING {
                break;
            }
            at = match &bracket {
                Some(bracket) => self.narrowed(state, start, [low, high], *bracket),
                None => low + 0.5 * (high - low),
            };
        }
        if low > ROUNDING && (wary || !self.overlaps(&clear)) {
            return Reached::At(clear, low);
        }
        Reached::Blocked(bracket.filter(|b| b.event.kind == Kind::Met).and_then(
            |Bracket { event, .. }| {
                let contact = self.pair.contact(&event.contact, &event.meeting, &state.rotation, state.cor);
                (contact.gap.abs() <= CLOSE).then_some((contact, event.meeting))
            },
        ))
    }

    /// The length, between a clear length and a length that passes an event, at which a step ends on the
    /// event, regardless of other events there: by false position, and without testing other features.
    fn narrowed(
        &mut self,
        state: &State,
        start: &Vector,
        [mut low, mut high]: [f64; 2],
        mut bracket: Bracket,
    ) -> f64 {
        let mut at = low + bracket.share() * (high - low);
        for _ in 0..NARROWINGS {
            let Some(next) = self.step_of(state, start, at) else { break };
            let value = self.value(&bracket.event, &next);
            if bracket.lands(value) || high - low < ROUNDING {
                break;
            }
            if value < 0.0 {
                high = at;
                bracket.passed_at(value);
            } else {
                low = at;
                bracket.clear_at(value);
            }
            at = low + bracket.share() * (high - low);
        }
        at
    }

    /// Value of an event's function at `state`: 0 within half of its tolerance.
    fn value(&self, event: &Event, state: &State) -> f64 {
        let contact = self.pair.contact(&event.contact, &event.meeting, &state.rotation, state.cor);
        match event.kind {
            Kind::Met => contact.gap - 0.5 * LANDING,
            Kind::Lost => self.hold(&contact, &event.meeting, state) + 0.5 * FAR_SIDE,
        }
    }

    /// Distance of a contact from its loss, in D or as a sine, whichever is less.
    pub(super) fn hold(&self, contact: &Contact, meeting: &Meeting, state: &State) -> f64 {
        let hold = self.pair.hold(contact, meeting, &state.rotation, state.cor);
        (hold.foot + BORDER).min(hold.support + SUPPORT)
    }

    /// A step of length `at`, with its result; overlaps that no contact predicts are detected only if `wary`.
    fn attempt(&mut self, state: &State, start: &Vector, at: f64, wary: bool) -> Trial {
        let Some(next) = self.step_of(state, start, at) else { return Trial::Failed };
        let carrying = std::mem::take(&mut self.sliding.carrying);
        let trial = self.judge(state, next, at, &carrying, wary);
        self.sliding.carrying = carrying;
        trial
    }

    /// End of a step of length `at`, with the carrying contacts kept as far as possible.
    fn step_of(&mut self, state: &State, start: &Vector, at: f64) -> Option<State> {
        let middle = self.moved(state, &start.map(|x| 0.5 * at * x));
        let u = self.direction(&middle).unwrap_or(*start);
        let next = self.moved(state, &u.map(|x| at * x));
        let trusted = TRUSTED_SHARE * at + TRUSTED;
        let carrying = std::mem::take(&mut self.sliding.carrying);
        // Contacts that fix the body cannot all be kept; it suffices that none overlaps.
        let corrected =
            self.corrected(&next, &carrying, trusted).or_else(|| self.corrected(&next, &[], trusted));
        self.sliding.carrying = carrying;
        corrected
    }

    /// Result of a step of length `at` from `state` that ends at `next`.
    fn judge(&mut self, state: &State, next: State, at: f64, carrying: &[usize], wary: bool) -> Trial {
        let closed = CLOSED_BY * self.moved_by(state, &next);
        let closed = closed.min(self.horizon(at).1);
        let reach = if self.pair.has_trees() { closed.min(DEEPEST_MET) } else { closed };
        if let Some(event) = self.first_met(state, &next, reach) {
            return Trial::Passed(next, event, false);
        }
        // If the search covered the whole reach, the overlap test is not needed.
        let wary = wary || reach < closed;
        let holds = carrying.iter().map(|&k| {
            let (before, meeting) = self.contacts[k];
            let contact = self.pair.contact(&before, &meeting, &next.rotation, next.cor);
            let event = Event { contact: before, meeting, kind: Kind::Lost };
            (self.hold(&contact, &meeting, &next), event)
        });
        match holds.min_by(|a, b| a.0.total_cmp(&b.0)).filter(|(hold, _)| *hold < 0.0) {
            Some((hold, event)) if hold < -FAR_SIDE => Trial::Passed(next, event, false),
            _ if wary && self.overlaps(&next) => Trial::Overlaps,
            Some((_, event)) => Trial::Passed(next, event, wary),
            None => Trial::Clear(next, wary),
        }
    }

    /// The first contact met from `state` on among those that overlap at `next` by up to `reach`, if gaps
    /// close evenly.
    fn first_met(&mut self, state: &State, next: &State, reach: f64) -> Option<Event> {
        self.look(next);
        let mut touched = std::mem::take(&mut self.sliding.touched);
        self.nearby.overlaps_within(next.cor, [LANDING, reach + LANDING], BORDER, &mut touched);
        let first = touched
            .iter()
            .filter_map(|&(contact, meeting)| {
                let before = self.pair.contact(&contact, &meeting, &state.rotation, state.cor).gap;
                // A gap that was not open before is that of a feature which has only now come near: others first.
                let order = (before < -LANDING, before / (before - contact.gap));
                (before >= PASSED_BEFORE * contact.gap).then_some((order, (contact, meeting)))
            })
            .min_by(|(a, _), (b, _)| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)))
            .map(|(_, (contact, meeting))| Event { contact, meeting, kind: Kind::Met });
        self.sliding.touched = touched;
        first
    }

    /// Largest displacement of any point of the body.
    fn moved_by(&self, from: &State, to: &State) -> f64 {
        from.cor.distance(to.cor) + self.radius * chord(&from.rotation, &to.rotation)
    }

    /// Whether the halves overlap at `state`.
    pub(super) fn overlaps(&mut self, state: &State) -> bool {
        self.nearby.overlaps_at(&state.rotation, state.cor)
    }
}
