//! The resolved design: without units, and with all defaults filled in.

use super::{Alignment, DrawnFrames, Family, FamilySpec, FileSpec, MeshContent, PartPlacement, PartSpec};
use catchment_base::pose::DofSet;
use serde::{Deserialize, Serialize};

/// A checked design: lengths in D, angles in radians.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Design {
    /// Name given by the user.
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

impl Design {
    /// A family with its defaults, free in `free`.
    pub fn of_family(family: Family, free: DofSet) -> Self {
        let alignment = Alignment { free, ..Alignment::default_for(Some(family)) };
        let connector = ConnectorSpec::Family(FamilySpec::new(family));
        Self { name: family.name().to_owned(), connector, width: 1.0, unit: None, alignment }
    }
}

/// A unit of length.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
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

    /// Metres per unit.
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

/// Source of the geometry.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
#[expect(clippy::large_enum_variant, reason = "a design has one")]
pub enum ConnectorSpec {
    /// A built-in family.
    Family(FamilySpec),
    /// The user's own halves.
    Own(OwnSpec),
}

/// The user's own halves.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct OwnSpec {
    /// z of the face centre in the frame of each half that faces +z, in D; `None`: derived from first
    /// contact.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub face_height: Option<f64>,
    /// Frames in which the halves are drawn.
    #[serde(default, skip_serializing_if = "DrawnFrames::is_facing")]
    pub drawn: DrawnFrames,
    /// Source of D.
    #[serde(default, skip_serializing_if = "WidthFrom::is_written")]
    pub width_from: WidthFrom,
    /// If true, the mated pose is the rest that the halves reach when released as drawn.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub settle: bool,
    /// The fixed half.
    pub fixed: HalfSpec,
    /// The moving half.
    pub moving: HalfSpec,
    /// Placement of the fixed half.
    #[serde(default, skip_serializing_if = "PartPlacement::is_none")]
    pub fixed_placement: PartPlacement,
    /// Placement of the moving half.
    #[serde(default, skip_serializing_if = "PartPlacement::is_none")]
    pub moving_placement: PartPlacement,
}

/// Source of D.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum WidthFrom {
    /// Stated in the design, or 1 because the design is dimensionless.
    #[default]
    Written,
    /// The larger lateral extent of the facets that can touch.
    Touching,
    /// The smallest value that the size of the parts permits; the region that can touch is smaller.
    Size,
}

impl WidthFrom {
    #[expect(clippy::trivially_copy_pass_by_ref, reason = "as serde calls it")]
    fn is_written(&self) -> bool {
        *self == Self::Written
    }
}

impl OwnSpec {
    /// Two halves drawn facing +z, their face centres on the z axis at `face_height`.
    pub const fn new(face_height: f64, fixed: HalfSpec, moving: HalfSpec) -> Self {
        let (drawn, none) = (DrawnFrames::Facing, PartPlacement::NONE);
        let face_height = Some(face_height);
        Self {
            face_height,
            drawn,
            width_from: WidthFrom::Written,
            settle: false,
            fixed,
            moving,
            fixed_placement: none,
            moving_placement: none,
        }
    }

    /// Whether the face centre is still to be determined.
    pub const fn is_face_unknown(&self) -> bool {
        match self.drawn {
            DrawnFrames::Facing => self.face_height.is_none(),
            DrawnFrames::Assembled { .. } => true,
        }
    }
}

/// A half of the user's own.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum HalfSpec {
    /// Convex pieces, each a list of vertices, in D.
    Pieces(Vec<Vec<[f64; 3]>>),
    /// A closed triangle mesh in a file.
    Mesh(FileSpec),
    /// Parts with individual positions; their union is the half.
    Parts(Vec<PartSpec>),
    /// Triangles that a program passed in memory, in D. The design stores their description, not the
    /// triangles.
    Memory {
        /// Description of the triangles.
        content: MeshContent,
    },
}

impl HalfSpec {
    /// The files that it comes from, in order.
    pub(super) fn files_mut(&mut self) -> Vec<&mut FileSpec> {
        match self {
            Self::Mesh(file) => vec![file],
            Self::Parts(parts) => parts.iter_mut().filter_map(|part| part.shape.file_mut()).collect(),
            Self::Pieces(_) | Self::Memory { .. } => Vec::new(),
        }
    }
}
