//! Results of robots.

use super::Settings;
use catchment_core::acceptance::Outcome;
use catchment_core::method::descent::Touch;
use catchment_core::pose::{Dof, PoseError};
use catchment_core::poses::Moments;
use serde::{Deserialize, Serialize};

/// Whether robots dock.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Success {
    /// The settings, everything filled in.
    pub settings: Settings,
    /// The robot that docks most seldom.
    pub success: Headline,
    /// Each robot, in the order of their file; at least one.
    pub robots: Vec<Docking>,
    /// Exact motions in all, those of grids left out.
    pub motions: usize,
}

/// The robot that docks most seldom.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Headline {
    /// The name of the robot.
    pub robot: String,
    /// Probability of docking, in [0, 1].
    pub probability: f64,
    /// Its 95 % interval.
    pub ci95: [f64; 2],
    /// By how much all its σ may be multiplied for the success that is required.
    pub tolerable: f64,
}

/// Whether a robot docks. Lengths in D, angles in radians.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Docking {
    /// The name of the robot.
    pub robot: String,
    /// Which errors are expected of it.
    pub errors: Errors,
    /// Probability of docking, in [0, 1].
    pub probability: f64,
    /// Its 95 % interval.
    pub ci95: [f64; 2],
    /// Exact motions that this took.
    pub motions: usize,
    /// How many of them could not be followed to their end: they count as failures.
    pub undecided: usize,
    /// Plain motions of random errors whose interval would be as wide.
    pub plain_motions: f64,
    /// The grid that decided where motions are followed most.
    pub grid: GridCost,
    /// Share of the errors that lie outside of the design's error box, in [0, 1].
    pub outside_box: f64,
    /// The sample, by stratum.
    pub strata: Vec<Stratum>,
    /// What fails.
    pub failures: Failures,
    /// What it helps to improve each error, the most helpful first.
    pub improve: Vec<Improvement>,
    /// How much larger σ may be.
    pub tolerable: Tolerable,
    /// The probability with all σ multiplied by some factors, in ascending order.
    pub curve: Vec<AtFactor>,
    /// Whether measured errors are normal; null of others, and of fewer than eight rows.
    pub fit: Option<Fit>,
}

/// Which errors are expected.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Errors {
    /// `normal`, `uniform` or `measured`.
    pub kind: &'static str,
    /// Rows of measured errors; null of others.
    pub rows: Option<usize>,
    /// Mean, standard deviations and correlations, in the order x, y, roll, pitch, yaw.
    #[serde(flatten)]
    pub moments: Moments,
}

/// The effort of a grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct GridCost {
    /// Cells that were decided; 0 where there was no grid.
    pub cells: usize,
    /// Motions that this took, to their end or not.
    pub motions: usize,
}

/// What was seen of a stratum of errors.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Stratum {
    /// What it holds.
    pub name: String,
    /// Its share of all errors, in [0, 1].
    pub share: f64,
    /// Motions in it.
    pub motions: usize,
    /// How many of them docked.
    pub docked: usize,
    /// How many could not be followed to their end.
    pub undecided: usize,
    /// Share of its errors that dock, in [0, 1].
    pub probability: f64,
}

/// What fails.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Failures {
    /// Share of all errors, in [0, 1].
    pub share: f64,
    /// Of the failures the share that jams.
    pub jammed: f64,
    /// The share that misses.
    pub missed: f64,
    /// The share that could not be followed to its end.
    pub undecided: f64,
    /// The error that is larger, in σ, where docking fails than where it does not, by more than any other; null where nothing fails.
    pub dominating: Option<Dof>,
    /// Where failures lie, error by error.
    pub along: Vec<AlongAxis>,
    /// The likeliest failure that was found; null where nothing failed.
    pub first: Option<First>,
}

/// How large an error is where docking fails, and where it does not.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct AlongAxis {
    /// Which error.
    pub axis: Dof,
    /// Mean distance from its mean, in σ (half-widths of uniform errors), of what fails; null where nothing does.
    pub failed: Option<f64>,
    /// The same of what docks.
    pub docked: Option<f64>,
}

