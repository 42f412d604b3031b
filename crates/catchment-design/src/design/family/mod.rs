//! The built-in families and their parameters: a small struct for each family, in its own file.
//!
//! ```text
//! families! { Cone: "cone", "circular cone in its socket", Freedom::Round; … }   one line per family
//!      └──▶ Family::Cone            the name
//!      └──▶ FamilySpec::Cone(Cone)  the name with its parameters
//! ```
//!
//! Lengths in D, angles in radians. A family's parameters are listed in [`keys`]; the reader, the templates
//! and the digest iterate over them by key, so that no other code depends on a family. `catchment-connector`
//! constructs a family's geometry and checks that its parameters yield a solid; this module only defines
//! their types.

mod cone;
mod pin_hole;
mod planar;
mod pyramid;
mod saddle;

pub use cone::Cone;
pub use pin_hole::PinHole;
pub use planar::{SFace, VFace, XFace};
pub use pyramid::Pyramid;
pub use saddle::{XFace3d, XFace3dLocking};

use super::keys::{self, Key};
use serde::{Deserialize, Serialize};

/// Description of the key `family`: every name of the table below.
pub(super) const NAMES: &str =
    "Built-in family: v-face, s-face, x-face, pyramid, cone, x-face-3d, x-face-3d-locking or pin-hole.";

/// Default free errors of a family.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Freedom {
    /// A profile in the x–z plane, extruded along y: x and pitch.
    Planar,
    /// All five.
    Spatial,
    /// All but yaw, which does not matter.
    Round,
}

/// The value of a parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Value {
    /// A length in D, an angle in radians, or a ratio.
    Number(f64),
    /// A count.
    Whole(u32),
    /// Yes or no.
    Flag(bool),
}

