//! Friction coefficients at which a half sticks at its contacts: two thresholds, not one.
//!
//! ```text
//!   friction   0 ───────────┬──────────────┬─────────▶
//!                 slips     │  either      │  sticks
//!                       holds from     slips until
//! ```
//!
//! From the first threshold on, forces within the friction cones exist that hold the half against the push;
//! up to the second the half can slip. Between them Coulomb's law for rigid bodies does not decide: a half
//! released at rest may stick, and a sliding half continues. Motions ([`super::Settings::friction`]) slip in
//! this range; [`super::Follower::follow_doubting`] reports whether they passed such a place.
//!
//! A half *wedges* if forces within the cones would also hold it against a straight pull: contacts press
//! against each other, and rigid-body mechanics does not determine how hard (Whitney, *J. Dyn. Sys. Meas.
//! Control* 104, 1982). Slightly compliant halves, as real ones and those of engines are, may come loose
//! there.
//!
//! Not promised: that a half which reaches a place at which it slips did not stick earlier. Only motions show
//! the result at each friction coefficient.

use super::coulomb::{Contacts, Coulomb, Tangents, is_still};
use super::motion::{Motion, MotionObserver, State};
use super::projection::{MAX_COORDINATES, Projection, Vector};
use super::rows::margin;
use super::{DescentSettings, MOST_FRICTION as MOST};
use crate::acceptance::Outcome;
use crate::contact::{Contact, Pair};
use crate::pose::PoseError;
use crate::tolerance::COINCIDENT;
use serde::{Deserialize, Serialize};

/// Friction coefficients at which a touching half may stick, by Coulomb's law.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Sticking {
    /// Sticking threshold: from this friction coefficient on, forces exist that hold the half; 0 if the
    /// contacts hold it without friction; null: never.
    pub holds_from: Option<f64>,
    /// Slipping threshold: up to this friction coefficient the half can slip; null: always.
    pub slips_until: Option<f64>,
    /// From this friction coefficient on the half wedges and may also resist a straight pull; null: never.
    pub wedges_from: Option<f64>,
}

/// Cases of a motion that Coulomb's law leaves open.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct FrictionAmbiguity {
    /// It passed a place at which it slips although some force could hold it.
    pub may_stick: bool,
    /// It jams, and wedges there: some force would hold it against a pull straight out as well.
    pub wedges: bool,
}

/// Accuracy of the sticking threshold, a friction coefficient: the slipping threshold is extrapolated from it.
const HOLDS_TO: f64 = 1e-9;
/// For the slipping threshold, slips are computed at these shares of the first estimate, then at this share
/// of the distance to their apparent end, until that distance is this share of it: the remainder is of second
/// order.
const FIRST: f64 = 0.9;
const SECOND: f64 = 0.95;
const SHARE: f64 = 0.7;
const NEAR: f64 = 2e-3;

/// A half holds weakly if μ is less than this factor above the friction coefficient at which it slips:
/// physics engines let a half slip up to a factor of 1.05 (`docs/friction.md`).
pub const HARDLY: f64 = 1.1;

/// Sticking thresholds at first contact of a half lowered at a pose error; `None` without contact.
pub fn sticking(pair: &Pair, error: &PoseError) -> Option<Sticking> {
    // Any friction coefficient above 0: the rows then include slips.
    let settings = DescentSettings { friction: 1.0, ..DescentSettings::default() };
    let mut motion = Motion::new(pair, &settings);
    let state = motion.lower(error)?;
    let mut touching = Touching::default();
    touching.see(&motion, &state);
    Some(touching.thresholds())
}

/// The other way: straight out.
const OUT: Vector = {
    let mut out = [0.0; MAX_COORDINATES];
    out[2] = 1.0;
    out
};

