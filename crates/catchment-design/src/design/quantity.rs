//! Numbers with units: `"5 mm"`, `"30 deg"`, `"0.5 rad"`, `"0.2 D"`.
//!
//! A bare number is in D or radians. A length with a unit is converted to D by the width of the design, which
//! needs a design with a unit.

use super::defect::{DesignDefect, Dimension};
use super::{Design, LengthUnit};
use catchment_base::suggest::nearest;
use std::fmt;
use std::str::FromStr;

/// Unit of a number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum QuantityUnit {
    /// Nothing written: D for lengths, radians for angles.
    Bare,
    /// The width of the connector.
    D,
    /// A length in the outside world.
    Length(LengthUnit),
    /// Degrees.
    Degrees,
    /// Radians.
    Radians,
}

/// Every unit with its spellings; messages use the first.
const UNITS: [(QuantityUnit, &[&str]); 8] = [
    (QuantityUnit::D, &["D"]),
    (QuantityUnit::Length(LengthUnit::Um), &["um", "µm", "μm"]),
    (QuantityUnit::Length(LengthUnit::Mm), &["mm"]),
    (QuantityUnit::Length(LengthUnit::Cm), &["cm"]),
    (QuantityUnit::Length(LengthUnit::M), &["m"]),
    (QuantityUnit::Length(LengthUnit::In), &["in", "inch"]),
    (QuantityUnit::Degrees, &["deg", "°"]),
    (QuantityUnit::Radians, &["rad"]),
];

impl QuantityUnit {
    fn named(name: &str) -> Option<Self> {
        UNITS.iter().find(|(_, names)| names.contains(&name)).map(|(unit, _)| *unit)
    }

    fn symbol(self) -> &'static str {
        UNITS.iter().find(|(unit, _)| *unit == self).map_or("", |(_, names)| names[0])
    }
}

/// A finite number and its unit, as written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quantity {
    /// The number.
    pub value: f64,
    /// Its unit.
    pub unit: QuantityUnit,
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.unit {
            QuantityUnit::Bare => write!(f, "{}", self.value),
            unit => write!(f, "{} {}", self.value, unit.symbol()),
        }
    }
}

impl FromStr for Quantity {
    type Err = DesignDefect;

    fn from_str(text: &str) -> Result<Self, DesignDefect> {
        let text = text.trim();
        let is_unit = |c: char| c.is_alphabetic() || c == '°';
        let number = text.trim_end_matches(is_unit);
        let unit = &text[number.len()..];
        let not_a_quantity = || DesignDefect::NotAQuantity { text: shortened(text) };
        if number.trim().is_empty() {
            return Err(not_a_quantity());
        }
        let value: f64 = number.trim().parse().map_err(|_| not_a_quantity())?;
        if !value.is_finite() {
            return Err(DesignDefect::NotFinite { text: shortened(text) });
        }
        if unit.is_empty() {
            return Ok(Self { value, unit: QuantityUnit::Bare });
        }
        let unit = QuantityUnit::named(unit).ok_or_else(|| DesignDefect::UnknownUnit {
            unit: shortened(unit),
            meant: nearest(unit, UNITS.iter().flat_map(|(_, names)| names.iter().copied())),
        })?;
        Ok(Self { value, unit })
    }
}

/// The first 40 characters without control characters: messages quote input of any size and kind.
pub fn shortened(text: &str) -> String {
    const LONGEST: usize = 40;
    let printable = |c: char| if c.is_control() { '\u{FFFD}' } else { c };
    let mut short: String = text.chars().take(LONGEST).map(printable).collect();
    if text.chars().nth(LONGEST).is_some() {
        short.push('…');
    }
    short
}

/// Conversion of lengths to D.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LengthScale {
    /// D in `unit`, or in the nameless unit that a dimensionless design is drawn in.
    pub width: f64,
    /// The unit of the design.
    pub unit: Option<LengthUnit>,
}

impl Quantity {
    /// The length in D; bare numbers are D.
    ///
    /// # Errors
    /// An angle, or a unit in a dimensionless design.
    pub fn length_d(self, scale: &LengthScale) -> Result<f64, DesignDefect> {
        match (self.unit, scale.unit) {
            (QuantityUnit::Bare | QuantityUnit::D, _) => Ok(self.value),
            (QuantityUnit::Length(unit), Some(design)) => {
                Ok(self.value * (unit.metres() / (design.metres() * scale.width)))
            }
            (QuantityUnit::Length(_), None) => {
                Err(DesignDefect::UnitInDimensionlessDesign { text: self.to_string() })
            }
            (QuantityUnit::Degrees | QuantityUnit::Radians, _) => {
                Err(DesignDefect::WrongDimension { text: self.to_string(), wanted: Dimension::Length })
            }
        }
    }

