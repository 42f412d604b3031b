//! Results of robots.

use super::SuccessSettings;
use catchment_core::acceptance::Outcome;
use catchment_core::method::descent::Touch;
use catchment_core::pose::{Dof, PoseError};
use catchment_core::poses::Moments;
use serde::{Deserialize, Serialize};

/// Docking success of robots.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Success {
    /// The settings, with all defaults filled in.
    pub settings: SuccessSettings,
    /// The robot with the lowest success probability.
    pub success: Headline,
    /// Results for each robot, in the order of the file; at least one.
    pub robots: Vec<RobotDocking>,
    /// Number of exact motions, without those of grids.
    pub motions: usize,
}

/// The robot with the lowest success probability.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Headline {
    /// Name of the robot.
    pub robot: String,
    /// Probability of docking, in [0, 1].
    pub probability: f64,
    /// Its 95 % interval.
    pub ci95: [f64; 2],
    /// Largest factor on all its σ at which the required success is reached.
    pub tolerable: f64,
}

/// Docking success of a robot. Lengths in D, angles in radians.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RobotDocking {
    /// Name of the robot.
    pub robot: String,
    /// Its expected errors.
    pub errors: ExpectedErrors,
    /// Probability of docking, in [0, 1].
    pub probability: f64,
    /// Its 95 % interval.
    pub ci95: [f64; 2],
    /// Number of exact motions behind it.
    pub motions: usize,
    /// Number of motions that could not be followed to their end: they count as failures.
    pub undecided: usize,
    /// Effective sample size: number of plain samples whose interval would be as wide.
    pub plain_motions: f64,
    /// The grid that allocates the motions to strata.
    pub grid: GridCost,
    /// Share of the errors outside the error box of the design, in [0, 1].
    pub outside_box: f64,
    /// The sample, by stratum.
    pub strata: Vec<ErrorStratum>,
    /// The failures.
    pub failures: Failures,
    /// Effect of an improvement of each error, largest effect first.
    pub improve: Vec<Improvement>,
    /// Largest tolerable increase of σ.
    pub tolerable: Tolerable,
    /// Success probability with all σ multiplied by a factor, in ascending order of the factor.
    pub curve: Vec<AtFactor>,
    /// Test of measured errors for normality; null for other errors, and for fewer than eight rows.
    pub fit: Option<NormalFit>,
}

/// The expected errors.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ExpectedErrors {
    /// `normal`, `uniform` or `measured`.
    pub kind: &'static str,
    /// Number of rows of measured errors; null for other errors.
    pub rows: Option<usize>,
    /// Mean, standard deviations and correlations, in the order x, y, roll, pitch, yaw.
    #[serde(flatten)]
    pub moments: Moments,
}

/// Cost of a grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct GridCost {
    /// Number of cells that were decided; 0 without a grid.
    pub cells: usize,
    /// Number of motions for it, complete or not.
    pub motions: usize,
}

/// Results of a stratum of errors.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ErrorStratum {
    /// Errors that the stratum contains.
    pub name: String,
    /// Its share of all errors, in [0, 1].
    pub share: f64,
    /// Number of motions in the stratum.
    pub motions: usize,
    /// Number of them that docked.
    pub docked: usize,
    /// Number of them that could not be followed to their end.
    pub undecided: usize,
    /// Estimated share of the stratum that docks, in [0, 1].
    pub probability: f64,
}

/// The failures.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Failures {
    /// Share of all errors, in [0, 1].
    pub share: f64,
    /// Share of the failures that jams.
    pub jammed: f64,
    /// Share of the failures that misses.
    pub missed: f64,
    /// Share of the failures that could not be followed to their end.
    pub undecided: f64,
    /// Dominant error: the error whose mean distance in σ differs most between failures and successes; null
    /// without failures.
    pub dominating: Option<Dof>,
    /// Statistics of the failures for each error.
    pub along: Vec<AlongAxis>,
    /// The nearest failure; null without a failure.
    pub first: Option<NearestFailure>,
}

/// Size of an error in failures and in successes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct AlongAxis {
    /// The error.
    pub axis: Dof,
    /// Mean distance from its mean in failures, in σ (in half-widths for uniform errors); null without
    /// failures.
    pub failed: Option<f64>,
    /// Mean distance from its mean in successes.
    pub docked: Option<f64>,
}

/// The nearest failure: the failing error nearest to the mean.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct NearestFailure {
    /// The pose error.
    pub error: PoseError,
    /// The pose error in σ from the mean (in half-widths for uniform errors).
    pub sigmas: PoseError,
    /// Mahalanobis distance from the mean; for uniform errors the largest component in half-widths.
    pub distance: f64,
    /// Its outcome.
    pub outcome: Outcome,
    /// Pose error at the end of its motion.
    pub end: PoseError,
    /// Contacts at the end, in the world frame of the fixed face centre.
    pub touches: Vec<Touch>,
}

