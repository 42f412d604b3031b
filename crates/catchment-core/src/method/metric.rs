//! From the gradient of the height to the velocity of the pose error, in cells of the grid.

use crate::contact::Pair;
use crate::landscape::{Gradient, Grid};
use crate::pose::{PoseError, descent_map};

/// The linear map from gradients to velocities at a given rotation, velocities in cells of the grid's axes,
/// in their order.
pub(super) struct Metric {
    /// Column k: velocity for a unit of the k-th component of the gradient.
    columns: [[f64; 5]; 5],
}

impl Metric {
    pub(super) fn new(pair: &Pair, grid: &Grid, error: &PoseError) -> Self {
        let alignment = &pair.alignment;
        let map = descent_map(error, alignment.center_of_rotation, alignment.rotation_length, alignment.free);
        let in_cells = |errors: [f64; 5]| {
            let mut cells = [0.0; 5];
            for (cell, axis) in cells.iter_mut().zip(&grid.axes) {
                *cell = errors[axis.dof.index()] / axis.step();
            }
            cells
        };
        Self { columns: map.map(in_cells) }
    }

    pub(super) fn velocity(&self, gradient: &Gradient) -> [f64; 5] {
        let mut velocity = [0.0; 5];
        for (column, g) in self.columns.iter().zip(gradient) {
            for (v, c) in velocity.iter_mut().zip(column) {
                *v += c * g;
            }
        }
        velocity
    }
}
