//! The features of the two halves that can be first contacts, as plain lists: corners, facets, convex edges.
//!
//! ```text
//!   facet ╲   ╱ facet        corner    its spokes lead to its neighbours
//!          ╲ ╱               ridge     a convex edge with the normals of its two facets
//!           ● corner
//! ```
//!
//! Built from the surfaces alone, not from the prepared shapes of [`crate::contact`], so that the two check
//! each other. Lengths in D, in each half's own frame (that of the moving half from the centre of rotation).

use crate::connector::Half;
use crate::tolerance;
use glam::DVec3;
use std::collections::BTreeSet;

/// A convex planar polygon.
#[derive(Debug, Clone)]
pub(super) struct Facet {
    pub(super) corners: Vec<u32>,
    pub(super) normal: DVec3,
}

/// A corner at which convex edges meet.
#[derive(Debug, Clone)]
pub(super) struct Corner {
    pub(super) vertex: u32,
    /// Unit vectors to all of its neighbours.
    pub(super) spokes: Vec<DVec3>,
    /// The two sides of every facet around it.
    pub(super) sides: Vec<Side>,
    /// Which ridges end here.
    pub(super) ridges: Vec<u32>,
}

/// A side of a facet at a corner.
#[derive(Debug, Clone, Copy)]
pub(super) struct Side {
    /// Its direction, unit.
    pub(super) along: DVec3,
    /// Outward normal of the facet.
    pub(super) normal: DVec3,
    pub(super) facet: u32,
}

/// A convex edge.
#[derive(Debug, Clone)]
pub(super) struct Ridge {
    pub(super) ends: [u32; 2],
    /// Unit vector from the first end to the second.
    pub(super) along: DVec3,
    /// Outward normals of the facets to its left and right, seen from outside.
    pub(super) normals: [DVec3; 2],
    /// Their numbers.
    pub(super) facets: [u32; 2],
}

/// Everything of a half.
#[derive(Debug, Clone, Default)]
pub(super) struct Body {
    pub(super) vertices: Vec<DVec3>,
    pub(super) facets: Vec<Facet>,
    pub(super) corners: Vec<Corner>,
    pub(super) ridges: Vec<Ridge>,
}

impl Body {
    /// The features of all surfaces of a half.
    pub(super) fn of(half: &Half) -> Self {
        let mut body = Self::default();
        for surface in &half.surfaces {
            let first = body.vertices.len() as u32;
            let at = |k: u32| surface.vertices[k as usize];
            let mut spokes = vec![Vec::new(); surface.vertices.len()];
            let mut sides = vec![Vec::new(); surface.vertices.len()];
            let first_facet = body.facets.len() as u32;
            for facet in &surface.facets {
                let number = body.facets.len() as u32;
                let n = facet.corners.len();
                for k in 0..n {
                    let (a, b) = (facet.corners[k], facet.corners[(k + 1) % n]);
                    let along = (at(b) - at(a)).normalize_or_zero();
                    spokes[a as usize].push(along);
                    let mut side = |end: u32, along: DVec3| {
                        sides[end as usize].push(Side { along, normal: facet.normal, facet: number });
                    };
                    side(a, along);
                    side(b, -along);
                }
                let corners = facet.corners.iter().map(|k| first + k).collect();
                body.facets.push(Facet { corners, normal: facet.normal });
            }
            let mut ridges = vec![Vec::new(); surface.vertices.len()];
            for edge in &surface.edges {
                let number = body.ridges.len() as u32;
                edge.ends.iter().for_each(|end| ridges[*end as usize].push(number));
                body.ridges.push(Ridge {
                    ends: edge.ends.map(|end| first + end),
                    along: (at(edge.ends[1]) - at(edge.ends[0])).normalize_or_zero(),
                    normals: edge.facets.map(|f| surface.facets[f as usize].normal),
                    facets: edge.facets.map(|f| first_facet + f),
                });
            }
            for (vertex, ((spokes, sides), ridges)) in spokes.into_iter().zip(sides).zip(ridges).enumerate() {
                if !ridges.is_empty() {
                    body.corners.push(Corner { vertex: first + vertex as u32, spokes, sides, ridges });
                }
            }
            body.vertices.extend(&surface.vertices);
        }
        body
    }

    pub(super) fn at(&self, vertex: u32) -> DVec3 {
        self.vertices[vertex as usize]
    }
}

