//! Plans of bench tests: poses at which a robot should try a connector, so that the trials are decisive.
//!
//! ```text
//!   pattern  ──▶  poses  ──▶  exact outcome of each          ──▶  trials in random order, in blocks, repeated
//!   grid          x, yaw      and distance from the border
//!   lattice                   in units of the robot's accuracy:
//!   arc                       below 1 both outcomes are possible
//!   bracket
//! ```
//!
//! The accuracy is a standard deviation per error, for x and y at the face centre; errors without a standard
//! deviation are exact. The distance to the border is the distance to the nearest pose found with another
//! outcome (`border`): an *upper bound*.
//!
//! Not promised: friction, unless it is given; speed; that the robot can reach a pose. Lengths in D, angles
//! in radians.

mod border;
mod pattern;
mod prediction;
mod report;
mod robot;
mod slices;
#[cfg(test)]
mod tests;

pub use border::{Border, DockingOracle, Search};
use catchment_core::acceptance::Stream;
use catchment_core::exec::{Cancelled, Exec};
use catchment_core::method::descent::{self, FrictionOutOfRange};
use catchment_core::pose::{Dof, PoseError};
use catchment_core::poses::OffsetsAt;
use catchment_core::problem::Problem;
pub use pattern::Pattern;
use pattern::{Maker, Placed};
pub use prediction::Prediction;
pub(crate) use prediction::{for_each, foretell};
pub(crate) use robot::{PoseColumns, accuracy_words};
use serde::{Deserialize, Serialize};
pub use slices::{BenchSlice, CELLS, panels};

use crate::validate::LIMIT;

/// Settings that change the result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct TrialPlanSettings {
    /// Pattern of the trial poses.
    pub pattern: Pattern,
    /// Standard deviation of each error of the robot, in D and radians; 0 for exact errors.
    pub accuracy: PoseError,
    /// Whether only positive errors are tried, because the halves are assumed to be symmetric.
    pub symmetric: bool,
    /// Number of trials per pose.
    pub repeats: usize,
    /// Number of parts of the test, such as operators or days, with about equal numbers of trials.
    pub blocks: usize,
    /// Whether the trials are in random order instead of the order of the pattern.
    pub shuffled: bool,
    /// Whether each line ends with its first predicted failure.
    pub stop_at_first_failure: bool,
    /// Seed of the order, of random lines and of the search for the border.
    pub seed: u64,
    /// Coefficient of friction between the halves.
    pub friction: f64,
}

impl TrialPlanSettings {
    /// A pattern for a robot of this accuracy; everything tried once, in random order.
    pub const fn new(pattern: Pattern, accuracy: PoseError) -> Self {
        Self {
            pattern,
            accuracy,
            symmetric: false,
            repeats: 1,
            blocks: 1,
            shuffled: true,
            stop_at_first_failure: false,
            seed: 1,
            friction: 0.0,
        }
    }
}

/// Most trials of a plan: weeks of work for a robot.
pub const MOST_TRIALS: usize = 10_000;

/// A plan of trials.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TrialPlan {
    /// The settings.
    pub settings: TrialPlanSettings,
    /// The point of the moving half at which the table for the robot gives x and y; the offsets of this
    /// report are those of the face centre.
    pub offsets_at: OffsetsAt,
    /// Counts of trials, poses and lines.
    #[serde(rename = "plan")]
    pub counts: TrialPlanCounts,
    /// The poses, line by line.
    pub points: Vec<PlannedPose>,
    /// The trials in their order.
    pub trials: Vec<PlannedTrial>,
    /// Exact motions that were followed.
    pub motions: usize,
}

/// Counts of trials, poses and lines of a plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TrialPlanCounts {
    /// Trials.
    pub trials: usize,
    /// Poses.
    pub poses: usize,
    /// Lines.
    pub lines: usize,
    /// Poses that are predicted to dock.
    pub docking: usize,
    /// Number of all other poses.
    pub failing: usize,
    /// Poses closer to the border than the standard deviation of the robot: they may dock or fail.
    pub either: usize,
    /// Decisive poses: at least two standard deviations from the border.
    pub deciding: usize,
    /// Poses whose outcome changes with the signs of their errors, beyond the uncertainty of the robot; 0
    /// unless the plan has only positive errors.
    pub asymmetric: usize,
    /// Directions without a failure inside the error box; 0 unless the pattern is a bracket.
    pub open: usize,
}

/// A pose of a plan.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PlannedPose {
    /// Pose error, in D and radians.
    pub error: PoseError,
    /// Number of its line, from 1; 0 without a line.
    pub line: usize,
    /// Its prediction by exact motion.
    #[serde(flatten)]
    pub prediction: Prediction,
}

/// A trial of a plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PlannedTrial {
    /// Its number from 1, in the order in which trials are made.
    #[serde(rename = "trial")]
    pub number: usize,
    /// Number of its part of the test, from 1.
    pub block: usize,
    /// Number of trials of this pose so far, including this one.
    pub repeat: usize,
    /// Index of its pose in `points`, from 0.
    pub point: usize,
}

