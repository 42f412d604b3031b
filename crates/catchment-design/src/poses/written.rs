//! A pose error as written, with the checks of its units and of the design.

use super::{FAMILY, OffsetsAt, defect};
use crate::design::{Design, Quantity, QuantityUnit};
use catchment_base::diagnostic::Diagnostic;
use catchment_base::pose::{Dof, PoseError, face_from_cor};
use catchment_base::tolerance::SINGLE;
use std::f64::consts::PI;

/// Largest offset that is tried, in D: beyond it a text is in the wrong unit.
const FARTHEST: f64 = 100.0;
/// Angles written as 180 deg, or rounded to six digits, are still half a turn.
const HALF_TURN: f64 = PI + 1e-5;

/// A pose error as written: a quantity for each error that was, in the order of [`Dof::ALL`].
pub(super) type Written = [Option<Quantity>; 5];

/// The pose error of the face centre, in D and radians, or all errors of the written pose.
///
/// Locked rotations are 0. A locked offset is 0, or at the face centre its value for the locked centre of
/// rotation.
pub(super) fn resolve(
    written: &Written,
    at: OffsetsAt,
    design: &Design,
) -> Result<PoseError, Vec<(Dof, Diagnostic)>> {
    let alignment = &design.alignment;
    let mut faults = Vec::new();
    let mut values = [0.0; 5];
    for (dof, quantity) in Dof::ALL.into_iter().zip(written) {
        let Some(quantity) = quantity else { continue };
        if quantity.value != 0.0 && dof.is_rotation() && !alignment.free.contains(dof) {
            faults.push((dof, locked(dof, *quantity, "it stays 0")));
            continue;
        }
        match in_range(dof, *quantity, design) {
            Ok(value) => values[dof.index()] = value,
            Err(fault) => faults.push((dof, fault)),
        }
    }
    let measured = PoseError::from_array(values);
    // The position of the face centre depends on the rotation.
    if faults.iter().all(|(dof, _)| !dof.is_rotation()) {
        for dof in OffsetsAt::LATERAL.into_iter().filter(|dof| !alignment.free.contains(*dof)) {
            let value = values[dof.index()];
            let Some(quantity) = written[dof.index()].filter(|_| value != 0.0) else { continue };
            let stays = match at {
                OffsetsAt::Cor => "it stays 0 at the centre of rotation".to_owned(),
                OffsetsAt::Face => {
                    let face = face_from_cor(&measured.rotation(), alignment.center_of_rotation);
                    let implied = [face.x, face.y][dof.index()];
                    if (value - implied).abs() <= SINGLE {
                        continue;
                    }
                    implied_by(implied, quantity.unit, design)
                }
            };
            faults.push((dof, locked(dof, quantity, &stays)));
        }
    }
    if faults.is_empty() { Ok(at.to_face(&measured, alignment)) } else { Err(faults) }
}

/// The error in D or radians, if it is permitted.
pub(super) fn in_range(dof: Dof, quantity: Quantity, design: &Design) -> Result<f64, Diagnostic> {
    let read = if dof.is_rotation() { quantity.angle_rad() } else { quantity.length_d(&design.scale()) };
    let value = read.map_err(|c| Diagnostic::error(FAMILY, format!("{}: {c}", dof.name()), c.help()))?;
    let (limit, help) = if dof.is_rotation() {
        (HALF_TURN, "angles lie between -pi and pi (-180 and 180 deg); a bare number is in radians")
    } else {
        (FARTHEST, "offsets lie between -100 and 100 D; a bare number is in D, the width of the connector")
    };
    if value.abs() > limit {
        return Err(defect(format!("{} = {quantity} is out of range", dof.name()), help));
    }
    Ok(value)
}

fn locked(dof: Dof, quantity: Quantity, stays: &str) -> Diagnostic {
    let name = dof.name();
    let help = if dof.is_rotation() {
        format!("leave {name} out, or free it in [alignment] of the design")
    } else {
        format!(
            "leave {name} out, or write what the lock makes of it; free it in [alignment] of the design if it varies"
        )
    };
    defect(format!("{name} = {quantity}, but {name} is locked: {stays}"), help)
}

/// The value of a locked offset of the face centre, in the unit of the text.
fn implied_by(implied: f64, unit: QuantityUnit, design: &Design) -> String {
    let quantity = Quantity { value: nine_digits(from_d(implied, unit, design)), unit };
    if quantity.value == 0.0 {
        return "it stays 0 at the centre of rotation, and at the face centre too at this rotation"
            .to_owned();
    }
    format!("it stays 0 at the centre of rotation, which puts the face centre at {quantity} at this rotation")
}

/// A length in D, in another unit of the design.
pub(super) fn from_d(value: f64, unit: QuantityUnit, design: &Design) -> f64 {
    match (unit, design.unit) {
        (QuantityUnit::Length(unit), Some(own)) => value * (design.width * own.metres() / unit.metres()),
        _ => value,
    }
}

/// The number rounded to nine digits: far finer than the required accuracy of a locked offset. Less than
/// 10⁻¹² is rounding.
fn nine_digits(value: f64) -> f64 {
    // In the unit of the number.
    const NOTHING: f64 = 1e-12;
    if value.abs() < NOTHING { 0.0 } else { format!("{value:.8e}").parse().unwrap_or(value) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn design() -> Design {
        let text = "[connector]\nfamily = \"pyramid\"\nwidth = 50\nunit = \"mm\"\n[alignment]\n\
                    free = [\"x\", \"pitch\", \"yaw\"]\ncenter_of_rotation = 0.5\n";
        crate::design::read(text, Path::new("")).unwrap().design
    }

    fn written(y: &str) -> Written {
        let number = |text: &str| Some(text.parse().unwrap());
        [None, number(y), None, number("0.3"), number("0.2")]
    }

    /// cor · sin yaw · sin pitch.
    fn implied() -> f64 {
        0.5 * 0.2f64.sin() * 0.3f64.sin()
    }

    #[test]
    fn a_locked_offset_is_where_the_lock_puts_the_face_centre() {
        let design = design();
        let read = |y: &str, at| resolve(&written(y), at, &design);
        let y = implied();
        for text in ["0".to_owned(), format!("{y:.6}"), format!("{:.4} mm", y * 50.0)] {
            let error = read(&text, OffsetsAt::Face).unwrap();
            assert!(error.y == 0.0 || (error.y - y).abs() <= SINGLE);
        }
        for (off, unit, scale) in [(y + 1e-4, "", 1.0), (y - 1e-4, " mm", 50.0)] {
            let [(Dof::Y, fault)] =
                &read(&format!("{}{unit}", off * scale), OffsetsAt::Face).unwrap_err()[..]
            else {
                panic!("one fault of y");
            };
            // The value that the message proposes is valid input.
            let stated = fault.message.split("face centre at ").nth(1).unwrap();
            let stated = stated.strip_suffix(" at this rotation").unwrap();
            assert!(read(stated, OffsetsAt::Face).is_ok(), "{stated}");
        }
    }

    #[test]
    fn offsets_of_the_centre_of_rotation_become_those_of_the_face_centre() {
        let design = design();
        let error = resolve(&written("0"), OffsetsAt::Cor, &design).unwrap();
        // Two roundings.
        assert!((error.y - implied()).abs() < 1e-16);
        assert!((error.x - 0.5 * 0.2f64.cos() * 0.3f64.sin()).abs() < 1e-15);
        let y = implied().to_string();
        let faults = resolve(&written(&y), OffsetsAt::Cor, &design).unwrap_err();
        assert!(faults[0].1.message.ends_with("it stays 0 at the centre of rotation"), "{faults:?}");
    }
}
