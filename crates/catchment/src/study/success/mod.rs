//! Will it dock? The probability that a robot's errors are corrected, by exact motions; what fails, and which error to improve.
//!
//! ```text
//!   robot  ──▶  random errors, none followed   ──▶  n of them followed exactly, most where there is doubt
//!   normal,     ░░░░░░░░░░░░░░░░░░░░░░░░░░░░░       · · ·· ·::·· ·
//!   uniform,    strata by a grid over them               │
//!   measured                                             ├─▶  P with its interval              what fails, what fails first
//!                                                        ├─▶  dP/dσ of every σ                 the same motions
//!                                                        ├─▶  P with σ halved, one by one      which to improve first
//!                                                        └─▶  P(t), every σ times t            how large they may be
//! ```
//!
//! - The *probability* is that of exact quasi-static motions, not of cells: the grid only says where to look, and whatever it says, the
//!   interval holds. Errors outside of the error box are followed like all others.
//! - *Normal* errors may be correlated. *Measured* ones are taken row by row, each once; where there are more rows than motions, any of them. Rows
//!   count as independent measurements: the interval says what they leave open.
//! - *Slopes* dP/dσ are of normal errors by the score of the density, of uniform ones by the faces of their box; of measured ones there are none.
//! - *Gains* are differences of two probabilities, with the σ as it is and halved: new motions, the same random errors.
//! - The *factor* is by how much all σ together, or one alone, may be multiplied for the success that is required.
//!
//! Not promised: friction, speed, or that errors are as they are said to be. Undecided motions count as failures. Lengths in D, angles in
//! radians.

mod estimate;
mod failure;
mod fit;
mod gain;
mod source;
mod strata;
#[cfg(test)]
mod tests;
mod tolerable;

use crate::acceptance::Outcome;
use crate::exec::{Cancelled, Exec};
use crate::method::descent::{self, Touch};
use crate::method::{Decide, DecideError};
use crate::pose::{Dof, PoseError};
use crate::poses::{Moments, Robot, Spread};
use crate::problem::Problem;
use serde::{Deserialize, Serialize};
use source::Source;
use std::f64::consts::SQRT_2;
use strata::Strata;
use tolerable::Curve;

/// What changes the answer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Settings {
    /// Exact motions of the probability of each robot; gains take half as many each, factors a quarter. Where nothing is said 8000 of simple
    /// halves, fewer of those with many facets.
    pub motions: Option<usize>,
    /// Seed of the random errors.
    pub seed: u64,
    /// The success for which factors are sought, above 0 and below 1.
    pub required: f64,
    /// Cells per axis of the grid that says where to look; 0 for none, by the number of errors where nothing is said.
    pub cells: Option<usize>,
}

impl Default for Settings {
    fn default() -> Self {
        Self { motions: None, seed: 1, required: 0.99, cells: None }
    }
}

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

