//! Comparison of all methods that apply to a problem, on a common grid, with the agreement of each pair.
//!
//! ```text
//!                transport  descent  flood  …
//!   transport        1        .98     .93        share of the cells that both accept or both reject
//!   descent         .98        1      .94
//! ```
//!
//! Each method has its own time limit; a method that does not apply, does not fit into memory or takes too
//! long is skipped, with the reason.
//!
//! Not promised: that methods which agree are correct. Only descent is exact at every pose.

mod report;

use catchment_core::acceptance::Acceptance;
use catchment_core::exec::Exec;
use catchment_core::landscape::{Resolution, ResolutionError};
use catchment_core::merit::MeritError;
use catchment_core::merit::comparison::{AcceptanceOverlap, ComparisonError, Paired, confusion};
use catchment_core::method::{DecisionMethod, Method, descent};
use catchment_core::problem::Problem;
use catchment_core::run::{Answer, Over, Run, RunError, Sample};
use serde::Serialize;
use std::time::Duration;

/// Settings that change the result.
#[derive(Debug, Clone, PartialEq)]
pub struct AgreementSettings {
    /// The methods, each with its settings.
    pub methods: Vec<Method>,
    /// Cells per axis; by default an even number that exact descent can afford.
    pub resolution: Resolution,
    /// Samples that correct the Sum.
    pub sample: Sample,
    /// Their seed.
    pub seed: u64,
    /// How long each method may take.
    pub time_limit: Duration,
}

impl Default for AgreementSettings {
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

/// Results of all methods for a design on a common grid.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Agreement {
    /// Number of cells of each axis.
    pub cells: Vec<usize>,
    /// Time limit for each method, in seconds.
    pub time_limit_s: f64,
    /// Unit of the Sums.
    pub unit: String,
    /// All methods. Seconds differ between equal runs, and so does the result of a method that the time limit
    /// stops.
    pub methods: Vec<ComparedMethod>,
    /// For the methods with a result, in their order: the agreement of each pair.
    pub agreement: Vec<Vec<PairAgreement>>,
}

/// Result of a single method.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ComparedMethod {
    /// Name of the method.
    pub method: &'static str,
    /// Result of the method; null without a result.
    pub result: Option<MethodResult>,
    /// Reason for the missing result.
    pub left_out: Option<String>,
}

/// Result of a method.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MethodResult {
    /// The measure of the accepted cells.
    pub sum_grid: f64,
    /// The Sum; corrected if the method draws samples.
    pub sum: f64,
    /// Its 95 % interval, if there is one.
    pub sum_ci95: Option<[f64; 2]>,
    /// Edge of the ONAA cube.
    pub onaa_edge: Option<f64>,
    /// Wall-clock time, in seconds.
    pub seconds: f64,
}

/// Agreement of two methods.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PairAgreement {
    /// Share of the cells that both accept or both reject.
    pub agreement: f64,
    /// Jaccard index: cells accepted by both, divided by cells accepted by either.
    pub jaccard: f64,
}

/// Why a method has no result.
#[derive(Debug, thiserror::Error)]
enum LeftOut {
    /// It is not made for the design.
    #[error("{reason}")]
    NotApplicable { reason: String },
    /// It takes too long.
    #[error("it takes longer than the {} s allowed", limit.as_secs_f64())]
    Time { limit: Duration },
    /// It gave up.
    #[error(transparent)]
    Run(RunError),
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
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] catchment_core::exec::Cancelled),
}

/// Default cells per axis of a grid shared by several methods, for one to five axes: affordable for exact
/// descent, and even, which keeps cells off the mirror planes, at which transport is weak.
pub fn even_cells(problem: &Problem) -> [usize; 5] {
    let odd = descent::DescentSettings::default().default_cells(problem.pair());
    odd.map(|cells| (cells - 1).max(Resolution::LEAST))
}

/// Decides a problem by every method.
///
/// # Errors
/// The resolution does not suit the problem, or the computation was cancelled.
pub fn run(
    problem: &Problem,
    settings: &AgreementSettings,
    exec: &Exec,
) -> Result<Agreement, AgreementError> {
    let grid = settings.resolution.grid(problem.alignment(), &even_cells(problem))?;
    let resolution = Resolution::of(&grid);
    let total = settings.methods.len() as f64;
    let mut methods = Vec::with_capacity(settings.methods.len());
    let mut decided: Vec<Acceptance> = Vec::new();
    let mut unit = String::new();
    for (k, method) in settings.methods.iter().enumerate() {
        let part = exec.part([k as f64 / total, (k + 1) as f64 / total], "methods");
        let run = Run {
            over: Over::Grid(resolution),
            sample: settings.sample,
            seed: settings.seed,
            ..Run::by(method.clone())
        };
        let answer = within(&run, problem, settings.time_limit, &part);
        // A requested stop ends the study, also if the method only failed because of it.
        exec.check()?;
        let (result, left_out) = match answer {
            Ok(answer) => {
                unit = answer.unit();
                let result = MethodResult::from(&answer);
                decided.push(answer.acceptance);
                (Some(result), None)
            }
            Err(reason) => (None, Some(reason.to_string())),
        };
        methods.push(ComparedMethod { method: method.name(), result, left_out });
    }
    let between = |a: &Acceptance, b: &Acceptance| -> Result<PairAgreement, AgreementError> {
        let paired = Paired::of(a, b)?;
        let overlap = AcceptanceOverlap::of(&confusion(&paired.first, &paired.second, exec)?);
        Ok(PairAgreement { agreement: overlap.agreement(), jaccard: overlap.jaccard() })
    };
    let agreement = decided
        .iter()
        .map(|a| decided.iter().map(|b| between(a, b)).collect())
        .collect::<Result<_, AgreementError>>()?;
    let time_limit_s = settings.time_limit.as_secs_f64();
    Ok(Agreement { cells: grid.shape(), time_limit_s, unit, methods, agreement })
}

impl Agreement {
    /// The methods that came to a result, with it.
    pub fn results(&self) -> impl Iterator<Item = (&'static str, &MethodResult)> {
        self.methods.iter().filter_map(|decided| Some((decided.method, decided.result.as_ref()?)))
    }
}

impl From<&Answer> for MethodResult {
    fn from(answer: &Answer) -> Self {
        Self {
            sum_grid: answer.merits.sum.sum,
            sum: answer.sum(),
            sum_ci95: answer.sum_ci95(),
            onaa_edge: answer.onaa().map(|onaa| onaa.edge),
            seconds: answer.seconds,
        }
    }
}

/// Runs a method, unless it does not apply or takes too long.
fn within(run: &Run, problem: &Problem, limit: Duration, exec: &Exec) -> Result<Answer, LeftOut> {
    let timed = exec.clone().with_time_limit(limit);
    run.on(problem, &timed).map_err(|error| match error {
        RunError::NotApplicable(refusal) => LeftOut::NotApplicable { reason: refusal.reason },
        _ if timed.is_cancelled() && !exec.is_cancelled() => LeftOut::Time { limit },
        error => LeftOut::Run(error),
    })
}
