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

mod surface;

pub use surface::{Edge, Facet, Surface, SurfaceError};

/// One half of a connector: the union of closed surfaces.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Half {
    /// Closed surfaces, outward normals.
    pub surfaces: Vec<Surface>,
}

impl Half {
    /// The same half with every vertex moved by `map`, which must be rigid and orientation preserving.
    #[must_use]
    pub fn mapped(&self, map: impl Fn(glam::DVec3) -> glam::DVec3 + Copy) -> Self {
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
