//! Meyer's flooding with a priority queue, as the dissertation has it (Meyer 1994; the dissertation's chapter 5).
//!
//! ```text
//!    ╲      dam       ╱     water rises from every minimum at once; a cell that two waters reach
//!     ╲    ╱│╲       ╱      is a dam; a basin shallower than the tolerance joins the one across
//!      ╲~~╱ │ ╲~~~~~╱       its lowest dam
//!       ╲╱  │  ╲___╱
//! ```
//!
//! 1. Minima: connected sets of equal cells without a lower neighbour, in the full neighbourhood (3ⁿ − 1 cells).
//!    Cells without contact are one basin of their own, the outside.
//! 2. Flooding by a priority queue: lowest cell first, first in first out among equals. A cell beside two basins
//!    becomes a dam and passes no water on.
//! 3. The shallowest basin below the tolerance joins the basin across its lowest boundary point, again and again.
//!
//! It serves the published tables ([`super::dissertation`]) and measures how far [`super::flood`] departs from it.

mod basins;
pub mod brute;
#[cfg(test)]
pub(super) mod dams;
mod merge;
pub(super) mod neighbourhood;
#[cfg(test)]
mod tests;

use crate::exec::{Cancelled, Exec};
pub use basins::Rules;
pub(super) use basins::{Height, is_basin};
use merge::Merged;
use neighbourhood::Neighbourhood;

/// Every cell's basin, after merging.
pub(super) struct Parts {
    /// The basin number of every cell, before merging; dam cells have none.
    pub(super) labels: Vec<u32>,
    /// Where the basins ended up.
    pub(super) merged: Merged,
}

/// Minima, flooding and merging.
pub(super) fn divide<H: Height>(
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
    Ok(Parts { labels: flooded.labels, merged })
}
