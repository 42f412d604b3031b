//! The first event on the way of a step.
//!
//! ```text
//!   f(s)   gap of what is met, or hold of what carries
//!     │╲
//!     │  ╲            clear        false position (Illinois) between the last clear share of the step and
//!   0 ┼────╲×──────── s            the first that is not, until the event is landed on
//!     │      ╲        not clear
//! ```
//!
//! What is met is landed on within its tolerance, from either side; what is lost is left on the far side of its border, so that
//! it is not felt again.

use super::super::motion::{Motion, State};
use super::super::projection::Vector;
use super::{BORDER, LANDING, SUPPORT};
use crate::contact::{Contact, Meeting};

/// How far beyond the border a lost contact is left, at most, in D or radians: below what a landing tells apart.
const FAR_SIDE: f64 = 1e-9;
/// Most trials of a step; bisection alone takes some 30 to [`NOWHERE`].
const MOST_TRIALS: usize = 60;
/// A step shorter than this leads nowhere, in D.
const NOWHERE: f64 = 1e-12;
/// A correction may move a body by this share of its step, and by this much in D, before it is not trusted.
const TRUSTED_SHARE: f64 = 0.1;
const TRUSTED: f64 = 1e-6;
/// What blocks a step at its start is one more contact if it is this close, in D.
const CLOSE: f64 = 1e-6;

/// False position keeps off the ends of its interval by this share of it.
const EDGE: f64 = 1e-6;

/// Where a step ended.
pub(super) enum Reached {
    /// Here, after this length.
    At(State, f64),
    /// Not anywhere: something is met at once.
    Blocked(Option<(Contact, Meeting)>),
}

/// What came of a step of some length.
enum Trial {
    /// Nothing met, nothing lost.
    Clear(State),
    /// A contact overlaps, or one that carries is lost.
    Passed(State, Watched),
    /// The contacts that carry cannot be kept.
    Failed,
}

/// The function of a step's length whose zero is an event.
#[derive(Clone, Copy)]
struct Watched {
    contact: Contact,
    meeting: Meeting,
    what: What,
}

#[derive(Clone, Copy, PartialEq)]
enum What {
    Gap,
    Hold,
}

impl Watched {
    fn is_same(&self, other: &Self) -> bool {
        self.meeting == other.meeting && self.what == other.what
    }
}

/// An event between a clear length and one that passes it, with the values there for false position.
struct Bracket {
    watched: Watched,
    clear: f64,
    passed: f64,
    /// Which end was moved last, for the Illinois rule: the value of an end that stays twice is halved.
    last_clear: Option<bool>,
}

impl Bracket {
    const fn new(watched: Watched, clear: f64, passed: f64) -> Self {
        Self { watched, clear, passed, last_clear: None }
    }

    fn is_clear_at(&mut self, value: f64) {
        if self.last_clear == Some(true) {
            self.passed *= 0.5;
        }
        self.clear = value;
        self.last_clear = Some(true);
    }

    fn is_passed_at(&mut self, value: f64) {
        if self.last_clear == Some(false) {
            self.clear *= 0.5;
        }
        self.passed = value;
        self.last_clear = Some(false);
    }

    /// Where the event is expected, as a share of the way from the clear length to the other.
    fn share(&self) -> f64 {
        if self.clear > 0.0 && self.passed < 0.0 {
            (self.clear / (self.clear - self.passed)).clamp(EDGE, 1.0 - EDGE)
        } else {
            0.5
        }
    }
}

