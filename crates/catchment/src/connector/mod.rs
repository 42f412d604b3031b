//! The two halves as solids: closed surfaces, ready to touch.
//!
//! ```text
//! Design ──▶ Connector { fixed: Half, moving: Half }      lengths in D
//!                        │            └ mounted: turned face down, origin at its own face centre
//!                        └ the world frame: origin at its face centre, facing +z
//! ```
//!
//! A [`Half`] is a list of closed [`Surface`]s whose union is the solid. Surfaces may touch or overlap (convex
//! pieces that make up a notch); a contact on a wall between two of them is not a contact of the solid, and
//! the contact room discards it.

mod family;
mod hull;
pub mod mesh;
mod problem;
mod round;
mod source;
pub mod stl;
mod surface;
mod ungendered;

pub use hull::{HullError, MAX_POINTS, convex_hull};
pub use mesh::MeshProblem;
pub use problem::{Problem, Side};
pub use source::{FileBytes, Read, Source};
pub use surface::{Edge, Facet, Surface, SurfaceError};

use crate::design::{ConnectorSpec, Contents, Design, FamilySpec, MeshContent};
use crate::pose::Mount;
use glam::DVec3;

/// One half of a connector: the union of closed surfaces.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Half {
    /// Closed surfaces, outward normals.
    pub surfaces: Vec<Surface>,
}

impl Half {
    /// The same half with every vertex moved by `map`, which must be rigid and orientation preserving.
    #[must_use]
    pub fn mapped(&self, map: impl Fn(DVec3) -> DVec3 + Copy) -> Self {
        Self { surfaces: self.surfaces.iter().map(|s| s.mapped(map)).collect() }
    }
}

/// A half and what its mesh held, or everything that is wrong with it.
type Sourced = Result<(Half, Option<MeshContent>), Vec<Problem>>;

/// The two halves, in the frames the contact room works in.
#[derive(Debug, Clone, PartialEq)]
pub struct Connector {
    /// The fixed half in the world frame (origin at its face centre).
    pub fixed: Half,
    /// The moving half, mounted, origin at its face centre.
    pub moving: Half,
    /// What the meshes held that the halves were built from.
    pub contents: Contents,
}

impl Connector {
    /// Two halves that already are in these frames.
    pub const fn from_halves(fixed: Half, moving: Half) -> Self {
        Self { fixed, moving, contents: Contents { fixed: None, moving: None } }
    }

    /// Builds the halves of a design, mesh files read from disk, and places them in the frames of the contact room.
    ///
    /// # Errors
    /// Everything that is wrong with the geometry, each with its place.
    pub fn build(design: &Design) -> Result<Self, Vec<Problem>> {
        Self::build_with(design, &source::disk::read)
    }

    /// Builds the halves of a design; `read` gives the mesh files.
    ///
    /// # Errors
    /// Everything that is wrong with the geometry, each with its place.
    pub fn build_with(design: &Design, read: Read<'_>) -> Result<Self, Vec<Problem>> {
        let mount = design.alignment.mount;
        match &design.connector {
            ConnectorSpec::Family(spec) => Self::of_family(spec, mount),
            ConnectorSpec::Own(own) => {
                let half =
                    |spec, side| Source::of(spec, side, read).map_err(|problem| vec![problem])?.build(side);
                Self::of_own(
                    [half(&own.fixed, Side::Fixed), half(&own.moving, Side::Moving)],
                    own.face_height,
                    mount,
                )
            }
        }
    }

    /// The halves of a family.
    ///
    /// # Errors
    /// Every parameter that makes no solid.
    pub fn of_family(spec: &FamilySpec, mount: Mount) -> Result<Self, Vec<Problem>> {
        Ok(Self::placed(&family::draw(spec)?, mount))
    }

    /// Builds two halves that face +z as drawn; `face_height` is the z of both face centres, in D. No file is touched.
    ///
    /// # Errors
    /// Everything that is wrong with either.
    pub fn from_sources(
        fixed: &Source,
        moving: &Source,
        face_height: f64,
        mount: Mount,
    ) -> Result<Self, Vec<Problem>> {
        Self::of_own([fixed.build(Side::Fixed), moving.build(Side::Moving)], face_height, mount)
    }

    fn of_own([fixed, moving]: [Sourced; 2], face_height: f64, mount: Mount) -> Result<Self, Vec<Problem>> {
        match (fixed, moving) {
            (Ok((fixed, of_fixed)), Ok((moving, of_moving))) => {
                let contents = Contents { fixed: of_fixed, moving: of_moving };
                let drawn = family::Drawn { fixed, moving, face_height };
                Ok(Self { contents, ..Self::placed(&drawn, mount) })
            }
            (fixed, moving) => Err([fixed, moving].into_iter().filter_map(Result::err).flatten().collect()),
        }
    }

    /// Moves both face centres to the origin and mounts the moving half.
    fn placed(drawn: &family::Drawn, mount: Mount) -> Self {
        let face = DVec3::new(0.0, 0.0, drawn.face_height);
        Self::from_halves(drawn.fixed.mapped(|p| p - face), drawn.moving.mapped(|p| mount.apply(p - face)))
    }
}