/// Why there is no plan.
#[derive(Debug, thiserror::Error)]
pub enum TrialPlanError {
    /// No accuracy.
    #[error("no error has an accuracy: say how exactly the robot moves along one of them at least")]
    NoAccuracy,
    /// A number that is no accuracy.
    #[error("{}: {value} is no accuracy: finite, 0 or more, of an error that the design leaves free", axis.name())]
    Accuracy {
        /// Which error.
        axis: Dof,
        /// The given value.
        value: f64,
    },
    /// No coefficient of friction.
    #[error(transparent)]
    Friction(#[from] FrictionOutOfRange),
    /// No pose at all.
    #[error("the pattern has no pose: give steps to one error at least")]
    Nothing,
    /// A plan without repeats or blocks.
    #[error("0 {what}: 1 or more")]
    None {
        /// The counted item.
        what: &'static str,
    },
    /// Too many trials.
    #[error("more than {most} trials; take larger steps, or fewer errors")]
    TooMany {
        /// As many may be.
        most: usize,
    },
    /// Too few trials.
    #[error("{trials} trials do not bracket a border: {fewest} or more, two on every line and two controls")]
    TooFew {
        /// The given value.
        trials: usize,
        /// The required minimum.
        fewest: usize,
    },
    /// An invalid lever.
    #[error("a lever of {lever} D turns nothing: it goes from the joint to the face centre, above 0")]
    Lever {
        /// The given value.
        lever: f64,
    },
    /// The arc rotates a locked error.
    #[error("{}: the arc turns it, but the design locks it", axis.name())]
    Locked {
        /// Which error.
        axis: Dof,
    },
    /// The arc moves a locked offset.
    #[error(
        "{}: the design locks it at its centre of rotation ({cor} D in front of the face centre), which a joint {lever} D behind the face centre \
         moves; free {0}, or put the centre of rotation at −{lever} D", axis.name()
    )]
    JointElsewhere {
        /// Which error.
        axis: Dof,
        /// From the joint to the face centre, in D.
        lever: f64,
        /// Centre of rotation of the design, in D.
        cor: f64,
    },
    /// Not even zero docks.
    #[error("the mated pose itself does not dock: there is no border around it")]
    NotDocked,
    /// There is no border to bracket.
    #[error("nothing fails within the error box along any line: enlarge [errors] of the design")]
    NoBorder,
    /// No point of a lattice is near the border.
    #[error(
        "no point of the lattice is within a step of the border: take a larger step, or enlarge [errors] of the design"
    )]
    FarFromBorder,
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Parts of the time that the pattern and the poses take.
const PARTS: [f64; 4] = [0.0, 0.3, 0.9, 1.0];
/// Name of the progress stage.
const STAGE: &str = "motions";

/// Plans trials.
///
/// # Errors
/// See [`TrialPlanError`].
///
/// # Examples
/// ```
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// use catchment_core::design::read;
/// use catchment_core::exec::Exec;
/// use catchment_core::pose::PoseError;
/// use catchment_core::problem::Problem;
/// use catchment_study::plan::{self, Pattern, TrialPlanSettings};
///
/// let text = "[connector]\nfamily = \"v-face\"\n[alignment]\nfree = [\"x\"]\n";
/// let problem = Problem::of(read(text, ".".as_ref())?.design)?;
/// let accuracy = PoseError { x: 0.01, ..PoseError::default() };
/// let pattern = Pattern::Bracket { trials: 6, lines: None, resolution: [None; 5] };
/// let plan = plan::run(&problem, &TrialPlanSettings::new(pattern, accuracy), &Exec::new())?;
/// // Without rotations a V-Face corrects offsets up to D/2: two accuracies inside and outside on either side, and two controls.
/// let mut x: Vec<f64> = plan.points.iter().map(|point| (1e3 * point.error.x).round() / 1e3).collect();
/// x.sort_by(f64::total_cmp);
/// assert_eq!(x, [-0.52, -0.48, 0.25, 0.48, 0.52, 0.75]);
/// # Ok(())
/// # }
/// ```
pub fn run(
    problem: &Problem,
    settings: &TrialPlanSettings,
    exec: &Exec,
) -> Result<TrialPlan, TrialPlanError> {
    check_accuracy(problem, &settings.accuracy)?;
    for (count, what) in [(settings.repeats, "repeats"), (settings.blocks, "blocks")] {
        if count == 0 {
            return Err(TrialPlanError::None { what });
        }
    }
    let motions = descent::DescentSettings::with_friction(settings.friction)?;
    let part = |k: usize| exec.part([PARTS[k], PARTS[k + 1]], STAGE);
    let maker = Maker {
        problem,
        accuracy: settings.accuracy,
        motions: &motions,
        symmetric: settings.symmetric,
        seed: settings.seed,
    };
    let made = maker.make(&settings.pattern, &part(0))?;
    if made.poses.is_empty() {
        return Err(TrialPlanError::FarFromBorder);
    }
    if made.poses.len().saturating_mul(settings.repeats) > MOST_TRIALS {
        return Err(TrialPlanError::TooMany { most: MOST_TRIALS });
    }
    let errors: Vec<PoseError> = made.poses.iter().map(|placed| placed.error).collect();
    let (prediction, followed) =
        foretell(problem, &settings.accuracy, &motions, &errors, settings.seed, &part(1))?;
    let point = |(Placed { error, line }, prediction)| PlannedPose { error, line, prediction };
    let mut points: Vec<PlannedPose> = made.poses.into_iter().zip(prediction).map(point).collect();
    if settings.stop_at_first_failure {
        points = stopped(problem, points);
    }
    let (asymmetric, more) =
        if settings.symmetric { other_signs(problem, &points, &motions, &part(2))? } else { (0, 0) };
    let trials = order(points.len(), settings);
    let count = |is: &dyn Fn(&Prediction) -> bool| points.iter().filter(|p| is(&p.prediction)).count();
    let docking = count(&Prediction::docks);
    let counts = TrialPlanCounts {
        trials: trials.len(),
        poses: points.len(),
        lines: points.iter().map(|point| point.line).max().unwrap_or(0),
        docking,
        failing: points.len() - docking,
        either: count(&|prediction| prediction.either),
        deciding: count(&|prediction| prediction.margin() >= LIMIT),
        asymmetric,
        open: made.open,
    };
    Ok(TrialPlan {
        settings: settings.clone(),
        offsets_at: OffsetsAt::Face,
        counts,
        points,
        trials,
        motions: made.followed + followed + more,
    })
}

