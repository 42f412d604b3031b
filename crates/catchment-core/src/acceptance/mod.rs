//! The common result type of all methods: the outcome of every pose error.
//!
//! ```text
//!   aligned     contact brings the halves to the mated pose
//!   jammed      they come to rest in contact elsewhere
//!   missed      no contact, or they slide off each other
//!   undecided   the budget ran out: never silent
//! ```
//!
//! Every method fills an [`Acceptance`], so that any two can be compared cell by cell.

mod random;

use crate::design::Alignment;
use crate::diagnostic::Diagnostic;
use crate::landscape::Grid;
use crate::pose::{Dof, PoseError};
use crate::problem::Problem;
pub use random::Stream;
use serde::{Deserialize, Serialize};

/// Outcome of a pose error: the end of its motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
#[repr(u8)]
pub enum Outcome {
    /// Docked: contact brings the halves to the mated pose.
    Aligned = 1,
    /// The moving half rests in contact outside the seat.
    Jammed = 2,
    /// The halves never touch, or the moving half slides off.
    Missed = 3,
    /// The step budget ended before the motion did.
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

    /// The word for people: an aligned pose has docked.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Aligned => "docked",
            other => other.name(),
        }
    }
}

/// Reason for a failure to dock, if the end of the motion shows it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum FailureReason {
    /// Jammed: a layer rests on, or stands against, a layer of the other half that is not its partner.
    Crossed,
}

impl FailureReason {
    /// Reason why a motion with this outcome and this last pose error did not dock, if it can be determined.
    pub fn of(problem: &Problem, outcome: Outcome, end: &PoseError) -> Option<Self> {
        let crossed = outcome == Outcome::Jammed && problem.may_cross() && problem.pair().crosses(end);
        crossed.then_some(Self::Crossed)
    }

    /// The lower-case name used in files and reports.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Crossed => "crossed",
        }
    }
}

/// The pose errors whose outcomes are decided.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Domain {
    /// The centre of every cell of a grid.
    Grid(Grid),
    /// Listed poses.
    Poses(Vec<PoseError>),
}

impl Domain {
    /// How many poses; `None` if the number overflows.
    pub fn checked_len(&self) -> Option<usize> {
        match self {
            Self::Grid(grid) => grid.checked_len(),
            Self::Poses(poses) => Some(poses.len()),
        }
    }

    /// How many poses.
    pub fn len(&self) -> usize {
        match self {
            Self::Grid(grid) => grid.len(),
            Self::Poses(poses) => poses.len(),
        }
    }

    /// Whether there is no pose.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The pose error number `k`, in the order of the outcomes.
    ///
    /// # Panics
    /// When a list has no pose number `k`.
    pub fn pose(&self, k: usize) -> PoseError {
        match self {
            Self::Grid(grid) => grid.pose(k),
            Self::Poses(poses) => poses[k],
        }
    }

    /// `count` poses sampled independently and uniformly from the error box of `alignment`. Pose k depends
    /// only on `seed` and k: a longer list starts with the shorter list.
    pub fn random(alignment: &Alignment, count: usize, seed: u64) -> Self {
        let stream = Stream::new(seed);
        let pose = |k: usize| {
            let number = |dof: Dof| stream.uniform((Dof::ALL.len() * k + dof.index()) as u64);
            let mut error = [0.0; 5];
            for dof in alignment.free.iter() {
                error[dof.index()] = alignment.half_range(dof) * (2.0 * number(dof) - 1.0);
            }
            PoseError::from_array(error)
        };
        Self::Poses((0..count).map(pose).collect())
    }
}

/// Outcome of every pose error tried.
#[derive(Debug, Clone, PartialEq)]
pub struct Acceptance {
    /// Name of the method that decided.
    pub method: &'static str,
    /// The decided poses.
    pub domain: Domain,
    /// The outcome of each cell or pose, in the order of the domain.
    pub outcomes: Vec<Outcome>,
    /// Warnings.
    pub warnings: Vec<Diagnostic>,
}

impl Acceptance {
    /// How many poses met each outcome, in the order of [`Outcome::ALL`].
    pub fn counts(&self) -> [usize; 4] {
        // So many outcomes can be counted in a byte each, which the compiler does for many at once.
        const PIECE: usize = u8::MAX as usize;
        let mut counts = [0; 4];
        for piece in self.outcomes.chunks(PIECE) {
            for (count, outcome) in counts.iter_mut().zip(Outcome::ALL) {
                let equal = piece.iter().fold(0u8, |sum, o| sum.wrapping_add(u8::from(*o == outcome)));
                *count += usize::from(equal);
            }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pose::{DofSet, Mount};

    fn drawn(count: usize, seed: u64) -> Vec<PoseError> {
        let alignment = Alignment::new(DofSet::ALL.without(Dof::Roll), Mount::X);
        match Domain::random(&alignment, count, seed) {
            Domain::Poses(poses) => poses,
            Domain::Grid(_) => Vec::new(),
        }
    }

    #[test]
    fn random_poses_fill_the_error_box_evenly() {
        const COUNT: usize = 20_000;
        let poses = drawn(COUNT, 7);
        let alignment = Alignment::new(DofSet::ALL, Mount::X);
        for dof in Dof::ALL {
            let values: Vec<f64> =
                poses.iter().map(|p| p.to_array()[dof.index()] / alignment.half_range(dof)).collect();
            let moment = |f: &dyn Fn(f64) -> f64| values.iter().map(|v| f(*v)).sum::<f64>() / COUNT as f64;
            if dof == Dof::Roll {
                assert!(values.iter().all(|v| *v == 0.0));
                continue;
            }
            assert!(values.iter().all(|v| (-1.0..1.0).contains(v)));
            // Mean 0 and mean square 1/3 of a uniform variable; five standard errors √(1/3n) and √(4/45n).
            assert!(moment(&|v| v).abs() < 5.0 * (1.0 / (3.0 * COUNT as f64)).sqrt());
            assert!((moment(&|v| v * v) - 1.0 / 3.0).abs() < 5.0 * (4.0 / (45.0 * COUNT as f64)).sqrt());
            // Neighbouring poses are not correlated; the product of two has variance 1/9.
            let lag = values.windows(2).map(|w| w[0] * w[1]).sum::<f64>() / COUNT as f64;
            assert!(lag.abs() < 5.0 / (3.0 * (COUNT as f64).sqrt()));
        }
    }

    #[test]
    fn a_random_pose_depends_on_seed_and_number_alone() {
        assert_eq!(drawn(100, 1)[..10], drawn(10, 1));
        assert!(drawn(10, 1).iter().zip(drawn(10, 2)).all(|(a, b)| *a != b));
    }
}
