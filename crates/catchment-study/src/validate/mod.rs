//! Verdicts on a prediction: what a robot saw at the poses of a plan, beside what exact motions say of them.
//!
//! ```text
//!                      observed                     how far each disagreement is from the predicted border,
//!   predicted     docks     fails                   in units of the robot's accuracy
//!     docks        96         0      ──▶            ─────────┬─────────┬──────────────────▶
//!     fails         1        53                        either │ noise   │ beyond k: counts
//!                                                      0      1         k
//!   verdict       consistent     none beyond k, or no more than the robot's own errors explain
//!                 inconsistent   more, farther, or more on one side: by chance less than once in twenty
//!                 undecided      too few trials are beyond k to decide anything
//! ```
//!
//! A trial m accuracies from the border fares otherwise by the robot's error alone with a chance of at most 2·Φ(−m), a flat border on both sides
//! of it. Four numbers are held against that: how many trials beyond k disagree, how far the farthest of them is, how many trials failed where docking
//! was predicted (`early`), and how many docked where it was not (`late`). The smallest of the four chances, times four, is that of the verdict. Trials
//! that may go either way count in none of them.
//!
//! Failures where docking was predicted are *systematic* where the robot's errors do not explain them: friction makes them, and a border
//! that is predicted too far out. `early` tests that one side alone.
//!
//! Not promised: that a consistent prediction is right where nothing was tried. Distances are at most so much ([`crate::plan`]); trials
//! count as independent. Lengths in D, angles in radians.

mod friction;
mod lines;
mod statistics;
#[cfg(test)]
mod tests;

use crate::plan::{Foretold, PlanError, check_accuracy, foretell};
use catchment_core::exec::{Cancelled, Exec};
use catchment_core::method::descent::{self, FrictionOutOfRange};
use catchment_core::pose::PoseError;
use catchment_core::poses::{Observed, Tried};
use catchment_core::problem::Problem;
pub use friction::FrictionFound;
pub use lines::Line;
use serde::{Deserialize, Serialize};
pub use statistics::clopper_pearson;
use statistics::{chance, tail};

/// What changes the answer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// Standard deviation of each error of the robot, in D and radians; 0 for those that are exact.
    pub accuracy: PoseError,
    /// k: disagreements nearer to the border than so many accuracies do not count.
    pub limit: f64,
    /// Coefficient of friction of the prediction.
    pub friction: f64,
    /// Whether to look for the friction that explains the trials.
    pub estimate_friction: bool,
    /// Seed of the search for the border.
    pub seed: u64,
}

impl Settings {
    /// Of a robot of this accuracy, without friction.
    pub const fn new(accuracy: PoseError) -> Self {
        Self { accuracy, limit: LIMIT, friction: 0.0, estimate_friction: false, seed: 1 }
    }
}

/// k where nothing is said.
pub const LIMIT: f64 = 2.0;
/// Trials beyond the limit that a verdict takes.
pub const FEWEST: usize = 5;
/// Chance that is allowed of a wrong verdict.
pub const LEVEL: f64 = 0.05;

/// What becomes of a prediction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// The trials say nothing against it.
    Consistent,
    /// They do.
    Inconsistent,
    /// They cannot.
    Undecided,
}

impl Verdict {
    /// As it is written.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Consistent => "consistent",
            Self::Inconsistent => "inconsistent",
            Self::Undecided => "undecided",
        }
    }
}

/// A trial and what exact motions say of its pose.
#[derive(Debug, Clone, PartialEq)]
pub struct Judged {
    /// What was tried.
    pub tried: Tried,
    /// What was to be expected.
    pub foretold: Foretold,
    /// Whether it docked, turned by a symmetry of the design or not; nothing where it was not made.
    pub seen: Option<bool>,
}

impl Judged {
    /// Whether the outcome contradicts the prediction. Never where the prediction was undecided, the trial was not made, or the
    /// pose lies within one accuracy of the border: there the robot's own error decides.
    pub fn disagrees(&self) -> bool {
        self.foretold.predicted.is_some()
            && !self.foretold.is_either()
            && self.seen.is_some_and(|seen| seen != self.foretold.docks())
    }
}

/// How many trials were predicted and seen how.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Count {
    /// What was predicted; nothing where that was undecided.
    pub predicted: Option<Observed>,
    /// What was seen.
    pub observed: Observed,
    /// Whether the poses are nearer to the border than the accuracy.
    pub either: bool,
    /// How many.
    pub trials: usize,
}

/// How often trials fared as predicted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Agreement {
    /// Trials at least one accuracy from the border that were made.
    pub trials: usize,
    /// Of them, as predicted.
    pub agreed: usize,
    /// Their share with Clopper and Pearson's 95 % interval.
    pub ci95: [f64; 2],
}

