//! The one result type: what becomes of every pose error.
//!
//! ```text
//!   aligned     contact brings the halves to the mated pose
//!   jammed      they come to rest in contact elsewhere
//!   missed      no contact, or they slide off each other
//!   undecided   the budget ran out: never silent
//! ```
//!
//! Every method fills an [`Acceptance`], so that any two can be compared cell by cell.

use crate::landscape::Grid;
use crate::pose::PoseError;
use serde::{Deserialize, Serialize};
use std::fmt;

/// What becomes of one pose error.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[repr(u8)]
pub enum Outcome {
    /// Contact brings the halves to the mated pose.
    Aligned = 1,
    /// At rest in contact elsewhere.
    Jammed = 2,
    /// No contact, or slid off.
    Missed = 3,
    /// The budget ran out.
    Undecided = 4,
}

impl Outcome {
    /// All four, in the order of their codes.
    pub const ALL: [Self; 4] = [Self::Aligned, Self::Jammed, Self::Missed, Self::Undecided];

    /// The lower-case name used in files and reports.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Aligned => "aligned",
            Self::Jammed => "jammed",
            Self::Missed => "missed",
            Self::Undecided => "undecided",
        }
    }
}

/// Which pose errors were tried.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Domain {
    /// The centre of every cell of a grid.
    Grid(Grid),
    /// Listed poses.
    Poses(Vec<PoseError>),
}

/// A doubt about a result, carried inside the report.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Warning {
    /// The accepted set reaches the border of the error box: part of it may lie outside.
    TouchesBorder {
        /// Names of the axes at whose border it does.
        axes: Vec<String>,
    },
    /// Some poses were not decided.
    Undecided {
        /// How many.
        cells: usize,
    },
    /// The method's direction is quantised by the grid, so its border does not converge to the true one.
    FloodingBias,
    /// Numbers of the dissertation's own conventions, fitted to its tables; not physics.
    DissertationConventions,
    /// The mated pose is not inside the accepted set.
    MatedPoseNotAccepted,
    /// Anything else a reader must know, in a sentence.
    Note {
        /// The sentence.
        text: String,
    },
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TouchesBorder { axes } => write!(
                f,
                "the accepted set reaches the border of the error box along {}: enlarge [errors] to see all of it",
                axes.join(", ")
            ),
            Self::Undecided { cells } => {
                write!(f, "{cells} poses undecided: their motion did not end within the step budget")
            }
            Self::FloodingBias => write!(
                f,
                "flooding follows grid directions only: its border may lie several percent off at any resolution; \
                 --method descent is exact"
            ),
            Self::DissertationConventions => {
                write!(
                    f,
                    "the dissertation preset uses conventions fitted to its tables; not for design decisions"
                )
            }
            Self::MatedPoseNotAccepted => {
                write!(
                    f,
                    "the mated pose itself is not accepted: the grid is too coarse, or the pair does not hold there"
                )
            }
            Self::Note { text } => f.write_str(text),
        }
    }
}

/// Outcome of every pose error tried.
#[derive(Debug, Clone, PartialEq)]
pub struct Acceptance {
    /// Name of the method that decided.
    pub method: &'static str,
    /// What was tried.
    pub domain: Domain,
    /// One outcome per cell or pose, in the order of the domain.
    pub outcomes: Vec<Outcome>,
    /// Doubts.
    pub warnings: Vec<Warning>,
}

impl Acceptance {
    /// How many poses met each outcome, in the order of [`Outcome::ALL`].
    pub fn counts(&self) -> [usize; 4] {
        let mut counts = [0; 4];
        for outcome in &self.outcomes {
            counts[*outcome as usize - 1] += 1;
        }
        counts
    }

    /// Whether each pose is accepted.
    pub fn accepted(&self) -> impl ExactSizeIterator<Item = bool> + '_ {
        self.outcomes.iter().map(|o| *o == Outcome::Aligned)
    }

    /// The grid, if a grid was tried.
    pub const fn grid(&self) -> Option<&Grid> {
        match &self.domain {
            Domain::Grid(grid) => Some(grid),
            Domain::Poses(_) => None,
        }
    }
}