    /// The width of a design whose unit is `unit`, in that unit.
    ///
    /// # Errors
    /// An angle, a length in D, or a unit in a dimensionless design.
    pub fn width(self, unit: Option<LengthUnit>) -> Result<f64, DesignDefect> {
        match self.unit {
            QuantityUnit::D => Err(DesignDefect::WidthInD),
            _ => self.length_d(&LengthScale { width: 1.0, unit }),
        }
    }

    /// The length in D; bare numbers are in the unit the halves are drawn in.
    ///
    /// # Errors
    /// As [`Quantity::length_d`].
    pub fn drawn_length_d(self, scale: &LengthScale) -> Result<f64, DesignDefect> {
        match self.unit {
            QuantityUnit::Bare => Ok(self.value / scale.width),
            _ => self.length_d(scale),
        }
    }

    /// The angle in radians; bare numbers are radians.
    ///
    /// # Errors
    /// A length.
    pub fn angle_rad(self) -> Result<f64, DesignDefect> {
        match self.unit {
            QuantityUnit::Bare | QuantityUnit::Radians => Ok(self.value),
            QuantityUnit::Degrees => Ok(self.value.to_radians()),
            QuantityUnit::D | QuantityUnit::Length(_) => {
                Err(DesignDefect::WrongDimension { text: self.to_string(), wanted: Dimension::Angle })
            }
        }
    }
}

impl Design {
    /// Conversion of lengths to D in this design.
    pub const fn scale(&self) -> LengthScale {
        LengthScale { width: self.width, unit: self.unit }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_6;

    const MM50: LengthScale = LengthScale { width: 50.0, unit: Some(LengthUnit::Mm) };

    fn quantity(text: &str) -> Quantity {
        text.parse().unwrap()
    }

    #[test]
    fn lengths_become_d() {
        for (text, d) in [("5 mm", 0.1), ("5mm", 0.1), ("0.5 cm", 0.1), ("2 in", 1.016), ("-0.3", -0.3)] {
            // A multiplication and a division: a few units in the last place.
            let got = quantity(text).length_d(&MM50).unwrap();
            assert!((got - d).abs() < 4.0 * f64::EPSILON, "{text}: {got}");
        }
        assert_eq!(quantity("1e-1 D").length_d(&MM50), Ok(0.1));
        assert_eq!(quantity("5").drawn_length_d(&MM50), Ok(0.1));
    }

    #[test]
    fn angles_become_radians() {
        assert_eq!(quantity("30 deg").angle_rad(), Ok(30f64.to_radians()));
        assert_eq!(quantity("30°").angle_rad(), Ok(30f64.to_radians()));
        assert_eq!(quantity("0.5 rad").angle_rad(), Ok(0.5));
        assert!((quantity("30deg").angle_rad().unwrap() - FRAC_PI_6).abs() < 2.0 * f64::EPSILON);
    }

    #[test]
    fn invalid_quantities_are_reported() {
        let defect = |text: &str| text.parse::<Quantity>().unwrap_err();
        assert!(matches!(defect("5 mmm"), DesignDefect::UnknownUnit { meant: Some("mm"), .. }));
        assert!(matches!(defect("5 furlong"), DesignDefect::UnknownUnit { meant: None, .. }));
        assert!(matches!(defect("mm"), DesignDefect::NotAQuantity { .. }));
        assert!(matches!(defect("1e999 mm"), DesignDefect::NotFinite { .. }));
        assert!(matches!(defect("5,5 mm"), DesignDefect::NotAQuantity { .. }));
        let bare = LengthScale { width: 1.0, unit: None };
        assert!(matches!(
            quantity("5 mm").length_d(&bare),
            Err(DesignDefect::UnitInDimensionlessDesign { .. })
        ));
        assert!(matches!(quantity("5 deg").length_d(&MM50), Err(DesignDefect::WrongDimension { .. })));
        assert!(matches!(quantity("5 D").angle_rad(), Err(DesignDefect::WrongDimension { .. })));
    }
}
