//! The corners of the O, ranked by their effect on the closing link: error and pressing force.
//!
//! ```text
//!   push  = torque / distance of the nearest corner from the docking face     a short lever, but across the approach if
//!                                                                             the corner lies on the face's axis
//!   press = torque / longest lever along the normal                           the pressing force that every joint can resist
//! ```
//!
//! The dissertation selects a "kinematic arrangement" for a large torque at the connection, without further
//! definition (section 6.3, p. 102); the first measure is the plain reading of it. Statics adds: all three
//! choices have joints 3 pitches away from the approach axis, so all press equally hard along it.

use super::accumulation::{ChainErrors, Closing, Covariance};
use super::kinematics::ModuleDimensions;
use super::shape::{ChainShape, FIRST_CORNERS, latches};
use serde::{Deserialize, Serialize};

/// Effect of a choice of corners on the closing link.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Corners {
    /// Joints that rotate.
    pub corners: Vec<usize>,
    /// Standard deviation across the face, in mm.
    pub lateral_sigma_mm: f64,
    /// Standard deviation of the gap, in mm.
    pub normal_sigma_mm: f64,
    /// Standard deviation of the angle, in radians.
    pub angle_sigma_rad: f64,
    /// Correlation of lateral offset and angle.
    pub correlation: f64,
    /// Pushing force: torque divided by the distance of the nearest corner from the face, in N.
    pub push_n: f64,
    /// Pressing force along the normal that all joints can hold, in N.
    pub press_n: f64,
    /// Rank among the choices by lateral error; equal choices share a rank.
    pub rank_by_error: usize,
    /// Rank among the choices by pushing force; equal choices share a rank.
    pub rank_by_force: usize,
}

/// Largest force along the normal that joints of this torque (N·m) can hold, and the force of the nearest of
/// `turned` across its lever, in N; infinite without levers.
pub fn forces(closing: &Closing, torque: f64, turned: &[usize]) -> (f64, f64) {
    const METRE: f64 = 1e3;
    let levers = closing.levers();
    let longest = levers.iter().map(|(_, lever, _)| *lever).fold(0.0, f64::max);
    let near = |(joint, _, distance): &(usize, f64, f64)| turned.contains(joint).then_some(*distance);
    let nearest = levers.iter().filter_map(near).fold(f64::INFINITY, f64::min);
    (torque * METRE / longest, torque * METRE / nearest)
}

/// All choices of corners.
pub fn choices(body: &ModuleDimensions, errors: &ChainErrors, torque: f64) -> Vec<Corners> {
    /// Mirror images differ by this share: rounding.
    const SAME: f64 = 1e-9;
    let mut result: Vec<Corners> = FIRST_CORNERS
        .filter_map(|first_corner| {
            let shape = ChainShape::O { first_corner };
            let angles = shape.angles();
            let latch = *latches(&angles).first()?;
            let closing = Closing::latch(*body, &angles, &latch, &[]);
            let covariance: Covariance = closing.first_order(errors);
            let [lateral_sigma_mm, normal_sigma_mm, angle_sigma_rad] = covariance.sigmas();
            let (press_n, push_n) = forces(&closing, torque, &shape.turned());
            Some(Corners {
                corners: shape.turned(),
                lateral_sigma_mm,
                normal_sigma_mm,
                angle_sigma_rad,
                correlation: covariance.correlation(),
                push_n,
                press_n,
                rank_by_error: 0,
                rank_by_force: 0,
            })
        })
        .collect();
    let errors: Vec<f64> = result.iter().map(|c| c.lateral_sigma_mm).collect();
    let pushes: Vec<f64> = result.iter().map(|c| c.push_n).collect();
    for corners in &mut result {
        let (own, push) = (corners.lateral_sigma_mm, corners.push_n);
        corners.rank_by_error = 1 + errors.iter().filter(|e| **e < own * (1.0 - SAME)).count();
        corners.rank_by_force = 1 + pushes.iter().filter(|p| **p > push * (1.0 + SAME)).count();
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_are_ranked_by_error_and_by_force() {
        let errors = ChainErrors { joint_sigma: 1f64.to_radians(), ..ChainErrors::default() };
        let result = choices(&ModuleDimensions::default(), &errors, 10.9);
        assert_eq!(result.iter().map(|c| c.rank_by_error).collect::<Vec<_>>(), [2, 1, 2]);
        assert_eq!(result.iter().map(|c| c.rank_by_force).collect::<Vec<_>>(), [1, 3, 1]);
        // Half a pitch, a pitch and a half; three pitches along the normal for all.
        assert!(
            (result[0].push_n - 10.9 / 0.0475).abs() < 1e-6
                && (result[1].push_n - 10.9 / 0.1425).abs() < 1e-6
        );
        assert!(result.iter().all(|c| (c.press_n - 10.9 / 0.285).abs() < 1e-6));
        assert_eq!(result[1].corners, [2, 5, 8, 11]);
    }

    /// The stall force at one pitch, 114.7 N: 12 times the latching force.
    #[test]
    fn the_p_presses_with_the_published_force() {
        let angles = ChainShape::P.angles();
        let closing = Closing::latch(ModuleDimensions::default(), &angles, &latches(&angles)[0], &[]);
        let (press, _) = forces(&closing, 10.9, &ChainShape::P.turned());
        assert!((press - 114.7).abs() < 0.05 && (press / 9.61).floor() == 11.0, "{press}");
    }
}
