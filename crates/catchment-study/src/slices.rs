//! Slices over two errors at a time, with all errors free: at a resolution that is not feasible for the whole
//! acceptance.
//!
//! ```text
//!   error box of 5 axes ──  yaw ▲ ░░░░          every cell of the plane is followed, by descent or drop,
//!                               │░░░░░░         the other errors begin at 0 and are free to move
//!                               └──────▶ x      n (n − 1)/2 planes of n free errors
//! ```
//!
//! A *slice* varies two errors and leaves all free in the motion; a *restricted* acceptance locks the others
//! too (`free` in the design). The two sets differ.
//!
//! With the x-y slice and those of x with every rotation, [`Estimate`] estimates the full-dimensional ONAA
//! edge.
//!
//! Not promised: results for errors off these planes. Lengths in D, angles in radians.

use super::pose_bytes;
use catchment_core::acceptance::{Acceptance, Domain};
use catchment_core::diagnostic::{Advice, Diagnostic};
use catchment_core::exec::{Cancelled, Exec, OutOfBudget};
use catchment_core::landscape::{Grid, Resolution, ResolutionError};
use catchment_core::merit::estimate::Estimate;
use catchment_core::merit::onaa::Onaa;
use catchment_core::merit::sum::{Sum, bracket};
use catchment_core::merit::{MeritError, slice, warnings};
use catchment_core::method::{DecideError, Method, PoseMethod, descent};
use catchment_core::pose::Dof;
use catchment_core::problem::Problem;
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

/// Settings that change the result.
#[derive(Debug, Clone, PartialEq)]
pub struct SlicesSettings {
    /// Cells per axis; [`SlicesSettings::CELLS`] by default.
    pub resolution: Resolution,
    /// The pairs of errors to vary, the first to the right in pictures; empty: all pairs of free errors.
    pub pairs: Vec<[Dof; 2]>,
    /// Decides every cell by itself.
    pub method: Method,
}

/// The settings of the method stand under its name.
impl Serialize for SlicesSettings {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(3))?;
        map.serialize_entry("resolution", &self.resolution)?;
        map.serialize_entry("pairs", &self.pairs)?;
        map.serialize_entry(self.method.name(), &self.method.settings())?;
        map.end()
    }
}

impl SlicesSettings {
    /// Cells per axis, as in the dissertation's drop tests. Odd, so that a cell is centred on the mated pose.
    pub const CELLS: usize = 71;
}

impl Default for SlicesSettings {
    fn default() -> Self {
        let resolution = Resolution::uniform(Self::CELLS).unwrap_or_default();
        Self { resolution, pairs: Vec::new(), method: Method::new(descent::DescentSettings::default()) }
    }
}

/// A slice.
#[derive(Debug, Clone, PartialEq)]
pub struct Slice {
    /// The two errors that vary, in the order of [`Dof::ALL`].
    pub axes: [Dof; 2],
    /// Outcomes over a grid of two axes.
    pub acceptance: Acceptance,
    /// Its area, Dᵃ·radᵇ.
    pub sum: Sum,
    /// The same if the border moves by one cell to either side.
    pub bracket: [f64; 2],
    /// Its largest axis-oriented square.
    pub onaa: Onaa,
    /// Its warnings.
    pub warnings: Vec<Diagnostic>,
}

/// Slices of a design.
#[derive(Debug, Clone, PartialEq)]
pub struct Slices {
    /// A slice for each pair, in the requested order.
    pub slices: Vec<Slice>,
    /// Estimate of the ONAA edge; `None` if the x-y slice or a slice of x with a free rotation is missing.
    pub estimate: Option<Estimate>,
}

