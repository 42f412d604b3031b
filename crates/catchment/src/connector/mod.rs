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
mod own;
mod problem;
pub mod stl;
mod surface;
mod ungendered;

pub use hull::{HullError, MAX_POINTS, convex_hull};
pub use problem::{Problem, Side};
pub use surface::{Edge, Facet, Surface, SurfaceError};

use crate::design::{ConnectorSpec, Design};
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

/// The two halves, in the frames the contact room works in.
#[derive(Debug, Clone, PartialEq)]
pub struct Connector {
    /// The fixed half in the world frame (origin at its face centre).
    pub fixed: Half,
    /// The moving half, mounted, origin at its face centre.
    pub moving: Half,
}

impl Connector {
    /// Builds the halves of a design and places them in the frames of the contact room.
    ///
    /// # Errors
    /// Everything that is wrong with the geometry, each with its place.
    pub fn build(design: &Design) -> Result<Self, Vec<Problem>> {
        let drawn = match &design.connector {
            ConnectorSpec::Family(spec) => family::draw(spec)?,
            ConnectorSpec::Own(spec) => own::build(spec)?,
        };
        Ok(Self::placed(&drawn, design.alignment.mount))
    }

    /// Moves both face centres to the origin and mounts the moving half.
    fn placed(drawn: &family::Drawn, mount: Mount) -> Self {
        let face = DVec3::new(0.0, 0.0, drawn.face_height);
        Self {
            fixed: drawn.fixed.mapped(|p| p - face),
            moving: drawn.moving.mapped(|p| mount.apply(p - face)),
        }
    }
}
