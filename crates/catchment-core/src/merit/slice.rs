//! Slices of the grid: some axes vary, the others are fixed.
//!
//! ```text
//!   grid over (x, y, yaw)  ──  axes = [x, yaw], at y = 0  ──▶  a table of x by yaw
//! ```
//!
//! A slice shows part of an acceptance in which *all* errors are free. It is not a restricted acceptance, in
//! which the other degrees of freedom are locked in the motion too.
//!
//! A fixed value selects the cell that contains it, on a border between two cells the upper cell.
//! [`GridSlice::at`] gives the centres that are used, at most half a cell away.

use super::{MeritError, axis_number};
use crate::landscape::{Grid, GridAxis};
use crate::pose::{Dof, PoseError};

/// A slice: which cells of the grid it shows.
#[derive(Debug, Clone, PartialEq)]
pub struct GridSlice {
    /// The varying axes in the requested order; the first runs fastest.
    pub axes: Vec<GridAxis>,
    /// The fixed axes and the cell centres used, in D and radians.
    pub at: Vec<(Dof, f64)>,
    /// Index into the grid of every cell of the slice.
    pub cells: Vec<usize>,
}

impl GridSlice {
    /// The slice of `grid` that keeps `axes` and fixes the others at the values of `at`.
    ///
    /// # Errors
    /// An axis that the grid does not have, an axis named twice, a value outside the error box.
    pub fn of(grid: &Grid, axes: &[Dof], at: &PoseError) -> Result<Self, MeritError> {
        super::require_sampled(grid, at)?;
        let mut strides = Vec::with_capacity(grid.axes.len());
        let mut stride = 1;
        for axis in &grid.axes {
            strides.push(stride);
            stride *= axis.cells;
        }
        let mut kept = Vec::with_capacity(axes.len());
        for (position, dof) in axes.iter().enumerate() {
            if axes[..position].contains(dof) {
                return Err(MeritError::RepeatedAxis { dof: *dof });
            }
            kept.push(axis_number(grid, *dof)?);
        }
        let mut origin = 0;
        let mut fixed = Vec::new();
        for (number, axis) in grid.axes.iter().enumerate() {
            if kept.contains(&number) {
                continue;
            }
            let value = at.to_array()[axis.dof.index()];
            let outside = MeritError::OutsideBox { dof: axis.dof, value, lo: axis.lo, hi: axis.hi };
            let k = axis.cell_of(value).ok_or(outside)?;
            origin += k * strides[number];
            fixed.push((axis.dof, axis.center(k)));
        }
        let mut cells = vec![origin];
        for number in &kept {
            let (n, stride) = (grid.axes[*number].cells, strides[*number]);
            cells = (0..n).flat_map(|k| cells.iter().map(move |c| c + k * stride)).collect();
        }
        Ok(Self { axes: kept.iter().map(|n| grid.axes[*n]).collect(), at: fixed, cells })
    }

    /// The values of any per-cell array of the grid on this slice.
    pub fn pick<T: Copy>(&self, values: &[T]) -> Vec<T> {
        self.cells.iter().map(|i| values[*i]).collect()
    }
}

/// All pairs of axes of the grid, in its order.
pub fn pairs(grid: &Grid) -> Vec<[Dof; 2]> {
    let dofs: Vec<Dof> = grid.axes.iter().map(|a| a.dof).collect();
    (0..dofs.len()).flat_map(|j| (0..j).map(move |i| (i, j))).map(|(i, j)| [dofs[i], dofs[j]]).collect()
}

#[cfg(test)]
mod tests {
    use super::super::testing::grid;
    use super::*;

    #[test]
    fn a_slice_contains_the_cells_of_its_axes() {
        let g = grid(&[4, 5, 6], &[1.0, 1.0, 1.5]);
        let at = PoseError { y: 0.41, ..PoseError::default() };
        let slice = GridSlice::of(&g, &[Dof::Roll, Dof::X], &at).unwrap();
        assert_eq!(slice.cells.len(), 24);
        assert_eq!(slice.at, [(Dof::Y, g.axes[1].center(3))]);
        for (position, index) in slice.cells.iter().enumerate() {
            let pose = g.pose(*index);
            assert_eq!(pose.roll, slice.axes[0].center(position % 6));
            assert_eq!(pose.x, slice.axes[1].center(position / 6));
            assert_eq!(pose.y, slice.at[0].1);
        }
    }

    #[test]
    fn every_axis_kept_is_the_whole_grid() {
        let g = grid(&[3, 4], &[1.0, 1.0]);
        let slice = GridSlice::of(&g, &[Dof::X, Dof::Y], &PoseError::default()).unwrap();
        assert_eq!(slice.cells, (0..12).collect::<Vec<_>>());
        assert_eq!(pairs(&grid(&[2; 4], &[1.0; 4])).len(), 6);
    }

    #[test]
    fn invalid_axes_and_positions_are_refused() {
        let g = grid(&[3, 3], &[1.0, 1.0]);
        let zero = PoseError::default();
        assert!(matches!(GridSlice::of(&g, &[Dof::Yaw], &zero), Err(MeritError::NoAxis { .. })));
        assert!(matches!(GridSlice::of(&g, &[Dof::X, Dof::X], &zero), Err(MeritError::RepeatedAxis { .. })));
        let far = PoseError { y: 1.5, ..zero };
        assert!(matches!(GridSlice::of(&g, &[Dof::X], &far), Err(MeritError::OutsideBox { .. })));
    }
}
