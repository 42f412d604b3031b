//! Verdicts on a prediction: the trials of a robot at the poses of a plan, compared with exact motions.
//!
//! ```text
//!                      observed                     distance of each disagreement from the predicted border,
//!   predicted     docks     fails                   in units of the robot's accuracy
//!     docks        96         0      ──▶            ─────────┬─────────┬──────────────────▶
//!     fails         1        53                        either │ noise   │ beyond k: counts
//!                                                      0      1         k
//!   verdict       consistent     none beyond k, or no more than the robot's own errors explain
//!                 inconsistent   more, farther, or more on one side: probability by chance below 5 %
//!                 undecided      too few trials beyond k for a decision
//! ```
//!
//! The robot's error alone changes the outcome of a trial m standard deviations from the border with a
//! probability of at most 2·Φ(−m), for a flat border on both sides of it. Four numbers are tested against
//! this: the number of disagreements beyond k, the distance of the farthest of them, the number of failures
//! at poses with a predicted success (`early`), and the number of successes at poses with a predicted failure
//! (`late`). The smallest of the four p-values, times four, is that of the verdict. Trials that may have
//! either outcome are excluded.
//!
//! Failures at poses with a predicted success are *systematic* if the robot's errors do not explain them:
//! friction causes them, and so does a border that is predicted too far out. `early` tests that side alone.
//!
//! Not promised: that a consistent prediction is correct at untested poses. Distances are upper bounds
//! ([`crate::plan`]); trials count as independent. Lengths in D, angles in radians.

mod friction;
mod lines;
mod report;
mod statistics;
#[cfg(test)]
mod tests;

use crate::plan::{PlannedPose, Prediction, TrialPlanError, check_accuracy, foretell};
use catchment_core::exec::{Cancelled, Exec};
use catchment_core::method::descent::{self, FrictionOutOfRange};
use catchment_core::pose::PoseError;
use catchment_core::poses::{ObservedOutcome, OffsetsAt, RobotTrial};
use catchment_core::problem::Problem;
pub use friction::{FrictionInterval, FrictionTried};
pub use lines::TrialLine;
use serde::{Deserialize, Serialize};
pub use statistics::clopper_pearson;
use statistics::{chance, tail};

/// Settings that change the result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ValidationSettings {
    /// Standard deviation of each error of the robot, in D and radians; 0 for exact errors.
    pub accuracy: PoseError,
    /// k: disagreements within k standard deviations of the border do not count.
    pub limit: f64,
    /// Coefficient of friction of the prediction.
    pub friction: f64,
    /// Whether to estimate the friction that explains the trials.
    pub estimate_friction: bool,
    /// Seed of the search for the border.
    pub seed: u64,
}

impl ValidationSettings {
    /// Of a robot of this accuracy, without friction.
    pub const fn new(accuracy: PoseError) -> Self {
        Self { accuracy, limit: LIMIT, friction: 0.0, estimate_friction: false, seed: 1 }
    }
}

/// Default of k.
pub const LIMIT: f64 = 2.0;
/// Trials beyond the limit that a verdict takes.
pub const FEWEST: usize = 5;
/// Chance that is allowed of a wrong verdict.
pub const LEVEL: f64 = 0.05;

/// Verdict on a prediction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum PredictionVerdict {
    /// The trials do not contradict the prediction.
    Consistent,
    /// The trials contradict the prediction.
    Inconsistent,
    /// The trials are not sufficient for a verdict.
    Undecided,
}

impl PredictionVerdict {
    /// As it is written.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Consistent => "consistent",
            Self::Inconsistent => "inconsistent",
            Self::Undecided => "undecided",
        }
    }
}

