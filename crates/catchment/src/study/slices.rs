//! Two errors at a time, with everything free: slices of the whole acceptance at a resolution that the whole could
//! never be computed at.
//!
//! ```text
//!   error box of 5 axes ──  yaw ▲ ░░░░          every cell of the plane is followed, by descent or drop,
//!                               │░░░░░░         the other errors begin at 0 and are free to move
//!                               └──────▶ x      n (n − 1)/2 planes of n free errors
//! ```
//!
//! A *slice* varies two errors and leaves all free in the motion; a *restricted* acceptance locks the others too
//! (`free` in the design). They are not the same set.
//!
//! With the x-y slice and those of x with every rotation, [`Estimate`] guesses the ONAA edge of the whole.
//!
//! Not promised: anything about errors off these planes. Lengths in D, angles in radians.

use super::pose_bytes;
use crate::acceptance::{Acceptance, Domain, Warning};
use crate::advice::Advice;
use crate::contact::Pair;
use crate::exec::{Cancelled, Exec, OutOfBudget};
use crate::landscape::{Grid, Resolution, ResolutionError};
use crate::merit::estimate::Estimate;
use crate::merit::onaa::Onaa;
use crate::merit::sum::{Sum, bracket};
use crate::merit::{MeritError, doubts, slice};
use crate::method::descent;
#[cfg(feature = "drop")]
use crate::method::drop;
use crate::pose::Dof;
use serde::{Deserialize, Serialize};

/// What changes the answer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// Cells per axis; [`Settings::CELLS`] on axes of which it says nothing.
    pub resolution: Resolution,
    /// The pairs of errors to vary, the first to the right in pictures; empty: all pairs of free errors.
    pub pairs: Vec<[Dof; 2]>,
    /// How every cell is followed.
    pub descent: descent::Settings,
    /// Drop tests in the place of descent, if so.
    #[cfg(feature = "drop")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub drop: Option<drop::Settings>,
}

impl Settings {
    /// Cells per axis: what the dissertation's drop tests used. Odd, so that a cell is centred on the mated pose.
    pub const CELLS: usize = 71;
}

impl Default for Settings {
    fn default() -> Self {
        let resolution = Resolution::uniform(Self::CELLS).unwrap_or_default();
        Self {
            resolution,
            pairs: Vec::new(),
            descent: descent::Settings::default(),
            #[cfg(feature = "drop")]
            drop: None,
        }
    }
}

/// One slice.
#[derive(Debug, Clone, PartialEq)]
pub struct Slice {
    /// The two errors that vary, in the order of [`Dof::ALL`].
    pub axes: [Dof; 2],
    /// Outcomes over a grid of two axes.
    pub acceptance: Acceptance,
    /// Its area, Dᵃ·radᵇ.
    pub sum: Sum,
    /// The same with one cell of doubt on either side of the border.
    pub bracket: [f64; 2],
    /// Its largest axis-oriented square.
    pub onaa: Onaa,
    /// The doubts that it raises.
    pub warnings: Vec<Warning>,
}

/// Slices of one design.
#[derive(Debug, Clone, PartialEq)]
pub struct Slices {
    /// One per pair, in the order asked for.
    pub slices: Vec<Slice>,
    /// What they say about the whole; `None` where the x-y slice or one of x with a free rotation is missing.
    pub estimate: Option<Estimate>,
}

