//! Pose errors, rotations, the mounting half turn, and the centre of rotation of a pose error.

use super::{Dof, DofSet};
use crate::tolerance::ROUNDING;
use glam::{DMat3, DQuat, DVec2, DVec3};
use serde::{Deserialize, Serialize};

/// A pose error: lateral offset of the moving *face centre* (D) and the Euler angles (radians).
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PoseError {
    /// Offset of the face centre along x, in D.
    pub x: f64,
    /// Offset of the face centre along y, in D.
    pub y: f64,
    /// Rotation about x, in radians.
    pub roll: f64,
    /// Rotation about y, in radians.
    pub pitch: f64,
    /// Rotation about z, in radians.
    pub yaw: f64,
}

impl PoseError {
    /// From five numbers in the order of [`Dof::ALL`].
    #[inline]
    pub const fn from_array([x, y, roll, pitch, yaw]: [f64; 5]) -> Self {
        Self { x, y, roll, pitch, yaw }
    }

    /// Five numbers in the order of [`Dof::ALL`].
    #[inline]
    pub const fn to_array(self) -> [f64; 5] {
        [self.x, self.y, self.roll, self.pitch, self.yaw]
    }

    /// The rotation `Rz(yaw) · Ry(pitch) · Rx(roll)`.
    #[inline]
    pub fn rotation(&self) -> DMat3 {
        rotation(self.roll, self.pitch, self.yaw)
    }
}

/// `Rz(yaw) · Ry(pitch) · Rx(roll)`, radians.
#[inline]
pub fn rotation(roll: f64, pitch: f64, yaw: f64) -> DMat3 {
    DMat3::from_rotation_z(yaw) * DMat3::from_rotation_y(pitch) * DMat3::from_rotation_x(roll)
}

/// `(roll, pitch, yaw)` of a rotation matrix; pitch in [−π/2, π/2], and roll = 0 at the gimbal pole.
#[inline]
pub fn euler_angles(rotation: &DMat3) -> (f64, f64, f64) {
    let [c0, c1, c2] = [rotation.x_axis, rotation.y_axis, rotation.z_axis];
    let cos_pitch = c0.x.hypot(c0.y);
    let pitch = (-c0.z).atan2(cos_pitch);
    if cos_pitch > ROUNDING {
        (c1.z.atan2(c2.z), pitch, c0.y.atan2(c0.x))
    } else {
        (0.0, pitch, (-c1.x).atan2(c1.y))
    }
}

/// Angle in [0, π] of a rotation about its own axis.
#[inline]
pub fn rotation_angle(rotation: &DMat3) -> f64 {
    let q = DQuat::from_mat3(rotation);
    2.0 * q.xyz().length().atan2(q.w.abs())
}

/// The half turn that brings a half, drawn facing +z, face to face with the other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Mount {
    /// About x: `(x, y, z) → (x, −y, −z)`. The default of spatial connectors.
    X,
    /// About y: `(x, y, z) → (−x, y, −z)`. The default of planar connectors: the profile stays in its plane.
    Y,
}

impl Mount {
    /// Turns a point (or direction), given from the face centre, into the mounted frame.
    #[inline]
    pub fn apply(self, p: DVec3) -> DVec3 {
        match self {
            Self::X => DVec3::new(p.x, -p.y, -p.z),
            Self::Y => DVec3::new(-p.x, p.y, -p.z),
        }
    }
}

/// Lateral position of the COR and rotation of the moving half: they determine the height of first contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CorPose {
    /// x and y of the COR in the world, in D.
    pub lateral: DVec2,
    /// Rotation of the moving half.
    pub rotation: DMat3,
}

