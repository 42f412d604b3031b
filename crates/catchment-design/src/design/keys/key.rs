//! Description of a key of the design file: its place, its type, its range and its meaning.

use super::KEYS;
use crate::design::defect::DesignDefect;
use crate::design::family::Family;
use crate::design::quantity::{LengthScale, Quantity, QuantityUnit};
use std::fmt;

/// A closed interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// Smallest value.
    pub min: f64,
    /// Largest value.
    pub max: f64,
    /// Its unit: `""`, `"D"`, `"rad"`.
    pub unit: &'static str,
}

impl Range {
    pub(super) const fn new(min: f64, max: f64, unit: &'static str) -> Self {
        Self { min, max, unit }
    }

    /// Whether `value` lies in it; a NaN does not.
    pub fn contains(&self, value: f64) -> bool {
        (self.min..=self.max).contains(&value)
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.unit == "rad" {
            let above = if self.min > 0.0 { "more than " } else { "" };
            write!(f, "{above}{} to {} deg", self.min.to_degrees().round(), self.max.to_degrees().round())
        } else {
            write!(f, "{} to {}", self.min, self.max)?;
            if self.unit.is_empty() { Ok(()) } else { write!(f, " {}", self.unit) }
        }
    }
}

/// Type of a value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ValueKind {
    /// A line of text for people.
    Line,
    /// A number without a unit.
    Ratio(Range),
    /// A whole number.
    Whole {
        /// Smallest.
        min: u32,
        /// Largest.
        max: u32,
    },
    /// `true` or `false`.
    Flag,
    /// A length: bare in D.
    Length(Range),
    /// A length: bare in the unit of the design.
    DrawnLength(Range),
    /// The width itself, in the unit of the design.
    Width(Range),
    /// An angle: bare in radians.
    Angle(Range),
    /// A unit of length.
    Unit,
    /// The name of a family.
    Family,
    /// `"x"` or `"y"`.
    Mount,
    /// `"facing"` or `"assembled"`.
    Drawn,
    /// A direction: `"+x"` … `"-z"`, or three numbers.
    Direction,
    /// Three lengths, bare in the unit of the design.
    Point(Range),
    /// Three angles, bare in radians: turns about x, y and z.
    Turns(Range),
    /// A list of degrees of freedom.
    Dofs,
    /// The path of a file.
    Path,
    /// Convex pieces, each a list of points.
    Pieces,
    /// The parts of a half: a list of tables.
    Parts,
    /// The path of a drawing, or the corners of a polygon: a list of two lengths each, bare in the unit of the design.
    Outline(Range),
    /// Read by a later version.
    Later,
    /// A table with keys of its own.
    Table(DesignTable),
}

/// A table of the design file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DesignTable {
    /// The file itself.
    Root,
    /// `[connector]`.
    Connector,
    /// `[connector.fixed]` and `[connector.moving]`.
    Half,
    /// `[[connector.fixed.parts]]` and `[[connector.moving.parts]]`.
    Part,
    /// `sphere` of a part.
    Sphere,
    /// `cylinder` of a part.
    Cylinder,
    /// `cone` of a part.
    Cone,
    /// `[alignment]`.
    Alignment,
    /// `[errors]`.
    Errors,
    /// `[docked]`.
    Docked,
}

impl DesignTable {
    /// Every table.
    pub const ALL: [Self; 10] = [
        Self::Root,
        Self::Connector,
        Self::Half,
        Self::Part,
        Self::Sphere,
        Self::Cylinder,
        Self::Cone,
        Self::Alignment,
        Self::Errors,
        Self::Docked,
    ];

    /// Name for people.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Root => "the top of the file",
            Self::Connector => "[connector]",
            Self::Half => "[connector.fixed] and [connector.moving]",
            Self::Part => "a part of a half",
            Self::Sphere => "a sphere",
            Self::Cylinder => "a cylinder",
            Self::Cone => "a cone",
            Self::Alignment => "[alignment]",
            Self::Errors => "[errors]",
            Self::Docked => "[docked]",
        }
    }

    /// Its keys, in the order of the documentation.
    pub fn keys(self) -> impl Iterator<Item = &'static Key> {
        KEYS.iter().copied().filter(move |key| key.table == self)
    }
}

/// Which connectors have a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Applies {
    /// Every design.
    Always,
    /// Every built-in family.
    AnyFamily,
    /// Some families.
    Families(&'static [Family]),
    /// Own halves.
    OwnHalves,
}

