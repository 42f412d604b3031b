//! What of the two halves can touch first, listed plainly: corners, facets, convex edges.
//!
//! ```text
//!   facet ╲   ╱ facet        corner    its spokes lead to its neighbours
//!          ╲ ╱               ridge     a convex edge with the normals of its two facets
//!           ● corner
//! ```
//!
//! Made from the surfaces alone, not from the prepared shapes of [`crate::contact`]: its bounds judge that room, and are judged by it.
//! Lengths in D, in each half's own frame (the moving one's from the centre of rotation).

use crate::connector::Half;
use glam::DVec3;

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
    /// The two sides of every facet around it: where they lead, unit, and the outward normal of the facet.
    pub(super) sides: Vec<[DVec3; 2]>,
    /// Which ridges end here.
    pub(super) ridges: Vec<u32>,
}

/// A convex edge.
#[derive(Debug, Clone)]
pub(super) struct Ridge {
    pub(super) ends: [u32; 2],
    /// Unit vector from the first end to the second.
    pub(super) along: DVec3,
    /// Outward normals of the facets to its left and right, seen from outside.
    pub(super) normals: [DVec3; 2],
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
            for facet in &surface.facets {
                let n = facet.corners.len();
                for k in 0..n {
                    let (a, b) = (facet.corners[k], facet.corners[(k + 1) % n]);
                    let along = (at(b) - at(a)).normalize_or_zero();
                    spokes[a as usize].push(along);
                    sides[a as usize].push([along, facet.normal]);
                    sides[b as usize].push([-along, facet.normal]);
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

/// Two features that may meet, by their numbers in the fixed and the moving body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Meeting {
    /// A fixed facet under a moving corner.
    FacetCorner(u32, u32),
    /// A fixed corner under a moving facet.
    CornerFacet(u32, u32),
    /// A fixed ridge under a moving one.
    RidgeRidge(u32, u32),
}

/// Every meeting of two bodies of which the upper does not lie upside down for certain.
pub(super) fn meetings(fixed: &Body, moving: &Body) -> Vec<Meeting> {
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
    all
}
