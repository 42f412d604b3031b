//! Docking probability under dynamics: speed, drift, spin, mass, friction, bounce and height of each trial
//! are sampled from declared distributions.
//!
//! ```text
//!   [dynamics]            one trial                                   questions
//!   speed 50 ± 10 mm/s    draw ──▶ settings ──▶ engine ──▶ aligned?   poses: aligned share of N trials, Wilson's interval
//!   friction 0.1..0.3                                                 cells over two errors: a map of this share
//!                                                                     expected errors: P by double sampling,
//!                                                                     most trials near the quasi-static border
//!                                                                     speed: P with every velocity times t, t → 0: quasi-static
//! ```
//!
//! **Drive.** With *held* speed the half is released at its approach speed v, and pushed with the force that
//! damping balances at v: F = m·γ·v. When contact stops it, it loses its momentum within a time of about γ⁻¹:
//! it coasts λ = v/γ, and speed enters the geometry only through λ/D. As v → 0 inertial forces vanish
//! compared with damping, and the motion converges to that of [`descent`](catchment_core::method::descent),
//! whose metric is that of damping. Time is scaled so that the half approaches at the engine's own pace:
//! trials of any speed take equally many steps. With a *given* push (a force, or gravity) nothing is scaled,
//! and t → 0 is a half released at rest: not a quasi-static motion.
//!
//! A distribution of the **mass** changes inertia and weight; the damping by the surroundings stays that of
//! the mean mass, so that a heavy half coasts farther.
//!
//! Draw k of pose e is a function only of the seed, e and k: threads, the order of poses and other requests
//! change no bit. Curves use the same draws at every speed.
//!
//! Not promised: that the distributions are true, or independent of each other as assumed. Undecided trials
//! count as failures and widen intervals upwards. The shares include the engine's own errors. Units: D, s,
//! kg, radians. The study follows the outlook of the dissertation, section 7.2.

mod pose_trials;
mod report;
mod results;
mod spread;
#[cfg(test)]
mod tests;
mod trial;

use catchment_core::exec::Cancelled;
use catchment_core::landscape::GridAxis;
use catchment_core::method::DecideError;
use catchment_core::method::descent::FrictionOutOfRange;
use catchment_core::method::drop;
use catchment_core::pose::{Dof, PoseError};
use catchment_core::poses::{Circumstance, Dynamics, Spread};
use catchment_core::problem::Problem;
pub use pose_trials::run;
pub use report::unit_of;
pub use results::{
    AtSpeed, ByOutcome, Chance, ChanceMap, DeclaredCircumstance, Overall, PoseChance, PresetOpen,
    majority_of_three,
};
use serde::{Deserialize, Serialize};

/// Settings that change the result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct ChanceSettings {
    /// Constants of the drop test for all parameters without a distribution; its trials and seed are ignored,
    /// and its push too if the speed is held.
    pub drop: drop::DropSettings,
    /// Distributions of the declared parameters.
    pub dynamics: Dynamics,
    /// Whether the push is the force that damping balances at the approach speed, instead of the push in
    /// `drop`.
    pub held: bool,
    /// Number of trials for each pose and each cell of a map.
    pub trials: usize,
    /// Number of trials for the probability under the expected errors, and for each speed of the curve.
    pub overall: usize,
    /// Seed of all draws.
    pub seed: u64,
}

/// Default decay rate of velocities, in 1/s: an arm under force control yields within a tenth of a second.
pub const DAMPING: f64 = 10.0;

impl Default for ChanceSettings {
    fn default() -> Self {
        let drop = drop::DropSettings {
            damping: DAMPING,
            angular_damping: DAMPING,
            ..drop::DropSettings::default()
        };
        Self { drop, dynamics: Dynamics::default(), held: true, trials: 100, overall: 1000, seed: 1 }
    }
}

impl ChanceSettings {
    /// Distance that a half with the mean speed coasts, in D; `None` without damping or speed.
    pub fn coasting(&self) -> Option<f64> {
        let speed = self.dynamics.mean(Circumstance::Speed).unwrap_or(self.drop.launch.speed);
        (speed > 0.0 && self.drop.damping > 0.0).then(|| speed / self.drop.damping)
    }
}

/// The requested results; all parts are optional.
#[derive(Debug, Clone, Default)]
pub struct Question {
    /// These poses, each by itself.
    pub poses: Vec<PoseError>,
    /// A map over one or two errors, with all others 0.
    pub map: Vec<GridAxis>,
    /// The errors that are expected.
    pub errors: Option<Spread>,
    /// All velocities times these, under the errors that are expected; above 0.
    pub times: Vec<f64>,
}

