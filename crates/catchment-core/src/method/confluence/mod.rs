//! Confluence: the outcome of every cell of a grid by exact motions, each followed only until it reaches
//! cells that are already decided.
//!
//! ```text
//!   ·   ·   ·   ·   ·        cells by rising potential energy. For each cell:
//!         ╲                    1  if the 2ⁿ centres ahead along the exact direction of descent are known and agree,
//!   ·   ·  ╲·   ·   ·             the cell inherits their outcome without a motion
//!           ╰─╮                2  if not, its exact motion, until it is among centres that agree
//!   a   a   a ▼ j   j          3  last, cells next to thin jams that inherited are followed to their end: a jam
//!   a   a   a   j   j             may be thinner than a cell
//! ```
//!
//! Lower cells are decided first, because a motion falls. Like rivers, motions flow together, so most are
//! followed for a fraction of their length, and not at all if a whole neighbourhood has the same outcome.
//! Cells are decided in batches that read only the results of earlier batches: the same bits for any number
//! of threads.
//!
//! A budget of motions or of time stops this early: lower cells are then decided, higher cells are undecided,
//! and no outcome is guessed.
//!
//! With friction ([`descent::DescentSettings::friction`]) the first of the three steps is skipped, because the
//! motion departs from the direction of descent.
//!
//! **Not guaranteed:** an inherited label may differ from the outcome of the centre's own motion if a feature
//! thinner than a cell lies between. [`InheritedLabels`] gives the rate: randomly sampled cells with inherited labels
//! are followed to their end. For 5-D grids of the pyramid and the 3-D X-Face it is one or two in ten
//! thousand. Outcomes hold at the centres of cells, not between two of them.
//!
//! Memory: 10 bytes per kept cell (energy, sides, order, label; [`DescentDirections`] keeps a half or a quarter of a
//! symmetric grid) and one per cell of the whole grid. Sources: cell mapping, Hsu 1980; interpolated, Tongue
//! 1987: here the map is the motion itself. Lengths in D, angles in radians.

pub(super) mod entry;
mod label;
mod labeller;
mod neighbours;
#[cfg(test)]
mod tests;

use super::descent;
use super::metric::Metric;
use crate::acceptance::{Acceptance, Domain, Outcome};
use crate::contact::Pair;
use crate::diagnostic::{Advice, Warning};
use crate::exec::{Cancelled, Exec, OutOfBudget, Stopwatch};
use crate::landscape::{DescentDirections, Fold, Gradient, Grid, Landscape, LandscapeError, Resolution};
use crate::pose::PoseError;
use label::Label;
use labeller::Labeller;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Settings that may change the result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct ConfluenceSettings {
    /// Share of the cell centres around a pose that must be decided, all with the same outcome, before the
    /// pose inherits it; above ½ and at most 1. Grids of up to three axes have at most eight such centres,
    /// and all must agree.
    pub known: f64,
    /// Number of motions after which no further batch of cells is started; cells not reached, the highest
    /// ones, are undecided. Default: no limit.
    pub motions: Option<usize>,
    /// Time limit in seconds from the start; progress within it depends on the machine. Heights are always
    /// computed.
    pub budget_s: Option<f64>,
    /// Settings of the exact motions.
    pub descent: descent::DescentSettings,
}

impl Default for ConfluenceSettings {
    fn default() -> Self {
        Self { known: 0.75, motions: None, budget_s: None, descent: descent::DescentSettings::default() }
    }
}