/// The contacts, as rows.
#[derive(Debug, Clone, Default)]
pub(super) struct Touching {
    pub(super) rows: Vec<Vector>,
    pub(super) tangents: Vec<Tangents>,
    /// The push there.
    pub(super) push: Vector,
    coulomb: Coulomb,
    projection: Projection,
}

impl Touching {
    /// Records the contacts at a place of a motion: contacts that carry alternately have gaps as large as the
    /// bend of a step.
    fn see_on_the_way(&mut self, motion: &Motion, state: &State) {
        let bend = motion.settings.step * motion.settings.step;
        let touches = |contact: &Contact| motion.pair.is_tight() || contact.gap <= bend;
        self.see_those(touches, motion, state);
    }

    pub(super) fn see(&mut self, motion: &Motion, state: &State) {
        // Plain motion keeps a margin from walls; the contacts that tight fits keep are closed.
        let touches =
            |contact: &Contact| motion.pair.is_tight() || contact.gap <= COINCIDENT + 2.0 * margin(contact);
        self.see_those(touches, motion, state);
    }

    /// Features with gaps up to `near` count as contacts.
    pub(super) fn see_within(&mut self, near: f64, motion: &Motion, state: &State) {
        self.see_those(|contact| contact.gap <= near, motion, state);
    }

    fn see_those(&mut self, touches: impl Fn(&Contact) -> bool, motion: &Motion, state: &State) {
        let axes = motion.axes(state);
        self.push = motion.push(state);
        self.rows.clear();
        self.tangents.clear();
        for (contact, _) in motion.contacts.iter().filter(|(contact, _)| touches(contact)) {
            self.rows.push(motion.row(contact, state, &axes));
            self.tangents.push(motion.slips(contact, state, &axes));
        }
    }

    /// The part of a push that the contacts do not balance: the push minus the nearest force that they can
    /// balance.
    pub(super) fn unheld(&mut self, push: &Vector, friction: f64) -> Option<Vector> {
        if friction == 0.0 {
            let touching = self.rows.iter().map(|_| 0.0);
            return self.projection.closest_allowed(push, &self.rows, touching, 1.0);
        }
        let contacts = Contacts { rows: &self.rows, tangents: &self.tangents, friction };
        self.coulomb.unheld(&mut self.projection, push, contacts)
    }

    /// The forces along normals that hold a push without friction, by rows; those of the nearest push that is held.
    pub(super) fn forces(&mut self, push: &Vector) -> Vec<(usize, f64)> {
        match self.unheld(push, 0.0) {
            Some(_) => self.projection.forces().collect(),
            None => Vec::new(),
        }
    }

    /// Whether some force holds a push.
    pub(super) fn holds(&mut self, push: &Vector, friction: f64) -> bool {
        let contacts = Contacts { rows: &self.rows, tangents: &self.tangents, friction };
        self.coulomb.may_stick(&mut self.projection, push, contacts)
    }

    /// Friction coefficient from which on a push is balanced, if it is at most `most`.
    fn holds_from(&mut self, push: &Vector, most: f64, to: f64) -> Option<f64> {
        self.holds(push, most).then(|| {
            let [mut slips, mut holds] = [0.0, most];
            while holds - slips > to {
                let middle = f64::midpoint(slips, holds);
                if self.holds(push, middle) { holds = middle } else { slips = middle }
            }
            holds
        })
    }

    /// From which friction on it wedges.
    pub(super) fn wedges_from(&mut self) -> Option<f64> {
        self.holds_from(&OUT, MOST, WAY_HOLDS_TO)
    }

    /// Slip at a friction coefficient, starting from a slip at a smaller one; `None` if the half sticks.
    fn slip(&mut self, friction: f64, from: Option<Vector>) -> Option<Vector> {
        let contacts = Contacts { rows: &self.rows, tangents: &self.tangents, friction };
        self.coulomb.begin_at(from);
        let touching = |_| 0.0;
        let u = self.coulomb.displacement(&mut self.projection, &self.push, contacts, touching, 1.0);
        u.filter(|u| !is_still(u))
    }