/// Checks that an accuracy belongs to free errors, and to at least one.
pub(crate) fn check_accuracy(problem: &Problem, accuracy: &PoseError) -> Result<(), TrialPlanError> {
    let free = problem.alignment().free;
    for (axis, value) in Dof::ALL.into_iter().zip(accuracy.to_array()) {
        let fits = value.is_finite() && value >= 0.0 && (value == 0.0 || free.contains(axis));
        if !fits {
            return Err(TrialPlanError::Accuracy { axis, value });
        }
    }
    if *accuracy == PoseError::default() { Err(TrialPlanError::NoAccuracy) } else { Ok(()) }
}

/// Distance of a pose from zero, as a share of the error box.
pub(crate) fn outwards(problem: &Problem, error: &PoseError) -> f64 {
    let alignment = problem.alignment();
    let part = |axis: Dof| (error.to_array()[axis.index()] / alignment.half_range(axis)).powi(2);
    alignment.free.iter().map(part).sum::<f64>().sqrt()
}

/// Every line up to its first predicted failure, that included.
fn stopped(problem: &Problem, mut points: Vec<PlannedPose>) -> Vec<PlannedPose> {
    points.sort_by(|a, b| {
        a.line.cmp(&b.line).then(outwards(problem, &a.error).total_cmp(&outwards(problem, &b.error)))
    });
    let mut ended = None;
    points.retain(|point| {
        if ended == Some(point.line) {
            return false;
        }
        if !point.prediction.docks() {
            ended = Some(point.line);
        }
        true
    });
    points
}

/// Poses with another outcome for other signs, beyond the uncertainty of the robot.
fn other_signs(
    problem: &Problem,
    points: &[PlannedPose],
    motions: &descent::DescentSettings,
    exec: &Exec,
) -> Result<(usize, usize), Cancelled> {
    let result = for_each(
        points.len(),
        exec,
        || DockingOracle::new(problem, motions),
        |judge, k| {
            let PlannedPose { error, prediction, .. } = &points[k];
            if prediction.either {
                return (false, 0);
            }
            let before = judge.followed();
            let values = error.to_array();
            let occurring: Vec<usize> = (0..5).filter(|k| values[*k] != 0.0).collect();
            let differs = (1..1u32 << occurring.len()).any(|signs| {
                let mut turned = values;
                for (bit, k) in occurring.iter().enumerate() {
                    if signs >> bit & 1 == 1 {
                        turned[*k] = -turned[*k];
                    }
                }
                judge.docks(&PoseError::from_array(turned)) != prediction.docks()
            });
            (differs, judge.followed() - before)
        },
    )?;
    let differing = result.iter().filter(|(differs, _)| *differs).count();
    Ok((differing, result.iter().map(|(_, count)| count).sum()))
}

/// The order of the trials: every pose once, then again; each time shuffled by itself. Blocks are runs of that order.
fn order(points: usize, settings: &TrialPlanSettings) -> Vec<PlannedTrial> {
    let total = points * settings.repeats;
    let mut trials = Vec::with_capacity(total);
    for repeat in 1..=settings.repeats {
        let mut turn: Vec<usize> = (0..points).collect();
        if settings.shuffled {
            // Fisher and Yates.
            let random = Stream::new(settings.seed).branch(5).branch(repeat as u64);
            for k in (1..points).rev() {
                let other = (random.uniform(k as u64) * (k + 1) as f64) as usize;
                turn.swap(k, other.min(k));
            }
        }
        trials.extend(turn.into_iter().map(|point| (repeat, point)));
    }
    let place = |(k, (repeat, point)): (usize, (usize, usize))| PlannedTrial {
        number: k + 1,
        block: k * settings.blocks / total + 1,
        repeat,
        point,
    };
    trials.into_iter().enumerate().map(place).collect()
}