/// Why there is no chance.
#[derive(Debug, thiserror::Error)]
pub enum ChanceError {
    /// The question is empty.
    #[error("nothing to compute: name poses, errors to expect, or the axes of a map")]
    Nothing,
    /// A held speed of 0.
    #[error(
        "the approach speed may be 0: held speed needs one above 0; declare it, or give a push or gravity in its place"
    )]
    NoSpeed,
    /// Held speed without damping.
    #[error(
        "without damping no force holds a speed: give a damping above 0, or a push or gravity in the place of held speed"
    )]
    Undamped,
    /// A distribution of a locked parameter.
    #[error("{} is declared, and the design locks {}: it would not count; leave it out", of.name(), axis.name())]
    Locked {
        /// The parameter.
        of: Circumstance,
        /// The locked error.
        axis: Dof,
    },
    /// Errors that the design locks.
    #[error("{} does not vary in this design, which locks it", axis.name())]
    LockedError {
        /// The error.
        axis: Dof,
    },
    /// No error varies.
    #[error("none of the expected errors varies: ask about the pose itself")]
    Still,
    /// An invalid factor of speeds.
    #[error("speeds cannot be multiplied by {factor}: give a number above 0, and at most {MOST_FACTOR}")]
    Factor {
        /// The given value.
        factor: f64,
    },
    /// Too few trials.
    #[error("{trials} trials of {what} are too few; {least} or more")]
    TooFew {
        /// How many.
        trials: usize,
        /// The counted item.
        what: &'static str,
        /// How many it takes.
        least: usize,
    },
    /// Too many trials.
    #[error(
        "{trials} trials in all, at some milliseconds each, are days: at most {MOST_TRIALS}; ask for fewer trials, poses, cells or speeds"
    )]
    TooMany {
        /// How many.
        trials: usize,
    },
    /// A setting that no trial can be made with, or a geometry that the engine does not take.
    #[error(transparent)]
    Drop(drop::DropError),
    /// No friction of exact motions.
    #[error(transparent)]
    Friction(#[from] FrictionOutOfRange),
    /// The guiding grid could not be decided.
    #[error(transparent)]
    Decide(#[from] DecideError),
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl From<drop::DropError> for ChanceError {
    fn from(error: drop::DropError) -> Self {
        match error {
            drop::DropError::Cancelled(error) => Self::Cancelled(error),
            error => Self::Drop(error),
        }
    }
}

/// Largest number of trials of a question: at 5 ms some fourteen hours on one core.
pub const MOST_TRIALS: usize = 10_000_000;
/// Largest factor of speeds.
const MOST_FACTOR: f64 = 1e3;
/// Fewest trials of a probability under errors: a few for each stratum.
const FEWEST_OVERALL: usize = 100;
/// Estimated seconds of a trial on one core: 3 ms between planar faces, 6 ms between pyramids, 15 ms between
/// saddles.
const TRIAL_SECONDS: f64 = 0.005;

/// A computation longer than this is announced, in seconds.
const LONG: f64 = 600.0;

impl Question {
    /// A map over two errors, so many cells along each, as far as the error box reaches.
    #[must_use]
    pub fn with_map(mut self, problem: &Problem, axes: [Dof; 2], cells: usize) -> Self {
        let alignment = problem.alignment();
        let axis = |dof| {
            let half = alignment.half_range(dof);
            GridAxis { dof, lo: -half, hi: half, cells }
        };
        self.map = axes.map(axis).to_vec();
        self
    }

    /// The same with errors uniform over the whole error box, if speeds or no particular results are
    /// requested, and no errors are given.
    #[must_use]
    pub fn or_box(mut self, problem: &Problem) -> Self {
        let nothing = self.poses.is_empty() && self.map.is_empty();
        if self.errors.is_none() && (nothing || !self.times.is_empty()) {
            let alignment = problem.alignment();
            let mut half_width = [0.0; 5];
            for dof in alignment.free.iter() {
                half_width[dof.index()] = alignment.half_range(dof);
            }
            let half_width = PoseError::from_array(half_width);
            self.errors = Some(Spread::Uniform { mean: PoseError::default(), half_width });
        }
        self
    }

    /// Trials in all.
    pub fn trials(&self, settings: &ChanceSettings) -> usize {
        let cells = self.map.iter().map(|axis| axis.cells).fold(1usize, usize::saturating_mul);
        let cells = if self.map.is_empty() { 0 } else { cells };
        let places = self.poses.len().saturating_add(cells);
        let curves = usize::from(self.errors.is_some()).saturating_mul(1 + self.times.len());
        places.saturating_mul(settings.trials).saturating_add(curves.saturating_mul(settings.overall))
    }

    /// That it takes long on so many threads, if it does.
    pub fn doubt(&self, settings: &ChanceSettings, threads: usize) -> Option<String> {
        let trials = self.trials(settings);
        let seconds = trials as f64 * TRIAL_SECONDS / threads.max(1) as f64;
        (seconds > LONG).then(|| {
            let took = if seconds < 3600.0 {
                format!("{:.0} minutes", seconds / 60.0)
            } else {
                format!("{:.1} hours", seconds / 3600.0)
            };
            format!("{trials} trials take about {took} between simple halves")
        })
    }
}