/// Disagreements on one side of the border.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OneSided {
    /// How many.
    pub disagreeing: usize,
    /// Of so many trials on that side, one accuracy from the border or more.
    pub trials: usize,
    /// As many are expected at most of the robot's errors alone.
    pub expected: f64,
    /// The chance of so many or more by its errors alone: one-sided.
    pub p_value: f64,
}

/// What the trials say.
#[derive(Debug, Clone, PartialEq)]
pub struct Validation {
    /// How it was asked for.
    pub settings: Settings,
    /// The verdict.
    pub verdict: Verdict,
    /// The trials in the order of the table.
    pub trials: Vec<Judged>,
    /// Predicted and observed.
    pub counts: Vec<Count>,
    /// Trials that were not made.
    pub blank: usize,
    /// How often they agree.
    pub agreement: Agreement,
    /// Trials beyond the limit, of poses predicted to dock and predicted to fail.
    pub deciding: [usize; 2],
    /// Of them, otherwise than predicted.
    pub beyond: usize,
    /// The chance that the robot's errors make so many, so far ones, or so many on one side; 1 where there are none.
    pub p_value: f64,
    /// Failures where docking was predicted.
    pub early: OneSided,
    /// Docked where it was not.
    pub late: OneSided,
    /// Where the border was seen.
    pub lines: Vec<Line>,
    /// Which friction explains the trials, if asked for.
    pub friction: Option<FrictionFound>,
    /// Trials of which the table says that something else was predicted: another design, or other friction.
    pub otherwise_planned: usize,
    /// Trials that docked turned where docking straight was predicted, or the other way about.
    pub turned: usize,
    /// Motions that were followed.
    pub motions: usize,
}

