//! How many labels of confluence are wrong? Cells drawn at random, each beside the exact motion of its own centre.

use super::{AccuracyError, Case, SEEDS, problem};
use catchment::acceptance::{Domain, Outcome};
use catchment::exec::Exec;
use catchment::landscape::Grid;
use catchment::method::{DecideError, Method, descent};
use catchment::study::refinement::RefinementError;
use serde::Serialize;
use std::time::Instant;

/// Cells that are drawn at least, and so many more at a time until enough of them jam.
pub const DRAWN: usize = 200_000;
/// Jams of which a share of two percent is told from one: then no more are drawn.
const ENOUGH_JAMS: usize = 1000;
/// Times that cells are drawn at most.
const MOST_ROUNDS: usize = 8;

/// The labels of one design beside exact motions.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LabelAccuracy {
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

/// Labels the grid of a design, and draws `drawn` of its cells, again until enough of them jam.
pub(super) fn labels(
    case: &Case,
    resolution: usize,
    drawn: usize,
    exec: &Exec,
) -> Result<LabelAccuracy, AccuracyError> {
    let failed = |error: DecideError| AccuracyError::Refinement(RefinementError::from(error));
    let problem = problem(case)?;
    let grid = Grid::over(problem.alignment(), |_| resolution);
    let started = Instant::now();
    let decided = Method::default().decide(&problem, &Domain::Grid(grid.clone()), exec).map_err(failed)?;
    let mut labels = LabelAccuracy {
        name: case.name(),
        resolution,
        drawn: 0,
        accepted_wrong: 0,
        wrong: 0,
        jams: 0,
        jams_lost: 0,
        seconds: started.elapsed().as_secs_f64(),
    };
    let random = Domain::random(problem.alignment(), MOST_ROUNDS * drawn, SEEDS[0]);
    for round in 0..MOST_ROUNDS {
        let cells: Vec<usize> = (round * drawn..(round + 1) * drawn)
            .filter_map(|k| {
                let error = random.pose(k).to_array();
                let numbers = grid.axes.iter().map(|axis| axis.cell_of(error[axis.dof.index()]));
                numbers.collect::<Option<Vec<usize>>>().map(|numbers| grid.index(&numbers))
            })
            .collect();
        let centres = Domain::Poses(cells.iter().map(|cell| grid.pose(*cell)).collect());
        let (exact, _) = descent::run(problem.pair(), centres, &descent::DescentSettings::default(), exec)
            .map_err(|error| failed(error.into()))?;
        for (cell, own) in cells.iter().zip(&exact.outcomes) {
            labels.count(decided.acceptance.outcomes[*cell], *own);
        }
        if labels.jams >= ENOUGH_JAMS {
            break;
        }
    }
    Ok(labels)
}

impl LabelAccuracy {
    /// Counts a cell with this label, whose centre has an outcome of its own.
    fn count(&mut self, label: Outcome, own: Outcome) {
        let is_jam = own == Outcome::Jammed;
        self.drawn += 1;
        self.wrong += usize::from(label != own);
        self.accepted_wrong += usize::from((label == Outcome::Aligned) != (own == Outcome::Aligned));
        self.jams += usize::from(is_jam);
        self.jams_lost += usize::from(is_jam && label != own);
    }
}