/// A trial with the prediction of its pose.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PredictedTrial {
    /// The number of the trial.
    pub trial: u64,
    /// The observed outcome; null if the trial was not made.
    pub observed: Option<ObservedOutcome>,
    /// Whether the outcome contradicts the prediction. False if the prediction is undecided, the trial was
    /// not made, or the pose lies within one standard deviation of the border: there the error of the robot
    /// decides.
    pub disagrees: bool,
    /// Its pose and the prediction.
    #[serde(flatten)]
    pub point: PlannedPose,
    /// Whether the half docked, rotated by a symmetry of the design or not; null if the trial was not made.
    #[serde(skip)]
    pub docked: Option<bool>,
    /// The prediction in the table.
    #[serde(skip)]
    planned: Option<ObservedOutcome>,
}

impl PredictedTrial {
    /// Of a trial, the prediction of its pose, and whether it docked.
    fn new(tried: &RobotTrial, prediction: Prediction, docked: Option<bool>) -> Self {
        Self {
            trial: tried.trial,
            observed: tried.observed,
            disagrees: prediction.predicted.is_some()
                && !prediction.either
                && docked.is_some_and(|docked| docked != prediction.docks()),
            point: PlannedPose { error: tried.error, line: tried.line as usize, prediction },
            docked,
            planned: tried.predicted,
        }
    }

    /// The prediction of its pose.
    pub const fn prediction(&self) -> &Prediction {
        &self.point.prediction
    }
}

/// The number of trials with the same predicted and the same observed outcome.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Count {
    /// The predicted outcome; null if it was undecided.
    pub predicted: Option<ObservedOutcome>,
    /// The observed outcome.
    pub observed: ObservedOutcome,
    /// Whether the poses are closer to the border than one standard deviation of the robot.
    pub either: bool,
    /// Number of trials.
    pub trials: usize,
}

/// Agreement of the trials with the prediction.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TrialAgreement {
    /// Number of trials at least one standard deviation from the border.
    pub trials: usize,
    /// Number of these that agree with the prediction.
    pub agreed: usize,
    /// Their share, in [0, 1]; null without trials.
    pub share: Option<f64>,
    /// The 95 % confidence interval of the share (Clopper and Pearson).
    pub ci95: [f64; 2],
}

/// Disagreements on one side of the border.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct OneSided {
    /// Number of trials that disagree.
    pub disagreeing: usize,
    /// Number of trials on that side, at least one standard deviation from the border.
    pub trials: usize,
    /// Largest expected number of disagreements that the errors of the robot alone cause.
    pub expected: f64,
    /// Probability that these errors cause this many or more disagreements: one-sided, in [0, 1].
    pub p_value: f64,
}

/// Evidence for a verdict.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Evidence {
    /// Number of trials beyond the limit at poses with a predicted success.
    pub inside: usize,
    /// Number of trials beyond the limit at all other poses.
    pub outside: usize,
    /// Number of both that disagree with the prediction.
    pub beyond: usize,
    /// Probability that the errors of the robot cause this many disagreements, disagreements this far from
    /// the border, or this many on one side; 1 without disagreements.
    pub p_value: f64,
}

/// Comparison of a prediction with the trials of a robot.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Validation {
    /// The settings.
    pub settings: ValidationSettings,
    /// The point of the moving half at which the table gave x and y; the offsets of this report are those of the face centre.
    pub offsets_at: OffsetsAt,
    /// The verdict.
    pub verdict: PredictionVerdict,
    /// The verdict as a number for requirements: 1 consistent, 0 undecided, −1 inconsistent.
    pub consistent: i8,
    /// Evidence for the verdict.
    pub evidence: Evidence,
    /// Trials by their predicted and observed outcome.
    pub counts: Vec<Count>,
    /// Agreement of the trials with the prediction, without trials closer to the border than one standard
    /// deviation of the robot.
    pub agreement: TrialAgreement,
    /// Failures at poses with a predicted success.
    pub early: OneSided,
    /// Successes at poses with a predicted failure.
    pub late: OneSided,
    /// Every trial that disagrees with the prediction, the farthest from the border first.
    pub disagreements: Vec<PredictedTrial>,
    /// The observed border, line by line.
    pub lines: Vec<TrialLine>,
    /// The coefficients of friction that explain the trials; null unless the settings estimate them.
    pub friction: Option<FrictionInterval>,
    /// Every trial in the order of the table.
    pub trials: Vec<PredictedTrial>,
    /// Number of trials that were not made.
    pub blank: usize,
    /// Number of exact motions.
    pub motions: usize,
    /// Number of trials for which the table states another prediction: it belongs to another design, or
    /// another friction.
    #[serde(skip)]
    pub differing_predictions: usize,
    /// Number of trials that docked rotated although docking unrotated was predicted, or the reverse.
    #[serde(skip)]
    pub turned: usize,
}

