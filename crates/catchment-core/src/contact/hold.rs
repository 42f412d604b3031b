//! Distance of a contact from the border of its features, at which it would end.
//!
//! ```text
//!       foot                       support
//!    ┌───────────┐                   ↑ n
//!    │      ×←d─→│              ─────×─────       a corner or an edge is supported while its spokes s
//!    └───────────┘                  ╱ ╲           stay on one side of the plane across n:
//!    d: distance to the border     ╱   ╲ s        −n·s of the closest spoke
//! ```
//!
//! Both pass continuously through zero at the end of the contact, so the instant of its end follows by
//! interpolation.

use super::element::{Elements, Meeting};
use super::shape::Shape;
use super::{Contact, Pair};
use glam::{DMat3, DVec3};

/// Distance of a contact from its end; negative beyond.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Hold {
    /// Distance of the foot from the border of the features, in D.
    pub(crate) foot: f64,
    /// Sine of the angle by which the features support the normal.
    pub(crate) support: f64,
}

impl Pair {
    /// The hold of the two features of `meeting` on `contact`, their contact with the COR at `position` and
    /// the moving half at `rotation`.
    pub(crate) fn hold(
        &self,
        contact: &Contact,
        meeting: &Meeting,
        rotation: &DMat3,
        position: DVec3,
    ) -> Hold {
        let [f, m] = meeting.shapes.map(|s| s as usize);
        let (fixed, moving) = (&self.fixed_shapes[f], &self.moving_shapes[m]);
        let back = rotation.transpose();
        let n = contact.normal;
        // The same contact as the moving half sees it.
        let seen = back * (contact.point + n * contact.gap - position);
        match meeting.features {
            Elements::FacetCorner { facet, vertex } => Hold {
                foot: inside(fixed, facet, contact.point),
                support: supported(moving, vertex, back * n),
            },
            Elements::CornerFacet { vertex, facet } => {
                Hold { foot: inside(moving, facet, seen), support: supported(fixed, vertex, -n) }
            }
            Elements::EdgeEdge { fixed: f, moving: m } => {
                let foot = between(fixed, f, contact.point).min(between(moving, m, seen));
                let support = spread(fixed, f, -n).min(spread(moving, m, back * n));
                Hold { foot, support }
            }
        }
    }
}

/// Distance of a point of a facet's plane from the facet's border; negative outside.
pub(super) fn inside(shape: &Shape, facet: u32, point: DVec3) -> f64 {
    let normal = shape.facets[facet as usize].normal;
    let mut least = f64::INFINITY;
    for side in shape.sides_of(facet) {
        least = least.min(normal.dot(side.along.cross(point - side.from)));
    }
    least
}

/// Distance of a point of an edge's line from the nearer end; negative beyond.
fn between(shape: &Shape, ends: [u32; 2], point: DVec3) -> f64 {
    let [a, b] = ends.map(|k| shape.at(k));
    let along = (b - a).normalize_or_zero();
    (point - a).dot(along).min((b - point).dot(along))
}

/// Smallest sine by which the neighbours of a corner lie along `toward`.
fn supported(shape: &Shape, vertex: u32, toward: DVec3) -> f64 {
    // Corners are in the order of their vertices.
    shape.corners.binary_search_by_key(&vertex, |c| c.vertex).map_or(f64::INFINITY, |k| {
        let corner = &shape.corners[k];
        let spokes = &shape.spokes[corner.spokes.start as usize..corner.spokes.end as usize];
        spokes.iter().map(|s| toward.dot(*s)).fold(f64::INFINITY, f64::min)
    })
}

/// Smaller sine by which the two facets beside an edge lie along `toward`.
fn spread(shape: &Shape, ends: [u32; 2], toward: DVec3) -> f64 {
    // Ridges are in the order of their ends, as the edges of a surface.
    shape.ridges.binary_search_by_key(&ends, |r| r.ends).map_or(f64::INFINITY, |k| {
        let ridge = &shape.ridges[k];
        let [left, right] = ridge.normals;
        toward.dot(left.cross(ridge.along)).min(toward.dot(ridge.along.cross(right)))
    })
}