/// Why there are no labels.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ConfluenceError {
    /// More cells than can be numbered.
    #[error("{cells} cells are more than can be numbered ({}); lower the resolution", u32::MAX)]
    TooManyCells {
        /// How many.
        cells: usize,
    },
    /// The heights alone, which nothing cuts short, take longer than there is.
    #[error(
        "the heights of {cells} cells alone take about {seconds:.0} s here, and the grid may take {budget_s:.0} s of the budget: \
         give {most} cells per error at most (--resolution {most}), or more time"
    )]
    HeightsTakeLonger {
        /// How many cells.
        cells: usize,
        /// Their time, estimated from a few motions.
        seconds: f64,
        /// The time limit.
        budget_s: f64,
        /// The size that would fit.
        most: usize,
    },
    /// No heights.
    #[error(transparent)]
    Landscape(#[from] LandscapeError),
    /// It does not fit into memory.
    #[error(transparent)]
    OutOfBudget(#[from] OutOfBudget),
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Number of cells with an inherited label, and how often that label was wrong.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct InheritedLabels {
    /// Cells in contact; mirror images count once.
    pub cells: usize,
    /// Cells that inherited their label, during their motion or at its start.
    #[serde(alias = "joined")]
    pub inherited: usize,
    /// Motions that were followed, to their end or until they inherited a label.
    pub motions: usize,
    /// Cells with an inherited label that were sampled at random and followed to their end.
    pub tried: usize,
    /// Number of these cells whose exact outcome differs from their label.
    pub wrong: usize,
    /// 95 % interval of the share of misclassified cells among the inherited labels, in [0, 1].
    pub wrong_ci95: [f64; 2],
}

/// The outcome of every cell of a grid.
#[derive(Debug, Clone)]
pub struct GridLabels {
    grid: Grid,
    fold: Fold,
    kept: Vec<Label>,
    /// How they came about.
    pub inherited: InheritedLabels,
}

/// Labels every cell of `grid`.
///
/// # Errors
/// See [`ConfluenceError`].
pub fn run(
    pair: &Pair,
    grid: &Grid,
    settings: &ConfluenceSettings,
    exec: &Exec,
) -> Result<GridLabels, ConfluenceError> {
    let cells = grid.checked_len().unwrap_or(usize::MAX);
    if cells >= u32::MAX as usize {
        return Err(ConfluenceError::TooManyCells { cells });
    }
    let needed = bytes(pair, grid);
    exec.ensure_fits("the outcome of every cell", needed, |budget| {
        let per_cell = (needed / (cells as u64).max(1)).max(1) + 1;
        vec![Advice::AtMostResolution(Resolution::largest_that_fits(budget, per_cell, grid.axes.len()))]
    })?;
    if let Some(budget_s) = settings.budget_s {
        ensure_in_time(pair, grid, budget_s, exec)?;
    }
    let started = Stopwatch::start();
    let part = |from, to| exec.part([from, to], STAGE);
    let falls = DescentDirections::compute(pair, grid, &part(0.0, HEIGHTS_SHARE), |error: &PoseError| {
        let metric = Metric::new(pair, grid, error);
        move |gradient: &Gradient| metric.velocity(gradient)
    })?;
    let labeller = Labeller { pair, falls: &falls, settings, started };
    let (kept, inherited) = labeller.run(&part(HEIGHTS_SHARE, 1.0))?;
    let DescentDirections { grid, fold, .. } = falls;
    Ok(GridLabels { grid, fold, kept, inherited })
}

const STAGE: &str = "motions";
/// Share of the time that goes to the heights.
const HEIGHTS_SHARE: f64 = 0.1;

/// Heights may take so long whatever the budget, in seconds: less is not worth a refusal.
const PATIENCE_S: f64 = 1.0;

/// Refuses heights that would outlast the budget, by the rate of a slice with two cells per rotation.
fn ensure_in_time(pair: &Pair, grid: &Grid, budget_s: f64, exec: &Exec) -> Result<(), ConfluenceError> {
    let mut slice = grid.clone();
    slice
        .axes
        .iter_mut()
        .filter(|axis| axis.dof.is_rotation())
        .for_each(|axis| axis.cells = axis.cells.min(2));
    let kept = |grid: &Grid| {
        let cells = grid.checked_len().unwrap_or(usize::MAX);
        Fold::new(grid, pair.mirrors()).map_or(cells, |fold| fold.kept_cells())
    };
    let started = Stopwatch::start();
    Landscape::compute(pair, &slice, &exec.part([0.0, 0.0], STAGE))?;
    let seconds = started.seconds() * kept(grid) as f64 / slice.len() as f64;
    if seconds <= budget_s.max(PATIENCE_S) {
        return Ok(());
    }
    let axes = grid.axes.len() as f64;
    let cells = grid.len();
    let fits = (cells as f64 * budget_s.max(PATIENCE_S) / seconds).powf(1.0 / axes);
    Err(ConfluenceError::HeightsTakeLonger { cells, seconds, budget_s, most: (fits as usize / 2 * 2).max(2) })
}

/// Bytes that it takes at the peak, for a pair.
pub fn bytes(pair: &Pair, grid: &Grid) -> u64 {
    let cells = grid.checked_len().map_or(u64::MAX, |cells| cells as u64);
    let kept = Fold::new(grid, pair.mirrors()).map_or(cells, |fold| fold.kept_cells() as u64);
    let per_kept = DescentDirections::BYTES_PER_CELL + (size_of::<u32>() + size_of::<Label>()) as u64;
    kept.saturating_mul(per_kept).saturating_add(cells)
}

impl GridLabels {
    /// The grid.
    pub const fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Outcome of the centre of a cell.
    pub fn outcome(&self, cell: usize) -> Outcome {
        self.kept[self.fold.kept_cell(cell)].outcome()
    }

    /// Kept cells in contact that a budget did not reach.
    fn unreached(&self) -> usize {
        self.kept.par_iter().filter(|label| !label.is_known()).count()
    }

    /// The outcomes of all cells.
    pub fn acceptance(&self, exec: &Exec) -> Acceptance {
        let slab = self.fold.slab();
        let mut outcomes = vec![Outcome::Missed; self.grid.len()];
        exec.install(|| {
            outcomes.par_chunks_exact_mut(slab).enumerate().for_each(|(rotation, outcomes)| {
                for (lateral, outcome) in outcomes.iter_mut().enumerate() {
                    *outcome = self.outcome(rotation * slab + lateral);
                }
            });
        });
        // Of those that a budget did not reach the other warning speaks.
        let lost = |cell: &usize| {
            outcomes[*cell] == Outcome::Undecided && self.kept[self.fold.kept_cell(*cell)].is_known()
        };
        let cells = (0..outcomes.len()).into_par_iter().filter(lost).count();
        let mut warnings = if cells > 0 { vec![Warning::Undecided { cells }.into()] } else { Vec::new() };
        let (left, of) = (self.unreached(), self.inherited.cells);
        if left > 0 {
            let text = format!(
                "the budget was spent before {left} of {of} cells in contact were reached, mirror images counted once: they are undecided, and lie \
                 higher than those that were decided"
            );
            warnings.push(Warning::Open { text }.into());
        }
        Acceptance { method: entry::NAME, domain: Domain::Grid(self.grid.clone()), outcomes, warnings }
    }
}
