//! Every method that applies to a problem, on one grid, and how each two of them agree.
//!
//! ```text
//!                transport  descent  flood  …
//!   transport        1        .98     .93        share of the cells that both accept or both reject
//!   descent         .98        1      .94
//! ```
//!
//! Each method has its own time; one that does not apply, does not fit or takes too long is left out, with the reason.
//!
//! Not promised: that methods which agree are right. Only descent is exact at every pose.

use catchment_core::acceptance::Acceptance;
use catchment_core::exec::Exec;
use catchment_core::landscape::{Resolution, ResolutionError};
use catchment_core::merit::MeritError;
use catchment_core::merit::comparison::{ComparisonError, Overlap, Paired, confusion};
use catchment_core::method::{Decide, Method, descent};
use catchment_core::problem::Problem;
use catchment_core::run::{Answer, Over, Run, RunError, Sample};
use std::time::Duration;

/// What changes the answer.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// The methods, each with its settings.
    pub methods: Vec<Method>,
    /// Cells per axis; an even number that exact descent affords where nothing is said.
    pub resolution: Resolution,
    /// Random poses that correct the Sum.
    pub sample: Sample,
    /// Their seed.
    pub seed: u64,
    /// How long each method may take.
    pub time_limit: Duration,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            methods: Method::all().collect(),
            resolution: Resolution::default(),
            sample: Sample::default(),
            seed: 1,
            time_limit: Duration::from_mins(1),
        }
    }
}

/// Why a method has no answer.
#[derive(Debug, thiserror::Error)]
pub enum LeftOut {
    /// It is not made for the design.
    #[error("{reason}")]
    NotApplicable {
        /// Why.
        reason: String,
    },
    /// It takes too long.
    #[error("it takes longer than the {} s allowed", limit.as_secs_f64())]
    Time {
        /// What was allowed.
        limit: Duration,
    },
    /// It gave up.
    #[error(transparent)]
    Run(RunError),
}

/// One method.
#[derive(Debug)]
pub struct Tried {
    /// Its name.
    pub method: &'static str,
    /// What it found.
    pub answer: Result<Answer, LeftOut>,
}

/// All methods of a problem.
#[derive(Debug)]
pub struct Agreement {
    /// Cells per axis, by axis.
    pub cells: Vec<usize>,
    /// Every method, in the order of the settings.
    pub tried: Vec<Tried>,
    /// Of the methods that have an answer, in their order: how each two agree.
    pub overlaps: Vec<Vec<Overlap>>,
}

/// Why there is no agreement to speak of.
#[derive(Debug, thiserror::Error)]
pub enum AgreementError {
    /// The resolution does not suit the free errors.
    #[error(transparent)]
    Resolution(#[from] ResolutionError),
    /// Two acceptances have nothing in common.
    #[error(transparent)]
    Comparison(#[from] ComparisonError),
    /// They could not be counted.
    #[error(transparent)]
    Merit(#[from] MeritError),
    /// It was asked to stop.
    #[error(transparent)]
    Cancelled(#[from] catchment_core::exec::Cancelled),
}

/// Cells per axis where several methods share a grid and nothing was said, for one to five axes: what exact descent can
/// afford, and even, which keeps cells off the mirror planes where transport is weak.
pub fn even_cells(problem: &Problem) -> [usize; 5] {
    let odd = descent::Settings::default().default_cells(problem.pair());
    odd.map(|cells| (cells - 1).max(Resolution::LEAST))
}

/// Decides a problem by every method.
///
/// # Errors
/// The resolution does not suit the problem, or it was asked to stop.
pub fn run(problem: &Problem, settings: &Settings, exec: &Exec) -> Result<Agreement, AgreementError> {
    let grid = settings.resolution.grid(problem.alignment(), &even_cells(problem))?;
    let resolution = Resolution::of(&grid);
    let total = settings.methods.len() as f64;
    let mut tried = Vec::with_capacity(settings.methods.len());
    for (k, method) in settings.methods.iter().enumerate() {
        let part = exec.part([k as f64 / total, (k + 1) as f64 / total], "methods");
        let run = Run {
            over: Over::Grid(resolution),
            sample: settings.sample,
            seed: settings.seed,
            ..Run::by(method.clone())
        };
        let answer = within(&run, problem, settings.time_limit, &part);
        // Whoever stops the study wants nothing more of it.
        exec.check()?;
        tried.push(Tried { method: method.name(), answer });
    }
    let found: Vec<&Acceptance> = tried
        .iter()
        .filter_map(|tried| tried.answer.as_ref().ok())
        .map(|answer| &answer.acceptance)
        .collect();
    let between = |a: &Acceptance, b: &Acceptance| -> Result<Overlap, AgreementError> {
        let paired = Paired::of(a, b)?;
        Ok(Overlap::of(&confusion(&paired.first, &paired.second, exec)?))
    };
    let overlaps = found
        .iter()
        .map(|a| found.iter().map(|b| between(a, b)).collect())
        .collect::<Result<_, AgreementError>>()?;
    Ok(Agreement { cells: grid.shape(), tried, overlaps })
}

/// One method, unless it does not apply or takes too long.
fn within(run: &Run, problem: &Problem, limit: Duration, exec: &Exec) -> Result<Answer, LeftOut> {
    let timed = exec.clone().with_time_limit(limit);
    run.on(problem, &timed).map_err(|error| match error {
        RunError::NotApplicable(refusal) => LeftOut::NotApplicable { reason: refusal.reason },
        _ if timed.is_cancelled() && !exec.is_cancelled() => LeftOut::Time { limit },
        error => LeftOut::Run(error),
    })
}