/// Why there is no verdict.
#[derive(Debug, thiserror::Error)]
pub enum ValidateError {
    /// No accuracy, or one that is none.
    #[error(transparent)]
    Accuracy(PlanError),
    /// A limit that is none.
    #[error("a limit of {limit} accuracies says nothing: 1 or more, such as {LIMIT}")]
    Limit {
        /// What was given.
        limit: f64,
    },
    /// No coefficient of friction.
    #[error(transparent)]
    Friction(#[from] FrictionOutOfRange),
    /// Nothing was tried.
    #[error("no trial has an outcome: write what was seen into the table")]
    NothingMade,
    /// It was asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Shares of the time that the prediction and friction take.
const PREDICTION: f64 = 0.3;
const STAGE: &str = "motions";

/// Judges a prediction by trials.
///
/// # Errors
/// See [`ValidateError`].
pub fn run(
    problem: &Problem,
    tried: &[Tried],
    settings: &Settings,
    exec: &Exec,
) -> Result<Validation, ValidateError> {
    check_accuracy(problem, &settings.accuracy).map_err(ValidateError::Accuracy)?;
    if !(settings.limit.is_finite() && settings.limit >= 1.0) {
        return Err(ValidateError::Limit { limit: settings.limit });
    }
    let motions = descent::Settings::with_friction(settings.friction)?;
    if tried.iter().all(|trial| trial.observed.is_none()) {
        return Err(ValidateError::NothingMade);
    }
    let turns = problem.alignment().symmetry > 1;
    let docked = |observed: Observed| match observed {
        Observed::Aligned => true,
        Observed::AlignedElsewhere => turns,
        Observed::Jammed | Observed::Missed => false,
    };
    // A pose that is tried several times is followed once.
    let mut poses: Vec<PoseError> = Vec::new();
    let mut which: std::collections::BTreeMap<[u64; 5], usize> = std::collections::BTreeMap::new();
    let mut number = Vec::with_capacity(tried.len());
    for trial in tried {
        let key = trial.error.to_array().map(f64::to_bits);
        number.push(*which.entry(key).or_insert_with(|| {
            poses.push(trial.error);
            poses.len() - 1
        }));
    }
    let share = if settings.estimate_friction { PREDICTION } else { 1.0 };
    let part = exec.part([0.0, share], STAGE);
    let (foretold, mut followed) =
        foretell(problem, &settings.accuracy, &motions, &poses, settings.seed, &part)?;
    let judged = |(trial, number): (&Tried, &usize)| Judged {
        tried: trial.clone(),
        foretold: foretold[*number],
        seen: trial.observed.map(docked),
    };
    let trials: Vec<Judged> = tried.iter().zip(&number).map(judged).collect();
    let friction = if settings.estimate_friction {
        let made: Vec<(Tried, bool)> =
            trials.iter().filter_map(|trial| Some((trial.tried.clone(), trial.seen?))).collect();
        let (found, more) = friction::estimate(problem, &made, settings, &exec.part([share, 1.0], STAGE))?;
        followed += more;
        Some(found)
    } else {
        None
    };
    Ok(Validation { friction, motions: followed, ..told(problem, trials, settings) })
}

/// Everything that follows from the trials without another motion.
fn told(problem: &Problem, trials: Vec<Judged>, settings: &Settings) -> Validation {
    let made = || trials.iter().filter(|trial| trial.seen.is_some());
    let clear = || made().filter(|trial| !trial.foretold.is_either());
    let agreed = clear().filter(|trial| !trial.disagrees()).count();
    let agreement =
        Agreement { trials: clear().count(), agreed, ci95: clopper_pearson(agreed, clear().count(), LEVEL) };
    let beyond_limit = || made().filter(|trial| trial.foretold.margin() >= settings.limit);
    let docking = beyond_limit().filter(|trial| trial.foretold.docks()).count();
    let deciding = [docking, beyond_limit().count() - docking];
    let beyond: Vec<f64> =
        beyond_limit().filter(|trial| trial.disagrees()).map(|trial| trial.foretold.margin()).collect();
    let chances = |least: f64| -> Vec<f64> {
        let margins = made().map(|trial| trial.foretold.margin());
        margins.filter(|margin| *margin >= least).map(chance).collect()
    };
    let [early, late] = [true, false].map(|docks| one_sided(&trials, docks));
    let farthest = beyond.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let of_number = tail(&chances(settings.limit), beyond.len());
    let of_farthest = if beyond.is_empty() { 1.0 } else { tail(&chances(farthest), 1) };
    let all = [of_number, of_farthest, early.p_value, late.p_value];
    // As many tests, each at a share of the level.
    let p_value = (all.len() as f64 * all.into_iter().fold(1.0, f64::min)).min(1.0);
    let verdict = if p_value < LEVEL {
        Verdict::Inconsistent
    } else if deciding[0] + deciding[1] < FEWEST {
        Verdict::Undecided
    } else {
        Verdict::Consistent
    };
    let straight = |observed: Option<Observed>| observed == Some(Observed::Aligned);
    let turned = made().filter(|trial| {
        let both = trial.seen == Some(true) && trial.foretold.docks();
        both && straight(trial.tried.observed) != straight(trial.foretold.predicted)
    });
    let otherwise = trials.iter().filter(|trial| {
        let docks = |observed| matches!(observed, Observed::Aligned | Observed::AlignedElsewhere);
        let said = trial.tried.predicted.map(docks);
        // On the border itself rounding decides.
        said.is_some_and(|said| said != trial.foretold.docks()) && !trial.foretold.is_either()
    });
    Validation {
        settings: settings.clone(),
        verdict,
        counts: counts(&trials),
        blank: trials.len() - made().count(),
        agreement,
        deciding,
        beyond: beyond.len(),
        p_value,
        early,
        late,
        lines: lines::lines(problem, &trials),
        friction: None,
        otherwise_planned: otherwise.count(),
        turned: turned.count(),
        motions: 0,
        trials,
    }
}

/// Disagreements of the trials that should dock, or of those that should not.
fn one_sided(trials: &[Judged], docks: bool) -> OneSided {
    let clear = |trial: &&Judged| {
        trial.seen.is_some() && trial.foretold.docks() == docks && !trial.foretold.is_either()
    };
    let side: Vec<&Judged> = trials.iter().filter(clear).collect();
    let chances: Vec<f64> = side.iter().map(|trial| chance(trial.foretold.margin())).collect();
    let disagreeing = side.iter().filter(|trial| trial.disagrees()).count();
    OneSided {
        disagreeing,
        trials: side.len(),
        expected: chances.iter().sum(),
        p_value: tail(&chances, disagreeing),
    }
}

/// The confusion matrix as a list of what occurs: clear poses first, in the order of the outcomes.
fn counts(trials: &[Judged]) -> Vec<Count> {
    let mut counts: Vec<Count> = Vec::new();
    let predictions: Vec<Option<Observed>> =
        Observed::ALL.into_iter().map(Some).chain(std::iter::once(None)).collect();
    for either in [false, true] {
        for predicted in &predictions {
            for observed in Observed::ALL {
                let same = |trial: &&Judged| {
                    trial.foretold.is_either() == either
                        && trial.foretold.predicted == *predicted
                        && trial.tried.observed == Some(observed)
                };
                let number = trials.iter().filter(same).count();
                if number > 0 {
                    counts.push(Count { predicted: *predicted, observed, either, trials: number });
                }
            }
        }
    }
    counts
}

impl Validation {
    /// A verdict on nothing: what requirements are tried on.
    pub fn form(problem: &Problem, settings: &Settings) -> Self {
        let friction =
            FrictionFound { fewest: 0, interval: [0.0; 2], open: false, broken: false, tried: Vec::new() };
        Self {
            friction: settings.estimate_friction.then_some(friction),
            ..told(problem, Vec::new(), settings)
        }
    }
}
