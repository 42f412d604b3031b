//! Errors in a design: facts, each with advice.

use super::FamilySpec;
use super::keys::{MOST_PARTS, Range};
use catchment_base::pose::Dof;
use catchment_base::suggest::{number_help, odd};

/// Lengths and angles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dimension {
    /// D, or a unit of length.
    Length,
    /// Radians or degrees.
    Angle,
}

impl Dimension {
    const fn name(self) -> &'static str {
        match self {
            Self::Length => "a length",
            Self::Angle => "an angle",
        }
    }

    const fn units(self) -> &'static str {
        match self {
            Self::Length => "lengths are bare numbers (in D) or strings with D, um, mm, cm, m or in",
            Self::Angle => "angles are bare numbers (in radians) or strings with rad or deg",
        }
    }
}

/// An error in a design.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DesignDefect {
    /// Not TOML.
    #[error("{message}")]
    Syntax {
        /// Message of the TOML parser.
        message: String,
        /// The correct form, if a number was meant.
        help: Option<String>,
    },
    /// A key that the table does not have.
    #[error("unknown key `{key}` in {table}{}", odd(key))]
    UnknownKey {
        /// The key as written.
        key: String,
        /// Name of the table, for people.
        table: &'static str,
        /// The key it probably stands for.
        meant: Option<&'static str>,
        /// Another table that has a key of this name.
        elsewhere: Option<&'static str>,
        /// The keys that the table has.
        known: Vec<&'static str>,
    },
    /// A name that no key has.
    #[error("no key of a design is called `{name}`{}", odd(name))]
    NoSuchKey {
        /// As written.
        name: String,
        /// The name that was probably meant.
        meant: Option<String>,
    },
    /// A name that several keys have.
    #[error("several keys are called `{name}`")]
    AmbiguousKey {
        /// As written.
        name: String,
        /// Their paths.
        paths: Vec<String>,
    },
    /// A value of another type.
    #[error("`{key}` should be {expected}, not {found}")]
    WrongType {
        /// The key.
        key: String,
        /// The type it should have.
        expected: &'static str,
        /// The type it has.
        found: &'static str,
    },
    /// A number out of range.
    #[error("`{key}` is {found}, outside of {range}")]
    OutOfRange {
        /// The key.
        key: String,
        /// The number as written, and as interpreted if that differs.
        found: String,
        /// Its permitted range.
        range: Range,
        /// Meaning of the key.
        doc: &'static str,
    },
    /// Infinite or not a number.
    #[error("`{text}` is not a finite number")]
    NotFinite {
        /// As written.
        text: String,
    },
    /// A string that is not a number with a unit.
    #[error("`{text}` is not a number with a unit")]
    NotAQuantity {
        /// As written.
        text: String,
    },
    /// A string with a number but no unit.
    #[error("\"{text}\" has no unit")]
    NoUnit {
        /// As written.
        text: String,
    },
    /// An unknown unit.
    #[error("unknown unit `{unit}`{}", odd(unit))]
    UnknownUnit {
        /// As written.
        unit: String,
        /// The unit it probably stands for.
        meant: Option<&'static str>,
    },
    /// A length in place of an angle, or an angle in place of a length.
    #[error("`{text}` is not {}", wanted.name())]
    WrongDimension {
        /// As written.
        text: String,
        /// The expected dimension.
        wanted: Dimension,
    },
    /// A unit in place of a plain number.
    #[error("`{key}` is a plain number, not `{text}`")]
    NotARatio {
        /// The key.
        key: &'static str,
        /// As written.
        text: String,
    },
    /// A length with a unit in a design without a unit.
    #[error("`{text}` has a unit, but the design is dimensionless")]
    UnitInDimensionlessDesign {
        /// As written.
        text: String,
    },
    /// A width in widths.
    #[error("the width is D itself, so it cannot be given in D")]
    WidthInD,
    /// A length in D that D itself depends on.
    #[error("{text} depends on D, and D on it: without `width` D is measured from the halves")]
    ShapesWidth {
        /// The length.
        text: String,
    },
    /// A piece that encloses no volume.
    #[error("`{key}` has {found} points; a solid has at least 4")]
    TooFewPoints {
        /// The piece.
        key: String,
        /// Its points.
        found: usize,
    },
    /// A list that is no point.
    #[error(
        "`{key}` has {found} numbers where {}",
        if *needed == 2 { "two are needed: [x, y]" } else { "three are needed: [x, y, z]" }
    )]
    NotAPoint {
        /// The key.
        key: String,
        /// Its coordinates.
        found: usize,
        /// How many a point has.
        needed: usize,
    },
    /// A polygon that encloses nothing.
    #[error("`{key}` has {found} corners; a polygon has at least 3")]
    TooFewCorners {
        /// The polygon.
        key: String,
        /// Its corners.
        found: usize,
    },
    /// A part that is nothing.
    #[error("`{key}` has no shape")]
    NoShape {
        /// The part.
        key: String,
        /// The correct form.
        advice: &'static str,
    },
    /// More parts than a half may have.
    #[error("`{key}` has {found} parts; a half may have {MOST_PARTS}")]
    TooManyParts {
        /// The key.
        key: String,
        /// How many there are.
        found: usize,
    },
    /// Three zeros, or values too small to define a direction.
    #[error("`{key}` points nowhere")]
    NoDirection {
        /// The key.
        key: String,
    },
    /// A name outside a fixed set.
    #[error("unknown {what} `{name}`{}", odd(name))]
    UnknownName {
        /// The named item.
        what: &'static str,
        /// As written.
        name: String,
        /// The name it probably stands for.
        meant: Option<&'static str>,
        /// All names.
        known: Vec<&'static str>,
    },
    /// Something that has to be there is not.
    #[error("`{key}` is missing")]
    Missing {
        /// The key.
        key: String,
        /// The correct form.
        advice: &'static str,
    },
    /// An empty list or text.
    #[error("`{key}` is empty")]
    Empty {
        /// The key.
        key: String,
        /// The correct form.
        advice: &'static str,
    },
    /// A text that is too long or has control characters.
    #[error("`{key}` is not a line of at most {longest} characters")]
    NotALine {
        /// The key.
        key: String,
        /// The longest text, in characters.
        longest: usize,
    },
    /// Two keys that cannot stand together.
    #[error("`{key}` and `{other}` exclude each other")]
    Contradiction {
        /// The rejected key.
        key: String,
        /// The conflicting key.
        other: String,
        /// Advice.
        advice: &'static str,
    },
    /// A parameter that this connector does not have.
    #[error("`{key}` is no parameter of {owner}")]
    NotAParameter {
        /// The key.
        key: String,
        /// The family, or own halves.
        owner: &'static str,
        /// The families that have it.
        belongs_to: String,
    },
    /// A degree of freedom named twice in the same list.
    #[error("`{}` is listed twice", dof.name())]
    Repeated {
        /// Which.
        dof: Dof,
    },
    /// A degree of freedom that is free and does not matter.
    #[error("`{}` is both free and don't-care", dof.name())]
    FreeAndDontCare {
        /// Which.
        dof: Dof,
    },
    /// A translation that is declared not to matter.
    #[error("`{}` is a translation: only rotations can be don't-care", dof.name())]
    DontCareTranslation {
        /// Which.
        dof: Dof,
    },
    /// Motion out of the plane of a planar family.
    #[error("`{}` leaves the plane of {family}", dof.name())]
    OutOfPlane {
        /// Which.
        dof: Dof,
        /// The family.
        family: &'static str,
        /// Whether it has layers that can be given a depth.
        layered: bool,
    },
    /// Pitch beyond ±90° beside free roll and yaw.
    #[error("a pitch of more than 90 deg counts rotations twice when roll and yaw are free")]
    PitchBeyondPole,
    /// A shape of half that a later version will read.
    #[error("`{key}` halves are not yet supported")]
    UnsupportedHalf {
        /// The kind of half.
        key: &'static str,
    },
    /// A format version of another program.
    #[error("this design has schema {found}; this program reads schema {known}")]
    OtherSchema {
        /// As written.
        found: i64,
        /// The supported version.
        known: i64,
    },
    /// More text than a design has.
    #[error("the design file is larger than {limit} bytes")]
    TooLarge {
        /// The limit, in bytes.
        limit: usize,
    },
}