impl Applies {
    /// Whether a design with this family (`None`: own halves) has the parameter.
    pub fn to(self, family: Option<Family>) -> bool {
        match (self, family) {
            (Self::Always, _) | (Self::AnyFamily, Some(_)) | (Self::OwnHalves, None) => true,
            (Self::Families(list), Some(family)) => list.contains(&family),
            (Self::AnyFamily | Self::Families(_), None) | (Self::OwnHalves, Some(_)) => false,
        }
    }
}

impl fmt::Display for Applies {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Always => f.write_str("every design"),
            Self::AnyFamily => f.write_str("the built-in families"),
            Self::OwnHalves => f.write_str("own halves"),
            Self::Families(list) => {
                let names: Vec<&str> = list.iter().map(|family| family.name()).collect();
                f.write_str(&names.join(" and "))
            }
        }
    }
}

/// A key of the design file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Key {
    /// The table it stands in.
    pub table: DesignTable,
    /// Its name.
    pub name: &'static str,
    /// Type of its value.
    pub kind: ValueKind,
    /// Who has it.
    pub applies: Applies,
    /// Its meaning, for people.
    pub doc: &'static str,
}

impl Key {
    /// The key for the check of each of the three values of this key.
    #[must_use]
    pub const fn element(self) -> Self {
        let kind = match self.kind {
            ValueKind::Point(range) | ValueKind::Outline(range) => ValueKind::DrawnLength(range),
            ValueKind::Turns(range) => ValueKind::Angle(range),
            kind => kind,
        };
        Self { kind, ..self }
    }

    /// Whether the meaning of a quantity for this key depends on D.
    pub(in crate::design) const fn depends_on_width(&self, quantity: Quantity) -> bool {
        match self.kind {
            ValueKind::Length(_) => !matches!(quantity.unit, QuantityUnit::Bare | QuantityUnit::D),
            ValueKind::DrawnLength(_) => !matches!(quantity.unit, QuantityUnit::D),
            _ => false,
        }
    }

    /// The length in D, whatever the range; `None` for other quantities.
    pub(in crate::design) fn unchecked(
        &self,
        quantity: Quantity,
        scale: Option<&LengthScale>,
    ) -> Option<f64> {
        match self.kind {
            ValueKind::Length(_) => quantity.length_d(scale?).ok(),
            ValueKind::DrawnLength(_) => quantity.drawn_length_d(scale?).ok(),
            _ => None,
        }
    }

    /// The quantity in the unit of this key's range (D, radians or without a unit), if it lies in the range.
    /// `None` if a `scale` is needed and missing.
    ///
    /// # Errors
    /// Out of range, a unit of the wrong dimension, or a unit in a dimensionless design.
    pub fn checked(
        &self,
        quantity: Quantity,
        scale: Option<&LengthScale>,
    ) -> Result<Option<f64>, DesignDefect> {
        let needs_scale = self.depends_on_width(quantity);
        let scale = match scale {
            Some(scale) => *scale,
            None if needs_scale => return Ok(None),
            None => LengthScale { width: 1.0, unit: None },
        };
        let (number, range) = match self.kind {
            ValueKind::Length(range) => (quantity.length_d(&scale)?, range),
            ValueKind::DrawnLength(range) => (quantity.drawn_length_d(&scale)?, range),
            ValueKind::Angle(range) => (quantity.angle_rad()?, range),
            ValueKind::Width(range) => (quantity.width(scale.unit)?, range),
            ValueKind::Ratio(range) if quantity.unit == QuantityUnit::Bare => (quantity.value, range),
            _ => return Err(DesignDefect::NotARatio { key: self.name, text: quantity.to_string() }),
        };
        if range.contains(number) {
            return Ok(Some(number));
        }
        let found = match quantity.unit {
            _ if range.unit.is_empty() => quantity.to_string(),
            QuantityUnit::Bare if matches!(self.kind, ValueKind::DrawnLength(_)) => {
                format!("{quantity} = {number} D")
            }
            QuantityUnit::Bare | QuantityUnit::D => format!("{} {}", quantity.value, range.unit),
            QuantityUnit::Length(_) => format!("{quantity} = {number} D"),
            QuantityUnit::Degrees | QuantityUnit::Radians => quantity.to_string(),
        };
        Err(DesignDefect::OutOfRange { key: self.name.to_owned(), found, range, doc: self.doc })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_are_closed_and_refuse_nan() {
        let range = Range::new(0.0, 1.0, "D");
        assert!(range.contains(0.0) && range.contains(1.0));
        assert!(!range.contains(-1e-300) && !range.contains(f64::NAN));
    }
}
