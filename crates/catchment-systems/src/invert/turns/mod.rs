//! Wanted heights at rotations: their requirements on the moving half, and bounds between the rotations.
//!
//! # The adjunction for a half that rotates
//!
//! The moving half M rotates by R about the centre of rotation; the fixed half F stays. With the face centre
//! at the lateral position x and the height z, a point m of M (from the face centre) is at (x, z) + R m.
//! Descending along −ẑ, M first touches F at
//!
//! ```text
//!   h(x, R) = max { f_z − (R m)_z :  f in F,  m in M,  f_xy = x + (R m)_xy }
//! ```
//!
//! `h(x, R) ≤ h*(x, R)` for every x means that no (x, h*(x, R)) + R m lies inside F or below it: with F↓ = F
//! − [0, ∞) ẑ,
//!
//! ```text
//!   m  is not inside  K(R) = R⁻¹ { F↓ − (x, h*(x, R)) :  all x }                for every m of M
//!   g(u) = max over R of  max { z : (u, z) in K(R) }                            as M is solid above its lower surface g
//! ```
//!
//! So g is the smallest function that keeps h ≤ h* at every given R, by M without undercuts.
//! `F↓ − (x, h*(x, R))` over all x is F minus the solid B above h*(·, R), so the upper side of K(R) is
//! another height of first contact: of R⁻¹B over R⁻¹F, exact like those without rotation. **The fixed half
//! appears rotated by R⁻¹**, and so does the direction of approach: the walls of B, infinite downward in K,
//! lean when R tilts, so B must be tall enough that their lower ends lie below all of g.
//!
//! **The centre of rotation** has no effect. It only determines which x belongs to which pose: for a COR c in
//! front of the face, the position of the COR is x − c·(R ẑ)_xy and its height h − c·(R ẑ)_z. Every x is
//! required at every R, so the same set is required for any c; heights here are always those of the face
//! centre, at the position of the face centre.
//!
//! # Bounds between the rotations
//!
//! A point at the distance r from the face centre moves by at most 2 r sin(δ/2) if the rotation changes by
//! the angle δ. Let δ be the angle to the nearest given rotation, at most half the sum of the steps of the
//! three angles, and ε the sum of these bounds for the new half and for the half that defines the wanted
//! heights. Going to that rotation and back,
//!
//! ```text
//!   h(x, R) ≤ max { h*(x + d, R) :  |d| ≤ ε } + ε        for every R within the range of the angles
//! ```
//!
//! if heights are wanted at all these x + d: no height is wanted where a half passes the other by.

use super::heights::{Heights, common};
use super::{InvertError, InvertSettings, heights_of, is_planar};
use catchment::connector::{Connector, Half};
use catchment::design::{Design, Quantity};
use catchment::exec::Exec;
use catchment::pose::rotation;
use catchment::study::sweep::SweepAxis;
use glam::{DMat3, DVec2};
use serde::Serialize;

/// Largest number of rotations: each needs its own envelope, in seconds.
pub const MOST_TURNS: usize = 1000;
/// Least cosine of a tilt: at more than 80° the halves stand side by side.
const LEAST_UPRIGHT: f64 = 0.17;
/// Extent of walls below the deepest position of the new half, in D.
const BELOW: f64 = 1.0;

/// Excess height of the new half between the given rotations.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Between {
    /// Largest angle from a rotation within the range to the nearest given rotation, in radians.
    pub turn_rad: f64,
    /// Proven bound, in D: within this lateral distance of any position, a position exists at which the half
    /// stops at most this much higher than wanted.
    pub bound_d: f64,
    /// Number of rotations midway between the given ones at which both heights were computed.
    pub midway: usize,
    /// Largest h − h* at them, in D; null without midway rotations.
    pub most_d: Option<f64>,
    /// Roll, pitch and yaw there, in radians.
    pub angles_rad: [f64; 3],
    /// Lateral place there, in D.
    pub at_d: [f64; 2],
}

/// Angles as a user lists them, in radians: `5 deg,10 deg`, or a range such as `-10..10 deg/21` (this number
/// of equidistant angles). A bare number has the unit of a design file.
///
/// # Errors
/// A message with the correct form.
pub fn list_of_angles(text: &str) -> Result<Vec<f64>, String> {
    // The ranges are those of a sweep, of any key that is an angle.
    let axis: SweepAxis = format!("errors.pitch={text}").parse().map_err(|_| {
        format!(
            "`{text}` is no list of angles: write 5 deg,10 deg or a range with its number, -10..10 deg/21"
        )
    })?;
    let angle = |value: &String| {
        let quantity: Quantity = value.parse().map_err(|defect| format!("{defect}"))?;
        quantity.angle_rad().map_err(|defect| format!("{defect}"))
    };
    axis.values.iter().map(angle).collect()
}

impl InvertSettings {
    /// Angles of the three rotations, ascending, each at least 0 alone.
    fn angles(&self) -> [Vec<f64>; 3] {
        [&self.roll, &self.pitch, &self.yaw].map(|angles| {
            let mut sorted = if angles.is_empty() { vec![0.0] } else { angles.clone() };
            sorted.sort_by(f64::total_cmp);
            sorted.dedup();
            sorted
        })
    }

