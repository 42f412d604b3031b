//! The dissertation's planar kinematic method (chapter 3), in the closed form that its printed bounds take for the
//! V-Face and the S-Face.
//!
//! ```text
//!         ● rotation point, r_p half-widths behind mid height
//!         │ ╲θ₀         tip lever  L = (r_p·D + H)/2
//!         │  ╲          the tip starts at  x₀ + L·sin θ₀
//!      ───┼───▼tip      and must meet the face it will slide down:
//!      ╲  ┊  ╱          V: |x₀ + L sin θ₀| < D/2
//!       ╲ ┊ ╱           S: |x₀ + L sin θ₀ + (D/6)(cos θ₀ − 1)| < D/3
//!        ╲ ╱
//! ```
//!
//! Both also need θ₀ below a right angle less the slope of the outer edge (V: 2H/D, S: 3H/(2D)) and
//! `|x₀| < r_p·D + H/2`. All bounds are strict; D = 1.
//!
//! The starts are `x₀ = (i − 20)·D/20`, i = 0…40, and θ₀ = j·π/80, j = 0…40: 41 values on [0, π/2]. Each counts
//! (2/40)(π/40) all the same, so that the one-sided count stands for ±π/2. They are indexed by integers: added-up
//! floating-point steps would break ties.
//!
//! This reproduces the printed tables 3.3 and 3.4 in every entry, and departs from a literal reading of the text in three
//! places: the range of θ₀, half dimensions in the lever and in the limit on |x₀|, and the outer edge's angle for S. The
//! coefficient of `r_p` in that limit cannot be told from the tables: it binds at `r_p` = 0 only. Nothing here knows
//! about contact beyond these bounds; for that, see [`crate::method::descent`].

use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_PI_2, PI};

/// A planar face with a closed-form bound.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Face {
    /// V notch and tip.
    VFace,
    /// Sawtooth of three edges.
    SFace,
}

/// What the answer depends on; lengths in D.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// Which face.
    pub face: Face,
    /// H/D, H from the lowest to the highest point of the face.
    pub aspect_ratio: f64,
    /// Distance of the rotation point behind mid height, in half-widths.
    pub rotation_point: f64,
}

/// Steps of x₀ over ±D, and of θ₀ over [0, π/2].
const STEPS: i32 = 40;

/// Area that one successful start counts, D·rad.
pub const START_MEASURE: f64 = (2.0 / STEPS as f64) * (PI / STEPS as f64);

impl Settings {
    /// Whether the start (x₀ in D, θ₀ in radians) slides home.
    pub fn succeeds(&self, x0: f64, theta0: f64) -> bool {
        let Self { face, aspect_ratio: h, rotation_point } = *self;
        let lever = f64::midpoint(rotation_point, h);
        let tip = x0 + lever * theta0.sin();
        let (tip, reach, outer_slope) = match face {
            Face::VFace => (tip, 0.5, 2.0 * h),
            // The base minimum that the tip must find sits D/6 off the axis, and swings with the body.
            Face::SFace => (tip + (theta0.cos() - 1.0) / 6.0, 1.0 / 3.0, 1.5 * h),
        };
        tip.abs() < reach && theta0 < FRAC_PI_2 - outer_slope.atan() && x0.abs() < rotation_point + h / 2.0
    }

    /// Number of successful starts.
    pub fn successes(&self) -> u32 {
        let starts = (0..=STEPS).flat_map(|i| (0..=STEPS).map(move |j| (i, j)));
        let succeeds = |&(i, j): &(i32, i32)| {
            let x0 = f64::from(i - STEPS / 2) / f64::from(STEPS / 2);
            self.succeeds(x0, f64::from(j) * PI / f64::from(2 * STEPS))
        };
        starts.filter(succeeds).count() as u32
    }

    /// The area of acceptance, D·rad.
    pub fn area(&self) -> f64 {
        f64::from(self.successes()) * START_MEASURE
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_rotation_the_bounds_are_nilssons() {
        for (face, bound) in [(Face::VFace, 0.5), (Face::SFace, 1.0 / 3.0)] {
            let settings = Settings { face, aspect_ratio: 0.5, rotation_point: 1.0 };
            for side in [-1.0, 1.0] {
                assert!(settings.succeeds(side * (bound - 1e-9), 0.0));
                assert!(!settings.succeeds(side * (bound + 1e-9), 0.0));
            }
        }
    }

    #[test]
    fn the_bound_itself_fails() {
        let settings = Settings { face: Face::VFace, aspect_ratio: 0.5, rotation_point: 1.0 };
        assert!(!settings.succeeds(0.5, 0.0));
    }

    #[test]
    fn a_centred_tip_slides_home_up_to_the_outer_edge() {
        for (face, slope) in [(Face::VFace, 2.0), (Face::SFace, 1.5)] {
            for h in [0.1, 0.5, 2.0] {
                let settings = Settings { face, aspect_ratio: h, rotation_point: 2.0 };
                let limit = FRAC_PI_2 - f64::atan(slope * h);
                let centred = |theta: f64| {
                    let swing = if face == Face::SFace { (theta.cos() - 1.0) / 6.0 } else { 0.0 };
                    settings.succeeds(-(2.0 + h) / 2.0 * theta.sin() - swing, theta)
                };
                assert!(centred(limit - 1e-9) && !centred(limit + 1e-9));
            }
        }
    }

    #[test]
    fn the_s_face_is_chiral_and_the_v_face_is_not() {
        // Centre of the tips that slide home at θ₀ = 1: 0 for V, moved by the swing of the minimum for S.
        let settings = |face| Settings { face, aspect_ratio: 0.2, rotation_point: 2.0 };
        let lever = 1.1;
        let theta: f64 = 1.0;
        let edges = |face| {
            let reaches = |x: f64| settings(face).succeeds(x - lever * theta.sin(), theta);
            let grid = (-5000..=5000).map(|k| f64::from(k) * 1e-4);
            let hits: Vec<f64> = grid.filter(|x| reaches(*x)).collect();
            hits[0] + hits[hits.len() - 1]
        };
        assert!(edges(Face::VFace).abs() < 1e-3);
        // Twice (D/6)(1 − cos θ), to the grid's step.
        assert!((edges(Face::SFace) - (1.0 - theta.cos()) / 3.0).abs() < 3e-4);
    }
}
