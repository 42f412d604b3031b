//! Pose errors as a person writes them: what a number, its unit and the design allow.

use catchment::design::{Design, Quantity};
use catchment::pose::Dof;
use std::f64::consts::PI;

/// Largest offset that is tried, in D: beyond it a file is in the wrong unit.
const FARTHEST: f64 = 100.0;
/// Angles written as 180 deg, or rounded to six digits, are still half a turn.
const HALF_TURN: f64 = PI + 1e-5;

/// What is wrong with an error, and what to do about it.
#[derive(Debug, PartialEq)]
pub(crate) struct Objection {
    /// What is wrong.
    pub message: String,
    /// What to do about it.
    pub help: Option<String>,
}

impl Objection {
    /// With advice.
    pub(crate) fn new(message: impl Into<String>, help: impl Into<String>) -> Self {
        Self { message: message.into(), help: Some(help.into()) }
    }
}

/// The error in D or radians, if it may be tried on this design.
pub(crate) fn checked(dof: Dof, quantity: Quantity, design: &Design) -> Result<f64, Objection> {
    let read = if dof.is_rotation() { quantity.angle_rad() } else { quantity.length_d(&design.scale()) };
    let value = read.map_err(|c| Objection { message: format!("{}: {c}", dof.name()), help: c.help() })?;
    if value != 0.0 && !design.alignment.free.contains(dof) {
        return Err(locked(dof, quantity));
    }
    let (limit, help) = if dof.is_rotation() {
        (HALF_TURN, "angles lie between -pi and pi (-180 and 180 deg); a bare number is in radians")
    } else {
        (FARTHEST, "offsets lie between -100 and 100 D; a bare number is in D, the width of the connector")
    };
    if value.abs() > limit {
        return Err(Objection::new(format!("{} = {quantity} is out of range", dof.name()), help));
    }
    Ok(value)
}

fn locked(dof: Dof, quantity: Quantity) -> Objection {
    let name = dof.name();
    let stays = if dof.is_rotation() { "it stays 0" } else { "it stays 0 at the centre of rotation" };
    Objection::new(
        format!("{name} = {quantity}, but {name} is locked: {stays}"),
        format!("leave {name} out, or free it with --free or in [alignment] of the design"),
    )
}
