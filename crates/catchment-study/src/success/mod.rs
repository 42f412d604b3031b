//! Success probability: the probability that a robot's errors dock, by exact motions; with the failures, and
//! the error to improve first.
//!
//! ```text
//!   robot  ──▶  errors drawn, no motions       ──▶  n of them followed exactly, most near the border
//!   normal,     ░░░░░░░░░░░░░░░░░░░░░░░░░░░░░       · · ·· ·::·· ·
//!   uniform,    strata by a grid over them               │
//!   measured                                             ├─▶  P with its interval              failures, and the most likely failure
//!                                                        ├─▶  dP/dσ of every σ                 the same motions
//!                                                        ├─▶  P with each σ halved             the best improvement
//!                                                        └─▶  P(t), every σ times t            the largest tolerable errors
//! ```
//!
//! - The *probability* is that of exact quasi-static motions, not of cells: the grid only allocates the
//!   motions, and the interval is valid for any grid. Errors outside of the error box are followed like all
//!   others.
//! - *Normal* errors may be correlated. *Measured* errors are taken row by row, each once; if there are more
//!   rows than motions, rows are sampled. Rows count as independent measurements: the interval includes their
//!   uncertainty.
//! - *Slopes* dP/dσ follow for normal errors from the score of the density, for uniform errors from the faces
//!   of their box; for measured errors they are not available.
//! - *Gains* are differences of two probabilities, with the σ as given and halved: new motions, the same
//!   random errors.
//! - The *factor* is the largest multiple of all σ together, or of a single σ, with the required success.
//!
//! Not promised: friction, speed, or that the errors follow their distribution. Undecided motions count as
//! failures. Lengths in D, angles in radians.

pub(crate) mod estimate;
mod failure;
mod fit;
mod gain;
mod report;
mod results;
mod samples;
pub(crate) mod source;
pub(crate) mod strata;
#[cfg(test)]
mod tests;
mod tolerable;

use catchment_core::exec::{Cancelled, Exec};
use catchment_core::method::descent::{self, FrictionOutOfRange};
use catchment_core::method::{DecideError, DecisionMethod};
use catchment_core::pose::{Dof, PoseError};
use catchment_core::poses::{Moments, Robot, Spread};
use catchment_core::problem::Problem;
pub use report::in_percent;
pub(crate) use results::Slope;
pub use results::{
    AlongAxis, AtFactor, AxisFit, ErrorStratum, ExpectedErrors, Factor, Failures, GridCost, Headline,
    Improvement, NearestFailure, NormalFit, RobotDocking, SingleErrorFactor, Success, Tolerable,
};
use serde::{Deserialize, Serialize};
use source::Source;
pub(crate) use source::normals;
use std::f64::consts::SQRT_2;
use strata::Strata;
use tolerable::Curve;

/// Settings that change the result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct SuccessSettings {
    /// Number of exact motions for the probability of each robot; gains use half as many each, factors a
    /// quarter. Default: 8000 for simple halves, fewer for halves with many facets.
    pub motions: Option<usize>,
    /// Seed of the sampled errors.
    pub seed: u64,
    /// Success probability for which factors are sought, above 0 and below 1.
    pub required: f64,
    /// Cells per axis of the grid that guides the sampling; 0 disables it. The default depends on the number
    /// of errors.
    pub cells: Option<usize>,
    /// Friction coefficient between the halves. The guiding grid is frictionless.
    pub friction: f64,
}

impl Default for SuccessSettings {
    fn default() -> Self {
        Self { motions: None, seed: 1, required: 0.99, cells: None, friction: 0.0 }
    }
}

