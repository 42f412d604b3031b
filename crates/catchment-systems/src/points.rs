//! Points of the plane as their coordinates.

use glam::DVec2;
use serde::{Serialize, Serializer};

/// A point as `[x, y]`.
pub(crate) fn point<S: Serializer>(point: &DVec2, serializer: S) -> Result<S::Ok, S::Error> {
    point.to_array().serialize(serializer)
}

/// Points as a list of `[x, y]`.
pub(crate) fn points<S: Serializer>(points: &[DVec2], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(points.iter().map(DVec2::to_array))
}
