//! Error of each method: the same designs by every method at several resolutions, compared with the exact
//! Sum.
//!
//! ```text
//!   error = Sum of the method / exact Sum − 1       exact: the finest grid of confluence, corrected by a large random sample
//! ```
//!
//! If a method's error is smaller than the interval of the exact Sum, this table gives only an upper bound on
//! it.
//!
//! Not promised: that other designs are as easy or as hard; that exact means real: all methods omit friction, speed
//! and mass.

mod cases;
mod labels;

pub use cases::{CASES, Case, LABELLED};
pub use labels::{DRAWN, LabelAccuracy};

use catchment::exec::Exec;
use catchment::method::Method;
use catchment::method::correction::{self, Stop};
use catchment::problem::{Problem, ProblemError};
use catchment::study::refinement::{GridDecision, RefinementError};
use serde::{Serialize, Serializer};
use std::time::Instant;

/// The exact Sum.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ExactSum {
    /// The estimate.
    pub sum: f64,
    /// Unit of this and of all compared Sums, like `D²·rad³`.
    pub unit: String,
    /// Its 95 % interval.
    pub ci95: [f64; 2],
    /// Random poses followed exactly.
    pub descents: usize,
}

/// Source of a Sum.
#[derive(Debug, Clone, PartialEq)]
pub enum SumSource {
    /// The grid of a method alone.
    Grid(Method),
    /// Confluence, corrected with the number of exact descents that `run` uses.
    Corrected,
}

/// One method at one resolution.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AccuracyEntry {
    /// The method.
    pub way: SumSource,
    /// Cells per axis.
    pub resolution: usize,
    /// Cells of the grid.
    pub cells: usize,
    /// The Sum, Dᵃ·radᵇ.
    pub sum: f64,
    /// `sum / exact − 1`.
    pub error: f64,
    /// Half-width of the Sum's own 95 % interval, as a share of the exact Sum; null for grids, which have no
    /// interval.
    pub doubt: Option<f64>,
    /// Wall-clock time, in seconds.
    pub seconds: f64,
}

/// One design.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AccuracyRow {
    /// The design's name.
    pub name: String,
    /// Its free errors.
    pub free: Vec<&'static str>,
    /// The exact Sum.
    pub exact: ExactSum,
    /// By resolution, then by source.
    pub entries: Vec<AccuracyEntry>,
}

/// The table.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Accuracy {
    /// Seed of the exact values' random poses.
    pub seed: u64,
    /// One per design.
    pub rows: Vec<AccuracyRow>,
    /// Labels of single cells compared with exact motions, one entry per design.
    pub labels: Vec<LabelAccuracy>,
}

/// Reasons why the table fails.
#[derive(Debug, thiserror::Error)]
pub enum AccuracyError {
    /// A design of the list cannot be built.
    #[error("{name} cannot be built: {problem}")]
    Geometry {
        /// The design.
        name: String,
        /// The defect.
        problem: String,
    },
    /// A method failed.
    #[error(transparent)]
    Refinement(#[from] RefinementError),
}

/// Seeds of the exact values, and of the corrected Sums that are compared with them.
const SEEDS: [u64; 2] = [1, 2];

/// Random poses of an exact value.
const EXACT: usize = 100_000;

impl Serialize for SumSource {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

impl SumSource {
    /// All sources, in the order of the table.
    pub fn all() -> Vec<Self> {
        Method::on_grids().into_iter().map(Self::Grid).chain([Self::Corrected]).collect()
    }

    /// Its name in tables.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Grid(method) => method.name(),
            Self::Corrected => "corrected",
        }
    }
}

/// Maximum number of grid cells that descent follows: more would take an hour.
const FOLLOWED: usize = 400_000;

