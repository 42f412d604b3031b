//! Placement of parts: from the coordinates of their files to the mated pose.
//!
//! ```text
//!   drawn = "facing"                              drawn = "assembled"
//!     each part in a frame of its own:              both parts in one frame, docked:
//!     facing ──▶ +z, then rotate, then translate    rotate, translate, then approach ──▶ −z
//!        ▲ its face centre on the z axis               ▲ fixed and moving share their face centre
//! ```
//!
//! The face centres of the mated halves coincide; pose errors are offsets of the face centre, and the centre
//! of rotation is measured from it. Its default height is mid height of the region
//! that the mated halves share along the approach, with the halves mated at first contact at zero error.

use serde::{Deserialize, Serialize};

/// Frames in which the two parts are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum DrawnFrames {
    /// Each half in its own frame, facing +z after placement; a half turn brings the moving half face to face
    /// with the fixed half.
    #[default]
    Facing,
    /// Both halves docked, in a common frame.
    Assembled {
        /// Unit vector of the approach of the moving half.
        approach: [f64; 3],
        /// The face centre in the common frame, in D; `None`: the centre of the bounding box of the region
        /// that the mated halves share.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        face_center: Option<[f64; 3]>,
    },
}

impl DrawnFrames {
    /// Whether it is the way that needs no word.
    pub(super) fn is_facing(&self) -> bool {
        *self == Self::Facing
    }
}

/// Rotation and translation of a part from the coordinates of its file; applied in the order of the fields.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PartPlacement {
    /// Unit vector in which the part faces in its file; rotated to +z by the shortest rotation, about x for
    /// −z.
    pub facing: [f64; 3],
    /// Rotations about x, then y, then z, in radians.
    pub rotate: [f64; 3],
    /// Translation, in D.
    pub translate: [f64; 3],
}

impl PartPlacement {
    /// As the file has it.
    pub const NONE: Self = Self { facing: [0.0, 0.0, 1.0], rotate: [0.0; 3], translate: [0.0; 3] };

    /// Whether the part stays as its file has it.
    pub(super) fn is_none(&self) -> bool {
        *self == Self::NONE
    }
}

impl Default for PartPlacement {
    fn default() -> Self {
        Self::NONE
    }
}