    /// Roll, pitch and yaw of every requested rotation except 0: all combinations.
    ///
    /// # Errors
    /// If they are too many, tilt too far, or leave the plane of a planar design.
    pub fn turns(&self, design: &Design) -> Result<Vec<[f64; 3]>, InvertError> {
        let angles = self.angles();
        if is_planar(design) && !(self.roll.is_empty() && self.yaw.is_empty()) {
            return Err(InvertError::Planar);
        }
        let count = angles.iter().map(Vec::len).product();
        if count > MOST_TURNS {
            return Err(InvertError::TooManyTurns { count });
        }
        let turns = combined(&angles);
        match turns.iter().find(|[roll, pitch, yaw]| rotation(*roll, *pitch, *yaw).z_axis.z < LEAST_UPRIGHT) {
            Some([roll, pitch, _]) => {
                Err(InvertError::TooFar { roll: roll.to_degrees(), pitch: pitch.to_degrees() })
            }
            None => Ok(turns.into_iter().filter(|turn| *turn != [0.0; 3]).collect()),
        }
    }

    /// Rotations midway between neighbours, and the largest angle to the nearest given rotation.
    fn midway(&self) -> (Vec<[f64; 3]>, f64) {
        let angles = self.angles();
        let half = |angles: &Vec<f64>| angles.windows(2).map(|w| (w[1] - w[0]) / 2.0).fold(0.0, f64::max);
        let turn = angles.iter().map(half).sum();
        let middles = angles.map(|angles| {
            if angles.len() == 1 { angles } else { angles.windows(2).map(|w| w[0].midpoint(w[1])).collect() }
        });
        (if turn > 0.0 { combined(&middles) } else { Vec::new() }, turn)
    }
}

fn combined([rolls, pitches, yaws]: &[Vec<f64>; 3]) -> Vec<[f64; 3]> {
    let mut all = Vec::with_capacity(rolls.len() * pitches.len() * yaws.len());
    for roll in rolls {
        for pitch in pitches {
            all.extend(yaws.iter().map(|yaw| [*roll, *pitch, *yaw]));
        }
    }
    all
}

/// The halves, in the frame of the moving half, whose height of first contact is the lower limit for it at a
/// rotation. `floor` is a height below all wanted heights of the new half.
pub(super) fn requested(fixed: &Half, wanted: &Heights, turn: DMat3, floor: f64) -> Option<(Half, Half)> {
    let back = turn.transpose();
    let fixed = fixed.mapped(|p| back * p);
    let wanted = wanted.without_cracks();
    let highest = wanted.range()?[1];
    let bounds = |half: &Half, of: fn(f64, f64) -> f64, start: f64| {
        half.surfaces.iter().flat_map(|s| &s.vertices).map(|p| p.z).fold(start, of)
    };
    let over = bounds(&fixed, f64::max, f64::NEG_INFINITY)
        - wanted.corners().map(|p| (back * p).z).fold(f64::INFINITY, f64::min);
    let tall = ((over - floor).max(0.0) + BELOW) / turn.z_axis.z;
    Some((fixed, wanted.above(highest + tall).mapped(|p| back * p)))
}

/// Bounds between the rotations; `None` if there is nothing between.
pub(super) fn between(
    design: &Design,
    wanted: &Connector,
    new: &Connector,
    settings: &InvertSettings,
    exec: &Exec,
) -> Result<Option<Between>, InvertError> {
    let (midway, turn_rad) = settings.midway();
    if midway.is_empty() {
        return Ok(None);
    }
    let reach =
        |half: &Half| half.surfaces.iter().flat_map(|s| &s.vertices).map(|p| p.length()).fold(0.0, f64::max);
    let bound_d = 2.0 * (turn_rad / 2.0).sin() * (reach(&wanted.moving) + reach(&new.moving));
    let mut result = Between {
        turn_rad,
        bound_d,
        midway: midway.len(),
        most_d: None,
        angles_rad: [0.0; 3],
        at_d: [0.0; 2],
    };
    for angles in midway {
        let [roll, pitch, yaw] = angles;
        let turn = rotation(roll, pitch, yaw);
        let limit = heights_of(design, wanted, turn, exec)?;
        let got = heights_of(design, new, turn, exec)?;
        if let Some((at, most)) = most_above(&got, &limit)
            && result.most_d.is_none_or(|before| most > before)
        {
            (result.most_d, result.angles_rad, result.at_d) = (Some(most), angles, at.to_array());
        }
    }
    Ok(Some(result))
}

/// The largest difference of two functions in their common domain, and its position.
pub(super) fn most_above(high: &Heights, low: &Heights) -> Option<(DVec2, f64)> {
    let mut most: Option<(DVec2, f64)> = None;
    for above in &high.facets {
        for below in &low.facets {
            let Some(polygon) = common(&above.polygon, &below.polygon) else { continue };
            for p in polygon {
                let apart = above.height(p) - below.height(p);
                if most.is_none_or(|(_, before)| apart > before) {
                    most = Some((p, apart));
                }
            }
        }
    }
    most
}

#[cfg(test)]
mod tests;
