//! The discrete method: flooding of the height landscape over the error grid (Meyer 1994; the dissertation's
//! chapter 5).
//!
//! ```text
//!    ╲      dam       ╱     water rises from every minimum at once; a cell that two waters reach
//!     ╲    ╱│╲       ╱      is a dam; a basin shallower than the tolerance joins the one across
//!      ╲~~╱ │ ╲~~~~~╱       its lowest dam; the area of acceptance is the basin of the mated pose
//!       ╲╱  │  ╲___╱
//!      jam  │  mated
//! ```
//!
//! 1. Minima: connected sets of equal cells without a lower neighbour, in the full neighbourhood (3ⁿ − 1 cells).
//!    Cells without contact are one basin of their own, the outside.
//! 2. Flooding by a priority queue: lowest cell first, first in first out among equals. A cell beside two basins
//!    becomes a dam and passes no water on.
//! 3. The shallowest basin below [`Settings::depth_tolerance`] joins the basin across its lowest boundary point,
//!    again and again.
//! 4. Every dam cell goes to the basin that its steepest descent leads to.
//!
//! The mated pose is lower than all around it. Where it falls between cell centres (an even number of cells),
//! the minima among the cells around it are therefore one minimum, and where none of these cells is a minimum, the
//! target is the basin of the lowest of them. If that basin, after merging, gathers deeper below the mated pose than
//! the tolerance, the mated pose does not hold and nothing is accepted.
//!
//! **Not guaranteed:** motion on a grid can only follow the grid's directions, so the border of a flooded basin does
//! not converge to the true one as the grid refines ([`Warning::FloodingBias`]). Against exact descent, the Sum of five
//! planar designs at 100 × 100 cells was off by +2, +2, +0.5, −5 and −24 %, and hardly better at 400 × 400.
//! Nothing is known of what lies beyond the error box: a basin whose minimum lies on a border of x or y counts as
//! missed (the halves slide off), one on a border of a rotation as jammed.

mod basins;
pub mod brute;
mod dams;
pub mod dissertation;
mod merge;
mod neighbourhood;
mod target;
#[cfg(test)]
mod tests;

use crate::acceptance::{Acceptance, Domain, Outcome, Warning};
use crate::contact::Pair;
use crate::exec::{Cancelled, Exec, OutOfBudget};
use crate::landscape::{Grid, Landscape, LandscapeError, Resolution};
pub use basins::Rules;
use basins::{Height, LABEL_LIMIT, OUTSIDE};
use merge::Merged;
use neighbourhood::Neighbourhood;
use serde::{Deserialize, Serialize};

/// What changes the answer.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// Basins shallower than this are merged, in D. 0 keeps every minimum.
    pub depth_tolerance: f64,
}

impl Settings {
    /// Default depth tolerance as a share of the height of the mating face.
    pub const DEPTH_PER_FACE_HEIGHT: f64 = 0.1;

    /// The default for a pair: a tenth of the height H of its mating face. H is how deep the mated halves reach into
    /// each other, which is `aspect_ratio` for every family and is defined for a person's own halves too.
    pub fn for_pair(pair: &Pair) -> Self {
        let z = |v: &glam::DVec3| v.z;
        let vertices = |half: &'_ crate::connector::Half| -> Vec<f64> {
            half.surfaces.iter().flat_map(|s| s.vertices.iter().map(z)).collect()
        };
        let highest = vertices(&pair.fixed).into_iter().fold(f64::NEG_INFINITY, f64::max);
        let lowest = vertices(&pair.moving).into_iter().fold(f64::INFINITY, f64::min);
        let face_height = highest - (lowest - pair.alignment.center_of_rotation);
        Self { depth_tolerance: Self::DEPTH_PER_FACE_HEIGHT * face_height.max(0.0) }
    }
}