/// Why there are no slices.
#[derive(Debug, thiserror::Error)]
pub enum SlicesError {
    /// Fewer than two free errors.
    #[error("a slice needs two free errors; this design frees {free}")]
    OneError {
        /// How many there are.
        free: usize,
    },
    /// A requested error is locked in the design.
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
    #[error(transparent)]
    Resolution(#[from] ResolutionError),
    /// A method whose cells depend on each other.
    #[error("slices are decided cell by cell, which {method} does not do")]
    NotByPose {
        /// Which method.
        method: &'static str,
    },
    /// The method gave up.
    #[error(transparent)]
    Decide(DecideError),
    /// A figure of merit that is not available.
    #[error(transparent)]
    Merit(#[from] MeritError),
    /// It does not fit into memory.
    #[error(transparent)]
    OutOfBudget(#[from] OutOfBudget),
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Rejects slices that do not fit into memory, before they are computed; returns their number of cells.
///
/// # Errors
/// They do not fit, or a pair is not free in the design.
pub fn ensure_fits(problem: &Problem, settings: &SlicesSettings, exec: &Exec) -> Result<u64, SlicesError> {
    let planes = planes(problem, settings)?;
    let cells = |grid: &Grid| grid.checked_len().map_or(u64::MAX, |cells| cells as u64);
    let largest = planes.iter().map(|(_, grid)| cells(grid)).max().unwrap_or(0);
    let kept = planes.iter().map(|(_, grid)| cells(grid)).fold(0, u64::saturating_add);
    let needed = largest.saturating_mul(pose_bytes()).saturating_add(kept);
    exec.ensure_fits("the largest slice", needed, |budget| {
        let fits = Resolution::largest_that_fits(budget, pose_bytes() + planes.len() as u64, 2);
        vec![Advice::AtMostResolution(fits), Advice::MoreMemory]
    })?;
    Ok(kept)
}

/// Computes slices through zero.
///
/// # Errors
/// A pair that the design does not free, a grid that does not fit into memory, a cancelled run.
pub fn run(problem: &Problem, settings: &SlicesSettings, exec: &Exec) -> Result<Slices, SlicesError> {
    let planes = planes(problem, settings)?;
    let method = settings.method.name();
    let judge = settings.method.follows().ok_or(SlicesError::NotByPose { method })?;
    ensure_fits(problem, settings, exec)?;
    let total = planes.len() as f64;
    let slices = planes
        .into_iter()
        .enumerate()
        .map(|(k, (axes, grid))| {
            let part = exec.part([k as f64 / total, (k + 1) as f64 / total], "slices");
            let acceptance = decide(problem, grid, judge, &part)?;
            let sum = Sum::of(&acceptance, problem.alignment());
            let onaa = Onaa::of(&acceptance, &part)?;
            let bracket = bracket(&acceptance, &part)?;
            let warnings = warnings(&acceptance, &part)?;
            Ok(Slice { axes, acceptance, sum, bracket, onaa, warnings })
        })
        .collect::<Result<Vec<Slice>, SlicesError>>()?;
    let estimate = estimate(problem, &slices);
    Ok(Slices { slices, estimate })
}

/// Decides a plane by itself.
fn decide(
    problem: &Problem,
    grid: Grid,
    judge: &dyn PoseMethod,
    exec: &Exec,
) -> Result<Acceptance, SlicesError> {
    Ok(judge.follow(problem, Domain::Grid(grid), exec)?.0)
}

impl From<DecideError> for SlicesError {
    fn from(error: DecideError) -> Self {
        match error {
            DecideError::OutOfBudget(error) => Self::OutOfBudget(error),
            DecideError::Cancelled(error) => Self::Cancelled(error),
            error => Self::Decide(error),
        }
    }
}

/// The pairs to vary, each once and in the order of [`Dof::ALL`], with their grids.
fn planes(problem: &Problem, settings: &SlicesSettings) -> Result<Vec<([Dof; 2], Grid)>, SlicesError> {
    let free = problem.alignment().free;
    if free.len() < 2 {
        return Err(SlicesError::OneError { free: free.len() });
    }
    let whole = settings.resolution.grid(problem.alignment(), &[SlicesSettings::CELLS; 5])?;
    let all = slice::pairs(&whole);
    let requested = if settings.pairs.is_empty() { &all } else { &settings.pairs };
    let mut planes: Vec<([Dof; 2], Grid)> = Vec::with_capacity(requested.len());
    for [a, b] in requested {
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

fn estimate(problem: &Problem, slices: &[Slice]) -> Option<Estimate> {
    let edge = |other: Dof| slices.iter().find(|s| s.axes == [Dof::X, other]).map(|s| s.onaa.edge);
    let rotations: Option<Vec<f64>> =
        problem.alignment().free.iter().filter(|dof| dof.is_rotation()).map(edge).collect();
    let rotations = rotations.filter(|edges| !edges.is_empty())?;
    Some(Estimate::of(edge(Dof::Y)?, &rotations))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::problem;
    use catchment_core::design::Family;
    use catchment_core::pose::DofSet;

    fn settings(cells: usize, pairs: &[[Dof; 2]]) -> SlicesSettings {
        let resolution = Resolution::uniform(cells).unwrap();
        SlicesSettings { resolution, pairs: pairs.to_vec(), ..SlicesSettings::default() }
    }

    #[test]
    fn a_slice_is_the_plane_of_the_whole_grid() {
        let problem = problem(Family::Pyramid, DofSet::ALL.without(Dof::Y).without(Dof::Roll));
        let result = run(&problem, &settings(5, &[[Dof::Yaw, Dof::X]]), &Exec::new()).unwrap();
        let whole = Grid::over(problem.alignment(), |_| 5);
        let all = descent::run(
            problem.pair(),
            Domain::Grid(whole.clone()),
            &descent::DescentSettings::default(),
            &Exec::new(),
        );
        let outcomes = all.unwrap().0.outcomes;
        let plane =
            slice::GridSlice::of(&whole, &[Dof::X, Dof::Yaw], &catchment_core::pose::PoseError::default())
                .unwrap();
        assert_eq!(result.slices[0].axes, [Dof::X, Dof::Yaw]);
        assert_eq!(result.slices[0].acceptance.outcomes, plane.pick(&outcomes));
        assert_eq!(result.estimate, None);
    }

    #[test]
    fn all_pairs_of_five_errors_are_ten_and_give_an_estimate() {
        let problem = problem(Family::Pyramid, DofSet::ALL);
        let result = run(&problem, &settings(3, &[]), &Exec::new()).unwrap();
        assert_eq!(result.slices.len(), 10);
        assert!(result.slices.iter().all(|s| s.sum.tried == 9));
        assert!(result.estimate.is_some());
    }

    #[test]
    fn impossible_slices_are_refused() {
        let problem = problem(Family::Pyramid, [Dof::X, Dof::Y].into_iter().collect());
        let error = |pairs: &[[Dof; 2]], exec: &Exec| run(&problem, &settings(9, pairs), exec).unwrap_err();
        assert!(matches!(error(&[[Dof::X, Dof::Yaw]], &Exec::new()), SlicesError::NotFree { dof: Dof::Yaw }));
        assert!(matches!(error(&[[Dof::X, Dof::X]], &Exec::new()), SlicesError::Same { dof: Dof::X }));
        let small = Exec::new().with_memory_budget(100);
        assert!(matches!(error(&[], &small), SlicesError::OutOfBudget(_)));
        let stopped = Exec::new();
        stopped.cancel_flag().store(true, std::sync::atomic::Ordering::Relaxed);
        assert!(matches!(error(&[], &stopped), SlicesError::Cancelled(Cancelled)));
    }
}