impl Body {
    /// Whether no facet faces up (1) or down (−1) except those of a single flat back.
    pub(super) fn is_over_flat_back(&self, side: f64) -> bool {
        let level = |vertex: u32| side * self.at(vertex).z;
        let back = (0..self.vertices.len() as u32).map(level).fold(f64::NEG_INFINITY, f64::max);
        let mut facets = self.facets.iter().filter(|facet| side * facet.normal.z > SEAM);
        facets.all(|facet| facet.corners.iter().all(|corner| level(*corner) >= back - SEAM))
    }

    /// Whether all corners of a ridge are those of a facet.
    pub(super) fn has_side(&self, facet: u32, ridge: u32) -> bool {
        self.ridges[ridge as usize].ends.iter().all(|end| self.has_corner(facet, *end))
    }

    /// Whether a vertex is a corner of a facet.
    pub(super) fn has_corner(&self, facet: u32, vertex: u32) -> bool {
        self.facets[facet as usize].corners.contains(&vertex)
    }
}

/// Two features that may meet, by their numbers in the fixed and the moving body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Meeting {
    /// A fixed facet under a moving corner.
    FacetCorner(u32, u32),
    /// A fixed corner under a moving facet.
    CornerFacet(u32, u32),
    /// A fixed ridge under a moving ridge.
    RidgeRidge(u32, u32),
}

/// Every possible meeting of features of two bodies, except for features that certainly face away; each
/// occurs once if both bodies move only in the x–z plane (`planar`).
pub(super) fn meetings(fixed: &Body, moving: &Body, planar: bool) -> Vec<Meeting> {
    let count = |list: usize| 0..list as u32;
    let up = |k: &u32| fixed.facets[*k as usize].normal.z > 0.0;
    let facets = count(fixed.facets.len()).filter(up);
    let of = |f, number: usize, of: fn(u32, u32) -> Meeting| count(number).map(move |m| of(f, m));
    let mut all: Vec<Meeting> =
        facets.flat_map(|f| of(f, moving.corners.len(), Meeting::FacetCorner)).collect();
    all.extend(count(fixed.corners.len()).flat_map(|f| of(f, moving.facets.len(), Meeting::CornerFacet)));
    let open = |k: &u32| fixed.ridges[*k as usize].normals.iter().any(|n| n.z > 0.0);
    let ridges = count(fixed.ridges.len()).filter(open);
    all.extend(ridges.flat_map(|f| of(f, moving.ridges.len(), Meeting::RidgeRidge)));
    if planar {
        let mut seen = BTreeSet::new();
        all.retain(|meeting| match *meeting {
            Meeting::FacetCorner(f, m) => {
                is_first(fixed, f, moving, m, &mut |x, z| seen.insert((0, f, x, z)))
            }
            Meeting::CornerFacet(f, m) => {
                is_first(moving, m, fixed, f, &mut |x, z| seen.insert((1, m, x, z)))
            }
            Meeting::RidgeRidge(f, m) => !(ends_on(fixed, f, moving, m) || ends_on(moving, m, fixed, f)),
        });
    }
    all
}

/// Whether a corner that moves in the x–z plane may touch a facet, and is the first at its place in that plane to do so.
fn is_first(
    body: &Body,
    facet: u32,
    other: &Body,
    corner: u32,
    is_new: &mut dyn FnMut(u64, u64) -> bool,
) -> bool {
    let facet = &body.facets[facet as usize];
    let at = other.at(other.corners[corner as usize].vertex);
    let sides = facet.corners.iter().map(|k| body.at(*k).y);
    let (near, far) = sides.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), y| (a.min(y), b.max(y)));
    // An oblique facet differs at each y, so no corner is a duplicate there.
    let oblique = facet.normal.y != 0.0;
    near - SEAM <= at.y && at.y <= far + SEAM && (oblique || is_new(at.x.to_bits(), at.z.to_bits()))
}

/// Whether a ridge along y meets a ridge across y in the x–z plane with its end: that corner lies on the
/// facet of the other, which has the same normal.
fn ends_on(body: &Body, along: u32, other: &Body, across: u32) -> bool {
    let (along, across) = (&body.ridges[along as usize], &other.ridges[across as usize]);
    let level = |ridge: &Ridge, body: &Body| ridge.ends.map(|end| body.at(end).y);
    let ([a, b], [c, d]) = (level(along, body), level(across, other));
    let is_along = along.along.x == 0.0 && along.along.z == 0.0;
    is_along && c == d && (c == a || c == b) && across.normals.iter().any(|n| n.y == 0.0)
}

/// Largest distance that counts as on a facet, as a multiple of lengths.
const SEAM: f64 = tolerance::ROUNDING;