/// Why there is no verdict.
#[derive(Debug, thiserror::Error)]
pub enum ValidateError {
    /// A missing or invalid accuracy.
    #[error(transparent)]
    Accuracy(TrialPlanError),
    /// An invalid limit.
    #[error("a limit of {limit} accuracies says nothing: 1 or more, such as {LIMIT}")]
    Limit {
        /// The given value.
        limit: f64,
    },
    /// No coefficient of friction.
    #[error(transparent)]
    Friction(#[from] FrictionOutOfRange),
    /// Nothing was tried.
    #[error("no trial has an outcome: write what was seen into the table")]
    NothingMade,
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Shares of the time that the prediction and friction take.
const PREDICTION: f64 = 0.3;
const STAGE: &str = "motions";

/// Evaluates a prediction by trials.
///
/// # Errors
/// See [`ValidateError`].
pub fn run(
    problem: &Problem,
    tried: &[RobotTrial],
    settings: &ValidationSettings,
    exec: &Exec,
) -> Result<Validation, ValidateError> {
    check_accuracy(problem, &settings.accuracy).map_err(ValidateError::Accuracy)?;
    if !(settings.limit.is_finite() && settings.limit >= 1.0) {
        return Err(ValidateError::Limit { limit: settings.limit });
    }
    let motions = descent::DescentSettings::with_friction(settings.friction)?;
    if tried.iter().all(|trial| trial.observed.is_none()) {
        return Err(ValidateError::NothingMade);
    }
    let turns = problem.alignment().symmetry > 1;
    let docks = |observed: ObservedOutcome| match observed {
        ObservedOutcome::Aligned => true,
        ObservedOutcome::AlignedElsewhere => turns,
        ObservedOutcome::Jammed | ObservedOutcome::Missed => false,
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
    let (prediction, mut followed) =
        foretell(problem, &settings.accuracy, &motions, &poses, settings.seed, &part)?;
    let judged = |(trial, number): (&RobotTrial, &usize)| {
        PredictedTrial::new(trial, prediction[*number], trial.observed.map(docks))
    };
    let trials: Vec<PredictedTrial> = tried.iter().zip(&number).map(judged).collect();
    let friction = if settings.estimate_friction {
        let made: Vec<(PoseError, bool)> =
            trials.iter().filter_map(|trial| Some((trial.point.error, trial.docked?))).collect();
        let (result, more) = friction::estimate(problem, &made, settings, &exec.part([share, 1.0], STAGE))?;
        followed += more;
        Some(result)
    } else {
        None
    };
    Ok(Validation { friction, motions: followed, ..summary(problem, trials, settings) })
}

/// Everything that follows from the trials without another motion.
fn summary(problem: &Problem, trials: Vec<PredictedTrial>, settings: &ValidationSettings) -> Validation {
    let made = || trials.iter().filter(|trial| trial.docked.is_some());
    let clear = || made().filter(|trial| !trial.prediction().either);
    let agreed = clear().filter(|trial| !trial.disagrees).count();
    let all = clear().count();
    let agreement = TrialAgreement {
        trials: all,
        agreed,
        share: (all > 0).then(|| agreed as f64 / all as f64),
        ci95: clopper_pearson(agreed, all, LEVEL),
    };
    let beyond_limit = || made().filter(|trial| trial.prediction().margin() >= settings.limit);
    let inside = beyond_limit().filter(|trial| trial.prediction().docks()).count();
    let outside = beyond_limit().count() - inside;
    let beyond: Vec<f64> =
        beyond_limit().filter(|trial| trial.disagrees).map(|trial| trial.prediction().margin()).collect();
    let chances = |least: f64| -> Vec<f64> {
        let margins = made().map(|trial| trial.prediction().margin());
        margins.filter(|margin| *margin >= least).map(chance).collect()
    };
    let [early, late] = [true, false].map(|docks| one_sided(&trials, docks));
    let farthest = beyond.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let of_number = tail(&chances(settings.limit), beyond.len());
    let of_farthest = if beyond.is_empty() { 1.0 } else { tail(&chances(farthest), 1) };
    let all = [of_number, of_farthest, early.p_value, late.p_value];
    // As many tests, each at a share of the level.
    let p_value = (all.len() as f64 * all.into_iter().fold(1.0, f64::min)).min(1.0);
    let (verdict, consistent) = if p_value < LEVEL {
        (PredictionVerdict::Inconsistent, -1)
    } else if inside + outside < FEWEST {
        (PredictionVerdict::Undecided, 0)
    } else {
        (PredictionVerdict::Consistent, 1)
    };
    let straight = |outcome: Option<ObservedOutcome>| outcome == Some(ObservedOutcome::Aligned);
    let turned = made().filter(|trial| {
        let both = trial.docked == Some(true) && trial.prediction().docks();
        both && straight(trial.observed) != straight(trial.prediction().predicted)
    });
    let differing = trials.iter().filter(|trial| {
        let docks = |outcome| matches!(outcome, ObservedOutcome::Aligned | ObservedOutcome::AlignedElsewhere);
        let planned = trial.planned.map(docks);
        // On the border itself rounding decides.
        planned.is_some_and(|planned| planned != trial.prediction().docks()) && !trial.prediction().either
    });
    let mut disagreements: Vec<PredictedTrial> =
        trials.iter().copied().filter(|trial| trial.disagrees).collect();
    disagreements.sort_by(|a, b| b.prediction().margin().total_cmp(&a.prediction().margin()));
    Validation {
        settings: settings.clone(),
        offsets_at: OffsetsAt::Face,
        verdict,
        consistent,
        evidence: Evidence { inside, outside, beyond: beyond.len(), p_value },
        counts: counts(&trials),
        agreement,
        early,
        late,
        disagreements,
        lines: lines::lines(problem, &trials),
        friction: None,
        blank: trials.len() - made().count(),
        motions: 0,
        differing_predictions: differing.count(),
        turned: turned.count(),
        trials,
    }
}

/// Disagreements of the trials that should dock, or of those that should not.
fn one_sided(trials: &[PredictedTrial], docks: bool) -> OneSided {
    let clear = |trial: &&PredictedTrial| {
        let prediction = trial.prediction();
        trial.docked.is_some() && prediction.docks() == docks && !prediction.either
    };
    let side: Vec<&PredictedTrial> = trials.iter().filter(clear).collect();
    let chances: Vec<f64> = side.iter().map(|trial| chance(trial.prediction().margin())).collect();
    let disagreeing = side.iter().filter(|trial| trial.disagrees).count();
    OneSided {
        disagreeing,
        trials: side.len(),
        expected: chances.iter().sum(),
        p_value: tail(&chances, disagreeing),
    }
}

/// The confusion matrix as a list of its nonzero entries: clear poses first, in the order of the outcomes.
fn counts(trials: &[PredictedTrial]) -> Vec<Count> {
    let mut counts: Vec<Count> = Vec::new();
    let predictions: Vec<Option<ObservedOutcome>> =
        ObservedOutcome::ALL.into_iter().map(Some).chain(std::iter::once(None)).collect();
    for either in [false, true] {
        for predicted in &predictions {
            for observed in ObservedOutcome::ALL {
                let same = |trial: &&PredictedTrial| {
                    let prediction = trial.prediction();
                    prediction.either == either
                        && prediction.predicted == *predicted
                        && trial.observed == Some(observed)
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