/// dP/dσ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Slope {
    /// By the σ (or half-width) of which error.
    pub axis: Dof,
    /// In 1/D or 1/rad.
    pub value: f64,
    /// Its 95 % interval.
    pub ci95: [f64; 2],
}

/// Effect of an improvement of a single error.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Improvement {
    /// The error.
    pub axis: Dof,
    /// Its standard deviation, in D or radians.
    pub sigma: f64,
    /// Derivative dP/dσ of the probability (by the half-width for uniform errors), in 1/D or 1/rad; null if
    /// it is not known.
    pub slope: Option<f64>,
    /// Its 95 % interval.
    pub slope_ci95: Option<[f64; 2]>,
    /// Success probability with this σ halved.
    pub halved: f64,
    /// Its 95 % interval.
    pub halved_ci95: [f64; 2],
    /// Gain in probability from halving σ.
    pub gain: f64,
    /// Its 95 % interval, computed as for two independent probabilities; common random errors can only make
    /// the true interval narrower.
    pub gain_ci95: [f64; 2],
}

/// Largest tolerable increase of σ.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Tolerable {
    /// Required success probability.
    pub required: f64,
    /// Factor on all σ together.
    #[serde(flatten)]
    pub all: Factor,
    /// Factor on each σ by itself, in the order of the errors.
    pub alone: Vec<SingleErrorFactor>,
}

/// Largest tolerable increase of a single σ.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SingleErrorFactor {
    /// The error.
    pub axis: Dof,
    /// Its standard deviation with this factor, in D or radians.
    pub sigma: f64,
    /// The factor.
    #[serde(flatten)]
    pub factor: Factor,
}

/// Largest factor on σ with which the required success is reached.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Factor {
    /// The factor: 0 if the success is never reached, the largest tried factor if it is always reached.
    pub factor: f64,
    /// Factors at which the ends of the probability's interval cross the required success.
    pub ci95: [f64; 2],
    /// Whether the success is reached even at the largest factor tried.
    pub is_more: bool,
    /// Whether the success is missed even at the smallest factor tried.
    pub is_less: bool,
}

/// The probability with σ multiplied by a factor.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct AtFactor {
    /// The factor.
    pub factor: f64,
    /// Probability of docking, in [0, 1].
    pub probability: f64,
    /// Its 95 % interval.
    pub ci95: [f64; 2],
}

/// Test of a normal fit to measured errors.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct NormalFit {
    /// Whether normality is rejected at the 5 % level.
    pub rejected: bool,
    /// Combined p-value: probability that normal errors deviate this much from normality in any of the tests,
    /// in [0, 1].
    pub p_value: f64,
    /// Test of each error.
    pub axes: Vec<AxisFit>,
    /// Mardia's kurtosis; null if errors are linearly dependent.
    pub kurtosis: Option<f64>,
    /// Its p-value.
    pub kurtosis_p_value: Option<f64>,
    /// Errors with correlated neighbouring rows, so that rows are not independent measurements.
    pub trending: Vec<Dof>,
    /// Success probability if the errors followed the fit.
    pub probability: Option<f64>,
    /// Its 95 % interval.
    pub ci95: Option<[f64; 2]>,
}

/// Test of a single error of a fit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct AxisFit {
    /// The error.
    pub axis: Dof,
    /// Anderson–Darling statistic, corrected for the number of rows.
    pub anderson_darling: f64,
    /// Probability of this or a larger statistic for normal errors, in [0, 1].
    pub p_value: f64,
    /// Correlation of neighbouring rows.
    pub lag: f64,
}

impl Success {
    /// The robot that docks most seldom.
    pub fn worst(&self) -> Option<&RobotDocking> {
        worst(&self.robots)
    }
}

impl Headline {
    pub(super) fn of(robots: &[RobotDocking]) -> Self {
        let worst = worst(robots);
        Self {
            robot: worst.map_or_else(String::new, |robot| robot.robot.clone()),
            probability: worst.map_or(0.0, |robot| robot.probability),
            ci95: worst.map_or([0.0, 1.0], |robot| robot.ci95),
            tolerable: worst.map_or(0.0, |robot| robot.tolerable.all.factor),
        }
    }
}

fn worst(robots: &[RobotDocking]) -> Option<&RobotDocking> {
    robots.iter().min_by(|a, b| a.probability.total_cmp(&b.probability))
}
