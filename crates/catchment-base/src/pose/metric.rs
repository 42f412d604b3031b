//! Rotations in Euler angles, and the ρ-metric in which a rotation has a length.
//!
//! ```text
//!   ω = a_roll·roll˙ + a_pitch·pitch˙ + a_yaw·yaw˙        a_roll = Rz(yaw)·Ry(pitch)·x̂,  a_pitch = Rz(yaw)·ŷ,  a_yaw = ẑ
//!
//!   |step|² = |v|² + ρ²·|ω|²                              v of the COR in x and y, in D; ω in radians; ρ the rotation length
//! ```
//!
//! An overdamped half in this metric, pushed down, moves against the gradient g of the height of first contact:
//!
//! ```text
//!   v  = −(∂h/∂x, ∂h/∂y)      of the centre of rotation, D
//!   ω  = −ρ⁻² ∂h/∂ω            world axes; with all three rotations free any axis is as good as another,
//!                              with fewer, only rotations about the axes of the free angles are possible
//!   ẋ_face = v + ω × (R ẑ·cor)  the error is that of the face centre
//!   (roll, pitch, yaw)˙         the rates of the angles that compose ω
//! ```
//!
//! Not promised: results at the pole of the Euler angles, pitch = ±90°, at which the axes of roll and yaw
//! coincide.

use super::{Dof, DofSet, PoseError, face_from_cor};
use glam::{DMat3, DVec2, DVec3};

/// The three rotations, in the order in which they are applied.
pub const ROTATIONS: [Dof; 3] = [Dof::Roll, Dof::Pitch, Dof::Yaw];

/// The world axes, unit, about which roll, pitch and yaw turn a half that has these angles, in radians.
#[inline]
pub fn euler_axes(pitch: f64, yaw: f64) -> [DVec3; 3] {
    let about_z = DMat3::from_rotation_z(yaw);
    let roll = about_z * (DMat3::from_rotation_y(pitch) * DVec3::X);
    [roll, about_z * DVec3::Y, DVec3::Z]
}

/// Angle in [0, π] between two rotations; near 0 exact to 10⁻⁸ only.
#[inline]
pub fn angle_between(a: &DMat3, b: &DMat3) -> f64 {
    let turn = DMat3::to_cols_array(&(a.transpose() * *b));
    ((turn[0] + turn[4] + turn[8] - 1.0) / 2.0).clamp(-1.0, 1.0).acos()
}

/// Length in D of a step of the COR in x and y (D) with a turn by `angle` (radians), in the metric of `rho` (D).
#[inline]
pub fn step_length(lateral: DVec2, angle: f64, rho: f64) -> f64 {
    lateral.length().hypot(rho * angle)
}

/// Rates of roll, pitch and yaw (per D of descent) that a pull `torque` on the Euler angles makes, ρ⁻²·G⁻¹·torque with
/// G the products of the free angles' axes. `torque` is 0 for locked angles, and so are their rates.
#[inline]
pub fn euler_rates(pitch: f64, yaw: f64, free: DofSet, rho: f64, torque: [f64; 3]) -> [f64; 3] {
    let axes = euler_axes(pitch, yaw);
    let entry = |j: usize, k: usize| {
        if free.contains(ROTATIONS[j]) && free.contains(ROTATIONS[k]) {
            axes[j].dot(axes[k])
        } else {
            f64::from(u8::from(j == k))
        }
    };
    let gram = DMat3::from_cols_array_2d(&std::array::from_fn(|j| std::array::from_fn(|k| entry(j, k))));
    (gram.inverse() * DVec3::from_array(torque) / (rho * rho)).to_array()
}

