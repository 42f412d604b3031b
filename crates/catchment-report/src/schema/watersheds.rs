//! The watersheds behind the outcomes: their numbers before and after merging.

use catchment_core::method::flood::{WatershedCounts, Watersheds};
use serde::{Deserialize, Serialize};

/// Watersheds of a flooded grid, without the region of cells without contact.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct WatershedsReport {
    /// Numbers of first and merged labels, and of dam and moved cells.
    #[serde(flatten)]
    pub counts: WatershedCounts,
    /// Share of all cells whose first watershed was merged into another.
    pub moved_share: f64,
}

impl WatershedsReport {
    /// Counts the labels of every cell.
    pub fn new(watersheds: &Watersheds) -> Self {
        let counts = watersheds.counts();
        Self { counts, moved_share: counts.moved as f64 / watersheds.first.len().max(1) as f64 }
    }
}
