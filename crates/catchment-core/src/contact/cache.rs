//! Facts about a pair that are computed once, when they are first needed.
//!
//! They depend on the halves and on the alignment, so a pair with other free errors starts without them
//! ([`Pair::with_free`](super::Pair::with_free)). Facts of the seat follow from heights alone and belong to the geometry; facts of motions
//! come from exact descent without friction, always with its default settings, so that they do not depend on the first caller.

use super::mated::ReleaseResult;
use std::sync::OnceLock;

/// Facts of the seat, from heights ([`Seat`](super::Seat)).
#[derive(Debug, Clone, Default)]
pub(crate) struct SeatCache {
    /// Range of the seat in yaw alone, in both directions, in radians.
    pub(crate) spins: OnceLock<[f64; 2]>,
    /// Whether its rim has a gap.
    pub(crate) leaks: OnceLock<bool>,
}

/// Facts of motions, from exact descent ([`crate::method::descent`]).
#[derive(Debug, Clone, Default)]
pub(crate) struct MotionCache {
    /// Whether all motion near the mated pose leads to it.
    pub(crate) homing: OnceLock<bool>,
    /// Motions of a half that is released slightly off the mated pose.
    pub(crate) about_mated: OnceLock<ReleaseResult>,
    /// Seconds that a motion takes.
    pub(crate) seconds: OnceLock<f64>,
}
