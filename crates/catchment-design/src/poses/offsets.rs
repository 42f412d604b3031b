//! The point at which offsets are measured.
//!
//! ```text
//!   face centre  ●          (x, y) of the face centre = (x, y) of the COR + the lateral part of R·(0, 0, cor)
//!                 ╲ cor·D
//!                  ○  centre of rotation
//! ```
//!
//! A locked translation is locked at the centre of rotation. The face centre of a half tilted about it still
//! lies beside the approach axis.

use crate::design::Alignment;
use catchment_base::pose::{Dof, PoseError, face_from_cor};
use serde::{Deserialize, Serialize};

/// The point of the moving half at which the offsets x and y are measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum OffsetsAt {
    /// The face centre, as in [`PoseError`].
    #[default]
    Face,
    /// The centre of rotation.
    Cor,
}

impl OffsetsAt {
    /// The two translations.
    pub(super) const LATERAL: [Dof; 2] = [Dof::X, Dof::Y];

    /// A pose error (of the face centre, in D and radians) with its offsets measured at this point. At the
    /// centre of rotation, locked offsets are 0.
    #[must_use]
    pub fn measure(self, error: &PoseError, alignment: &Alignment) -> PoseError {
        match self {
            Self::Face => *error,
            Self::Cor => {
                let face = face_from_cor(&error.rotation(), alignment.center_of_rotation);
                let at = |dof: Dof, offset: f64| if alignment.free.contains(dof) { offset } else { 0.0 };
                PoseError { x: at(Dof::X, error.x - face.x), y: at(Dof::Y, error.y - face.y), ..*error }
            }
        }
    }

    /// The pose error whose offsets, measured at this point, are those of `measured`.
    #[must_use]
    pub fn to_face(self, measured: &PoseError, alignment: &Alignment) -> PoseError {
        match self {
            Self::Face => *measured,
            Self::Cor => {
                let face = face_from_cor(&measured.rotation(), alignment.center_of_rotation);
                PoseError { x: measured.x + face.x, y: measured.y + face.y, ..*measured }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use catchment_base::pose::{CorPose, DofSet, Mount};

    #[test]
    fn the_face_centre_swings_about_the_centre_of_rotation() {
        let free = DofSet::ALL.without(Dof::Y);
        let alignment = Alignment { center_of_rotation: 0.5, ..Alignment::new(free, Mount::X) };
        let (pitch, yaw): (f64, f64) = (0.3, 0.2);
        let measured = PoseError { x: 0.1, pitch, yaw, ..PoseError::default() };
        let error = OffsetsAt::Cor.to_face(&measured, &alignment);
        // Rz(yaw)·Ry(pitch)·(0, 0, cor) = cor·(cos yaw·sin pitch, sin yaw·sin pitch, cos pitch); rounded twice.
        assert!((error.x - 0.1 - 0.5 * yaw.cos() * pitch.sin()).abs() < 1e-15);
        assert!((error.y - 0.5 * yaw.sin() * pitch.sin()).abs() < 1e-15);
        let lateral = CorPose::from_error(&error, 0.5, DofSet::ALL).lateral;
        assert!((lateral.x - 0.1).abs() < 1e-15 && lateral.y.abs() < 1e-15);
        let back = OffsetsAt::Cor.measure(&error, &alignment);
        assert!((back.x - 0.1).abs() < 1e-15 && back.y == 0.0);
        assert_eq!(OffsetsAt::Face.to_face(&measured, &alignment), measured);
        assert_eq!(OffsetsAt::Face.measure(&measured, &alignment), measured);
    }
}
