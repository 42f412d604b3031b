//! Comparison of two acceptances from any source.
//!
//! ```text
//!   a stored result ──▶ read ─────────┐
//!   a problem and a run ──▶ decided ──┼──▶ the cells that both have ──▶ overlap, confusions, distances, picture
//!   (over the other's cells)          ┘
//! ```

use super::comparison::{Compared as Side, ComparisonBody, ComparisonReport};
use super::folder::RESULT;
use super::schema::{Timing, axes};
use super::zarr::{self, ZarrError};
use super::{Report, figure};
use catchment_core::acceptance::Acceptance;
use catchment_core::exec::{Exec, Stopwatch};
use catchment_core::landscape::{Grid, Resolution, ResolutionError};
use catchment_core::merit::MeritError;
use catchment_core::merit::comparison::{Comparison, ComparisonError, Paired};
use catchment_core::problem::Problem;
use catchment_core::run::{Over, Run, RunError};
use catchment_study::agreement::even_cells;
use std::path::{Path, PathBuf};

/// One side of a comparison.
#[derive(Debug)]
pub enum ComparisonSource {
    /// A result that was stored: its folder or its group.
    Stored(PathBuf),
    /// A problem to be decided; the resolution of the run is ignored.
    Fresh {
        /// Its source, for people.
        source: String,
        /// The problem.
        problem: Box<Problem>,
        /// How it is decided.
        run: Box<Run>,
    },
}