/// Why nothing was flooded.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FloodError {
    /// The tolerance is no depth.
    #[error("a depth tolerance of {depth} is no depth; give a length of at least 0")]
    Tolerance {
        /// What was given, in D.
        depth: f64,
    },
    /// More cells than a basin number can tell apart.
    #[error("{cells} cells are more than flooding can number ({LABEL_LIMIT}); lower the resolution")]
    TooManyCells {
        /// How many.
        cells: usize,
    },
    /// No heights.
    #[error(transparent)]
    Landscape(#[from] LandscapeError),
    /// It does not fit into memory.
    #[error(transparent)]
    OutOfBudget(#[from] OutOfBudget),
    /// It was asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// A basin after merging.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Basin {
    /// The lowest cell.
    pub minimum: usize,
    /// Its height, in D; −∞ for the basin of all cells without contact.
    pub height: f64,
    /// How far the water must rise above the minimum to run over into another basin, in D: how hard this
    /// equilibrium is to shake loose. Infinite for the only basin.
    pub depth: f64,
    /// How many cells drain to it.
    pub cells: usize,
    /// What becomes of them.
    pub outcome: Outcome,
}

/// The result of flooding.
#[derive(Debug, Clone, PartialEq)]
pub struct Flooding {
    /// Outcome of every cell.
    pub acceptance: Acceptance,
    /// The basins, those with the most cells first.
    pub basins: Vec<Basin>,
}

/// Heights of `pair` over `grid`, flooded.
///
/// # Errors
/// When the grid does not suit the pair, does not fit into memory, or the computation is cancelled.
pub fn accept(pair: &Pair, grid: &Grid, settings: &Settings, exec: &Exec) -> Result<Acceptance, FloodError> {
    let cells = grid.checked_len().unwrap_or(usize::MAX) as u64;
    reserve(cells, Landscape::bytes(1), grid.axes.len(), exec)?;
    let landscape = Landscape::compute(pair, grid, exec)?;
    Ok(flood(&landscape, &pair.alignment, settings, exec)?.acceptance)
}

/// Floods a landscape.
///
/// # Errors
/// When the tolerance is no depth, the landscape is too large, or the computation is cancelled.
pub fn flood(
    landscape: &Landscape,
    alignment: &crate::design::Alignment,
    settings: &Settings,
    exec: &Exec,
) -> Result<Flooding, FloodError> {
    let Landscape { grid, heights } = landscape;
    if !(settings.depth_tolerance >= 0.0 && settings.depth_tolerance.is_finite()) {
        return Err(FloodError::Tolerance { depth: settings.depth_tolerance });
    }
    if heights.len() >= LABEL_LIMIT as usize {
        return Err(FloodError::TooManyCells { cells: heights.len() });
    }
    reserve(heights.len() as u64, 0, grid.axes.len(), exec)?;
    let targets = target::cells(grid, alignment);
    let around = Neighbourhood::new(&grid.shape());
    let tolerance = settings.depth_tolerance;
    let mut parts = divide(heights, &around, &targets, tolerance, Rules::default(), exec)?;
    dams::assign(heights, &around, &mut parts.labels);
    Ok(verdict(grid, heights, &targets, &parts))
}

/// Bytes per cell that flooding needs at most, beside the heights: a label, an outcome, and a place in the queue.
const BYTES_PER_CELL: u64 = (size_of::<u32>() + size_of::<Outcome>() + size_of::<(f32, u32, u32)>()) as u64;

/// Bytes that flooding `cells` cells needs at most, heights included.
pub const fn bytes(cells: u64) -> u64 {
    cells.saturating_mul(BYTES_PER_CELL + Landscape::bytes(1))
}

fn reserve(cells: u64, heights: u64, axes: usize, exec: &Exec) -> Result<(), OutOfBudget> {
    let per_cell = BYTES_PER_CELL + heights;
    exec.reserve("flooding", cells.saturating_mul(per_cell), |budget| {
        let largest = Resolution::largest_that_fits(budget, per_cell, axes);
        format!("use at most --resolution {largest}")
    })
}

/// Every cell's basin, after merging.
struct Parts {
    /// The basin number of every cell, before merging.
    labels: Vec<u32>,
    /// The lowest cell of every basin before merging.
    minima: Vec<Option<usize>>,
    merged: Merged,
    tolerance: f64,
}

/// Minima, flooding and merging; dam cells have no basin yet.
fn divide<H: Height>(
    heights: &[H],
    around: &Neighbourhood,
    targets: &[usize],
    tolerance: f64,
    rules: Rules,
    exec: &Exec,
) -> Result<Parts, Cancelled> {
    let flooded = basins::flood(heights, around, targets, rules, exec)?;
    let bottoms =
        flooded.minima.iter().map(|m| m.map_or(f64::INFINITY, |cell| heights[cell].into())).collect();
    let passes = merge::passes(heights, around, &flooded);
    let merged = merge::merge(bottoms, passes, tolerance);
    Ok(Parts { labels: flooded.labels, minima: flooded.minima, merged, tolerance })
}

/// The number of the basin that gathers at the mated pose: the one that holds the lowest cell around it, unless that
/// has joined a basin which gathers lower than the tolerance can explain.
fn target_basin(heights: &[f32], targets: &[usize], parts: &Parts) -> Option<u32> {
    let lower = |a: usize, b: usize| if heights[b] < heights[a] { b } else { a };
    let cell = targets.iter().copied().reduce(lower)?;
    let basin = *parts.merged.into.get(parts.labels[cell] as usize)?;
    let gathers_at = parts.merged.bottom[basin as usize];
    (f64::from(heights[cell]) - gathers_at <= parts.tolerance).then_some(basin)
}

fn verdict(grid: &Grid, heights: &[f32], targets: &[usize], parts: &Parts) -> Flooding {
    let Parts { labels, minima, merged, .. } = parts;
    let target = target_basin(heights, targets, parts);
    let outside = merged.into[OUTSIDE as usize];
    let mut found: Vec<Option<Basin>> = vec![None; minima.len()];
    for (number, minimum) in minima.iter().enumerate() {
        let Some(minimum) = *minimum else { continue };
        let last = merged.into[number];
        let slot = &mut found[last as usize];
        let lower = slot.is_none_or(|basin| f64::from(heights[minimum]) < basin.height);
        if lower {
            *slot = Some(Basin {
                minimum,
                height: heights[minimum].into(),
                depth: merged.depth[last as usize],
                cells: 0,
                outcome: Outcome::Jammed,
            });
        }
    }
    let mut border_cells = 0;
    for label in labels {
        let last = merged.into.get(*label as usize).map(|n| *n as usize);
        if let Some(basin) = last.and_then(|n| found[n].as_mut()) {
            basin.cells += 1;
        }
    }
    for (number, basin) in found.iter_mut().enumerate() {
        let Some(basin) = basin else { continue };
        let (translation, rotation) = on_border(grid, basin.minimum);
        basin.outcome = if number as u32 == outside && minima[OUTSIDE as usize].is_some() {
            Outcome::Missed
        } else if Some(number as u32) == target {
            Outcome::Aligned
        } else {
            border_cells += if translation || rotation { basin.cells } else { 0 };
            if translation { Outcome::Missed } else { Outcome::Jammed }
        };
    }
    let outcome_of = |label: &u32| {
        let last = merged.into.get(*label as usize).map(|n| *n as usize);
        last.and_then(|n| found[n]).map_or(Outcome::Undecided, |basin| basin.outcome)
    };
    let outcomes: Vec<Outcome> = labels.iter().map(outcome_of).collect();
    let warnings = warnings(grid, &outcomes, targets, border_cells);
    let mut basins: Vec<Basin> = found.into_iter().flatten().collect();
    basins.sort_by(|a, b| b.cells.cmp(&a.cells).then(a.minimum.cmp(&b.minimum)));
    Flooding {
        acceptance: Acceptance { method: "flood", domain: Domain::Grid(grid.clone()), outcomes, warnings },
        basins,
    }
}

/// Whether a cell lies on a border of a translation, and of a rotation.
fn on_border(grid: &Grid, index: usize) -> (bool, bool) {
    let cell = grid.cell(index);
    let at = |rotation: bool| {
        grid.axes
            .iter()
            .zip(&cell)
            .any(|(a, k)| a.dof.is_rotation() == rotation && (*k == 0 || k + 1 == a.cells))
    };
    (at(false), at(true))
}

fn warnings(grid: &Grid, outcomes: &[Outcome], targets: &[usize], border_cells: usize) -> Vec<Warning> {
    let mut warnings = vec![Warning::FloodingBias];
    if targets.is_empty() || targets.iter().all(|t| outcomes[*t] != Outcome::Aligned) {
        warnings.push(Warning::MatedPoseNotAccepted);
    }
    let axes = touched_axes(grid, outcomes);
    if !axes.is_empty() {
        warnings.push(Warning::TouchesBorder { axes });
    }
    if border_cells > 0 {
        let share = 100.0 * border_cells as f64 / outcomes.len() as f64;
        warnings.push(Warning::Note {
            text: format!(
                "{share:.1} % of the poses drain to the border of the error box, beyond which nothing was sampled; \
                 they count as missed at a border of x or y, as jammed at one of an angle"
            ),
        });
    }
    let undecided = outcomes.iter().filter(|o| **o == Outcome::Undecided).count();
    if undecided > 0 {
        warnings.push(Warning::Undecided { cells: undecided });
    }
    warnings
}

/// Names of the axes at whose border a cell is accepted.
fn touched_axes(grid: &Grid, outcomes: &[Outcome]) -> Vec<String> {
    let mut names = Vec::new();
    let mut stride = 1;
    for axis in &grid.axes {
        let at_border = |index: usize| {
            let k = index / stride % axis.cells;
            k == 0 || k + 1 == axis.cells
        };
        if outcomes.iter().enumerate().any(|(index, o)| *o == Outcome::Aligned && at_border(index)) {
            names.push(axis.dof.name().to_owned());
        }
        stride *= axis.cells;
    }
    names
}
