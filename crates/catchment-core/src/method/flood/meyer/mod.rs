//! Meyer's flooding with a priority queue, as in the dissertation (Meyer 1994; the dissertation's chapter 5).
//!
//! ```text
//!    ╲      dam       ╱     water rises from every minimum at once; a cell that water reaches from two basins
//!     ╲    ╱│╲       ╱      is a dam; a basin shallower than the tolerance is merged across
//!      ╲~~╱ │ ╲~~~~~╱       its lowest dam
//!       ╲╱  │  ╲___╱
//! ```
//!
//! 1. Minima: connected sets of equal cells without a lower neighbour, in the full neighbourhood (3ⁿ − 1
//!    cells). Cells without contact form a separate basin, the outside.
//! 2. Flooding by a priority queue: lowest cell first, first in first out among equals. A cell next to two
//!    basins becomes a dam and is not flooded through.
//! 3. The shallowest basin below the tolerance joins the basin across its lowest boundary point, repeatedly.
//! 4. Dam cells go to the basin of the neighbour of steepest descent.
//!
//! [`accept`] does all four on an error grid and gives the outcome of every cell; [`divide`] does the first
//! three on heights over any shape, for callers with their own rule for the fourth.
//!
//! **Cost:** every cell is taken from the queue once and visits all its 3ⁿ − 1 neighbours two or three times:
//! 8 in the plane, 242 over five errors. A single thread, O(N·(3ⁿ + log N)), about 40 bytes per cell besides
//! the heights, plus the passes between basins. [`flood`](super::flood) needs a fraction of both.
//!
//! **Not guaranteed:** that the accepted set converges as the grid is refined, see [`super`]; nor that ties
//! (plateaus, equal cells in the queue) are resolved equally for another order of the axes.

mod accept;
mod basins;
pub mod brute;
mod dams;
pub(in crate::method) mod entry;
mod merge;
pub(super) mod neighbourhood;
#[cfg(test)]
mod tests;

use super::drain::LABEL_LIMIT;
use super::{FloodError, Watersheds};
use crate::exec::Exec;
use crate::method::flood;
pub use accept::{MeyerFlooding, MeyerSettings, accept, bytes};
pub use basins::{Height, Rules};
use basins::{OUTSIDE, is_basin};
use merge::Merged;
use neighbourhood::Neighbourhood;

/// A landscape divided into basins: every cell belongs to a basin, or is a dam.
#[derive(Debug, Clone)]
pub struct Division {
    around: Neighbourhood,
    /// The basin number of every cell, before merging; dam cells have no basin.
    labels: Vec<u32>,
    /// The final basins.
    merged: Merged,
}

impl Division {
    /// The number of the merged basin that a cell belongs to; `None` for a dam.
    ///
    /// Numbers are those of the minima in the order of their first cells, from 2 on; 1 is the outside. A basin that others
    /// have joined keeps its own.
    pub fn basin(&self, cell: usize) -> Option<u32> {
        let label = self.labels[cell];
        is_basin(label).then(|| self.merged.into[label as usize])
    }

    /// Height of the lowest cell of a merged basin; −∞ for the outside.
    pub fn bottom(&self, basin: u32) -> f64 {
        self.merged.bottom[basin as usize]
    }

    /// Whether a basin is that of the cells without contact.
    pub const fn is_outside(basin: u32) -> bool {
        basin == OUTSIDE
    }

    /// The label of every cell before and after merging. Cells enclosed by dams are dams.
    pub fn watersheds(&self) -> Watersheds {
        let label = |label: &u32| if is_basin(*label) { *label } else { flood::DAM };
        let first = self.labels.iter().map(label).collect();
        Watersheds { first, into: self.merged.into.clone(), outside: Some(OUTSIDE) }
    }

    /// The cells around a cell, up to 3ⁿ − 1: in ascending order of their position along the last axis, then
    /// along the axis before.
    pub fn neighbours(&self, cell: usize) -> impl Iterator<Item = usize> + '_ {
        self.around.of(cell)
    }

    /// Gives every dam cell the basin of the neighbour of steepest descent (height difference by distance in cells), the
    /// lowest cells first; a cell of a plateau joins its lowest neighbour that has a basin. `heights` are those that were
    /// divided.
    pub fn give_dams<H: Height>(&mut self, heights: &[H]) {
        dams::assign(heights, &self.around, &mut self.labels);
    }
}

/// Minima, flooding and merging of heights over a grid.
///
/// `shape` has the cells per axis, the first axis fastest; `heights` a value for each cell, −∞ without
/// contact, never NaN. Minima that contain one of the cells `targets` are merged. Basins shallower than
/// `tolerance`, in the unit of the heights, are merged.
///
/// # Errors
/// If the shape is not that of the heights, there are too many cells, or the computation is cancelled.
pub fn divide<H: Height>(
    shape: &[usize],
    heights: &[H],
    targets: &[usize],
    tolerance: f64,
    rules: Rules,
    exec: &Exec,
) -> Result<Division, FloodError> {
    let fits = shape.len() <= Neighbourhood::MOST_AXES
        && neighbourhood::cells(shape) == Some(heights.len())
        && targets.iter().all(|cell| *cell < heights.len());
    if !fits {
        let most_axes = Neighbourhood::MOST_AXES;
        return Err(FloodError::Shape { shape: shape.to_vec(), heights: heights.len(), most_axes });
    }
    if heights.len() >= LABEL_LIMIT as usize {
        return Err(FloodError::TooManyCells { cells: heights.len() });
    }
    let around = Neighbourhood::new(shape);
    let flooded = basins::flood(heights, &around, targets, rules, exec)?;
    let bottoms =
        flooded.minima.iter().map(|m| m.map_or(f64::INFINITY, |cell| heights[cell].into())).collect();
    let passes = merge::passes(heights, &around, &flooded);
    let merged = merge::merge(bottoms, passes, tolerance);
    Ok(Division { around, labels: flooded.labels, merged })
}
