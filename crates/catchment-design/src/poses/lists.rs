//! Numbers of points, lists of angles and single lengths, for the settings of a plan of trials.
//!
//! ```text
//!   x=5,y=5,yaw=6          so many points along each error
//!   0..45:2.25 deg         from, to, step; the unit at the end is that of all
//!   0,20 deg               these
//!   72.9 mm                a length
//! ```

use super::terms::terms;
use super::{FAMILY, defect, shortened};
use crate::design::{Design, DesignDefect, Quantity, QuantityUnit};
use catchment_base::diagnostic::{Diagnostic, DiagnosticCollector, Diagnostics};
use catchment_base::pose::Dof;

/// Most angles of a list.
pub const MOST_ANGLES: usize = 10_000;
/// Largest number of points along an error.
const MOST_POINTS: f64 = 10_000.0;
/// The last angle of a range may miss its end by this share of a step, which rounding does.
const ROUNDING: f64 = 1e-9;

/// Reads `x=5,y=5,yaw=6`: how many points along each error, 2 or more, of errors that the design leaves free.
///
/// # Errors
/// Everything that is wrong with the text, each with its bytes.
pub fn parse_counts(text: &str, design: &Design) -> Result<[Option<usize>; 5], Diagnostics> {
    let mut result = DiagnosticCollector::default();
    let (written, spans) = terms(text, &mut result);
    let mut counts = [None; 5];
    for dof in Dof::ALL {
        let Some(Quantity { value, unit }) = written[dof.index()] else { continue };
        let span = || Some(spans[dof.index()].clone());
        let name = dof.name();
        if !design.alignment.free.contains(dof) {
            let help = format!("leave {name} out, or free it in [alignment] of the design");
            result.push_at(defect(format!("{name} is locked, so it has one place"), help), span);
        } else if unit != QuantityUnit::Bare || value.fract() != 0.0 || !(2.0..=MOST_POINTS).contains(&value)
        {
            let help = "write how many points, such as 5: 2 or more";
            result.push_at(
                defect(format!("{name}: `{}` is no number of points", Quantity { value, unit }), help),
                span,
            );
        } else {
            counts[dof.index()] = Some(value as usize);
        }
    }
    result.refuse()?;
    Ok(counts)
}

/// Reads `0..45:2.25 deg` or `0,20 deg`; without a unit radians. In radians.
///
/// # Errors
/// The errors of the text.
///
/// # Examples
/// ```
/// # fn main() -> Result<(), catchment_base::diagnostic::Diagnostics> {
/// let angles = catchment_design::poses::parse_angles("0..45:2.25 deg")?;
/// assert_eq!((angles.len(), angles[20]), (21, 45f64.to_radians()));
/// # Ok(())
/// # }
/// ```
pub fn parse_angles(text: &str) -> Result<Vec<f64>, Diagnostics> {
    angles(text).map_err(|fault| one(text, fault))
}

/// Reads a length such as `72.9 mm`, or a number of D. In D.
///
/// # Errors
/// The errors of the text.
pub fn parse_length(text: &str, design: &Design) -> Result<f64, Diagnostics> {
    let refusal = |c: DesignDefect| one(text, Diagnostic::error(FAMILY, c.to_string(), c.help()));
    let quantity: Quantity = text.parse().map_err(refusal)?;
    quantity.length_d(&design.scale()).map_err(refusal)
}

fn one(text: &str, fault: Diagnostic) -> Diagnostics {
    Diagnostic { span: Some(0..text.len()), ..fault }.into()
}

fn angles(text: &str) -> Result<Vec<f64>, Diagnostic> {
    const FORM: &str =
        "write angles such as \"0..45:2.25 deg\" or \"0,20 deg\"; without a unit they are radians";
    let text = text.trim();
    let numbers = text.trim_end_matches(|c: char| c.is_alphabetic() || c == '°');
    let symbol = &text[numbers.len()..];
    let read = |part: &str| -> Result<f64, Diagnostic> {
        let quantity: Quantity = format!("{} {symbol}", part.trim())
            .parse()
            .map_err(|c: DesignDefect| Diagnostic::error(FAMILY, c.to_string(), Some(FORM.to_owned())))?;
        // An angle like those of any pose: within half a turn.
        quantity.angle_rad().map_err(|c| Diagnostic::error(FAMILY, c.to_string(), c.help()))
    };
    let within = |angle: f64| -> Result<f64, Diagnostic> {
        if angle.abs() <= std::f64::consts::PI {
            Ok(angle)
        } else {
            Err(defect(format!("`{}` leaves half a turn", shortened(text)), FORM))
        }
    };
    let Some((from, rest)) = numbers.split_once("..") else {
        let list: Result<Vec<f64>, Diagnostic> = numbers.split(',').map(|part| within(read(part)?)).collect();
        return list;
    };
    let Some((to, step)) = rest.split_once(':') else {
        return Err(defect(format!("`{}` has no step", shortened(text)), FORM));
    };
    let (from, to, step) = (within(read(from)?)?, within(read(to)?)?, read(step)?);
    let steps = (to - from) / step;
    if !(step > 0.0 && steps >= 0.0) {
        return Err(defect(format!("`{}` goes nowhere", shortened(text)), FORM));
    }
    if steps >= MOST_ANGLES as f64 {
        let help = format!("at most {MOST_ANGLES}");
        return Err(defect(format!("`{}` has too many steps", shortened(text)), help));
    }
    let count = (steps + ROUNDING).floor() as usize;
    // The end is the end, not its neighbour in double precision.
    let at = |k: usize| if (k as f64 - steps).abs() < ROUNDING { to } else { from + k as f64 * step };
    Ok((0..=count).map(at).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn design() -> Design {
        let text = "[connector]\nfamily = \"pyramid\"\nwidth = 50.8\nunit = \"mm\"\n[alignment]\nfree = [\"x\", \"yaw\"]\n";
        crate::design::read(text, Path::new("")).unwrap().design
    }

    #[test]
    fn points_are_counted_and_angles_listed() {
        assert_eq!(parse_counts("x=5, yaw=6", &design()).unwrap(), [Some(5), None, None, None, Some(6)]);
        let angles = parse_angles("0..45:2.25 deg").unwrap();
        assert_eq!((angles.len(), angles[20]), (21, 45f64.to_radians()));
        assert!((angles[1] - 2.25f64.to_radians()).abs() < 1e-15);
        assert_eq!(parse_angles("-0.2, 0.1").unwrap(), [-0.2, 0.1]);
        // The end is reached only by whole steps.
        assert_eq!(parse_angles("0..10:4 deg").unwrap().len(), 3);
        assert!((parse_length("1 in", &design()).unwrap() - 0.5).abs() < 1e-15);
    }

    #[test]
    fn defects_are_reported_in_their_places() {
        let text = "x=1,y=5,yaw=2.5,x=3,pich=2";
        let places: Vec<&str> = parse_counts(text, &design())
            .unwrap_err()
            .list
            .into_iter()
            .map(|o| &text[o.span.unwrap()])
            .collect();
        assert_eq!(places, ["x=1", "y=5", "yaw=2.5", "x=3", "pich=2"]);
        for text in [
            "0..45:2.25",
            "",
            "0..10 deg",
            "10..0:1 deg",
            "0..1:0 deg",
            "0,20 mm",
            "0..1:1e-9",
            "a",
            "190 deg",
        ] {
            assert!(parse_angles(text).is_err(), "{text}");
        }
        assert!(parse_length("3 deg", &design()).is_err() && parse_length("", &design()).is_err());
    }
}
