//! The surfaces of the two halves in contact; for a connector in layers, whether each touches its partner.
//!
//! ```text
//!     ┌─────1─────┐ ┌─────2─────┐     moving half, off by y
//!   ┌─────1─────┐ ┌─────2─────┐       fixed half: its layer 2 is under the moving layer 1 as well
//! ```
//!
//! Partners are the surfaces with the same number. Lengths in D. Not promised: a result for a half under an
//! overhang; the query assumes a half lowered from above.

use super::Pair;
use crate::design::Alignment;
use crate::pose::{CorPose, PoseError};
use crate::tolerance::TOUCHING;

impl Pair {
    /// Whether a contact at a pose error, with the moving half lowered onto the fixed half, is between
    /// surfaces that are not partners.
    pub fn crosses(&self, error: &PoseError) -> bool {
        let Alignment { center_of_rotation, free, rotation_length, .. } = self.alignment;
        let pose = CorPose::from_error(error, center_of_rotation, free);
        let mut nearby = self.about(TOUCHING);
        nearby.turn(&pose.rotation, pose.lateral, TOUCHING / rotation_length, TOUCHING);
        let Some(height) = nearby.height_below(pose.lateral, f64::INFINITY).0 else { return false };
        let mut result = Vec::new();
        nearby.contacts(pose.lateral.extend(height), TOUCHING, &mut result);
        result.iter().any(|(_, meeting)| meeting.shapes[0] != meeting.shapes[1])
    }
}
