//! Lengths and pose errors in the design's own unit and degrees.
//!
//! ```text
//!   0.2 D, 0.1 rad   ──▶   "10 mm", "5.73 deg"     if the design has a unit and D is 50 mm; "0.2 D" without a unit
//! ```

use crate::design::Design;
use crate::pose::{Dof, PoseError};

/// Digits of lengths that are shown: a thousandth of their first.
const GRAIN: f64 = 1e-3;
/// Errors below these are not shown: below two decimals of a degree, and a millionth of D.
const NONE: [f64; 2] = [1e-6, 0.005 / 180.0 * std::f64::consts::PI];

/// How much of a unit D is, and the unit's name.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DisplayUnit {
    /// D in the unit.
    pub scale: f64,
    /// Its symbol.
    pub unit: &'static str,
}

impl DisplayUnit {
    /// For designs without a unit.
    pub(crate) const IN_D: Self = Self { scale: 1.0, unit: "D" };

    /// As a design has it.
    pub(crate) fn of(design: &Design) -> Self {
        design.unit.map_or(Self::IN_D, |unit| Self { scale: design.width, unit: unit.symbol() })
    }

    /// A length that is given in D.
    pub fn length(self, value: f64) -> String {
        format!("{} {}", number(self.scale * value), self.unit)
    }

    /// An amount of an error, in D or radians.
    pub(crate) fn amount(self, dof: Dof, value: f64) -> String {
        if dof.is_rotation() { degrees(value) } else { self.length(value) }
    }

    /// The parts of an error that are not 0.
    pub(crate) fn error(self, error: &PoseError) -> String {
        let parts = Dof::ALL
            .into_iter()
            .zip(error.to_array())
            .filter(|(dof, value)| value.abs() >= NONE[usize::from(dof.is_rotation())]);
        let parts: Vec<String> =
            parts.map(|(dof, value)| format!("{} {}", dof.name(), self.amount(dof, value))).collect();
        if parts.is_empty() { "no error".to_owned() } else { parts.join(", ") }
    }
}

fn degrees(value: f64) -> String {
    format!("{:.2} deg", value.to_degrees())
}

/// A length to about four digits.
pub fn number(value: f64) -> String {
    let grain = GRAIN * 10f64.powf(value.abs().max(f64::MIN_POSITIVE).log10().floor().clamp(-3.0, 3.0));
    let rounded = (value / grain).round() * grain;
    let digits = (-grain.log10()).ceil().clamp(0.0, 6.0) as usize;
    let text = format!("{rounded:.digits$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_in_the_unit_and_angles_in_degrees() {
        let display_unit = DisplayUnit { scale: 50.0, unit: "mm" };
        let error = PoseError { x: 0.2, roll: 1e-9, pitch: -1.0, ..PoseError::default() };
        assert_eq!(display_unit.error(&error), "x 10 mm, pitch -57.30 deg");
        assert_eq!(display_unit.error(&PoseError::default()), "no error");
        assert_eq!(DisplayUnit::IN_D.length(-0.012_345_6), "-0.01235 D");
        assert_eq!([number(-0.0), number(1234.56), number(2.5e-4)], ["0", "1235", "0.00025"]);
    }
}