impl DesignDefect {
    pub(super) fn nothing_free(key: String) -> Self {
        Self::Empty {
            key,
            advice: "name at least one of x, y, roll, pitch, yaw, or remove the key for the default",
        }
    }

    /// The rule of planar families without depth: nothing leaves the x–z plane.
    pub(super) fn out_of_plane(dof: Dof, family: Option<&FamilySpec>) -> Option<Self> {
        let spec = family.filter(|spec| !spec.has_depth() && !matches!(dof, Dof::X | Dof::Pitch))?;
        Some(Self::OutOfPlane { dof, family: spec.family().name(), layered: spec.is_layered() })
    }

    /// Advice; `None` if the message is sufficient.
    pub fn help(&self) -> Option<String> {
        let did_you_mean = |meant: Option<&str>| meant.map(|word| format!("did you mean `{word}`?"));
        match self {
            Self::UnknownKey { meant: Some(word), .. } => Some(format!("did you mean `{word}`?")),
            Self::UnknownKey { elsewhere: Some(table), .. } => Some(format!("it belongs to {table}")),
            Self::UnknownKey { known, .. } => Some(format!("keys here: {}", known.join(", "))),
            Self::NoSuchKey { meant, .. } => did_you_mean(meant.as_deref())
                .or_else(|| Some("`catchment schema` lists the keys; cor and rho are short for two of them".to_owned())),
            Self::AmbiguousKey { paths, .. } => Some(format!("write {}", paths.join(" or "))),
            Self::OutOfRange { doc, range, .. } if range.unit == "rad" => {
                Some(format!("{doc} Bare angles are radians; degrees are written \"30 deg\""))
            }
            Self::OutOfRange { doc, .. } => Some((*doc).to_owned()),
            Self::NotAQuantity { text } => number_help(text).or_else(|| {
                Some("write the number, a space and the unit, such as \"5 mm\" or \"30 deg\"".to_owned())
            }),
            Self::NotFinite { .. } => Some("write a finite number, or leave it out".to_owned()),
            Self::NotARatio { text, .. } => number_help(text),
            Self::NoUnit { text } => Some(format!(
                "write {text} without quotes for D or radians, or add a unit as in \"{text} mm\" or \"{text} deg\""
            )),
            Self::UnknownUnit { meant, .. } => did_you_mean(*meant)
                .or_else(|| Some("lengths: um, mm, cm, m, in, D; angles: deg, rad".to_owned())),
            Self::ShapesWidth { .. } => {
                Some("write it in the unit of the design, as in \"0.5 mm\", or write `width`".to_owned())
            }
            Self::WidthInD => Some(
                "write a bare number, in `unit`; a dimensionless design has width = 1.0 or no width at all".to_owned(),
            ),
            Self::WrongDimension { wanted, .. } => Some(wanted.units().to_owned()),
            Self::UnitInDimensionlessDesign { .. } => Some(
                "add `unit = \"mm\"` (the unit of `width`) to [connector], or write a bare number in D".to_owned(),
            ),
            Self::UnknownName { meant, known, .. } => Some(match did_you_mean(*meant) {
                Some(question) => format!("{question} One of {}", known.join(", ")),
                None => format!("one of {}", known.join(", ")),
            }),
            Self::Missing { advice, .. }
            | Self::Empty { advice, .. }
            | Self::NoShape { advice, .. }
            | Self::Contradiction { advice, .. } => Some((*advice).to_owned()),
            Self::TooManyParts { .. } => Some("unite them into a mesh: mesh = \"half.stl\"".to_owned()),
            Self::UnsupportedHalf { key: "profile" } => {
                Some("extrude it, as a part: parts = [{ profile = [[x, y], …], height = 1.0, axis = \"-y\" }]".to_owned())
            }
            Self::NotAParameter { belongs_to, .. } => Some(format!("it belongs to {belongs_to}; remove it")),
            Self::FreeAndDontCare { .. } => {
                Some("a don't-care rotation is locked in the motion: list it in one of the two".to_owned())
            }
            Self::OutOfPlane { layered: true, .. } => Some(
                "its layers have no depth until the design gives them one: write layer_thickness and layer_gap; else only x \
                 and pitch can be free"
                    .to_owned(),
            ),
            Self::OutOfPlane { .. } => Some(
                "a planar family is a profile in the x-z plane: only x and pitch can be free; for a solid of finite \
                 depth give own halves"
                    .to_owned(),
            ),
            Self::PitchBeyondPole => {
                Some("set `errors.pitch` to at most \"90 deg\", or lock roll or yaw".to_owned())
            }
            Self::UnsupportedHalf { .. } => {
                Some("give convex `pieces` or a closed triangle mesh: mesh = \"half.stl\"".to_owned())
            }
            Self::TooLarge { .. } => {
                Some("put large geometry into an STL file: mesh = \"half.stl\"".to_owned())
            }
            Self::OtherSchema { found, known } if found > known => Some("use a newer version of catchment".to_owned()),
            Self::Syntax { help: Some(help), .. } => Some(help.clone()),
            Self::Syntax { message, .. } if message.contains("string values must be quoted") => {
                Some("a value with a unit is a string: \"5 mm\"".to_owned())
            }
            Self::Syntax { .. }
            | Self::WrongType { .. }
            | Self::TooFewPoints { .. }
            | Self::TooFewCorners { .. }
            | Self::NotAPoint { .. }
            | Self::NoDirection { .. }
            | Self::NotALine { .. }
            | Self::Repeated { .. }
            | Self::DontCareTranslation { .. }
            | Self::OtherSchema { .. } => None,
        }
    }
}