/// The overdamped motion of a pose error at a given rotation, as a linear map of the height's gradient.
///
/// Column k is the velocity of the error (x, y of the *face centre*, roll, pitch, yaw) for a unit of the k-th
/// component of the gradient: ∂h/∂x and ∂h/∂y at the COR, then ∂h/∂ω about the COR in world axes.
#[inline]
pub fn descent_map(error: &PoseError, cor: f64, rho: f64, free: DofSet) -> [[f64; 5]; 5] {
    let per_turn = rho.powi(-2);
    let rotation = error.rotation();
    let face = face_from_cor(&rotation, cor);
    let axes = euler_axes(error.pitch, error.yaw);
    let rates_of = DMat3::from_cols(axes[0], axes[1], axes[2]).inverse();
    std::array::from_fn(|component| {
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
            for (k, dof) in ROTATIONS.into_iter().enumerate() {
                if free.contains(dof) {
                    rates[k] = turn.dot(axes[k]);
                    possible += axes[k] * rates[k];
                }
            }
            turn = possible;
            rates
        };
        let swing = turn.cross(face);
        [velocity[0] + swing.x, velocity[1] + swing.y, rates[0], rates[1], rates[2]]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pose::{rotation, rotation_angle};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn euler_axes_are_those_of_small_turns(angles in proptest::array::uniform3(-1.4..1.4f64)) {
            const STEP: f64 = 1e-6;
            let at = |angles: [f64; 3]| rotation(angles[0], angles[1], angles[2]);
            for (k, axis) in euler_axes(angles[1], angles[2]).into_iter().enumerate() {
                let mut turned = angles;
                turned[k] += STEP;
                // R(a + δ)·R(a)ᵀ = 1 + δ·[axis]× to second order.
                let turn = (at(turned) * at(angles).transpose() - DMat3::IDENTITY) * (1.0 / STEP);
                let result = DVec3::new(turn.y_axis.z, turn.z_axis.x, turn.x_axis.y);
                prop_assert!((result - axis).length() < 2e-6, "{k}: {result} {axis}");
            }
        }

        #[test]
        fn the_angle_between_is_that_of_the_turn(a in proptest::array::uniform3(-1.5..1.5f64), b in proptest::array::uniform3(-1.5..1.5f64)) {
            let [a, b] = [a, b].map(|r| rotation(r[0], r[1], r[2]));
            prop_assert!((angle_between(&a, &b) - rotation_angle(&(a.transpose() * b))).abs() < 1e-7);
        }

        #[test]
        fn descent_falls_as_fast_as_its_length_squared(
            error in proptest::array::uniform5(-1.2..1.2f64), gradient in proptest::array::uniform5(-1.0..1.0f64), rho in 0.2..2.0f64,
        ) {
            // With every error free v = −M⁻¹g, so −g·v is |v|² in the ρ-metric; the COR itself is followed with cor = 0.
            let columns = descent_map(&PoseError::from_array(error), 0.0, rho, DofSet::ALL);
            let velocity: [f64; 5] =
                std::array::from_fn(|k| columns.iter().zip(gradient).map(|(column, g)| column[k] * g).sum());
            let axes = euler_axes(error[3], error[4]);
            let turn: DVec3 = axes.into_iter().zip(&velocity[2..]).map(|(axis, rate)| axis * *rate).sum();
            let squared = velocity[0].powi(2) + velocity[1].powi(2) + rho * rho * turn.length_squared();
            let fall = gradient[0].powi(2) + gradient[1].powi(2)
                + DVec3::from_slice(&gradient[2..]).length_squared() / (rho * rho);
            prop_assert!((squared - fall).abs() < 1e-9 * (1.0 + fall));
            // The same rates from the pull on the angles themselves.
            let torque = axes.map(|axis| -axis.dot(DVec3::from_slice(&gradient[2..])));
            let rates = euler_rates(error[3], error[4], DofSet::ALL, rho, torque);
            for (a, b) in rates.into_iter().zip(&velocity[2..]) {
                prop_assert!((a - b).abs() < 1e-8 * (1.0 + b.abs()) / (rho * rho), "{a} {b}");
            }
        }
    }

    #[test]
    fn locked_angles_do_not_turn() {
        let free: DofSet = [Dof::X, Dof::Pitch].into_iter().collect();
        let rates = euler_rates(0.3, 0.0, free, 0.5, [0.0, 1.0, 0.0]);
        assert_eq!(rates, [0.0, 4.0, 0.0]);
        let columns = descent_map(&PoseError { pitch: 0.3, ..PoseError::default() }, 0.0, 0.5, free);
        assert!(columns.iter().all(|column| column[2] == 0.0 && column[4] == 0.0));
        assert!((step_length(DVec2::new(0.3, 0.0), 0.8, 0.5) - 0.5).abs() < 1e-15);
    }
}
