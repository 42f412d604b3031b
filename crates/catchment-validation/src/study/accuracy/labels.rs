//! How many labels of confluence are wrong? Cells drawn at random, each beside the exact motion of its own centre.

use super::{AccuracyError, Case, SEEDS, problem};
use catchment::acceptance::{Domain, Outcome};
use catchment::exec::Exec;
use catchment::landscape::Grid;
use catchment::method::{DecideError, Method, descent};
use catchment::study::refinement::RefinementError;
use serde::Serialize;
use std::time::Instant;

/// Cells that are drawn.
pub const DRAWN: usize = 200_000;

/// The labels of one design beside exact motions.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Labels {
    /// What it is.
    pub name: String,
    /// Cells per axis.
    pub resolution: usize,
    /// Cells that were drawn.
    pub drawn: usize,
    /// How many of them are accepted and should not be, or the other way round.
    pub accepted_wrong: usize,
    /// How many have another outcome than their motion, whichever.
    pub wrong: usize,
    /// How many jam by their own motion.
    pub jams: usize,
    /// How many of these are labelled otherwise.
    pub jams_lost: usize,
    /// Wall-clock time of all labels, in seconds.
    pub seconds: f64,
}

/// Labels the grid of a design, and draws `drawn` of its cells.
pub(super) fn labels(
    case: &Case,
    resolution: usize,
    drawn: usize,
    exec: &Exec,
) -> Result<Labels, AccuracyError> {
    let failed = |error: DecideError| AccuracyError::Refinement(RefinementError::from(error));
    let problem = problem(case)?;
    let grid = Grid::over(problem.alignment(), |_| resolution);
    let started = Instant::now();
    let decided = Method::default().decide(&problem, &Domain::Grid(grid.clone()), exec).map_err(failed)?;
    let seconds = started.elapsed().as_secs_f64();
    let random = Domain::random(problem.alignment(), drawn, SEEDS[0]);
    let cells: Vec<usize> = (0..drawn)
        .filter_map(|k| {
            let error = random.pose(k).to_array();
            let numbers = grid.axes.iter().map(|axis| axis.cell_of(error[axis.dof.index()]));
            numbers.collect::<Option<Vec<usize>>>().map(|numbers| grid.index(&numbers))
        })
        .collect();
    let centres = Domain::Poses(cells.iter().map(|cell| grid.pose(*cell)).collect());
    let (exact, _) = descent::run(problem.pair(), centres, &descent::Settings::default(), exec)
        .map_err(|error| failed(error.into()))?;
    let count = |test: &dyn Fn(Outcome, Outcome) -> bool| {
        let labels = cells.iter().map(|cell| decided.acceptance.outcomes[*cell]);
        labels.zip(&exact.outcomes).filter(|(label, own)| test(*label, **own)).count()
    };
    Ok(Labels {
        name: case.name(),
        resolution,
        drawn: cells.len(),
        accepted_wrong: count(&|label, own| (label == Outcome::Aligned) != (own == Outcome::Aligned)),
        wrong: count(&|label, own| label != own),
        jams: count(&|_, own| own == Outcome::Jammed),
        jams_lost: count(&|label, own| own == Outcome::Jammed && label != own),
        seconds,
    })
}