/// A parameter's place in its struct.
enum Field<'a> {
    Number(&'a mut f64),
    /// `None`: the family's default.
    Optional(&'a mut Option<f64>),
    Whole(&'a mut u32),
    Flag(&'a mut bool),
}

impl Field<'_> {
    const fn value(&self) -> Option<Value> {
        match self {
            Self::Number(number) => Some(Value::Number(**number)),
            Self::Optional(Some(number)) => Some(Value::Number(*number)),
            Self::Optional(None) => None,
            Self::Whole(count) => Some(Value::Whole(**count)),
            Self::Flag(flag) => Some(Value::Flag(**flag)),
        }
    }

    /// Whether the value is of the field's type, and was taken.
    const fn set(self, value: Value) -> bool {
        match (self, value) {
            (Self::Number(field), Value::Number(number)) => *field = number,
            (Self::Optional(field), Value::Number(number)) => *field = Some(number),
            (Self::Whole(field), Value::Whole(count)) => *field = count,
            (Self::Flag(field), Value::Flag(flag)) => *field = flag,
            _ => return false,
        }
        true
    }
}

macro_rules! field_of {
    ($($type:ty => $variant:ident),*) => {
        $(impl<'a> From<&'a mut $type> for Field<'a> {
            fn from(field: &'a mut $type) -> Self {
                Self::$variant(field)
            }
        })*
    };
}
field_of!(f64 => Number, Option<f64> => Optional, u32 => Whole, bool => Flag);

/// A family's struct: `field: type = default => KEY;` for each of its parameters, in the order of the documentation.
macro_rules! parameters {
    ($(#[$doc:meta])* $name:ident {
        $($(#[$field_doc:meta])* $field:ident: $type:ty = $default:expr => $key:ident;)*
    }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
        #[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
        pub struct $name {
            $($(#[$field_doc])* pub $field: $type,)*
        }

        impl $name {
            /// The default parameters.
            pub const DEFAULT: Self = Self { $($field: $default,)* };

            /// Every parameter with its key.
            pub(super) fn fields(&mut self) -> Vec<(&'static $crate::design::keys::Key, super::Field<'_>)> {
                vec![$((&$crate::design::keys::$key, super::Field::from(&mut self.$field)),)*]
            }
        }

        impl Default for $name {
            fn default() -> Self {
                Self::DEFAULT
            }
        }
    };
}
use parameters;

/// The table of families: `Struct: "name in files", "summary", freedom;`
macro_rules! families {
    ($($name:ident: $text:literal, $summary:literal, $freedom:expr;)*) => {
        /// The built-in families.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
        #[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
        pub enum Family {
            $(#[doc = $summary] #[serde(rename = $text)] $name,)*
        }

        impl Family {
            /// Every family, in the order of the documentation.
            pub const ALL: [Self; [$($text),*].len()] = [$(Self::$name),*];

            /// The name used in design files.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$name => $text,)* }
            }

            /// Short description.
            pub const fn summary(self) -> &'static str {
                match self { $(Self::$name => $summary,)* }
            }

            /// Default free errors.
            pub const fn freedom(self) -> Freedom {
                match self { $(Self::$name => $freedom,)* }
            }
        }

        /// A family and its parameters; all lengths in D, angles in radians.
        /// In JSON it is an object: the family's name under `family`, then its parameters. Other keys are
        /// ignored, so that objects with the parameters of all families are still valid.
        #[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
        #[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
        #[serde(tag = "family")]
        pub enum FamilySpec {
            $(#[doc = $summary] #[serde(rename = $text)] $name($name),)*
        }

        impl FamilySpec {
            /// The family with its default parameters.
            pub const fn new(family: Family) -> Self {
                match family { $(Family::$name => Self::$name($name::DEFAULT),)* }
            }

            /// Which family.
            pub const fn family(&self) -> Family {
                match self { $(Self::$name(_) => Family::$name,)* }
            }

            /// H/D.
            pub const fn aspect_ratio(&self) -> f64 {
                match self { $(Self::$name(parameters) => parameters.aspect_ratio,)* }
            }

            /// Thickness of the material behind the mating surface, in D, if it differs from the family's
            /// default.
            pub const fn base_thickness(&self) -> Option<f64> {
                match self { $(Self::$name(parameters) => parameters.base_thickness,)* }
            }

            /// The same with another H/D.
            #[must_use]
            pub const fn with_aspect_ratio(mut self, aspect_ratio: f64) -> Self {
                match &mut self { $(Self::$name(parameters) => parameters.aspect_ratio = aspect_ratio,)* }
                self
            }

            /// The same with other material behind the mating surface, in D; `None` for the family's default.
            #[must_use]
            pub const fn with_base_thickness(mut self, base_thickness: Option<f64>) -> Self {
                match &mut self { $(Self::$name(parameters) => parameters.base_thickness = base_thickness,)* }
                self
            }

            fn fields(&mut self) -> Vec<(&'static Key, Field<'_>)> {
                match self { $(Self::$name(parameters) => parameters.fields(),)* }
            }
        }

        $(impl From<$name> for FamilySpec {
            fn from(parameters: $name) -> Self {
                Self::$name(parameters)
            }
        })*
    };
}

families! {
    VFace: "v-face", "V notch and tip, planar", Freedom::Planar;
    SFace: "s-face", "sawtooth of three edges, planar, both halves alike", Freedom::Planar;
    XFace: "x-face", "two crossed ramps in two layers, planar, both halves alike", Freedom::Planar;
    Pyramid: "pyramid", "square pyramid in its socket", Freedom::Spatial;
    Cone: "cone", "circular cone in its socket", Freedom::Round;
    XFace3d: "x-face-3d", "saddle of four triangles, both halves alike", Freedom::Spatial;
    XFace3dLocking: "x-face-3d-locking", "the saddle with a lip along its centre lines, both halves alike",
        Freedom::Spatial;
    PinHole: "pin-hole", "pins and chamfered holes on a circle", Freedom::Spatial;
}

impl Family {
    /// Whether the family is a profile in the x–z plane, extruded along y.
    pub const fn is_planar(self) -> bool {
        matches!(self.freedom(), Freedom::Planar)
    }
}

impl FamilySpec {
    /// Every parameter with its key and value, in the order of the documentation; `None` for the family's
    /// default.
    pub fn parameters(mut self) -> Vec<(&'static Key, Option<Value>)> {
        self.fields().into_iter().map(|(key, field)| (key, field.value())).collect()
    }

    /// The value of a parameter; `None` if the family does not have it, or has its default.
    pub fn get(self, key: &Key) -> Option<Value> {
        self.parameters().into_iter().find(|(has, _)| has.name == key.name)?.1
    }

    /// Sets a parameter. False if the family does not have the parameter, or it has another type.
    pub fn set(&mut self, key: &Key, value: Value) -> bool {
        let field = self.fields().into_iter().find(|(has, _)| has.name == key.name);
        field.is_some_and(|(_, field)| field.set(value))
    }

    /// Whether its halves have layers, each of which belongs to the layer of the other half with the same
    /// number.
    pub fn is_layered(&self) -> bool {
        keys::LAYER_GAP.applies.to(Some(self.family()))
    }

    /// Whether errors out of the plane have a meaning: not for a profile, unless its layers have a size along
    /// y.
    pub fn has_depth(&self) -> bool {
        let written = |key| self.get(key).is_some();
        !self.family().is_planar() || written(&keys::LAYER_THICKNESS) || written(&keys::LAYER_GAP)
    }

    /// Largest distance between a circle and the polygon that stands for it, in D, of families with circles.
    pub fn chord_error(&self) -> Option<f64> {
        match self.get(&keys::CHORD_ERROR) {
            Some(Value::Number(error)) => Some(error),
            _ => None,
        }
    }

    /// The same with another chord error, in D. A family without circles stays unchanged.
    #[must_use]
    pub fn with_chord_error(mut self, chord_error: f64) -> Self {
        self.set(&keys::CHORD_ERROR, Value::Number(chord_error));
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::keys::{Applies, DesignTable};

    #[test]
    fn the_key_table_lists_each_familys_parameters() {
        for family in Family::ALL {
            let has: Vec<_> = FamilySpec::new(family).parameters().iter().map(|(key, _)| key.name).collect();
            let message: Vec<_> = DesignTable::Connector
                .keys()
                .filter(|key| matches!(key.applies, Applies::AnyFamily | Applies::Families(_)))
                .filter(|key| key.applies.to(Some(family)))
                .map(|key| key.name)
                .collect();
            assert_eq!(has, message, "{}", family.name());
            assert!(NAMES.contains(&format!(" {}", family.name())));
        }
    }

    #[test]
    fn json_holds_only_the_parameters_of_the_family() {
        let json = |spec: FamilySpec| serde_json::to_string(&spec).unwrap();
        let pyramid = FamilySpec::new(Family::Pyramid);
        assert_eq!(json(pyramid), r#"{"family":"pyramid","aspect_ratio":0.5,"base_thickness":null}"#);
        for family in Family::ALL {
            let spec = FamilySpec::new(family).with_aspect_ratio(0.1 + 0.2).with_base_thickness(Some(0.3));
            assert_eq!(serde_json::from_str::<FamilySpec>(&json(spec)).unwrap(), spec);
        }
        // As written by versions that gave every family all parameters.
        let old = r#"{"family":"x-face-3d","aspect_ratio":0.25,"base_thickness":null,"chord_error":0.001,"lip_height":0.1,
            "draft_angle":0.0,"pins":2,"hermaphroditic":false,"pin_radius":0.05,"clearance":0.005,"chamfer":0.1,
            "circle_radius":0.3}"#;
        let spec = FamilySpec::new(Family::XFace3d).with_aspect_ratio(0.25);
        assert_eq!(serde_json::from_str::<FamilySpec>(old).unwrap(), spec);
    }

    #[test]
    fn a_parameter_is_set_where_the_family_has_it() {
        let coarse = FamilySpec::new(Family::Cone).with_chord_error(0.02);
        assert_eq!(coarse.chord_error(), Some(0.02));
        let pyramid = FamilySpec::new(Family::Pyramid);
        assert_eq!(pyramid.with_chord_error(0.02), pyramid);
        let mut pins = FamilySpec::new(Family::PinHole);
        assert!(!pins.set(&keys::PINS, Value::Number(3.0)) && pins.set(&keys::PINS, Value::Whole(3)));
        assert_eq!(pins, PinHole { pins: 3, ..PinHole::DEFAULT }.into());
        assert_eq!(pins.get(&keys::BASE_THICKNESS), None);
    }
}
