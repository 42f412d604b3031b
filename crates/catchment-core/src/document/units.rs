//! Lengths, angles and pose errors of a design in its own unit and degrees.

use super::number::{decimals, length, significant};
use crate::design::Design;
use crate::pose::{Dof, PoseError};

/// Lengths below this are written as 0, in D: rounding, and the last step of a search for rests.
pub(crate) const NOTHING: f64 = 1e-8;

/// The unit of a design: its own, or D without one.
#[derive(Debug, Clone, Copy)]
pub struct DesignUnits<'a> {
    design: &'a Design,
}

impl<'a> DesignUnits<'a> {
    /// Those of a design.
    pub const fn of(design: &'a Design) -> Self {
        Self { design }
    }

    /// `mm`, or `D`.
    pub fn unit(self) -> &'static str {
        self.design.unit.map_or("D", |unit| unit.symbol())
    }

    /// D in that unit.
    pub const fn scale(self) -> f64 {
        if self.design.unit.is_some() { self.design.width } else { 1.0 }
    }

    /// A length that is given in D, without its unit: `12.500`.
    pub fn plain(self, value: f64) -> String {
        length(value * self.scale(), self.scale())
    }

    /// A length that is given in D: `12.500 mm`.
    pub fn length(self, value: f64) -> String {
        format!("{} {}", self.plain(value), self.unit())
    }

    /// A small length that is given in D, to four digits.
    pub fn fine(self, value: f64) -> String {
        let value = if value < NOTHING { 0.0 } else { value };
        format!("{} {}", significant(value * self.scale()), self.unit())
    }

    /// A point that is given in D: `(1.2, 0.0, -3.4) mm`.
    pub fn point(self, point: [f64; 3]) -> String {
        let [x, y, z] = point.map(|part| self.plain(part));
        format!("({x}, {y}, {z}) {}", self.unit())
    }

    /// The half-width of an error, in D or radians, rounded towards zero: `±0.402 mm`, `±12.34°`.
    pub fn half_width(self, axis: Dof, value: f64) -> String {
        let down = |value: f64, digits: f64| (value * digits + 1e-9).floor() / digits;
        if axis.is_rotation() {
            return format!("±{:.2}°", down(value.to_degrees(), 100.0));
        }
        match self.design.unit {
            Some(unit) => {
                let decimals = decimals(self.design.width);
                let value = down(value * self.design.width, 10f64.powf(decimals as f64));
                format!("±{value:.decimals$} {}", unit.symbol())
            }
            None => format!("±{:.4} D", down(value, 10_000.0)),
        }
    }

    /// An error, in D or radians: `12.500 mm`, `6.00°`.
    pub fn amount(self, axis: Dof, value: f64) -> String {
        if !axis.is_rotation() {
            return self.length(value);
        }
        let degrees = value.to_degrees();
        format!("{:.2}°", if degrees.abs() < 5e-3 { 0.0 } else { degrees })
    }

    /// All free errors: `x 12.500 mm, yaw 6.00°`.
    pub fn pose(self, error: &PoseError) -> String {
        let value = |axis: Dof| error.to_array()[axis.index()];
        let free = self.design.alignment.free.iter();
        let parts: Vec<String> =
            free.map(|axis| format!("{} {}", axis.name(), self.amount(axis, value(axis)))).collect();
        parts.join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::read;

    #[test]
    fn a_design_has_millimetres_or_widths() {
        let design = |width: &str| {
            let connector = format!("[connector]\nfamily = \"v-face\"\naspect_ratio = 1.0\n{width}");
            let text = format!("{connector}[alignment]\nfree = [\"x\", \"pitch\"]\n");
            read(&text, ".".as_ref()).unwrap().design
        };
        let (bare, sized) = (design(""), design("unit = \"mm\"\nwidth = 50.0\n"));
        let error = PoseError { x: 0.25, pitch: -1e-9, ..PoseError::default() };
        assert_eq!(DesignUnits::of(&bare).pose(&error), "x 0.250 D, pitch 0.00°");
        assert_eq!(DesignUnits::of(&sized).pose(&error), "x 12.500 mm, pitch 0.00°");
        assert_eq!(DesignUnits::of(&sized).half_width(Dof::X, 0.019_999), "±0.999 mm");
        assert_eq!(DesignUnits::of(&sized).half_width(Dof::Pitch, 0.1), "±5.72°");
        assert_eq!(DesignUnits::of(&sized).fine(1e-10), "0 mm");
        assert_eq!(DesignUnits::of(&sized).point([0.0, 0.1, -0.02]), "(0.000, 5.000, -1.000) mm");
    }
}
