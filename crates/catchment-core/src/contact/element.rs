//! A pair of features of the two halves that can touch: a corner on a facet, a facet on a corner, or two
//! crossed edges.
//!
//! At a fixed rotation every element is a plane in the position c of the COR:
//!
//! ```text
//!   gap(c) = n·c + offset          > 0 apart, 0 touching          (n unit, from fixed to moving)
//!   z(x, y) = −(n_x x + n_y y + offset)/n_z                       its height of contact
//! ```
//!
//! It is valid while the foot of the contact lies on both features.

use super::Contact;
use super::shape::Shape;
use glam::{DMat3, DVec2, DVec3};

/// Which features meet; indices into the fixed and the moving shape.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Elements {
    /// Fixed facet under a moving corner.
    FacetCorner { facet: u32, vertex: u32 },
    /// Fixed corner under a moving facet.
    CornerFacet { vertex: u32, facet: u32 },
    /// Fixed edge under a moving edge, by their ends.
    EdgeEdge { fixed: [u32; 2], moving: [u32; 2] },
}

/// A pair of features that meet, by name: [`Pair::contact`](super::Pair::contact) evaluates the same pair at
/// another pose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Meeting {
    /// Index of the fixed and of the moving shape.
    pub(super) shapes: [u32; 2],
    pub(super) features: Elements,
}

impl Meeting {
    /// The contact of the two features, regardless of their borders, with the COR at `c` and the moving half
    /// at `rotation`; edges keep the orientation of `before`, and its normal if they have become parallel.
    pub(super) fn at(
        &self,
        before: &Contact,
        fixed: &Shape,
        moving: &Shape,
        rotation: &DMat3,
        c: DVec3,
    ) -> Contact {
        match self.features {
            Elements::FacetCorner { facet, vertex } => {
                let normal = before.normal;
                let point = c + *rotation * moving.at(vertex);
                let gap = normal.dot(point) - fixed.levels[facet as usize];
                Contact { gap, normal, point: point - normal * gap }
            }
            Elements::CornerFacet { vertex, facet } => {
                let facet = facet as usize;
                let normal = *rotation * -moving.facets[facet].normal;
                let point = fixed.at(vertex);
                let gap = normal.dot(c - point) - moving.levels[facet];
                Contact { gap, normal, point }
            }
            Elements::EdgeEdge { fixed: [a, b], moving: [p, q] } => {
                let (a, p) = (fixed.at(a), c + *rotation * moving.at(p));
                let (u, w) = (fixed.at(b) - a, c + *rotation * moving.at(q) - p);
                let across = u.cross(w);
                let normal = across
                    .try_normalize()
                    .map_or(before.normal, |n| if n.dot(before.normal) < 0.0 { -n } else { n });
                let along = (p - a).cross(w).dot(across) / across.length_squared();
                let along = if along.is_finite() { along } else { 0.0 };
                Contact { gap: normal.dot(p - a), normal, point: a + u * along }
            }
        }
    }
}

/// A possible contact at a given rotation.
#[derive(Debug, Clone, Copy)]
pub(super) struct Element {
    pub(super) meeting: Meeting,
    /// Unit normal, from fixed to moving.
    pub(super) normal: DVec3,
    /// `gap = normal·c + offset`.
    pub(super) offset: f64,
}

impl Element {
    /// Distance along the normal with the COR at `c`; negative when the halves overlap.
    pub(super) fn gap(&self, c: DVec3) -> f64 {
        self.normal.dot(c) + self.offset
    }

    /// z of the COR at contact. Only for elements that face up.
    pub(super) fn height(&self, lateral: DVec2) -> f64 {
        -(self.normal.truncate().dot(lateral) + self.offset) / self.normal.z
    }

