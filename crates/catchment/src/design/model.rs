//! The resolved design: no units, no defaults left open.

use super::Alignment;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// A checked design: lengths in D, angles in radians.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Design {
    /// What the person called it.
    pub name: String,
    /// The two halves.
    pub connector: ConnectorSpec,
    /// D in `unit`; 1 for a dimensionless design.
    pub width: f64,
    /// The unit of `width`; `None` for a dimensionless design.
    pub unit: Option<LengthUnit>,
    /// The alignment problem.
    pub alignment: Alignment,
}

/// A unit of length.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum LengthUnit {
    /// Micrometre.
    Um,
    /// Millimetre.
    Mm,
    /// Centimetre.
    Cm,
    /// Metre.
    M,
    /// Inch, 25.4 mm.
    In,
}

impl LengthUnit {
    /// Every unit, small to large but for the inch.
    pub const ALL: [Self; 5] = [Self::Um, Self::Mm, Self::Cm, Self::M, Self::In];

    /// Metres in one of this unit.
    pub const fn metres(self) -> f64 {
        match self {
            Self::Um => 1e-6,
            Self::Mm => 1e-3,
            Self::Cm => 1e-2,
            Self::M => 1.0,
            Self::In => 0.0254,
        }
    }

    /// The symbol written after a number.
    pub const fn symbol(self) -> &'static str {
        match self {
            Self::Um => "um",
            Self::Mm => "mm",
            Self::Cm => "cm",
            Self::M => "m",
            Self::In => "in",
        }
    }
}

/// Where the geometry comes from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ConnectorSpec {
    /// A built-in family.
    Family(FamilySpec),
    /// The person's own halves.
    Own(OwnSpec),
}

/// The built-in families (spec section 2).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Family {
    /// V notch and tip: planar, gendered.
    VFace,
    /// Sawtooth of three edges: planar, ungendered.
    SFace,
    /// Two crossed ramps in two layers: planar, ungendered.
    XFace,
    /// Square pyramid in its socket: gendered.
    Pyramid,
    /// Circular cone in its socket: gendered, yaw does not matter.
    Cone,
    /// Saddle of four triangular facets: ungendered.
    #[serde(rename = "x-face-3d")]
    XFace3d,
    /// The saddle with a lip along its centre lines: ungendered.
    #[serde(rename = "x-face-3d-locking")]
    XFace3dLocking,
    /// Pins and chamfered holes on a circle.
    PinHole,
}

impl Family {
    /// Every family, in the order of the documentation.
    pub const ALL: [Self; 8] = [
        Self::VFace,
        Self::SFace,
        Self::XFace,
        Self::Pyramid,
        Self::Cone,
        Self::XFace3d,
        Self::XFace3dLocking,
        Self::PinHole,
    ];

    /// The name used in design files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::VFace => "v-face",
            Self::SFace => "s-face",
            Self::XFace => "x-face",
            Self::Pyramid => "pyramid",
            Self::Cone => "cone",
            Self::XFace3d => "x-face-3d",
            Self::XFace3dLocking => "x-face-3d-locking",
            Self::PinHole => "pin-hole",
        }
    }

    /// What it is, in a few words.
    pub const fn summary(self) -> &'static str {
        match self {
            Self::VFace => "V notch and tip, planar",
            Self::SFace => "sawtooth of three edges, planar, both halves alike",
            Self::XFace => "two crossed ramps in two layers, planar, both halves alike",
            Self::Pyramid => "square pyramid in its socket",
            Self::Cone => "circular cone in its socket",
            Self::XFace3d => "saddle of four triangles, both halves alike",
            Self::XFace3dLocking => "the saddle with a lip along its centre lines, both halves alike",
            Self::PinHole => "pins and chamfered holes on a circle",
        }
    }

    /// Whether the family is a profile in the x–z plane, extruded along y.
    pub const fn is_planar(self) -> bool {
        matches!(self, Self::VFace | Self::SFace | Self::XFace)
    }
}

/// A family and its parameters; all lengths in D, angles in radians. Parameters that a family does not have
/// are ignored by it (the file reader refuses them).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FamilySpec {
    /// Which family.
    pub family: Family,
    /// H/D.
    pub aspect_ratio: f64,
    /// Material behind the mating surface, in D, where the family's default is not wanted.
    pub base_thickness: Option<f64>,
    /// Largest distance between a circle and the polygon that stands for it, in D (`cone`, `pin-hole`).
    pub chord_error: f64,
    /// Height of the lip, in D (`x-face-3d-locking`).
    pub lip_height: f64,
    /// Inclination of the lip's mating faces from the vertical, radians (`x-face-3d-locking`).
    pub draft_angle: f64,
    /// Pins per half (`pin-hole`).
    pub pins: u32,
    /// Pins and holes alternate on both halves instead of all pins on one (`pin-hole`).
    pub hermaphroditic: bool,
    /// Radius of a pin, in D (`pin-hole`).
    pub pin_radius: f64,
    /// Radial play between pin and hole, in D (`pin-hole`); play between vertical lips, in D
    /// (`x-face-3d-locking` without draft).
    pub clearance: f64,
    /// Width of the chamfer around a hole, and of the point of a pin, in D (`pin-hole`).
    pub chamfer: f64,
    /// Radius of the circle on which pins and holes sit, in D (`pin-hole`).
    pub circle_radius: f64,
}

impl FamilySpec {
    /// The family with its default parameters.
    pub const fn new(family: Family) -> Self {
        Self {
            family,
            aspect_ratio: match family {
                // tan 30°, the dissertation's choice.
                Family::XFace3d | Family::XFace3dLocking => 0.577_350_269_189_625_8,
                Family::PinHole => 0.2,
                _ => 0.5,
            },
            base_thickness: None,
            chord_error: 0.001,
            lip_height: 0.1,
            draft_angle: 0.0,
            pins: 2,
            hermaphroditic: false,
            pin_radius: 0.05,
            clearance: 0.005,
            chamfer: 0.1,
            circle_radius: 0.3,
        }
    }
}

/// The person's own halves, both drawn facing +z.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OwnSpec {
    /// z of the face centre in each half's own frame, in D.
    pub face_height: f64,
    /// The fixed half.
    pub fixed: HalfSpec,
    /// The moving half.
    pub moving: HalfSpec,
}

/// One half of the person's own.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum HalfSpec {
    /// Convex pieces, each a list of vertices, in D.
    Pieces(Vec<Vec<[f64; 3]>>),
    /// A closed triangle mesh in an STL file.
    Mesh {
        /// The file, absolute or relative to the working directory.
        path: PathBuf,
        /// Multiplies the file's coordinates to give D.
        scale: f64,
    },
}