    pub(super) fn thresholds(&mut self) -> Sticking {
        self.coulomb = Coulomb::patient();
        let push = self.push;
        let holds_from = self.holds_from(&push, MOST, HOLDS_TO);
        // Where no force holds the half, it slips.
        let slips_until = holds_from.and_then(|holds| Some(self.slips_until(holds)?.max(holds)));
        Sticking { holds_from, slips_until, wedges_from: self.wedges_from() }
    }

    /// Friction coefficient at which the speed of the slip becomes zero, with `holds` that from which on forces can hold:
    /// by secants, because iterations close to it are slow.
    fn slips_until(&mut self, holds: f64) -> Option<f64> {
        let mut way = None;
        let mut known: Option<[f64; 2]> = None;
        let mut friction = FIRST * holds;
        loop {
            let Some(result) = self.slip(friction, way) else { return Some(friction) };
            let speed = result.iter().map(|x| x * x).sum::<f64>().sqrt();
            let ends = match known {
                None => SECOND * holds,
                Some([before, faster]) if faster > speed => {
                    let ends = friction + speed * (friction - before) / (faster - speed);
                    if ends - friction <= NEAR * ends {
                        return Some(ends);
                    }
                    friction + SHARE * (ends - friction)
                }
                // More friction lets it slip faster.
                Some(_) => friction / FIRST,
            };
            if ends > MOST {
                return None;
            }
            (known, way, friction) = (Some([friction, speed]), Some(result), ends);
        }
    }
}

/// Whether a motion passes a place at which it slips and could as well stick, and the contacts at the last
/// place.
#[derive(Debug, Default)]
pub(super) struct AmbiguityObserver {
    touching: Touching,
    /// Whether it may stick at the last place: ignored if that is its end.
    here: bool,
    may_stick: bool,
}

impl AmbiguityObserver {
    /// The open cases of a motion with this outcome.
    pub(super) fn doubt(mut self, outcome: Outcome, friction: f64) -> FrictionAmbiguity {
        let jams = outcome == Outcome::Jammed && !self.touching.rows.is_empty();
        FrictionAmbiguity { may_stick: self.may_stick, wedges: jams && self.touching.holds(&OUT, friction) }
    }
}

impl MotionObserver for AmbiguityObserver {
    fn see(&mut self, motion: &Motion, state: &State, _: f64) -> Option<Outcome> {
        self.may_stick |= self.here;
        self.touching.see_on_the_way(motion, state);
        if !self.may_stick {
            let push = self.touching.push;
            self.here =
                !self.touching.rows.is_empty() && self.touching.holds(&push, motion.settings.friction);
        }
        None
    }
}

/// The least friction at which some force would hold it somewhere on the way, the end left out.
#[derive(Debug)]
pub(super) struct HoldingFrictionObserver {
    touching: Touching,
    /// At the place that was seen last.
    here: f64,
    least: f64,
}

/// Accuracy of the wedging threshold and of thresholds along a motion, a friction coefficient: less accurate,
/// as it is computed at every step.
const WAY_HOLDS_TO: f64 = 1e-4;

impl HoldingFrictionObserver {
    pub(super) fn up_to(most: f64) -> Self {
        Self { touching: Touching::default(), here: most, least: most }
    }

    pub(super) const fn least(&self) -> f64 {
        self.least
    }
}

impl MotionObserver for HoldingFrictionObserver {
    fn see(&mut self, motion: &Motion, state: &State, _: f64) -> Option<Outcome> {
        self.least = self.least.min(self.here);
        self.touching.see_on_the_way(motion, state);
        let push = self.touching.push;
        let holds = (!self.touching.rows.is_empty())
            .then(|| self.touching.holds_from(&push, self.least, WAY_HOLDS_TO));
        self.here = holds.flatten().unwrap_or(self.least);
        None
    }
}
