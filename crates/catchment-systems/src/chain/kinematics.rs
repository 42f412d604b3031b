//! Exact positions of rotors and faces.
//!
//! ```text
//!   h_k = h_0 + q_1 + … + q_k            heading behind joint k
//!   r_{k+1} = r_k + a (cos h_k, sin h_k)   rotor of the next module
//! ```
//!
//! Millimetres and radians; a positive angle turns left.

use glam::DVec2;
use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_PI_2, PI};

/// The dimensions of a module.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ModuleDimensions {
    /// Distance from a rotor to the next, in mm.
    pub pitch: f64,
    /// Width of a face and of the module: D, in mm.
    pub face: f64,
    /// Distance from a rotor to the face centre, in mm.
    pub overhang: f64,
    /// Length of the module along the chain, in mm.
    pub length: f64,
}

impl Default for ModuleDimensions {
    /// `CKBot` with the latching X-Face: the dissertation, section 6.1 (p. 94–95).
    fn default() -> Self {
        Self { pitch: 95.0, face: 65.5, overhang: 47.5, length: 90.4 }
    }
}

impl ModuleDimensions {
    /// Position of the last rotor, in D in front of the face: behind it, so negative.
    pub fn center_of_rotation(&self) -> f64 {
        -self.overhang / self.face
    }
}

/// A position in the plane with a heading.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PlanarPose {
    /// Across the plane, in mm.
    pub x: f64,
    /// Up the plane, in mm.
    pub y: f64,
    /// Heading from the x axis, left positive, in radians.
    pub heading: f64,
}

impl PlanarPose {
    /// The place alone.
    pub const fn place(&self) -> DVec2 {
        DVec2::new(self.x, self.y)
    }

    /// Direction of the heading.
    pub fn along(&self) -> DVec2 {
        direction(self.heading)
    }

    /// The frame `distance` ahead in a direction that is turned by `turn` from the heading, and turned so itself.
    #[must_use]
    pub fn ahead(&self, turn: f64, distance: f64) -> Self {
        let heading = self.heading + turn;
        let place = self.place() + distance * direction(heading);
        Self { x: place.x, y: place.y, heading }
    }
}

/// The unit vector of a heading.
pub fn direction(heading: f64) -> DVec2 {
    let (sin, cos) = heading.sin_cos();
    DVec2::new(cos, sin)
}

/// A quarter turn to the left.
pub const fn left(v: DVec2) -> DVec2 {
    DVec2::new(-v.y, v.x)
}

/// An angle brought into (−π, π].
pub fn wrapped(angle: f64) -> f64 {
    let turned = angle - 2.0 * PI * (angle / (2.0 * PI)).round();
    if turned <= -PI { turned + 2.0 * PI } else { turned }
}

/// The multiple of a quarter turn that is nearest to an angle.
pub fn nearest_quarter(angle: f64) -> f64 {
    (angle / FRAC_PI_2).round() * FRAC_PI_2
}

/// Rotor of every module with the heading behind its joint, from the base on; link k is `links(k)` long, counted from 0.
pub fn rotors_with(base: PlanarPose, angles: &[f64], links: impl Fn(usize) -> f64) -> Vec<PlanarPose> {
    let mut next = base;
    let mut result = Vec::with_capacity(angles.len());
    for (k, angle) in angles.iter().enumerate() {
        next.heading += angle;
        result.push(next);
        next = next.ahead(0.0, links(k));
    }
    result
}

/// Rotor of every module of a chain that starts at the origin along x.
pub fn rotors(body: &ModuleDimensions, angles: &[f64]) -> Vec<PlanarPose> {
    rotors_with(PlanarPose::default(), angles, |_| body.pitch)
}

/// How a point at `at`, fixed behind a joint at `rotor`, moves per radian of the joint.
pub fn swing(rotor: DVec2, at: DVec2) -> DVec2 {
    left(at - rotor)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const STEP: f64 = 1e-4;

    proptest! {
        /// The swing is the derivative of exact motion: central differences of step h are wrong by h²·l/6, below 1e-5 mm for
        /// levers of 2 m and h = 1e-4, and their rounding by 1e-12 of 2 m over h.
        #[test]
        fn the_swing_is_the_derivative(angles in proptest::collection::vec(-1.7..1.7f64, 2..12), joint in 0usize..12) {
            let joint = joint % angles.len();
            let body = ModuleDimensions::default();
            let tip = |change: f64| {
                let mut angles = angles.clone();
                angles[joint] += change;
                rotors(&body, &angles).last().unwrap().ahead(0.0, body.overhang).place()
            };
            let slope = (tip(STEP) - tip(-STEP)) / (2.0 * STEP);
            let expected = swing(rotors(&body, &angles)[joint].place(), tip(0.0));
            prop_assert!((slope - expected).length() < 1e-4, "{slope} for {expected}");
        }

        #[test]
        fn a_wrapped_angle_is_the_same_direction(angle in -50.0..50.0f64) {
            let result = wrapped(angle);
            prop_assert!(result > -PI && result <= PI);
            prop_assert!((direction(result) - direction(angle)).length() < 1e-12);
        }
    }

    #[test]
    fn a_straight_chain_lies_along_x() {
        let result = rotors(&ModuleDimensions::default(), &[0.0; 4]);
        assert_eq!(result.iter().map(|r| r.x).collect::<Vec<_>>(), [0.0, 95.0, 190.0, 285.0]);
        assert_eq!(result[3].ahead(0.0, 47.5), PlanarPose { x: 332.5, y: 0.0, heading: 0.0 });
        assert!((ModuleDimensions::default().center_of_rotation() + 0.725_190_84).abs() < 1e-8);
    }
}
