//! The polyhedral partition behind the outcomes: its size, and its exact measure.

use catchment_core::acceptance::Outcome;
use catchment_core::method::partition::{Partition, PartitionCounts};
use serde::{Deserialize, Serialize};

/// A partition of the contact space.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PartitionReport {
    /// Numbers of polytopes of the Minkowski sum, cells of the contact space, parts of cells, and rests.
    pub counts: PartitionCounts,
    /// Measure of the accepted polytopes inside the error box, in the unit of the Sum, independent of any
    /// grid.
    pub sum: f64,
}

impl PartitionReport {
    /// Measures a partition.
    pub fn new(partition: &Partition) -> Self {
        Self { counts: partition.counts(), sum: partition.measure(Outcome::Aligned) }
    }
}
