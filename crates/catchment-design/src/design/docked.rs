//! The docking tolerance: the depth and the residual misalignment that count as docked.
//!
//! ```text
//!   [docked]
//!   depth = "0.1 mm"      the seat: poses at most this much above the mated height, connected with the mated pose
//!   x = "0.3 mm"          the largest residual offset that counts as docked: the limit of the pins or latches behind the face
//! ```

use catchment_base::pose::Dof;
use serde::{Deserialize, Serialize};

/// Docking tolerance. `Seat` of the module `contact` defines its effect on a pair of halves.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct Docked {
    /// Largest height above the mated height at which a half at rest counts as docked, in D.
    pub depth: f64,
    /// Largest residual misalignment that counts as docked, in the order of [`Dof::ALL`]: D and radians;
    /// null: the play of the seat, limited.
    pub limits: [Option<f64>; 5],
}

impl Default for Docked {
    fn default() -> Self {
        Self { depth: Self::DEFAULT_DEPTH, limits: [None; 5] }
    }
}

impl Docked {
    /// Above the rounding of drawings, below any chamfer.
    pub const DEFAULT_DEPTH: f64 = 2e-3;
    /// Without a limit a seat may leave a half this much play before the problem counts as ill posed, in D and radians (5°).
    pub const MOST_PLAY: [f64; 2] = [0.05, 5.0 / 180.0 * std::f64::consts::PI];

    /// The limit of an error, if it has one: D or radians.
    #[inline]
    pub const fn limit(&self, dof: Dof) -> Option<f64> {
        self.limits[dof.index()]
    }

    /// Largest play of an error: its limit, or the default.
    #[inline]
    pub fn most_play(&self, dof: Dof) -> f64 {
        self.limit(dof).unwrap_or(Self::MOST_PLAY[usize::from(dof.is_rotation())])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use catchment_base::tolerance::TOUCHING;

    #[test]
    fn a_seat_is_far_deeper_than_the_ends_of_motions_are_exact() {
        assert!(Docked::default().depth >= 10.0 * TOUCHING);
    }
}