impl CorPose {
    /// The COR pose of a pose error. A translation outside `free` is locked at the COR: it stays 0 there.
    #[inline]
    pub fn from_error(error: &PoseError, cor: f64, free: DofSet) -> Self {
        let rotation = error.rotation();
        let face = face_from_cor(&rotation, cor);
        let x = if free.contains(Dof::X) { error.x - face.x } else { 0.0 };
        let y = if free.contains(Dof::Y) { error.y - face.y } else { 0.0 };
        Self { lateral: DVec2::new(x, y), rotation }
    }

    /// The pose error of this COR pose (for a locked translation: the actual position of the face centre).
    #[inline]
    pub fn to_error(&self, cor: f64) -> PoseError {
        let (roll, pitch, yaw) = euler_angles(&self.rotation);
        let face = self.lateral + face_from_cor(&self.rotation, cor).truncate();
        PoseError { x: face.x, y: face.y, roll, pitch, yaw }
    }
}

/// The face centre as seen from the COR, in world axes.
#[inline]
pub fn face_from_cor(rotation: &DMat3, cor: f64) -> DVec3 {
    rotation.z_axis * cor
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::FRAC_PI_2;

    proptest! {
        #[test]
        fn euler_angles_invert_rotation(roll in -3.1..3.1f64, pitch in -1.57..1.57f64, yaw in -3.1..3.1f64) {
            let (r, p, y) = euler_angles(&rotation(roll, pitch, yaw));
            // Near the pole the roll/yaw split loses digits as 1/cos(pitch) ≤ 1/cos(1.57) ≈ 1256.
            prop_assert!((r - roll).abs() < 1e-11 && (p - pitch).abs() < 1e-11 && (y - yaw).abs() < 1e-11);
        }

        #[test]
        fn cor_pose_round_trip(e in proptest::array::uniform5(-1.5..1.5f64), cor in -2.0..2.0f64) {
            let error = PoseError::from_array(e);
            let back = CorPose::from_error(&error, cor, DofSet::ALL).to_error(cor);
            for (a, b) in error.to_array().into_iter().zip(back.to_array()) {
                prop_assert!((a - b).abs() < 1e-12);
            }
        }

        #[test]
        fn mounting_twice_is_the_identity(p in proptest::array::uniform3(-2.0..2.0f64)) {
            let p = DVec3::from_array(p);
            for mount in [Mount::X, Mount::Y] {
                prop_assert_eq!(mount.apply(mount.apply(p)), p);
            }
        }

        #[test]
        fn rotation_angle_of_a_turn_about_an_axis(axis in proptest::array::uniform3(-1.0..1.0f64), angle in 0.0..3.0f64) {
            let axis = DVec3::from_array(axis);
            prop_assume!(axis.length() > 0.1);
            let r = DMat3::from_axis_angle(axis.normalize(), angle);
            prop_assert!((rotation_angle(&r) - angle).abs() < 1e-7);
        }
    }

    #[test]
    fn a_locked_translation_stays_at_the_cor() {
        let free: DofSet = [Dof::X, Dof::Pitch].into_iter().collect();
        let error = PoseError { x: 0.3, y: 0.7, pitch: 0.4, ..PoseError::default() };
        let pose = CorPose::from_error(&error, 0.5, free);
        assert_eq!(pose.lateral.y, 0.0);
        assert!((pose.lateral.x - (0.3 - 0.5 * 0.4f64.sin())).abs() < 1e-15);
    }

    #[test]
    fn order_of_the_angles() {
        // Roll first takes y to z, then pitch (a quarter turn about y) takes z to x, then yaw takes x to y.
        let r = rotation(FRAC_PI_2, FRAC_PI_2, FRAC_PI_2);
        assert!((r * DVec3::Y - DVec3::Y).length() < 1e-15);
    }

    #[test]
    fn positive_cor_lies_in_front_of_the_face() {
        // Aligned: the face centre is at the origin, the COR below it, inside the fixed half.
        let face = face_from_cor(&DMat3::IDENTITY, 0.5);
        assert_eq!(face, DVec3::new(0.0, 0.0, 0.5));
    }
}
