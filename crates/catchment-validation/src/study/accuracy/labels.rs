//! Misclassified labels of confluence: randomly drawn cells, each compared with the exact motion of its own
//! centre.

use super::{AccuracyError, Case, SEEDS, problem};
use catchment::acceptance::{Domain, Outcome};
use catchment::exec::Exec;
use catchment::landscape::Grid;
use catchment::method::{DecideError, Method, descent};
use catchment::study::refinement::RefinementError;
use serde::Serialize;
use std::time::Instant;

/// Cells per round of drawing, at least one round; further rounds follow until enough cells jam.
pub const DRAWN: usize = 200_000;
/// Number of jams that distinguishes a share of two percent from one percent; drawing stops there.
const ENOUGH_JAMS: usize = 1000;
/// Maximum number of rounds.
const MOST_ROUNDS: usize = 8;

/// The labels of one design compared with exact motions.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LabelAccuracy {
    /// The design's name.
    pub name: String,
    /// Cells per axis.
    pub resolution: usize,
    /// Cells that were drawn.
    pub drawn: usize,
    /// Number of cells whose accepted label contradicts the exact motion, in either direction.
    pub accepted_wrong: usize,
    /// Number of cells whose label differs from the exact outcome.
    pub wrong: usize,
    /// Number of cells that jam by exact motion.
    pub jams: usize,
    /// Number of these with a different label.
    pub jams_lost: usize,
    /// Wall-clock time of all labels, in seconds.
    pub seconds: f64,
}

/// Labels the grid of a design and draws `drawn` of its cells, repeatedly until enough of them jam.
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
    /// Counts a cell with this label and the exact outcome of its centre.
    fn count(&mut self, label: Outcome, own: Outcome) {
        let is_jam = own == Outcome::Jammed;
        self.drawn += 1;
        self.wrong += usize::from(label != own);
        self.accepted_wrong += usize::from((label == Outcome::Aligned) != (own == Outcome::Aligned));
        self.jams += usize::from(is_jam);
        self.jams_lost += usize::from(is_jam && label != own);
    }
}
