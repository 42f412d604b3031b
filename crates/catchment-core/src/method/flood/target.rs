//! Position of the mated pose in a grid.
//!
//! ```text
//!   odd number of cells            even number of cells
//!   ├──┬──┬──┬──┬──┤               ├──┬──┬──┬──┤
//!         ▲ one cell is              ▲  ▲  the two nearest
//!           centred on it                  cells are around it
//! ```

use crate::design::Alignment;
use crate::landscape::{Grid, GridAxis};
use crate::pose::{Dof, PoseError};
use std::f64::consts::TAU;

/// Largest distance from a cell's centre, in cells, at which a pose counts as sampled there: far above the
/// rounding of `lo + k·step`, far below any effect on heights.
const CENTRED: f64 = 1e-6;

/// The aligned poses: the mated pose, and for an n-fold symmetry its turns about z by 2π/n within half a turn.
pub(super) fn aligned_poses(symmetry: u32) -> Vec<PoseError> {
    let n = i64::from(symmetry.max(1));
    (-(n / 2)..=n / 2).map(|k| PoseError { yaw: TAU * k as f64 / n as f64, ..PoseError::default() }).collect()
}

/// Cells around every aligned pose within the grid: one cell if it is centred on the pose, up to 2ⁿ if the
/// pose lies between centres. In ascending order.
pub(super) fn cells(grid: &Grid, alignment: &Alignment) -> Vec<usize> {
    let poses = match grid.axis(Dof::Yaw) {
        Some(_) => aligned_poses(alignment.symmetry),
        None => vec![PoseError::default()],
    };
    let mut cells: Vec<usize> = poses.iter().flat_map(|p| around(grid, &p.to_array())).collect();
    cells.sort_unstable();
    cells.dedup();
    cells
}

/// Cells around a pose; empty if it lies outside the grid.
fn around(grid: &Grid, pose: &[f64; 5]) -> Vec<usize> {
    let mut cells = vec![0usize];
    let mut stride = 1;
    for axis in &grid.axes {
        let Some((low, high)) = between(axis, pose[axis.dof.index()]) else { return Vec::new() };
        let mut next: Vec<usize> = cells.iter().map(|c| c + low * stride).collect();
        if high != low {
            next.extend(cells.iter().map(|c| c + high * stride));
        }
        cells = next;
        stride *= axis.cells;
    }
    cells
}

/// The cells whose centres lie on both sides of `value`; twice the same cell if its centre equals it, or at
/// the border.
fn between(axis: &GridAxis, value: f64) -> Option<(usize, usize)> {
    let place = (value - axis.center(0)) / axis.step();
    let last = axis.cells - 1;
    if place < -0.5 - CENTRED || place > last as f64 + 0.5 + CENTRED {
        return None;
    }
    let clamp = |k: f64| k.clamp(0.0, last as f64) as usize;
    let nearest = place.round();
    if (place - nearest).abs() <= CENTRED {
        return Some((clamp(nearest), clamp(nearest)));
    }
    Some((clamp(place.floor()), clamp(place.ceil())))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pose::{DofSet, Mount};

    fn grid(free: &[Dof], cells: usize) -> Grid {
        Grid::over(&Alignment::new(free.iter().copied().collect(), Mount::X), |_| cells)
    }

    #[test]
    fn odd_grids_have_one_cell_on_the_mated_pose_and_even_ones_two_per_axis() {
        let alignment = Alignment::new(DofSet::ALL, Mount::X);
        assert_eq!(cells(&grid(&[Dof::X, Dof::Pitch], 5), &alignment), [12]);
        assert_eq!(cells(&grid(&[Dof::X, Dof::Pitch], 4), &alignment), [5, 6, 9, 10]);
        assert_eq!(cells(&grid(&Dof::ALL, 6), &alignment).len(), 32);
        assert_eq!(cells(&grid(&Dof::ALL, 7), &alignment), [(7usize.pow(5) - 1) / 2]);
    }

    #[test]
    fn a_mated_pose_outside_the_grid_has_no_cells() {
        let alignment = Alignment::new(DofSet::ALL, Mount::X);
        let mut grid = grid(&[Dof::X], 8);
        (grid.axes[0].lo, grid.axes[0].hi) = (0.1, 0.9);
        assert!(cells(&grid, &alignment).is_empty());
        grid.axes[0].lo = 0.0;
        assert_eq!(cells(&grid, &alignment), [0]);
    }

    #[test]
    fn turns_of_a_symmetric_pair_are_aligned_too() {
        let mut alignment = Alignment::new(DofSet::ALL, Mount::X);
        alignment.symmetry = 4;
        // ±90° lie on the border: the outermost cells are around them. ±180° lie outside.
        assert_eq!(cells(&grid(&[Dof::Yaw], 9), &alignment), [0, 4, 8]);
        alignment.symmetry = 3;
        assert_eq!(cells(&grid(&[Dof::Yaw], 9), &alignment), [4]);
        assert_eq!(cells(&grid(&[Dof::X], 9), &alignment), [4]);
        assert_eq!(aligned_poses(4).len(), 5);
    }
}