/// Why the two cannot be compared.
#[derive(Debug, thiserror::Error)]
pub enum CompareError {
    /// A stored result cannot be read.
    #[error(transparent)]
    Zarr(#[from] ZarrError),
    /// A resolution does not suit a problem.
    #[error("{subject}: {error}")]
    Resolution {
        /// Source of the problem.
        subject: String,
        /// Why not.
        error: ResolutionError,
    },
    /// A problem has no answer.
    #[error(transparent)]
    Run(#[from] RunError),
    /// They have nothing in common.
    #[error("cannot compare {first} with {second}: {error}")]
    Apart {
        /// Source of the first.
        first: String,
        /// Source of the second.
        second: String,
        /// Why not.
        error: ComparisonError,
    },
    /// A figure of merit cannot be computed.
    #[error(transparent)]
    Merit(#[from] MeritError),
    /// The accepted sets cannot be compared.
    #[error(transparent)]
    Comparison(#[from] ComparisonError),
    /// The picture would not fit into memory.
    #[error(transparent)]
    OutOfBudget(#[from] catchment_core::exec::OutOfBudget),
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] catchment_core::exec::Cancelled),
}

/// The comparison, and its picture if there is something to draw.
#[derive(Debug)]
pub struct ComparisonResult {
    /// The report.
    pub report: ComparisonReport,
    /// The differences as a picture, if requested; or the reason why it cannot be drawn.
    pub picture: Option<Result<figure::Picture, figure::FigureError>>,
}

/// Compares two sources. Problems are decided over the cells of a stored result if there is one, else over
/// `resolution`, else over an even number of cells that exact descent can afford.
///
/// # Errors
/// See [`CompareError`].
pub fn compare(
    sources: [ComparisonSource; 2],
    resolution: Option<Resolution>,
    picture: bool,
    exec: &Exec,
) -> Result<ComparisonResult, CompareError> {
    let started = Stopwatch::start();
    // Read stored results first: problems are computed on their grid.
    let mut sides: [Option<(Side, Acceptance)>; 2] = [None, None];
    for (side, source) in sides.iter_mut().zip(&sources) {
        if let ComparisonSource::Stored(path) = source {
            let (report, acceptance) = zarr::read(&group(path), exec)?;
            *side = Some((Side { source: path.display().to_string(), report }, acceptance));
        }
    }
    let stored = sides.iter().flatten().find_map(|(side, _)| as_resolution(&side.report));
    let cells = resolution.or(stored).unwrap_or_default();
    if picture {
        // The cells that both have are no more than those of either.
        let grids =
            sources.iter().filter_map(|source| planned(source, cells)).collect::<Result<Vec<_>, _>>()?;
        let fits = grids.iter().map(|grid| figure::ensure_grid_fits(grid, exec));
        fits.reduce(Result::or).unwrap_or(Ok(()))?;
    }
    let mut decided = Vec::with_capacity(2);
    for (k, (side, source)) in sides.into_iter().zip(sources).enumerate() {
        let part = exec.part([0.5 * k as f64, 0.5 * (k + 1) as f64], "comparing");
        decided.push(match (side, source) {
            (Some(stored), _) => stored,
            (None, ComparisonSource::Fresh { source, problem, run }) => {
                decide(source, &problem, &run, cells, &part)?
            }
            (None, ComparisonSource::Stored(path)) => {
                return Err(ZarrError::Content { path, reason: "it was not read".to_owned() }.into());
            }
        });
    }
    let [(first, a), (second, b)] = &decided[..] else {
        return Err(MeritError::NotAGrid.into());
    };
    let paired = Paired::of(a, b).map_err(|error| CompareError::Apart {
        first: first.source.clone(),
        second: second.source.clone(),
        error,
    })?;
    let comparison = Comparison::of(&paired, &first.report.design.alignment, exec)?;
    if let (true, Some(grid)) = (picture, paired.first.grid()) {
        // Of two stored results nothing was known before.
        figure::ensure_grid_fits(grid, exec)?;
    }
    let picture = picture.then(|| {
        let names = names([first, second]);
        let names = names.each_ref().map(String::as_str);
        figure::difference(&first.report.design, &paired, &comparison, names)
    });
    let timing = Timing { total_s: started.seconds(), threads: exec.threads() };
    let axes = axes(&paired.first);
    let body = ComparisonBody { first: first.clone(), second: second.clone(), axes, comparison };
    let report = ComparisonReport::of(body, Vec::new(), Some(timing));
    Ok(ComparisonResult { report, picture })
}

/// The Zarr group of a path: the group in the folder of a run, or the path itself.
pub fn group(path: &Path) -> PathBuf {
    let inside = path.join(RESULT);
    if inside.is_dir() { inside } else { path.to_owned() }
}

/// The cells of a stored result, for a problem beside it.
fn as_resolution(report: &Report) -> Option<Resolution> {
    report.axes.iter().try_fold(Resolution::default(), |all, axis| all.with(axis.axis, axis.cells).ok())
}

/// The grid that a problem will be decided on; `None` of a stored result.
fn planned(from: &ComparisonSource, cells: Resolution) -> Option<Result<Grid, CompareError>> {
    let ComparisonSource::Fresh { source, problem, .. } = from else { return None };
    Some(grid_of(source, problem, cells))
}

fn grid_of(source: &str, problem: &Problem, cells: Resolution) -> Result<Grid, CompareError> {
    cells
        .grid(problem.alignment(), &even_cells(problem))
        .map_err(|error| CompareError::Resolution { subject: source.to_owned(), error })
}

/// Decides a problem, as a run does.
fn decide(
    source: String,
    problem: &Problem,
    run: &Run,
    cells: Resolution,
    exec: &Exec,
) -> Result<(Side, Acceptance), CompareError> {
    let grid = grid_of(&source, problem, cells)?;
    let answer = Run { over: Over::Grid(Resolution::of(&grid)), ..run.clone() }.on(problem, exec)?;
    let mut report = Report::of_answer(&answer);
    report.timing = None;
    Ok((Side { source, report }, answer.acceptance))
}

/// Distinguishing names of the two: the methods if the designs are equal, else the designs, else the files.
fn names(sides: [&Side; 2]) -> [String; 2] {
    let [a, b] = sides.map(|side| &side.report);
    if a.design == b.design && a.method != b.method {
        return [a, b].map(|report| report.method.clone());
    }
    if a.design.name != b.design.name {
        return [a, b].map(|report| format!("{} by {}", report.design.name, report.method));
    }
    sides.map(|side| format!("{} by {}", side.source, side.report.method))
}
