//! The classical rule of steepest neighbours: to the neighbour with the greatest fall per distance.
//!
//! ```text
//!   distance² = |step of the COR, in x and y|² + (ρ·angle between the rotations)²
//! ```
//!
//! This is the metric of steepest descent in exact motions, too. The grid is over the offsets of the face
//! centre, so a step that rotates the half also moves its COR. Directions are still those of the grid: the
//! rule does not converge as the grid is refined, and is provided for comparison.

use super::drain::{FLAT, OUTSIDE};
use crate::design::Alignment;
use crate::exec::{Cancelled, Exec};
use crate::landscape::{Grid, GridAxis};
use crate::pose::{Dof, angle_between, face_from_cor, step_length};
use glam::{DMat3, DVec2};
use rayon::prelude::*;
use std::sync::atomic::AtomicU32;

/// Distances between the cells of a grid.
pub(super) struct Metric<'a> {
    pub(super) grid: &'a Grid,
    pub(super) alignment: &'a Alignment,
}

/// A step to a neighbour.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Step {
    /// Added to the index of the cell.
    delta: isize,
    /// Along x and y, in cells.
    lateral: [isize; 2],
    /// In D.
    length: f64,
}

impl Metric<'_> {
    /// The downhill link of every cell: the first in memory among equally steep links.
    pub(super) fn steepest(
        &self,
        heights: &[f32],
        ways: &mut [AtomicU32],
        exec: &Exec,
    ) -> Result<(), Cancelled> {
        let [nx, ny] = self.lateral_cells();
        ways.par_chunks_exact_mut(nx * ny).enumerate().try_for_each(|(rotation, ways)| {
            exec.check()?;
            let steps = self.steps(rotation);
            let first = rotation * nx * ny;
            for (at, way) in ways.iter_mut().enumerate() {
                let here = heights[first + at];
                if here == f32::NEG_INFINITY {
                    *way.get_mut() = OUTSIDE;
                    continue;
                }
                let (x, y) = (at % nx, at / nx);
                let mut best = (0.0, FLAT);
                for step in &steps {
                    let [dx, dy] = step.lateral;
                    if x.checked_add_signed(dx).is_none_or(|x| x >= nx)
                        || y.checked_add_signed(dy).is_none_or(|y| y >= ny)
                    {
                        continue;
                    }
                    let near = (first + at).wrapping_add_signed(step.delta);
                    let slope = (f64::from(here) - f64::from(heights[near])) / step.length;
                    if slope > best.0 {
                        best = (slope, near as u32);
                    }
                }
                *way.get_mut() = best.1;
            }
            Ok(())
        })
    }

    /// Cells along x and y; 1 for an axis that is not sampled.
    fn lateral_cells(&self) -> [usize; 2] {
        [Dof::X, Dof::Y].map(|dof| self.grid.axis(dof).map_or(1, |axis| axis.cells))
    }

    /// Steps from any cell at a rotation, in the order of memory.
    fn steps(&self, rotation: usize) -> Vec<Step> {
        let [nx, ny] = self.lateral_cells();
        let size = [Dof::X, Dof::Y].map(|dof| self.grid.axis(dof).map_or(0.0, GridAxis::step));
        let slab = nx * ny;
        let (here, cor) = self.turned(rotation * slab);
        let rho = self.alignment.rotation_length;
        let mut steps = Vec::new();
        for near in self.rotations_around(rotation) {
            let (there, moved) = self.turned(near * slab);
            let angle = angle_between(&here, &there);
            for dy in if ny > 1 { -1..=1 } else { 0..=0isize } {
                for dx in if nx > 1 { -1..=1 } else { 0..=0isize } {
                    let delta = (near * slab).cast_signed() - (rotation * slab).cast_signed();
                    let delta = delta + dx + dy * nx.cast_signed();
                    let offset = DVec2::new(dx as f64 * size[0], dy as f64 * size[1]) + moved - cor;
                    let length = step_length(offset, angle, rho);
                    if delta != 0 {
                        steps.push(Step { delta, lateral: [dx, dy], length });
                    }
                }
            }
        }
        steps
    }

    /// The rotation of a cell, and its COR's offset as far as the rotation makes it.
    fn turned(&self, cell: usize) -> (DMat3, DVec2) {
        let rotation = self.grid.pose(cell).rotation();
        let face = face_from_cor(&rotation, self.alignment.center_of_rotation);
        let free = |dof| if self.alignment.free.contains(dof) { -1.0 } else { 0.0 };
        (rotation, DVec2::new(free(Dof::X) * face.x, free(Dof::Y) * face.y))
    }

    /// Numbers of the rotations at most one step away along every axis, itself included, ascending.
    fn rotations_around(&self, rotation: usize) -> Vec<usize> {
        let mut around = vec![0];
        let (mut rest, mut stride) = (rotation, 1);
        for axis in self.grid.axes.iter().filter(|axis| axis.dof.is_rotation()) {
            let k = rest % axis.cells;
            rest /= axis.cells;
            around = (k.saturating_sub(1)..=(k + 1).min(axis.cells - 1))
                .flat_map(|k| around.iter().map(move |lower| lower + k * stride))
                .collect();
            stride *= axis.cells;
        }
        around
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pose::{DofSet, Mount};

    #[test]
    fn a_step_is_as_long_as_its_cor_moves_and_turns() {
        let alignment = Alignment {
            center_of_rotation: 0.5,
            rotation_length: 0.25,
            ..Alignment::new([Dof::X, Dof::Pitch].into_iter().collect(), Mount::Y)
        };
        let grid = Grid::over(&alignment, |_| 5);
        let metric = Metric { grid: &grid, alignment: &alignment };
        let steps = metric.steps(2);
        assert_eq!(steps.len(), 8);
        let (dx, angle) = (0.4, std::f64::consts::PI / 5.0);
        for step in steps {
            let turns = (step.delta - step.lateral[0]) / 5;
            let moved = step.lateral[0] as f64 * dx - turns as f64 * 0.5 * angle.sin();
            let expected = moved.hypot(0.25 * angle * turns as f64);
            assert!((step.length - expected).abs() < 1e-12, "{step:?} {expected}");
        }
    }

    #[test]
    fn five_axes_have_all_their_neighbours_in_the_order_of_memory() {
        let alignment = Alignment::new(DofSet::ALL, Mount::X);
        let grid = Grid::over(&alignment, |_| 3);
        let metric = Metric { grid: &grid, alignment: &alignment };
        let steps = metric.steps(13);
        assert_eq!(steps.len(), 242);
        assert!(steps.is_sorted_by_key(|s| s.delta));
        assert_eq!(metric.steps(0).len(), 71);
        assert!(steps.iter().all(|s| s.length > 0.0));
    }
}