    /// The point of the fixed half at which this element touches (or would, across its gap) with the COR at
    /// `c` and the moving half at `rotation`; `None` if the foot misses a feature by more than `seam`.
    pub(super) fn foot(
        &self,
        fixed: &Shape,
        moving: &Shape,
        rotation: &DMat3,
        c: DVec3,
        seam: f64,
    ) -> Option<DVec3> {
        match self.meeting.features {
            Elements::FacetCorner { facet, vertex } => {
                let point = c + *rotation * moving.at(vertex);
                let foot = point - self.normal * self.gap(c);
                on_facet(fixed, facet, foot, seam).then_some(foot)
            }
            Elements::CornerFacet { vertex, facet } => {
                let foot = fixed.at(vertex);
                // Seen from the COR, across the gap.
                let seen = foot + self.normal * self.gap(c) - c;
                on_facet(moving, facet, rotation.transpose() * seen, seam).then_some(foot)
            }
            Elements::EdgeEdge { fixed: [a, b], moving: [p, q] } => {
                let (a, p) = (fixed.at(a), *rotation * moving.at(p));
                let (u, w) = (fixed.at(b) - a, *rotation * moving.at(q) - p);
                let across = u.cross(w);
                let d = c + p - a;
                let scale = 1.0 / across.length_squared();
                let s = d.cross(w).dot(across) * scale;
                let t = d.cross(u).dot(across) * scale;
                let on = |k: f64, edge: DVec3| {
                    let beyond = (k - 1.0).max(-k);
                    beyond <= 0.0 || beyond * beyond * edge.length_squared() <= seam * seam
                };
                (on(s, u) && on(t, w)).then(|| a + u * s)
            }
        }
    }

    /// The contact point with the COR at `c`, for an element known to touch: affine in c; `turned` are the
    /// moving vertices at the element's rotation.
    pub(super) fn touch(&self, fixed: &Shape, turned: &[DVec3], c: DVec3) -> DVec3 {
        match self.meeting.features {
            Elements::FacetCorner { vertex, .. } => c + turned[vertex as usize],
            Elements::CornerFacet { vertex, .. } => fixed.at(vertex),
            Elements::EdgeEdge { fixed: [a, b], moving: [p, q] } => {
                let (a, p) = (fixed.at(a), turned[p as usize]);
                let (u, w) = (fixed.at(b) - a, turned[q as usize] - p);
                let across = u.cross(w);
                a + u * ((c + p - a).cross(w).dot(across) / across.length_squared())
            }
        }
    }

    /// The lateral COR positions for which the element is valid, as the corners of a convex polygon; `turned` are the
    /// moving vertices at the element's rotation.
    pub(super) fn footprint(&self, fixed: &Shape, moving: &Shape, turned: &[DVec3], out: &mut Vec<DVec2>) {
        out.clear();
        let turned = |k: u32| turned[k as usize];
        match self.meeting.features {
            Elements::FacetCorner { facet, vertex } => {
                let v = turned(vertex);
                let facet = &fixed.facets[facet as usize];
                out.extend(facet.corners.iter().map(|&k| (fixed.at(k) - v).truncate()));
            }
            Elements::CornerFacet { vertex, facet } => {
                let v = fixed.at(vertex);
                let facet = &moving.facets[facet as usize];
                out.extend(facet.corners.iter().map(|&k| (v - turned(k)).truncate()));
            }
            Elements::EdgeEdge { fixed: f, moving: m } => {
                let [a, b] = f.map(|k| fixed.at(k).truncate());
                let [p, q] = m.map(|k| turned(k).truncate());
                out.extend([a - p, b - p, b - q, a - q]);
            }
        }
    }
}

/// Whether a point of a facet's plane lies on the facet, within the seam.
fn on_facet(shape: &Shape, facet: u32, point: DVec3, seam: f64) -> bool {
    let facet = &shape.facets[facet as usize];
    let n = facet.corners.len();
    let mut a = shape.at(facet.corners[n - 1]);
    facet.corners.iter().all(|&k| {
        let b = shape.at(k);
        let along = b - a;
        let left = facet.normal.dot(along.cross(point - a));
        let inside = left >= 0.0 || left * left <= seam * seam * along.length_squared();
        a = b;
        inside
    })
}
