//! Ways to decide what becomes of a pose error. Every one has the same door, `Settings` + input + `&Exec`,
//! and returns an [`crate::acceptance::Acceptance`].

pub mod descent;
pub mod flood;
pub mod kinematic;
pub mod zraa;

use crate::landscape::Resolution;
use serde::{Deserialize, Serialize};

/// The methods that decide every cell of an error grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// [`descent`]: exact motion of every cell's centre.
    Descent,
    /// [`flood`]: flooding of the heights over the grid.
    Flood,
}

impl Method {
    /// All of them, the default first.
    pub const ALL: [Self; 2] = [Self::Descent, Self::Flood];

    /// The lower-case name used in files, reports and options.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Descent => "descent",
            Self::Flood => "flood",
        }
    }

    /// What it does, in a line.
    pub const fn summary(self) -> &'static str {
        match self {
            Self::Descent => "exact frictionless motion of every cell's centre",
            Self::Flood => "fast flooding of the heights over the grid; biased, made for comparisons",
        }
    }

    /// Cells per axis when nothing was said, for one to five axes: an answer within seconds, at 0.1 to 0.5 ms per
    /// descent and about 1 µs per flooded cell. Odd, so that a cell is centred on the mated pose.
    pub const fn default_cells(self) -> [usize; 5] {
        match self {
            Self::Descent => [1001, 101, 25, 11, 7],
            Self::Flood => Resolution::DEFAULT_CELLS,
        }
    }

    /// Random poses followed exactly beside the grid when nothing was said. They cost a flooded run its speed.
    pub const fn default_samples(self) -> usize {
        match self {
            Self::Descent => 4000,
            Self::Flood => 0,
        }
    }
}