/// Why there is no probability.
#[derive(Debug, thiserror::Error)]
pub enum SuccessError {
    /// No robot.
    #[error("there is no robot to ask about")]
    NoRobot,
    /// A success that cannot be required.
    #[error("a success of {required} cannot be required: above 0 and below 1")]
    Required {
        /// What was.
        required: f64,
    },
    /// Too few motions.
    #[error("{motions} motions are too few; {FEWEST_MOTIONS} or more")]
    TooFew {
        /// How many.
        motions: usize,
    },
    /// Errors of what the design locks.
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
    /// It was asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Fewest motions of a probability.
pub const FEWEST_MOTIONS: usize = 100;
/// Shares of the time that a robot's parts take, about.
const PARTS: [f64; 6] = [0.0, 0.08, 0.2, 0.3, 0.5, 1.0];
/// Factors of the curve beside those that are tried for the required success.
const CURVE: [f64; 7] = [0.25, 0.5, 0.75, 1.2, SQRT_2, 1.7, 2.0];
/// Motions of a probability, as a multiple of the random poses of a run: one takes a tenth of a millisecond or less between simple halves.
const PER_SAMPLE: usize = 2;

/// Asks whether robots dock.
///
/// # Errors
/// See [`SuccessError`].
///
/// # Examples
/// ```
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// use catchment::design::read;
/// use catchment::exec::Exec;
/// use catchment::pose::PoseError;
/// use catchment::poses::{Robot, Spread};
/// use catchment::problem::Problem;
/// use catchment::study::success::{self, Settings};
///
/// let text = "[connector]\nfamily = \"v-face\"\n[alignment]\nfree = [\"x\"]\n";
/// let problem = Problem::of(read(text, ".".as_ref())?.design)?;
/// let errors = Spread::normal(PoseError { x: 0.25, ..PoseError::default() });
/// let robots = [Robot { name: "arm".to_owned(), errors }];
/// let found = success::run(&problem, &robots, &Settings { motions: Some(500), ..Settings::default() }, &Exec::new())?;
/// // Without rotations a V-Face corrects offsets up to D/2, here two standard deviations: 95.45 %.
/// let [lo, hi] = found.robots[0].ci95;
/// assert!(lo < 0.9545 && 0.9545 < hi && hi - lo < 0.03);
/// # Ok(())
/// # }
/// ```
pub fn run(
    problem: &Problem,
    robots: &[Robot],
    settings: &Settings,
    exec: &Exec,
) -> Result<Success, SuccessError> {
    let by_method = || {
        let samples = descent::Settings::default().default_samples(problem.pair());
        (PER_SAMPLE * samples).max(FEWEST_MOTIONS)
    };
    let motions = settings.motions.unwrap_or_else(by_method);
    check(problem, robots, settings, motions)?;
    let settings = Settings { motions: Some(motions), ..settings.clone() };
    let mut found = Vec::new();
    let mut followed = 0;
    for (number, robot) in robots.iter().enumerate() {
        let [from, to] = [number, number + 1].map(|k| k as f64 / robots.len() as f64);
        let (docking, more) = of_robot(problem, robot, &settings, motions, &exec.part([from, to], STAGE))?;
        followed += more;
        found.push(docking);
    }
    Ok(Success { settings, robots: found, motions: followed })
}

const STAGE: &str = "motions";

fn check(
    problem: &Problem,
    robots: &[Robot],
    settings: &Settings,
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
        // What a table says of a locked offset is what its lock makes of it.
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
    settings: &Settings,
    motions: usize,
    exec: &Exec,
) -> Result<(Docking, usize), SuccessError> {
    let part = |k: usize| exec.part([PARTS[k], PARTS[k + 1]], STAGE);
    let source = Source::of(&robot.errors, motions, settings.seed);
    // Rows that are all followed need no grid.
    let cells = if source.rows().is_some() { Some(0) } else { settings.cells };
    let strata = Strata::decide(problem, &source, cells, &part(0))?;
    let found = estimate::as_expected(problem, &source, &strata, motions, &part(1))?;
    let (failures, more) = failure::failures(problem, &source, &found, &part(2))?;
    let mut followed = found.motions + more;
    let (improve, more) = gain::gains(problem, &source, &strata, &found, motions.div_ceil(2), &part(3))?;
    followed += more;
    let quarter = motions.div_ceil(4).max(FEWEST_MOTIONS);
    let (curves, fit_part) = (part(4).part([0.0, 0.9], STAGE), part(4).part([0.9, 1.0], STAGE));
    let axes: Vec<Dof> = source.varying().collect();
    let step = |k: usize| {
        let of = (axes.len() + 1) as f64;
        curves.part([k as f64 / of, (k + 1) as f64 / of], STAGE)
    };
    let mut all = Curve::new(problem, &source, &strata, quarter, [true; 5]);
    all.know(&found);
    for factor in CURVE {
        all.look(factor, &step(0))?;
    }
    let tolerable = all.factor(settings.required, &step(0))?;
    followed += all.followed();
    let mut tolerable_alone = Vec::new();
    for (k, axis) in axes.iter().enumerate() {
        let mut changed = [false; 5];
        changed[axis.index()] = true;
        let mut alone = Curve::new(problem, &source, &strata, quarter, changed);
        alone.know(&found);
        tolerable_alone.push((*axis, alone.factor(settings.required, &step(k + 1))?));
        followed += alone.followed();
    }
    let mut fit = fit::fit(&robot.errors);
    if let Some(fit) = &mut fit {
        let Moments { mean, sigma, correlation } = fit.moments;
        let spread = Spread::Normal { mean, sigma, correlation };
        let source = Source::of(&spread, 0, settings.seed);
        let strata = Strata::decide(problem, &source, settings.cells, &fit_part)?;
        let found = estimate::as_expected(problem, &source, &strata, motions.div_ceil(2), &fit_part)?;
        followed += found.motions;
        fit.success = Some((found.probability, found.ci95));
    }
    let rows = match &robot.errors {
        Spread::Measured { poses, .. } => Some(poses.len()),
        _ => None,
    };
    let docking = Docking {
        robot: robot.name.clone(),
        kind: robot.errors.kind(),
        moments: robot.errors.moments(),
        rows,
        probability: found.probability,
        ci95: found.ci95,
        motions: found.motions,
        undecided: found.undecided,
        plain_motions: found.plain,
        grid: [strata.cells(), strata.motions()],
        outside: outside(problem, &source, &found, exec)?,
        strata: found.strata,
        failures,
        improve,
        tolerable,
        tolerable_alone,
        curve: all.points().to_vec(),
        fit,
    };
    Ok((docking, followed))
}

/// Share of the errors that lie outside of the error box.
fn outside(
    problem: &Problem,
    source: &Source<'_>,
    found: &estimate::Sample,
    exec: &Exec,
) -> Result<f64, Cancelled> {
    let alignment = problem.alignment();
    let is_outside = |number: u64| {
        let error = source.pose(&source.standard(number), &source::SAME).to_array();
        alignment.free.iter().any(|dof| error[dof.index()].abs() > alignment.half_range(dof))
    };
    let drawn = found.drawn().max(1);
    exec.check()?;
    let count = (0..drawn as u64).filter(|number| is_outside(*number)).count();
    Ok(count as f64 / drawn as f64)
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
