//! A regular grid over any subset of the five pose errors.

use crate::design::Alignment;
use crate::pose::{Dof, PoseError};
use serde::{Deserialize, Serialize};

/// A sampled axis of the error grid: `cells` equal cells over [lo, hi], sampled at their centres.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct GridAxis {
    /// The error.
    pub dof: Dof,
    /// Lower border of the axis, in D or radians.
    pub lo: f64,
    /// Upper border of the axis, in D or radians.
    pub hi: f64,
    /// Number of cells.
    pub cells: usize,
}

impl GridAxis {
    /// Width of a cell.
    pub fn step(&self) -> f64 {
        (self.hi - self.lo) / self.cells as f64
    }

    /// Centre of cell `k`.
    pub fn center(&self, k: usize) -> f64 {
        self.lo + (k as f64 + 0.5) * self.step()
    }

    /// The cell that holds `value`, if any; a value on a border belongs to the upper cell, on `hi` to the last.
    pub fn cell_of(&self, value: f64) -> Option<usize> {
        if !(self.lo..=self.hi).contains(&value) {
            return None;
        }
        Some((((value - self.lo) / self.step()) as usize).min(self.cells - 1))
    }
}

/// A regular grid. Axes are in the order of [`Dof::ALL`]; the *first* axis runs fastest in memory:
/// `index = k₀ + n₀·(k₁ + n₁·(k₂ + …))`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Grid {
    /// The sampled axes; errors without an axis are 0.
    pub axes: Vec<GridAxis>,
}

impl Grid {
    /// The error box of `alignment`, `cells(dof)` cells per free axis.
    pub fn over(alignment: &Alignment, mut cells: impl FnMut(Dof) -> usize) -> Self {
        let axis = |dof: Dof| {
            let half = alignment.half_range(dof);
            GridAxis { dof, lo: -half, hi: half, cells: cells(dof) }
        };
        Self { axes: alignment.free.iter().map(axis).collect() }
    }

    /// Number of cells; `None` if it overflows.
    pub fn checked_len(&self) -> Option<usize> {
        self.axes.iter().try_fold(1usize, |n, a| n.checked_mul(a.cells))
    }

    /// Number of cells.
    pub fn len(&self) -> usize {
        self.axes.iter().map(|a| a.cells).product()
    }

    /// Whether some axis has no cell.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of cells per axis, first axis first.
    pub fn shape(&self) -> Vec<usize> {
        self.axes.iter().map(|a| a.cells).collect()
    }

    /// The axis of `dof`, if it is sampled.
    pub fn axis(&self, dof: Dof) -> Option<&GridAxis> {
        self.axes.iter().find(|a| a.dof == dof)
    }

    /// Measure of a cell, Dᵃ·radᵇ.
    pub fn cell_measure(&self) -> f64 {
        self.axes.iter().map(GridAxis::step).product()
    }

    /// Measure of the whole box, Dᵃ·radᵇ.
    pub fn measure(&self) -> f64 {
        self.axes.iter().map(|a| a.hi - a.lo).product()
    }

    /// Per-axis cell numbers of a cell.
    pub fn cell(&self, mut index: usize) -> Vec<usize> {
        self.axes
            .iter()
            .map(|a| {
                let k = index % a.cells;
                index /= a.cells;
                k
            })
            .collect()
    }

    /// Index of the cell with these per-axis numbers.
    pub fn index(&self, cell: &[usize]) -> usize {
        self.axes.iter().zip(cell).rev().fold(0, |index, (a, k)| index * a.cells + k)
    }

    /// The pose error at the centre of a cell.
    pub fn pose(&self, index: usize) -> PoseError {
        let mut error = [0.0; 5];
        for (axis, k) in self.axes.iter().zip(self.cell(index)) {
            error[axis.dof.index()] = axis.center(k);
        }
        PoseError::from_array(error)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pose::{DofSet, Mount};

    #[test]
    fn index_and_cell_are_inverse_and_x_runs_fastest() {
        let alignment = Alignment::new(DofSet::ALL, Mount::X);
        let grid = Grid::over(&alignment, |dof| 2 + dof.index());
        assert_eq!(grid.shape(), [2, 3, 4, 5, 6]);
        for index in 0..grid.len() {
            assert_eq!(grid.index(&grid.cell(index)), index);
        }
        assert_eq!(grid.cell(1), [1, 0, 0, 0, 0]);
        assert!((grid.cell_measure() * grid.len() as f64 - grid.measure()).abs() < 1e-12);
    }

    #[test]
    fn cell_of_inverts_center() {
        let axis = GridAxis { dof: Dof::X, lo: -1.0, hi: 1.0, cells: 7 };
        for k in 0..7 {
            assert_eq!(axis.cell_of(axis.center(k)), Some(k));
        }
        assert_eq!(axis.cell_of(1.0), Some(6));
        assert_eq!(axis.cell_of(1.1), None);
    }
}