/// Why there are no slices.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SlicesError {
    /// Fewer than two free errors.
    #[error("a slice needs two free errors; this design frees {free}")]
    OneError {
        /// How many there are.
        free: usize,
    },
    /// An error is asked for that the design locks.
    #[error("{} is not free in this design, so it has no slice", dof.name())]
    NotFree {
        /// The error.
        dof: Dof,
    },
    /// A slice of an error with itself.
    #[error("a slice needs two different errors, not {} twice", dof.name())]
    Same {
        /// The error.
        dof: Dof,
    },
    /// A resolution for an axis that is not there.
    #[error("resolution: {0}")]
    Resolution(#[from] ResolutionError),
    /// Drop tests refuse.
    #[cfg(feature = "drop")]
    #[error(transparent)]
    Drop(#[from] drop::DropError),
    /// A figure of merit that is not to be had.
    #[error(transparent)]
    Merit(#[from] MeritError),
    /// It does not fit into memory.
    #[error(transparent)]
    OutOfBudget(#[from] OutOfBudget),
    /// It was asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Computes slices through zero.
///
/// # Errors
/// A pair that the design does not free, a grid that does not fit into memory, a cancelled run.
pub fn run(pair: &Pair, settings: &Settings, exec: &Exec) -> Result<Slices, SlicesError> {
    let planes = planes(pair, settings)?;
    let cells = |grid: &Grid| grid.checked_len().map_or(u64::MAX, |cells| cells as u64);
    let largest = planes.iter().map(|(_, grid)| cells(grid)).max().unwrap_or(0);
    let kept = planes.iter().map(|(_, grid)| cells(grid)).fold(0, u64::saturating_add);
    let needed = largest.saturating_mul(pose_bytes()).saturating_add(kept);
    exec.reserve("the largest slice", needed, |budget| {
        let fits = Resolution::largest_that_fits(budget, pose_bytes() + planes.len() as u64, 2);
        vec![Advice::AtMostResolution(fits), Advice::MoreMemory]
    })?;
    let total = planes.len() as f64;
    let slices = planes
        .into_iter()
        .enumerate()
        .map(|(k, (axes, grid))| {
            let part = exec.part([k as f64 / total, (k + 1) as f64 / total], "slices");
            let acceptance = decide(pair, grid, settings, &part)?;
            let sum = Sum::of(&acceptance, &pair.alignment);
            let onaa = Onaa::of(&acceptance, &part)?;
            let bracket = bracket(&acceptance, &part)?;
            let warnings = doubts(&acceptance, &part)?;
            Ok(Slice { axes, acceptance, sum, bracket, onaa, warnings })
        })
        .collect::<Result<Vec<Slice>, SlicesError>>()?;
    let estimate = estimate(pair, &slices);
    Ok(Slices { slices, estimate })
}

/// What becomes of every cell of a plane.
fn decide(pair: &Pair, grid: Grid, settings: &Settings, exec: &Exec) -> Result<Acceptance, SlicesError> {
    #[cfg(feature = "drop")]
    if let Some(settings) = &settings.drop {
        return Ok(drop::run(pair, Domain::Grid(grid), settings, exec)?.0);
    }
    Ok(descent::run(pair, Domain::Grid(grid), &settings.descent, exec)?.0)
}

/// The pairs to vary, each once and in the order of [`Dof::ALL`], with their grids.
fn planes(pair: &Pair, settings: &Settings) -> Result<Vec<([Dof; 2], Grid)>, SlicesError> {
    let free = pair.alignment.free;
    if free.len() < 2 {
        return Err(SlicesError::OneError { free: free.len() });
    }
    let whole = settings.resolution.grid(&pair.alignment, &[Settings::CELLS; 5])?;
    let all = slice::pairs(&whole);
    let asked = if settings.pairs.is_empty() { &all } else { &settings.pairs };
    let mut planes: Vec<([Dof; 2], Grid)> = Vec::with_capacity(asked.len());
    for [a, b] in asked {
        if a == b {
            return Err(SlicesError::Same { dof: *a });
        }
        let axis = |dof: Dof| whole.axis(dof).copied().ok_or(SlicesError::NotFree { dof });
        let axes = [*a.min(b), *a.max(b)];
        let grid = Grid { axes: vec![axis(axes[0])?, axis(axes[1])?] };
        if planes.iter().all(|(known, _)| *known != axes) {
            planes.push((axes, grid));
        }
    }
    Ok(planes)
}

fn estimate(pair: &Pair, slices: &[Slice]) -> Option<Estimate> {
    let edge = |other: Dof| slices.iter().find(|s| s.axes == [Dof::X, other]).map(|s| s.onaa.edge);
    let rotations: Option<Vec<f64>> =
        pair.alignment.free.iter().filter(|dof| dof.is_rotation()).map(edge).collect();
    let rotations = rotations.filter(|edges| !edges.is_empty())?;
    Some(Estimate::of(edge(Dof::Y)?, &rotations))
}

#[cfg(test)]
mod tests {
    use super::super::testing::pair;
    use super::*;
    use crate::design::Family;
    use crate::pose::DofSet;

    fn settings(cells: usize, pairs: &[[Dof; 2]]) -> Settings {
        let resolution = Resolution::uniform(cells).unwrap();
        Settings { resolution, pairs: pairs.to_vec(), ..Settings::default() }
    }

    #[test]
    fn a_slice_is_the_plane_of_the_whole_grid() {
        let pair = pair(Family::Pyramid, DofSet::ALL.without(Dof::Y).without(Dof::Roll));
        let found = run(&pair, &settings(5, &[[Dof::Yaw, Dof::X]]), &Exec::new()).unwrap();
        let whole = Grid::over(&pair.alignment, |_| 5);
        let all =
            descent::run(&pair, Domain::Grid(whole.clone()), &descent::Settings::default(), &Exec::new());
        let outcomes = all.unwrap().0.outcomes;
        let plane =
            slice::Slice::of(&whole, &[Dof::X, Dof::Yaw], &crate::pose::PoseError::default()).unwrap();
        assert_eq!(found.slices[0].axes, [Dof::X, Dof::Yaw]);
        assert_eq!(found.slices[0].acceptance.outcomes, plane.pick(&outcomes));
        assert_eq!(found.estimate, None);
    }

    #[test]
    fn all_pairs_of_five_errors_are_ten_and_give_an_estimate() {
        let pair = pair(Family::Pyramid, DofSet::ALL);
        let found = run(&pair, &settings(3, &[]), &Exec::new()).unwrap();
        assert_eq!(found.slices.len(), 10);
        assert!(found.slices.iter().all(|s| s.sum.tried == 9));
        assert!(found.estimate.is_some());
    }

    #[test]
    fn what_has_no_slice_is_refused() {
        let pair = pair(Family::Pyramid, [Dof::X, Dof::Y].into_iter().collect());
        let error = |pairs: &[[Dof; 2]], exec: &Exec| run(&pair, &settings(9, pairs), exec).unwrap_err();
        assert_eq!(error(&[[Dof::X, Dof::Yaw]], &Exec::new()), SlicesError::NotFree { dof: Dof::Yaw });
        assert_eq!(error(&[[Dof::X, Dof::X]], &Exec::new()), SlicesError::Same { dof: Dof::X });
        let small = Exec::new().with_memory_budget(100);
        assert!(matches!(error(&[], &small), SlicesError::OutOfBudget(_)));
        let stopped = Exec::new();
        stopped.cancel_flag().store(true, std::sync::atomic::Ordering::Relaxed);
        assert_eq!(error(&[], &stopped), SlicesError::Cancelled(Cancelled));
    }
}