/// Why there is no probability.
#[derive(Debug, thiserror::Error)]
pub enum SuccessError {
    /// No coefficient of friction.
    #[error(transparent)]
    Friction(#[from] FrictionOutOfRange),
    /// No robot.
    #[error("there is no robot to ask about")]
    NoRobot,
    /// A success that cannot be required.
    #[error("a success of {required} cannot be required: above 0 and below 1")]
    Required {
        /// The given value.
        required: f64,
    },
    /// Too few motions.
    #[error("{motions} motions are too few; {FEWEST_MOTIONS} or more")]
    TooFew {
        /// How many.
        motions: usize,
    },
    /// Errors that the design locks.
    #[error("{robot}: {} does not vary in this design, which locks it", axis.name())]
    Locked {
        /// The robot.
        robot: String,
        /// The error.
        axis: Dof,
    },
    /// Nothing varies.
    #[error("{robot}: none of its errors varies; follow its mean, it is one pose")]
    Still {
        /// The robot.
        robot: String,
    },
    /// The grid was not decided.
    #[error(transparent)]
    Decide(#[from] DecideError),
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Fewest motions of a probability.
pub const FEWEST_MOTIONS: usize = 100;
/// Shares of the time that a robot's parts take, about.
const PARTS: [f64; 6] = [0.0, 0.08, 0.2, 0.3, 0.5, 1.0];
/// Factors of the curve beside those that are tried for the required success.
const CURVE: [f64; 7] = [0.25, 0.5, 0.75, 1.2, SQRT_2, 1.7, 2.0];
/// Motions of a probability, as a multiple of the samples of a run: a motion takes a tenth of a millisecond
/// or less between simple halves.
const PER_SAMPLE: usize = 2;

/// Computes the success probability of robots.
///
/// # Errors
/// See [`SuccessError`].
///
/// # Examples
/// ```
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// use catchment_core::design::read;
/// use catchment_core::exec::Exec;
/// use catchment_core::pose::PoseError;
/// use catchment_core::poses::{Robot, Spread};
/// use catchment_core::problem::Problem;
/// use catchment_study::success::{self, SuccessSettings};
///
/// let text = "[connector]\nfamily = \"v-face\"\n[alignment]\nfree = [\"x\"]\n";
/// let problem = Problem::of(read(text, ".".as_ref())?.design)?;
/// let errors = Spread::normal(PoseError { x: 0.25, ..PoseError::default() });
/// let robots = [Robot { name: "arm".to_owned(), errors }];
/// let found = success::run(&problem, &robots, &SuccessSettings { motions: Some(500), ..SuccessSettings::default() }, &Exec::new())?;
/// // Without rotations a V-Face corrects offsets up to D/2, here two standard deviations: 95.45 %.
/// let [lo, hi] = found.robots[0].ci95;
/// assert!(lo < 0.9545 && 0.9545 < hi && hi - lo < 0.03);
/// # Ok(())
/// # }
/// ```
pub fn run(
    problem: &Problem,
    robots: &[Robot],
    settings: &SuccessSettings,
    exec: &Exec,
) -> Result<Success, SuccessError> {
    let by_method = || {
        let samples = descent::DescentSettings::default().default_samples(problem.pair());
        (PER_SAMPLE * samples).max(FEWEST_MOTIONS)
    };
    let motions = settings.motions.unwrap_or_else(by_method);
    check(problem, robots, settings, motions)?;
    let settings = SuccessSettings { motions: Some(motions), ..settings.clone() };
    let mut result = Vec::new();
    let mut followed = 0;
    for (number, robot) in robots.iter().enumerate() {
        let [from, to] = [number, number + 1].map(|k| k as f64 / robots.len() as f64);
        let (docking, more) = of_robot(problem, robot, &settings, motions, &exec.part([from, to], STAGE))?;
        followed += more;
        result.push(docking);
    }
    Ok(Success { settings, success: Headline::of(&result), robots: result, motions: followed })
}

const STAGE: &str = "motions";

fn check(
    problem: &Problem,
    robots: &[Robot],
    settings: &SuccessSettings,
    motions: usize,
) -> Result<(), SuccessError> {
    let required = settings.required;
    if !(required > 0.0 && required < 1.0) {
        return Err(SuccessError::Required { required });
    }
    if motions < FEWEST_MOTIONS {
        return Err(SuccessError::TooFew { motions });
    }
    if robots.is_empty() {
        return Err(SuccessError::NoRobot);
    }
    for robot in robots {
        let free = problem.alignment().free;
        // A measured table may contain locked offsets: their values follow from the rotation.
        let declared = !matches!(robot.errors, Spread::Measured { .. });
        if let Some(axis) = robot.errors.occurring().find(|dof| declared && !free.contains(*dof)) {
            return Err(SuccessError::Locked { robot: robot.name.clone(), axis });
        }
        if robot.errors.moments().sigma == PoseError::default() {
            return Err(SuccessError::Still { robot: robot.name.clone() });
        }
    }
    Ok(())
}

fn of_robot(
    problem: &Problem,
    robot: &Robot,
    settings: &SuccessSettings,
    motions: usize,
    exec: &Exec,
) -> Result<(RobotDocking, usize), SuccessError> {
    let part = |k: usize| exec.part([PARTS[k], PARTS[k + 1]], STAGE);
    let followed_by = descent::DescentSettings::with_friction(settings.friction)?;
    let source = Source::of(&robot.errors, motions, settings.seed).followed_by(&followed_by);
    // Rows that are all followed need no grid.
    let cells = if source.rows().is_some() { Some(0) } else { settings.cells };
    let strata = Strata::decide(problem, &source, cells, &part(0))?;
    let result = estimate::as_expected(problem, &source, &strata, motions, &part(1))?;
    let (failures, more) = failure::failures(problem, &source, &result, &part(2))?;
    let mut followed = result.motions + more;
    let (improve, more) = gain::gains(problem, &source, &strata, &result, motions.div_ceil(2), &part(3))?;
    followed += more;
    let quarter = motions.div_ceil(4).max(FEWEST_MOTIONS);
    let (curves, fit_part) = (part(4).part([0.0, 0.9], STAGE), part(4).part([0.9, 1.0], STAGE));
    let axes: Vec<Dof> = source.varying().collect();
    let step = |k: usize| {
        let of = (axes.len() + 1) as f64;
        curves.part([k as f64 / of, (k + 1) as f64 / of], STAGE)
    };
    let mut all = Curve::new(problem, &source, &strata, quarter, [true; 5]);
    all.know(&result);
    for factor in CURVE {
        all.look(factor, &step(0))?;
    }
    let together = all.factor(settings.required, &step(0))?;
    followed += all.followed();
    let moments = robot.errors.moments();
    let Moments { mean, sigma, correlation } = moments;
    let mut each = Vec::new();
    for (k, axis) in axes.iter().enumerate() {
        let mut changed = [false; 5];
        changed[axis.index()] = true;
        let mut alone = Curve::new(problem, &source, &strata, quarter, changed);
        alone.know(&result);
        let factor = alone.factor(settings.required, &step(k + 1))?;
        let sigma = factor.factor * sigma.to_array()[axis.index()];
        each.push(SingleErrorFactor { axis: *axis, sigma, factor });
        followed += alone.followed();
    }
    let mut fit = fit::fit(&robot.errors);
    if let Some(fit) = &mut fit {
        let spread = Spread::Normal { mean, sigma, correlation };
        let source = Source::of(&spread, 0, settings.seed).followed_by(&followed_by);
        let strata = Strata::decide(problem, &source, settings.cells, &fit_part)?;
        let result = estimate::as_expected(problem, &source, &strata, motions.div_ceil(2), &fit_part)?;
        followed += result.motions;
        (fit.probability, fit.ci95) = (Some(result.probability), Some(result.ci95));
    }
    let rows = match &robot.errors {
        Spread::Measured { poses, .. } => Some(poses.len()),
        _ => None,
    };
    let docking = RobotDocking {
        robot: robot.name.clone(),
        errors: ExpectedErrors { kind: robot.errors.kind(), rows, moments },
        probability: result.probability,
        ci95: result.ci95,
        motions: result.motions,
        undecided: result.undecided,
        plain_motions: result.plain,
        grid: GridCost { cells: strata.cells(), motions: strata.motions() },
        outside_box: outside(problem, &source, &result, exec)?,
        strata: result.strata,
        failures,
        improve,
        tolerable: Tolerable { required: settings.required, all: together, alone: each },
        curve: all.points().to_vec(),
        fit,
    };
    Ok((docking, followed))
}

/// Share of the errors that lie outside of the error box.
fn outside(
    problem: &Problem,
    source: &Source<'_>,
    result: &estimate::Sample,
    exec: &Exec,
) -> Result<f64, Cancelled> {
    let alignment = problem.alignment();
    let is_outside = |number: u64| {
        let error = source.pose(&source.standard(number), &source::SAME).to_array();
        alignment.free.iter().any(|dof| error[dof.index()].abs() > alignment.half_range(dof))
    };
    let drawn = result.drawn().max(1);
    exec.check()?;
    let count = (0..drawn as u64).filter(|number| is_outside(*number)).count();
    Ok(count as f64 / drawn as f64)
}
