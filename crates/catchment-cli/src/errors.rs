//! Pose errors as a person writes them: what a number, its unit and the design allow.

use crate::failure::Failure;
use catchment::design::{Complaint, Design, Quantity, nearest};
use catchment::pose::{Dof, PoseError};
use miette::{MietteDiagnostic, Report};
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

/// Reads `x=0.2,pitch=10 deg`, the text of `--pose`; everything that is wrong with it at once.
pub(crate) fn pose(text: &str, design: &Design) -> Result<PoseError, Failure> {
    let mut values = [None; 5];
    let mut objections = Vec::new();
    for part in text.split(',') {
        match term(part, design) {
            Ok((dof, value)) => {
                if values[dof.index()].replace(value).is_some() {
                    objections.push(Objection::new(format!("{} is given twice", dof.name()), "name it once"));
                }
            }
            Err(objection) => objections.push(objection),
        }
    }
    if objections.is_empty() {
        Ok(PoseError::from_array(values.map(|value| value.unwrap_or(0.0))))
    } else {
        Err(refusal(text, objections))
    }
}

/// Reads `pitch=10 deg`.
fn term(part: &str, design: &Design) -> Result<(Dof, f64), Objection> {
    const FORM: &str = "write errors such as \"x=0.2,pitch=10 deg\"";
    let part = part.trim();
    let Some((name, number)) = part.split_once('=') else {
        return Err(Objection::new(format!("`{part}` is no error"), FORM));
    };
    let name = name.trim();
    let Some(dof) = Dof::ALL.into_iter().find(|dof| dof.name() == name) else {
        let help = nearest(name, Dof::ALL.map(Dof::name)).map_or_else(
            || "one of x, y, roll, pitch, yaw".to_owned(),
            |meant| format!("did you mean {meant}?"),
        );
        return Err(Objection::new(format!("there is no error `{name}`"), help));
    };
    let quantity: Quantity = number
        .parse()
        .map_err(|c: Complaint| Objection { message: format!("{name}: {c}"), help: c.help() })?;
    Ok((dof, checked(dof, quantity, design)?))
}

fn refusal(text: &str, objections: Vec<Objection>) -> Failure {
    let count = objections.len();
    let reports = objections
        .into_iter()
        .map(|objection| {
            let mut diagnostic = MietteDiagnostic::new(format!("--pose: {}", objection.message));
            diagnostic.help = objection.help;
            Report::new(diagnostic)
        })
        .collect();
    let shown: String = text.chars().filter(|c| !c.is_control()).take(80).collect();
    Failure::many(reports, (count > 1).then(|| format!("{count} problems in --pose \"{shown}\"")))
}