/// Computes the table of some designs, [`CASES`], and the labels of others, [`LABELLED`], with at least `drawn` cells of each: all of them
/// take a quarter of an hour.
///
/// # Errors
/// See [`AccuracyError`].
pub fn run(
    cases: &[Case],
    labelled: &[(Case, usize)],
    drawn: usize,
    exec: &Exec,
) -> Result<Accuracy, AccuracyError> {
    let share = |k: usize| k as f64 / (cases.len() + labelled.len()) as f64;
    let rows = cases
        .iter()
        .enumerate()
        .map(|(k, case)| row(case, &exec.part([share(k), share(k + 1)], "accuracy")))
        .collect::<Result<Vec<AccuracyRow>, _>>()?;
    let labels = labelled
        .iter()
        .enumerate()
        .map(|(k, (case, resolution))| {
            let span = [share(cases.len() + k), share(cases.len() + k + 1)];
            labels::labels(case, *resolution, drawn, &exec.part(span, "accuracy"))
        })
        .collect::<Result<Vec<LabelAccuracy>, _>>()?;
    Ok(Accuracy { seed: SEEDS[0], rows, labels })
}

fn problem(case: &Case) -> Result<Problem, AccuracyError> {
    let unfit =
        |problem: ProblemError| AccuracyError::Geometry { name: case.name(), problem: problem.to_string() };
    Problem::of(case.design()).map_err(unfit)
}

fn row(case: &Case, exec: &Exec) -> Result<AccuracyRow, AccuracyError> {
    let problem = problem(case)?;
    let mut entries = Vec::new();
    let mut finest = None;
    for resolution in case.resolutions() {
        for method in Method::on_grids() {
            if method.name() == "descent" && resolution.pow(case.free.len() as u32) > FOLLOWED {
                continue;
            }
            let sampled = GridDecision::by(&method, &problem, resolution, exec)?;
            entries.push(AccuracyEntry::of(&sampled, &method, &problem, exec)?);
            if method == Method::default() {
                entries.push(AccuracyEntry::corrected(&sampled, &method, &problem, exec)?);
                finest = Some(sampled);
            }
        }
    }
    entries
        .sort_by_key(|entry| (entry.resolution, SumSource::all().iter().position(|way| *way == entry.way)));
    let mut exact = ExactSum { sum: 0.0, unit: String::new(), ci95: [0.0; 2], descents: 0 };
    if let Some(sampled) = finest {
        let settings = correction::CorrectionSettings { seed: SEEDS[0], stop: Stop::Samples(EXACT) };
        let result = sampled.correct(&problem, &settings, exec).map_err(RefinementError::from)?;
        let unit = sampled.refinement(&problem, exec)?.unit;
        exact = ExactSum { sum: result.sum, unit, ci95: result.ci95, descents: result.descents };
    }
    for entry in &mut entries {
        entry.error = entry.sum / exact.sum - 1.0;
        entry.doubt = entry.doubt.map(|half| half / exact.sum);
    }
    let free = case.free.iter().map(|dof| dof.name()).collect();
    Ok(AccuracyRow { name: case.name(), free, exact, entries })
}

impl AccuracyEntry {
    /// The grid's own Sum; its error is not yet known.
    fn of(
        sampled: &GridDecision,
        method: &Method,
        problem: &Problem,
        exec: &Exec,
    ) -> Result<Self, RefinementError> {
        let result = sampled.refinement(problem, exec)?;
        Ok(Self {
            way: SumSource::Grid(method.clone()),
            resolution: result.resolution,
            cells: result.cells,
            sum: result.sum,
            error: f64::NAN,
            doubt: None,
            seconds: result.seconds,
        })
    }

    /// The same grid, corrected.
    fn corrected(
        sampled: &GridDecision,
        method: &Method,
        problem: &Problem,
        exec: &Exec,
    ) -> Result<Self, RefinementError> {
        let started = Instant::now();
        let descents = method.default_samples(problem.pair());
        let settings = correction::CorrectionSettings { seed: SEEDS[1], stop: Stop::Samples(descents) };
        let result = sampled.correct(problem, &settings, exec)?;
        let grid = Self::of(sampled, method, problem, exec)?;
        Ok(Self {
            way: SumSource::Corrected,
            sum: result.sum,
            doubt: Some(0.5 * (result.ci95[1] - result.ci95[0])),
            seconds: grid.seconds + started.elapsed().as_secs_f64(),
            ..grid
        })
    }
}