/// The failing error that is nearest to the mean.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct First {
    /// The pose error.
    pub error: PoseError,
    /// The same in σ from the mean (half-widths of uniform errors).
    pub sigmas: PoseError,
    /// Mahalanobis' distance from the mean; of uniform errors the largest of their half-widths.
    pub distance: f64,
    /// Its outcome.
    pub outcome: Outcome,
    /// Where it ends.
    pub end: PoseError,
    /// What touches there, in the world frame of the fixed face centre.
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

/// What it helps to improve an error.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Improvement {
    /// Which.
    pub axis: Dof,
    /// Its standard deviation, in D or radians.
    pub sigma: f64,
    /// dP/dσ (by the half-width of uniform errors), in 1/D or 1/rad; null where it is not known.
    pub slope: Option<f64>,
    /// Its 95 % interval.
    pub slope_ci95: Option<[f64; 2]>,
    /// Probability of docking with this σ halved.
    pub halved: f64,
    /// Its 95 % interval.
    pub halved_ci95: [f64; 2],
    /// What that gains.
    pub gain: f64,
    /// Its 95 % interval, as of two independent probabilities: common random errors make it narrower than stated, never wider.
    pub gain_ci95: [f64; 2],
}

/// How much larger σ may be.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Tolerable {
    /// The success that is required.
    pub required: f64,
    /// All of them together.
    #[serde(flatten)]
    pub all: Factor,
    /// Each alone, in the order of the errors.
    pub alone: Vec<Alone>,
}

/// How much larger one σ may be.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Alone {
    /// Which.
    pub axis: Dof,
    /// The standard deviation then, in D or radians.
    pub sigma: f64,
    /// The factor.
    #[serde(flatten)]
    pub factor: Factor,
}

/// By how much σ may be multiplied for the success that is required.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Factor {
    /// The factor: 0 if none suffices, the largest one tried if all do.
    pub factor: f64,
    /// Where the ends of the interval of the probability cross what is required.
    pub ci95: [f64; 2],
    /// Whether even the largest factor tried suffices.
    pub is_more: bool,
    /// Whether not even the smallest one does.
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

/// A normal fit to measured errors.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Fit {
    /// Whether it is rejected at 5 %.
    pub rejected: bool,
    /// Chance of normal errors to look so little normal, in [0, 1], however many tests there are.
    pub p_value: f64,
    /// Each error by itself.
    pub axes: Vec<AxisFit>,
    /// Mardia's kurtosis; null where errors follow from each other.
    pub kurtosis: Option<f64>,
    /// Its p-value.
    pub kurtosis_p_value: Option<f64>,
    /// Errors of which neighbouring rows are alike: rows that are no independent measurements.
    pub trending: Vec<Dof>,
    /// Probability of docking if errors were as the fit has them.
    pub probability: Option<f64>,
    /// Its 95 % interval.
    pub ci95: Option<[f64; 2]>,
}

/// One error of a fit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct AxisFit {
    /// Which.
    pub axis: Dof,
    /// Anderson's and Darling's statistic, corrected for the number of rows.
    pub anderson_darling: f64,
    /// Chance of normal errors to have such a one or a larger, in [0, 1].
    pub p_value: f64,
    /// Correlation of neighbouring rows.
    pub lag: f64,
}

impl Success {
    /// The robot that docks most seldom.
    pub fn worst(&self) -> Option<&Docking> {
        worst(&self.robots)
    }
}

impl Headline {
    pub(super) fn of(robots: &[Docking]) -> Self {
        let worst = worst(robots);
        Self {
            robot: worst.map_or_else(String::new, |robot| robot.robot.clone()),
            probability: worst.map_or(0.0, |robot| robot.probability),
            ci95: worst.map_or([0.0, 1.0], |robot| robot.ci95),
            tolerable: worst.map_or(0.0, |robot| robot.tolerable.all.factor),
        }
    }
}

fn worst(robots: &[Docking]) -> Option<&Docking> {
    robots.iter().min_by(|a, b| a.probability.total_cmp(&b.probability))
}
