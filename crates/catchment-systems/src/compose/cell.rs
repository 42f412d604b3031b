//! The cells of a branch and bound over positions, in the order in which they are divided.

use glam::DVec2;
use std::cmp::Ordering;

/// A square of positions, the square with the highest bound first; among equal bounds that of the highest number:
/// the most recent is the smallest.
pub(super) struct Cell {
    /// Its middle.
    pub(super) center: DVec2,
    /// Half of its side.
    pub(super) half: f64,
    /// No value in it is larger.
    pub(super) bound: f64,
    /// How many were made before it.
    pub(super) number: usize,
}

impl PartialEq for Cell {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}
impl Eq for Cell {}
impl PartialOrd for Cell {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Cell {
    fn cmp(&self, other: &Self) -> Ordering {
        self.bound.total_cmp(&other.bound).then(self.number.cmp(&other.number))
    }
}
