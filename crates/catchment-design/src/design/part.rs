//! The parts of a half, each with its position.
//!
//! ```text
//!        z, turned to `axis`
//!        ▲                      sphere: about the origin
//!     ┌──┴──┐                   cylinder, cone, box, extruded profile: standing on it
//!     │     │                   mesh, pieces: in their own coordinates
//!     └──┬──┘
//!       at = the origin of the part in its half
//! ```
//!
//! The half is the union of its parts, which may overlap. Lengths in D, angles in radians.

use super::model::LengthUnit;
use super::{MeshContent, MeshPreparation};
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// A file of geometry, and the conversion of its coordinates to D.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FileSpec {
    /// The file, absolute or relative to the working directory.
    pub path: PathBuf,
    /// Factor from the file's coordinates to D; for [`FileUnit::InFile`] from metres to D.
    pub scale: f64,
    /// Source of the file's unit.
    #[serde(default, skip_serializing_if = "FileUnit::is_beside")]
    pub unit: FileUnit,
    /// The unit that the design states beside the file, for messages.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub written: Option<LengthUnit>,
    /// Permitted changes to a mesh before use.
    #[serde(default, skip_serializing_if = "MeshPreparation::is_default")]
    pub treatment: MeshPreparation,
    /// Content of the file, once it was read.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub content: Option<MeshContent>,
}

impl FileSpec {
    /// A file whose coordinates times `scale` are D, whatever unit it states.
    pub fn new(path: impl Into<PathBuf>, scale: f64) -> Self {
        Self {
            path: path.into(),
            scale,
            unit: FileUnit::Beside,
            written: None,
            treatment: MeshPreparation::DEFAULT,
            content: None,
        }
    }

    /// Whether files of this type may state their unit.
    pub fn may_state_unit(&self) -> bool {
        const SAY: [&str; 5] = ["3mf", "step", "stp", "svg", "dxf"];
        SAY.contains(&self.ending().as_str())
    }

    /// Whether it is called a STEP file.
    pub fn is_step(&self) -> bool {
        ["step", "stp"].contains(&self.ending().as_str())
    }

    /// How its name ends, in lower case.
    pub fn ending(&self) -> String {
        self.path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default()
    }
}

/// Source of the unit of a file's coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum FileUnit {
    /// Only the scale: the file does not state a unit, or the design is dimensionless.
    #[default]
    Beside,
    /// The design states it; a file that states another unit is rejected.
    Stated(LengthUnit),
    /// The file states it.
    InFile,
}

impl FileUnit {
    #[expect(clippy::trivially_copy_pass_by_ref, reason = "as serde calls it")]
    fn is_beside(&self) -> bool {
        *self == Self::Beside
    }
}

/// A part of a half.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PartSpec {
    /// Shape of the part.
    pub shape: ShapeSpec,
    /// Unit vector to which the part's z axis is rotated, by the shortest rotation; about x for −z.
    pub axis: [f64; 3],
    /// Rotations about x, then y, then z, applied after `axis`, in radians.
    pub rotate: [f64; 3],
    /// Position of its origin.
    pub at: [f64; 3],
}

impl PartSpec {
    /// Default largest distance between a round surface and its facets, in D.
    pub const CHORD_ERROR: f64 = 0.001;

    /// A shape with its origin at a place, upright.
    pub const fn new(shape: ShapeSpec, at: [f64; 3]) -> Self {
        Self { shape, axis: [0.0, 0.0, 1.0], rotate: [0.0; 3], at }
    }
}

/// Shape of a part.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum ShapeSpec {
    /// A closed triangle mesh.
    Mesh(FileSpec),
    /// Convex pieces, each a list of vertices.
    Pieces(Vec<Vec<[f64; 3]>>),
    /// A ball about the origin.
    Sphere {
        /// Its radius.
        radius: f64,
        /// Largest distance of the surface to its facets, which lie inside.
        chord_error: f64,
    },
    /// A cone or truncated cone that stands on the origin; a cylinder if both radii are equal.
    Cone {
        /// Radius of its base.
        radius: f64,
        /// Radius of its top; 0 for an apex.
        top_radius: f64,
        /// Its height.
        height: f64,
        /// Largest distance of the surface to its facets, which lie inside.
        chord_error: f64,
    },
    /// A box that stands on the origin, the centre of its base.
    Box {
        /// Size along x, y and z.
        size: [f64; 3],
    },
    /// Outlines extruded from z = 0.
    Profile {
        /// The outlines.
        outline: OutlineSpec,
        /// Length of the extrusion.
        height: f64,
        /// Largest distance of a curve to its chords.
        chord_error: f64,
    },
}

/// Outlines of a profile, in the x-y plane.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum OutlineSpec {
    /// The corners of a single polygon, in order.
    Corners(Vec<[f64; 2]>),
    /// The closed outlines of an SVG or DXF file; a point inside an odd number of outlines is solid.
    File(FileSpec),
}

impl ShapeSpec {
    /// Its file, if it comes from a file.
    pub const fn file(&self) -> Option<&FileSpec> {
        match self {
            Self::Mesh(file) | Self::Profile { outline: OutlineSpec::File(file), .. } => Some(file),
            _ => None,
        }
    }

    pub(super) const fn file_mut(&mut self) -> Option<&mut FileSpec> {
        match self {
            Self::Mesh(file) | Self::Profile { outline: OutlineSpec::File(file), .. } => Some(file),
            _ => None,
        }
    }

    /// Largest distance between its round surfaces and their facets; `None` without round surfaces.
    pub const fn chord_error(&self) -> Option<f64> {
        match self {
            Self::Sphere { chord_error, .. }
            | Self::Cone { chord_error, .. }
            | Self::Profile { outline: OutlineSpec::File(_), chord_error, .. } => Some(*chord_error),
            _ => None,
        }
    }
}
