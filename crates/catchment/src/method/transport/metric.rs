//! From the gradient of the height to the velocity of the pose error.
//!
//! ```text
//!   v  = −(∂h/∂x, ∂h/∂y)      of the centre of rotation, D
//!   ω  = −ρ⁻² ∂h/∂ω            world axes; with all three rotations free any axis is as good as another,
//!                              otherwise only turns about the axes of the free angles are possible
//!   ẋ_face = v + ω × (R ẑ·cor)  the error is that of the face centre
//!   (roll, pitch, yaw)˙         those whose axes make up ω
//! ```

use crate::contact::Pair;
use crate::landscape::{Gradient, Grid};
use crate::pose::{Dof, PoseError, face_from_cor};
use glam::{DMat3, DVec3};

/// The linear map from gradients to velocities at one rotation, velocities in cells of the grid's axes, in their order.
pub(super) struct Metric {
    /// Column k: velocity for a unit of the k-th component of the gradient.
    columns: [[f64; 5]; 5],
}

impl Metric {
    pub(super) fn new(pair: &Pair, grid: &Grid, error: &PoseError) -> Self {
        let free = pair.alignment.free;
        let per_turn = pair.alignment.rotation_length.powi(-2);
        let rotation = error.rotation();
        let face = face_from_cor(&rotation, pair.alignment.center_of_rotation);
        let about_z = DMat3::from_rotation_z(error.yaw);
        let roll_axis = about_z * (DMat3::from_rotation_y(error.pitch) * DVec3::X);
        let axes = [roll_axis, about_z * DVec3::Y, DVec3::Z];
        // Singular only at the pole of the Euler angles, pitch = ±90°, where no cell has its centre.
        let rates_of = DMat3::from_cols(axes[0], axes[1], axes[2]).inverse();
        let columns = std::array::from_fn(|component| {
            let mut velocity = [0.0; 5];
            let mut turn = DVec3::ZERO;
            match component {
                0 | 1 => velocity[component] = -1.0,
                _ => turn[component - 2] = -per_turn,
            }
            let rates = if free.rotations() == 3 {
                (rates_of * turn).to_array()
            } else {
                let mut rates = [0.0; 3];
                let mut possible = DVec3::ZERO;
                for (k, dof) in [Dof::Roll, Dof::Pitch, Dof::Yaw].into_iter().enumerate() {
                    if free.contains(dof) {
                        rates[k] = turn.dot(axes[k]);
                        possible += axes[k] * rates[k];
                    }
                }
                turn = possible;
                rates
            };
            let swing = turn.cross(face);
            let errors = [velocity[0] + swing.x, velocity[1] + swing.y, rates[0], rates[1], rates[2]];
            let mut cells = [0.0; 5];
            for (k, axis) in grid.axes.iter().enumerate() {
                cells[k] = errors[axis.dof.index()] / axis.step();
            }
            cells
        });
        Self { columns }
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