impl Motion<'_> {
    /// Moves along `u` by `step`, or to the first event before.
    pub(super) fn until_event(&mut self, state: &State, u: &Vector, step: f64) -> Reached {
        let (mut low, mut clear) = (0.0, *state);
        let (mut high, mut at) = (step, step);
        let mut bracket: Option<Bracket> = None;
        for _ in 0..MOST_TRIALS {
            match self.attempt(state, u, at) {
                Trial::Clear(next) => {
                    let value = bracket.as_ref().map(|b| self.value(&b.watched, &next));
                    let landed = match (&bracket, value) {
                        (Some(b), Some(value)) => b.watched.what == What::Gap && value.abs() <= LANDING,
                        _ => at >= high,
                    };
                    if landed {
                        return Reached::At(next, at);
                    }
                    (low, clear) = (at, next);
                    if let (Some(b), Some(value)) = (&mut bracket, value) {
                        b.is_clear_at(value);
                    }
                }
                Trial::Passed(next, watched) => {
                    let value = self.value(&watched, &next);
                    if watched.what == What::Hold && value >= -0.5 * FAR_SIDE {
                        return Reached::At(next, at);
                    }
                    high = at;
                    match &mut bracket {
                        Some(b) if b.watched.is_same(&watched) => b.is_passed_at(value),
                        _ => bracket = Some(Bracket::new(watched, self.value(&watched, &clear), value)),
                    }
                }
                Trial::Failed => {
                    high = at;
                    bracket = None;
                }
            }
            if std::env::var("DBG").is_ok() {
                let n = bracket.as_ref().map(|b| (b.watched.what == What::Gap, b.watched.meeting, b.watched.contact.normal, b.clear, b.passed));
                eprintln!("   at {at:.3e} low {low:.3e} high {high:.3e} {n:?}");
            }
            if high - low < NOWHERE {
                break;
            }
            at = low + bracket.as_ref().map_or(0.5, Bracket::share) * (high - low);
        }
        if low > NOWHERE {
            return Reached::At(clear, low);
        }
        Reached::Blocked(bracket.and_then(|Bracket { watched: event, .. }| {
            let contact =
                self.pair.contact(&event.contact, &event.meeting, &state.rotation, state.cor);
            (event.what == What::Gap && contact.gap.abs() <= CLOSE).then_some((contact, event.meeting))
        }))
    }

    /// Value of what is watched at `state`, below 0 behind the event.
    fn value(&self, watched: &Watched, state: &State) -> f64 {
        let contact =
            self.pair.contact(&watched.contact, &watched.meeting, &state.rotation, state.cor);
        match watched.what {
            What::Gap => contact.gap + 0.5 * LANDING,
            What::Hold => self.hold(&contact, &watched.meeting, state) + 0.5 * FAR_SIDE,
        }
    }

    fn hold(&self, contact: &Contact, meeting: &Meeting, state: &State) -> f64 {
        let hold = self.pair.hold(contact, meeting, &state.rotation, state.cor);
        (hold.foot + BORDER).min(hold.support + SUPPORT)
    }

    /// A step of length `at` along `u`, and what comes of it.
    fn attempt(&mut self, state: &State, start: &Vector, at: f64) -> Trial {
        let middle = self.moved(state, &start.map(|x| 0.5 * at * x));
        let u = self.direction(&middle).unwrap_or(*start);
        let next = self.moved(state, &u.map(|x| at * x));
        let trusted = TRUSTED_SHARE * at + TRUSTED;
        let carrying = self.sliding.as_mut().map(|s| std::mem::take(&mut s.carrying)).unwrap_or_default();
        let corrected = self.corrected(&next, &carrying, trusted).or_else(|| { if std::env::var("DBG").is_ok() { eprintln!("      uncorrected at {at:.3e} {carrying:?}"); } self.corrected(&next, &[], trusted) });
        let trial = corrected.map_or(Trial::Failed, |next| self.judge(state, next, at, &carrying));
        if let Some(sliding) = &mut self.sliding {
            sliding.carrying = carrying;
        }
        trial
    }

    /// What comes of a step of length `at` that ends at `next`.
    fn judge(&mut self, state: &State, next: State, at: f64, carrying: &[usize]) -> Trial {
        let (_, near) = self.horizon(self.settings.step);
        let (_, closed) = self.horizon(at);
        self.nearby.turn(&next.rotation, next.cor.truncate(), SUPPORT, near);
        let mut touched = self.sliding.as_mut().map(|s| std::mem::take(&mut s.touched)).unwrap_or_default();
        self.nearby.contacts_within(next.cor, closed + LANDING, BORDER, &mut touched);
        // What is met first if gaps close evenly.
        let mut first: Option<((bool, f64), Watched)> = None;
        for (contact, meeting) in touched.iter().filter(|(c, _)| c.gap < -LANDING) {
            let before = self.pair.contact(contact, meeting, &state.rotation, state.cor).gap;
            // What was as deep before is another way through the same wall.
            if before < 0.25 * contact.gap {
                continue;
            }
            // A gap that was not open before is that of a feature which has only now come near.
            let when = (before < -LANDING, before / (before - contact.gap));
            if first.is_none_or(|(earliest, _)| when < earliest) {
                first = Some((when, Watched { contact: *contact, meeting: *meeting, what: What::Gap }));
            }
        }
        if let Some(sliding) = &mut self.sliding {
            sliding.touched = touched;
        }
        if let Some((_, met)) = first {
            return Trial::Passed(next, met);
        }
        let mut lost: Option<(f64, Watched)> = None;
        for &k in carrying {
            let (before, meeting) = self.contacts[k];
            let contact = self.pair.contact(&before, &meeting, &next.rotation, next.cor);
            let hold = self.hold(&contact, &meeting, &next);
            if hold < 0.0 && lost.is_none_or(|(least, _)| hold < least) {
                lost = Some((hold, Watched { contact: before, meeting, what: What::Hold }));
            }
        }
        match lost {
            Some((hold, event)) if hold < -FAR_SIDE => Trial::Passed(next, event),
            _ if self.overlaps(&next) => Trial::Failed,
            Some((_, event)) => Trial::Passed(next, event),
            None => Trial::Clear(next),
        }
    }

    /// Whether the halves overlap at `state`.
    pub(super) fn overlaps(&mut self, state: &State) -> bool {
        let mut placed = self.sliding.as_mut().map(|s| std::mem::take(&mut s.placed)).unwrap_or_default();
        let overlaps = self.pair.overlaps(&state.rotation, state.cor, &mut placed);
        if let Some(sliding) = &mut self.sliding {
            sliding.placed = placed;
        }
        overlaps
    }
}
