//! Planes through the mated pose, in addition to a grid over three or more errors: the sections at zero in
//! pictures and pages.
//!
//! ```text
//!   grid, 30 cells per axis:   no cell is centred on 0     ──▶  the plane of the grid "at 0" is half a cell off
//!   plane, yaw = 0 exactly:    each (x, pitch) is followed ──▶  symmetric halves give a symmetric plane
//! ```
//!
//! For every pair of axes of the grid the two errors vary and the others start at exactly 0; all free errors
//! take part in the motion. All planes have the same resolution: an odd number, at least 25 cells per axis,
//! and together about as many cells as a plane of 71 × 71; fewer if motions of the pair are slow, but never
//! fewer than the grid.
//!
//! Not promised: that a plane is part of the grid. It is computed by exact motions, whatever method decided
//! the grid. Lengths in D, angles in radians.

use super::pose_bytes;
use catchment_core::acceptance::{Acceptance, Domain};
use catchment_core::contact::Pair;
use catchment_core::exec::{Cancelled, Exec};
use catchment_core::landscape::{Grid, GridAxis};
use catchment_core::merit::slice;
use catchment_core::method::{DecisionMethod, descent};
use catchment_core::pose::Dof;

/// Cells per axis of a plane that is shown alone.
const MAIN_CELLS: usize = 71;
/// Smallest number of cells per axis of a plane among many.
const CELLS: usize = 25;

/// Cells per axis for this many planes beside each other: odd, so that a cell is centred on zero.
fn cells_of(planes: usize) -> usize {
    let each = (MAIN_CELLS as f64 / (planes.max(1) as f64).sqrt()) as usize;
    (each | 1).max(CELLS)
}

/// The pair for a single plane: x with the rotation in the same plane; the first pair if the grid has
/// neither.
pub fn main_pair(grid: &Grid) -> Option<[Dof; 2]> {
    let pairs = slice::pairs(grid);
    let favourites = [[Dof::X, Dof::Pitch], [Dof::X, Dof::Yaw]];
    favourites.into_iter().find(|pair| pairs.contains(pair)).or_else(|| pairs.first().copied())
}

/// The grids of planes over these pairs of axes; empty for a grid of fewer than three axes, which is a plane
/// itself.
fn grids(pair: &Pair, motions: &descent::DescentSettings, grid: &Grid, planes: &[[Dof; 2]]) -> Vec<Grid> {
    if grid.axes.len() < 3 {
        return Vec::new();
    }
    let least = cells_of(planes.len()).min(motions.default_cells(pair)[1]);
    let finer = |axis: &GridAxis| GridAxis { cells: axis.cells.max(least), ..*axis };
    let plane = |axes: &[Dof; 2]| Grid {
        axes: grid.axes.iter().filter(|axis| axes.contains(&axis.dof)).map(finer).collect(),
    };
    planes.iter().map(plane).collect()
}

/// Bytes that [`through_zero`] takes at its peak.
pub fn bytes(pair: &Pair, motions: &descent::DescentSettings, grid: &Grid) -> u64 {
    let cells = |grid: &Grid| grid.checked_len().map_or(u64::MAX, |cells| cells as u64);
    let planes = grids(pair, motions, grid, &slice::pairs(grid));
    let largest = planes.iter().map(cells).max().unwrap_or(0);
    planes.iter().map(cells).fold(largest.saturating_mul(pose_bytes()), u64::saturating_add)
}

/// Follows every pose of every plane: an acceptance for each pair of axes of `grid`, over a grid of two axes;
/// empty for a grid of fewer than three.
///
/// # Errors
/// [`Cancelled`] if a stop is requested.
pub fn through_zero(
    pair: &Pair,
    motions: &descent::DescentSettings,
    grid: &Grid,
    exec: &Exec,
) -> Result<Vec<Acceptance>, Cancelled> {
    follow(pair, motions, grid, &slice::pairs(grid), exec)
}

/// Only the plane of the [`main_pair`], finer than among others; `None` for a grid of fewer than three axes.
///
/// # Errors
/// [`Cancelled`] if a stop is requested.
pub fn main_through_zero(
    pair: &Pair,
    motions: &descent::DescentSettings,
    grid: &Grid,
    exec: &Exec,
) -> Result<Option<Acceptance>, Cancelled> {
    let main: Vec<_> = main_pair(grid).into_iter().collect();
    Ok(follow(pair, motions, grid, &main, exec)?.pop())
}

fn follow(
    pair: &Pair,
    motions: &descent::DescentSettings,
    grid: &Grid,
    planes: &[[Dof; 2]],
    exec: &Exec,
) -> Result<Vec<Acceptance>, Cancelled> {
    let follow = |plane| Ok(descent::run(pair, Domain::Grid(plane), motions, exec)?.0);
    grids(pair, motions, grid, planes).into_iter().map(follow).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::problem;
    use catchment_core::acceptance::Outcome;
    use catchment_core::design::Family;
    use catchment_core::pose::DofSet;

    fn free(dofs: &[Dof]) -> DofSet {
        dofs.iter().copied().collect()
    }

    /// A pyramid is its own mirror image, and so is every plane through zero. The plane of the even grid "at 0" is not: it lies half a cell beside.
    #[test]
    fn planes_of_symmetric_halves_are_symmetric_on_even_grids() {
        let problem = problem(Family::Pyramid, free(&[Dof::X, Dof::Y, Dof::Yaw]));
        let grid = Grid::over(problem.alignment(), |_| 4);
        let motions = descent::DescentSettings::default();
        let planes = through_zero(problem.pair(), &motions, &grid, &Exec::new()).unwrap();
        let axes = |plane: &Acceptance| plane.grid().unwrap().axes.iter().map(|a| a.dof).collect::<Vec<_>>();
        assert!(planes.iter().map(axes).eq(slice::pairs(&grid).into_iter().map(Vec::from)));
        for plane in &planes {
            let [wide, high] = [0, 1].map(|k| plane.grid().unwrap().axes[k].cells);
            assert!(wide.min(high) > 4, "{wide} × {high}");
            // (x, y) ↦ (−x, −y) and (x, yaw) ↦ (−x, −yaw).
            let mirrored = |k: usize| (wide - 1 - k % wide) + wide * (high - 1 - k / wide);
            let differing = |same: fn(Outcome, Outcome) -> bool| {
                let cells = 0..wide * high;
                cells.filter(|k| !same(plane.outcomes[*k], plane.outcomes[mirrored(*k)])).count()
            };
            let aligned = differing(|a, b| (a == Outcome::Aligned) == (b == Outcome::Aligned));
            assert!(aligned * 1000 <= wide * high, "{aligned} of {}", wide * high);
            // A half that slides off ends on the rims of both halves at once; rounding decides whether it
            // jams there.
            let any = differing(|a, b| a == b);
            assert!(any * 50 <= wide * high, "{any} of {}", wide * high);
        }
    }

    #[test]
    fn planes_beside_each_other_have_one_resolution() {
        assert_eq!([1, 3, 6, 10].map(cells_of), [71, 41, 29, 25]);
    }

    #[test]
    fn a_grid_of_two_errors_is_its_own_plane() {
        let problem = problem(Family::Pyramid, free(&[Dof::X, Dof::Pitch]));
        let grid = Grid::over(problem.alignment(), |_| 6);
        let motions = descent::DescentSettings::default();
        assert!(through_zero(problem.pair(), &motions, &grid, &Exec::new()).unwrap().is_empty());
        assert_eq!(bytes(problem.pair(), &motions, &grid), 0);
        assert_eq!(main_pair(&grid), Some([Dof::X, Dof::Pitch]));
    }
}
