//! Free rotations, and the locking of the others.
//!
//! ```text
//!   R = Rz(yaw)·Ry(pitch)·Rx(roll)     hinges one inside the other: z outermost, x innermost
//!   ω = Σ axisₖ(angles)·ȧₖ             over the free angles
//! ```
//!
//! An engine's locked axes are fixed in the world, which is correct for one free rotation and wrong for two:
//! rotating to and fro about two axes adds up to a rotation about the third. Here the inertia is infinite
//! about the axes that the free hinges cannot reach, `A·(Aᵀ·I·A)⁻¹·Aᵀ` in place of `I⁻¹`, with the axes at
//! the beginning of a step; the second-order deviation of a step from the hinges is removed by recovering the
//! angles and rebuilding the rotation.

use crate::pose::{Dof, DofSet, euler_angles, rotation};
use glam::{DMat3, DVec3};

/// The rotations that are free.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Turning {
    free: [bool; 3],
}

impl Turning {
    /// Those of `free`.
    pub(super) fn new(free: DofSet) -> Self {
        Self { free: [Dof::Roll, Dof::Pitch, Dof::Yaw].map(|dof| free.contains(dof)) }
    }

    /// Whether all three are: there is nothing to lock.
    pub(super) fn is_spherical(self) -> bool {
        self.free == [true; 3]
    }

    /// Whether the hinges move when the half rotates.
    pub(super) fn hinges_move(self) -> bool {
        self.free.iter().filter(|free| **free).count() == 2
    }

    /// (roll, pitch, yaw) of a rotation that the free hinges can make, or nearly; locked angles are 0.
    pub(super) fn angles(self, r: &DMat3) -> [f64; 3] {
        let [x, y, z] = [r.x_axis, r.y_axis, r.z_axis];
        match self.free {
            [true, true, true] => {
                let (roll, pitch, yaw) = euler_angles(r);
                [roll, pitch, yaw]
            }
            [true, true, false] => {
                let pitch = (-x.z).atan2(x.x);
                let inner = (DMat3::from_rotation_y(-pitch) * *r).y_axis;
                [inner.z.atan2(inner.y), pitch, 0.0]
            }
            [true, false, true] => {
                let yaw = x.y.atan2(x.x);
                let inner = (DMat3::from_rotation_z(-yaw) * *r).y_axis;
                [inner.z.atan2(inner.y), 0.0, yaw]
            }
            [false, true, true] => {
                let yaw = (-y.x).atan2(y.y);
                let inner = (DMat3::from_rotation_z(-yaw) * *r).x_axis;
                [0.0, (-inner.z).atan2(inner.x), yaw]
            }
            [true, false, false] => [y.z.atan2(y.y), 0.0, 0.0],
            [false, true, false] => [0.0, z.x.atan2(z.z), 0.0],
            [false, false, true] => [0.0, 0.0, x.y.atan2(x.x)],
            [false, false, false] => [0.0; 3],
        }
    }

    /// The free hinge axes in the world, outermost first, with their names.
    pub(super) fn hinges(self, [_, pitch, yaw]: [f64; 3]) -> Vec<(Dof, DVec3)> {
        let outer = rotation(0.0, pitch, yaw);
        let all = [
            (Dof::Yaw, DVec3::Z),
            (Dof::Pitch, DMat3::from_rotation_z(yaw).y_axis),
            (Dof::Roll, outer.x_axis),
        ];
        all.into_iter().filter(|(dof, _)| self.free[dof.index() - Dof::Roll.index()]).collect()
    }

    /// The inverse inertia that the free hinges leave of `inertia` (body axes) at `rotation`: symmetric, in the world.
    pub(super) fn inverse_inertia(self, inertia: &DMat3, r: &DMat3) -> DMat3 {
        let world = *r * *inertia * r.transpose();
        let axes: Vec<DVec3> = self.hinges(self.angles(r)).into_iter().map(|(_, axis)| axis).collect();
        match axes[..] {
            [] => DMat3::ZERO,
            [a] => outer(a, a) * (1.0 / a.dot(world * a)),
            [a, b] => {
                // The plane of the two, by an orthonormal pair in it: hinge axes may come close to each other.
                let u = a;
                let v = a.cross(b).cross(a).normalize_or_zero();
                let (uu, uv, vv) = (u.dot(world * u), u.dot(world * v), v.dot(world * v));
                let scale = 1.0 / (uu * vv - uv * uv);
                (outer(u, u) * vv + outer(v, v) * uu - (outer(u, v) + outer(v, u)) * uv) * scale
            }
            _ => world.inverse(),
        }
    }
}

/// a·bᵀ.
fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn angles_are_read_off_and_hinges_are_the_derivatives(code in 0u8..8, a in proptest::array::uniform3(-1.5..1.5f64)) {
            let free: DofSet = [Dof::Roll, Dof::Pitch, Dof::Yaw].into_iter().filter(|d| code >> (d.index() - 2) & 1 == 1).collect();
            let turning = Turning::new(free);
            let angles: [f64; 3] = std::array::from_fn(|k| if turning.free[k] { a[k] } else { 0.0 });
            let r = rotation(angles[0], angles[1], angles[2]);
            for (read, set) in turning.angles(&r).into_iter().zip(angles) {
                prop_assert!((read - set).abs() < 1e-12);
            }
            for (dof, axis) in turning.hinges(angles) {
                let mut moved = angles;
                moved[dof.index() - 2] += 1e-6;
                let turn = rotation(moved[0], moved[1], moved[2]) * r.transpose();
                // The antisymmetric part of a small turn is its axis times its angle; the rest is of second order.
                let seen = DVec3::new(turn.y_axis.z, turn.z_axis.x, turn.x_axis.y) * 1e6;
                prop_assert!((seen - axis).length() < 1e-5);
            }
            // Torques turn the body about the free hinges only, and by the inertia about them.
            let inertia = DMat3::from_diagonal(DVec3::new(1.0, 2.0, 4.0));
            let inverse = turning.inverse_inertia(&inertia, &r);
            prop_assert!(inverse.abs_diff_eq(inverse.transpose(), 1e-12));
            let world = r * inertia * r.transpose();
            for (_, axis) in turning.hinges(angles) {
                // Of the momentum of a turn about a free axis nothing is lost: I⁻¹·I·axis = axis within the hinges.
                prop_assert!((inverse * (world * axis) - axis).length() < 1e-9);
            }
        }
    }
}
