//! What is found of robots: the words of the answer.

use super::{Settings, fit};
use catchment_core::acceptance::Outcome;
use catchment_core::method::descent::Touch;
use catchment_core::pose::{Dof, PoseError};
use catchment_core::poses::{Moments, Robot};
use serde::{Deserialize, Serialize};

/// What becomes of the robots.
#[derive(Debug, Clone, PartialEq)]
pub struct Success {
    /// How it was asked for, everything filled in.
    pub settings: Settings,
    /// Each of them, in their order; at least one.
    pub robots: Vec<Docking>,
    /// Motions in all, those of grids left out.
    pub motions: usize,
}

/// Whether a robot docks.
#[derive(Debug, Clone, PartialEq)]
pub struct Docking {
    /// What it is called.
    pub robot: String,
    /// How its errors spread: `normal`, `uniform` or `measured`.
    pub kind: &'static str,
    /// Their mean, standard deviations and correlations.
    pub moments: Moments,
    /// Rows, of measured errors.
    pub rows: Option<usize>,
    /// Probability of docking, in [0, 1].
    pub probability: f64,
    /// Its 95 % interval.
    pub ci95: [f64; 2],
    /// Motions that this took.
    pub motions: usize,
    /// How many of them could not be followed to their end.
    pub undecided: usize,
    /// Plain motions of random errors whose interval would be as wide.
    pub plain_motions: f64,
    /// Cells of the grid that said where to look, and the motions that it took, to their end or not.
    pub grid: [usize; 2],
    /// Share of the errors that lie outside of the design's error box.
    pub outside: f64,
    /// What was seen of each stratum.
    pub strata: Vec<Stratum>,
    /// What fails.
    pub failures: Failures,
    /// What it helps to improve each error, the most helpful first.
    pub improve: Vec<Improvement>,
    /// How much larger all σ may be.
    pub tolerable: Factor,
    /// How much larger each alone may be, in the order of the errors.
    pub tolerable_alone: Vec<(Dof, Factor)>,
    /// The probability with all σ multiplied by some factors, in ascending order.
    pub curve: Vec<AtFactor>,
    /// Of measured errors, whether they are normal; none of fewer than eight rows.
    pub fit: Option<Fit>,
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
#[derive(Debug, Clone, PartialEq)]
pub struct Failures {
    /// Share of all errors, in [0, 1].
    pub share: f64,
    /// Of the failures the share that jams.
    pub jammed: f64,
    /// The share that misses.
    pub missed: f64,
    /// The share that could not be followed to its end.
    pub undecided: f64,
    /// Where failures lie, error by error.
    pub along: Vec<AlongAxis>,
    /// The likeliest failure that was found; none where nothing failed.
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
#[derive(Debug, Clone, PartialEq)]
pub struct First {
    /// The pose error.
    pub error: PoseError,
    /// The same in σ from the mean (half-widths of uniform errors), in the order of [`Dof::ALL`].
    pub sigmas: [f64; 5],
    /// Mahalanobis' distance from the mean; of uniform errors the largest of their half-widths.
    pub distance: f64,
    /// What becomes of it.
    pub outcome: Outcome,
    /// Where it ends.
    pub end: PoseError,
    /// What touches there.
    pub touches: Vec<Touch>,
}

/// dP/dσ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slope {
    /// By the σ (or half-width) of which error.
    pub axis: Dof,
    /// In 1/D or 1/rad.
    pub slope: f64,
    /// Its 95 % interval.
    pub ci95: [f64; 2],
}

/// What it helps to improve an error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Improvement {
    /// Which.
    pub axis: Dof,
    /// Its standard deviation.
    pub sigma: f64,
    /// dP/dσ, where it is known; by the half-width of uniform errors.
    pub slope: Option<Slope>,
    /// Probability of docking with this σ halved.
    pub halved: f64,
    /// Its 95 % interval.
    pub halved_ci95: [f64; 2],
    /// What that gains.
    pub gain: f64,
    /// Its 95 % interval, as of two independent probabilities: common random errors make it narrower than stated, never wider.
    pub gain_ci95: [f64; 2],
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
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// Mean, standard deviations, correlations.
    pub moments: Moments,
    /// Whether it is rejected at 5 %.
    pub rejected: bool,
    /// Chance of normal errors to look so little normal, in [0, 1], however many tests there are.
    pub p_value: f64,
    /// Each error by itself.
    pub axes: Vec<AxisFit>,
    /// Mardia's kurtosis; none where errors follow from each other.
    pub kurtosis: Option<f64>,
    /// Its p-value.
    pub kurtosis_p_value: Option<f64>,
    /// Errors of which neighbouring rows are alike: rows that are no independent measurements.
    pub trending: Vec<Dof>,
    /// Probability of docking if errors were as the fit has them, and its 95 % interval.
    pub success: Option<(f64, [f64; 2])>,
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
        self.robots.iter().min_by(|a, b| a.probability.total_cmp(&b.probability))
    }

    /// With every place that an answer about these robots has, and numbers that mean nothing: what requirements are tried on.
    pub fn form(robots: &[Robot]) -> Self {
        let docking = |robot: &Robot| {
            let sigma = robot.errors.moments().sigma.to_array();
            let axes: Vec<Dof> = Dof::ALL.into_iter().filter(|dof| sigma[dof.index()] > 0.0).collect();
            let slope = |axis| Slope { axis, slope: 0.0, ci95: [0.0; 2] };
            let improvement = |axis: &Dof| Improvement {
                axis: *axis,
                sigma: 0.0,
                slope: Some(slope(*axis)),
                halved: 0.0,
                halved_ci95: [0.0; 2],
                gain: 0.0,
                gain_ci95: [0.0; 2],
            };
            let mut fit = fit::fit(&robot.errors);
            if let Some(fit) = &mut fit {
                fit.success = Some((0.0, [0.0; 2]));
            }
            Docking {
                robot: robot.name.clone(),
                kind: robot.errors.kind(),
                moments: robot.errors.moments(),
                rows: Some(0),
                probability: 0.0,
                ci95: [0.0; 2],
                motions: 0,
                undecided: 0,
                plain_motions: 0.0,
                grid: [0; 2],
                outside: 0.0,
                strata: Vec::new(),
                failures: Failures {
                    share: 0.0,
                    jammed: 0.0,
                    missed: 0.0,
                    undecided: 0.0,
                    along: axes
                        .iter()
                        .map(|axis| AlongAxis { axis: *axis, failed: Some(0.0), docked: Some(0.0) })
                        .collect(),
                    first: Some(First {
                        error: PoseError::default(),
                        sigmas: [0.0; 5],
                        distance: 0.0,
                        outcome: Outcome::Aligned,
                        end: PoseError::default(),
                        touches: Vec::new(),
                    }),
                },
                improve: axes.iter().map(improvement).collect(),
                tolerable: Factor::default(),
                tolerable_alone: axes.iter().map(|axis| (*axis, Factor::default())).collect(),
                curve: Vec::new(),
                fit,
            }
        };
        let robots = robots.iter().map(docking).collect();
        Self { settings: Settings { motions: Some(0), ..Settings::default() }, robots, motions: 0 }
    }
}
