//! A closed polygonal surface with outward normals: the only geometry type of the program.
//!
//! Facets are convex planar polygons; every edge stores its two facets and whether the solid is convex there.
//! Only convex edges and their corners can be first contacts with another solid, so the contact module uses
//! nothing else.

use catchment_base::tolerance;
use glam::DVec3;

/// A convex planar polygon of a closed surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Facet {
    /// Corners, counter-clockwise seen from outside: indices into [`Surface::vertices`].
    pub corners: Vec<u32>,
    /// Outward unit normal.
    pub normal: DVec3,
}

/// An edge between two facets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Edge {
    /// The two ends: indices into [`Surface::vertices`].
    pub ends: [u32; 2],
    /// The two facets it separates: indices into [`Surface::facets`].
    pub facets: [u32; 2],
}

/// A closed surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    /// Corners, in D.
    pub vertices: Vec<DVec3>,
    /// Facets, outward.
    pub facets: Vec<Facet>,
    /// Only the *convex* edges: flat and reflex edges are never first contacts. In the order of their ends.
    pub edges: Vec<Edge>,
    /// Whether the whole solid is convex.
    pub convex: bool,
}

/// Why polygons do not make a closed surface.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SurfaceError {
    /// A facet has no area.
    #[error("facet {facet} has no area")]
    ZeroArea {
        /// Index of the facet.
        facet: usize,
    },
    /// An edge has only one facet, or two facets run along it in the same direction.
    #[error("the surface is open along the edge from {from} to {to}")]
    Open {
        /// Start of the edge, in D.
        from: DVec3,
        /// The other end, in D.
        to: DVec3,
    },
    /// More than two facets meet along an edge.
    #[error("more than two facets meet along the edge from {from} to {to}")]
    NonManifold {
        /// Start of the edge, in D.
        from: DVec3,
        /// The other end, in D.
        to: DVec3,
    },
    /// The surface encloses no volume or is turned inside out.
    #[error("the surface is turned inside out (its volume is {volume:.3e} D³)")]
    InsideOut {
        /// Signed volume, in D³.
        volume: f64,
    },
}

/// Sine of the dihedral angle below which two facets count as coplanar: far above the rounding of a
/// single-precision STL file (1e-7), far below any designed chamfer.
const FLAT_SINE: f64 = tolerance::SINGLE;

impl Surface {
    /// Builds a closed surface from convex planar polygons, counter-clockwise seen from outside.
    ///
    /// # Errors
    /// The first reason why the polygons do not bound a solid.
    pub fn from_polygons(vertices: Vec<DVec3>, polygons: &[Vec<u32>]) -> Result<Self, SurfaceError> {
        use std::collections::BTreeMap;
        let at = |i: u32| vertices[i as usize];
        let mut facets = Vec::with_capacity(polygons.len());
        let mut volume = 0.0;
        for (facet, corners) in polygons.iter().enumerate() {
            let origin = at(corners[0]);
            let area: DVec3 = corners.windows(2).map(|w| (at(w[0]) - origin).cross(at(w[1]) - origin)).sum();
            let Some(normal) = area.try_normalize() else { return Err(SurfaceError::ZeroArea { facet }) };
            volume += origin.dot(area) / 6.0;
            facets.push(Facet { corners: corners.clone(), normal });
        }
        // Directed edges: each must occur once, with its reverse occurring once in another facet.
        let mut directed: BTreeMap<(u32, u32), u32> = BTreeMap::new();
        for (f, facet) in facets.iter().enumerate() {
            let n = facet.corners.len();
            for k in 0..n {
                let (a, b) = (facet.corners[k], facet.corners[(k + 1) % n]);
                if directed.insert((a, b), f as u32).is_some() {
                    return Err(SurfaceError::NonManifold { from: at(a), to: at(b) });
                }
            }
        }
        let mut edges = Vec::new();
        let mut convex = true;
        for (&(a, b), &left) in &directed {
            let Some(&right) = directed.get(&(b, a)) else {
                return Err(SurfaceError::Open { from: at(a), to: at(b) });
            };
            if a > b {
                continue;
            }
            // Convex if the two normals spread apart: their cross product runs along the edge of the left
            // facet.
            let (nl, nr) = (facets[left as usize].normal, facets[right as usize].normal);
            let along = (at(b) - at(a)).normalize_or_zero();
            let sine = nl.cross(nr).dot(along);
            if sine > FLAT_SINE || (sine.abs() <= FLAT_SINE && nl.dot(nr) < 0.0) {
                edges.push(Edge { ends: [a, b], facets: [left, right] });
            } else if sine < -FLAT_SINE {
                convex = false;
            }
        }
        if volume <= 0.0 {
            return Err(SurfaceError::InsideOut { volume });
        }
        Ok(Self { vertices, facets, edges, convex })
    }

    /// The same surface with every vertex moved by `map`, which must be rigid and orientation preserving.
    #[must_use]
    pub fn mapped(&self, map: impl Fn(DVec3) -> DVec3) -> Self {
        let origin = map(DVec3::ZERO);
        Self {
            vertices: self.vertices.iter().map(|v| map(*v)).collect(),
            facets: self
                .facets
                .iter()
                .map(|f| Facet { corners: f.corners.clone(), normal: map(f.normal) - origin })
                .collect(),
            edges: self.edges.clone(),
            convex: self.convex,
        }
    }

    /// The mirror image by `map`, a reflection: the inside stays inside.
    #[must_use]
    pub(crate) fn reflected(&self, map: impl Fn(DVec3) -> DVec3) -> Self {
        let mut image = self.mapped(map);
        image.facets.iter_mut().for_each(|facet| facet.corners.reverse());
        image.edges.iter_mut().for_each(|edge| edge.facets.reverse());
        image
    }

    /// The axis-aligned box around the surface: lowest and highest corner.
    pub fn bounds(&self) -> (DVec3, DVec3) {
        self.vertices
            .iter()
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), v| (lo.min(*v), hi.max(*v)))
    }

    /// The facets as triangles of corner numbers, counter-clockwise seen from outside; no triangle is flat,
    /// even if corners of a facet are collinear.
    pub fn triangles(&self) -> Vec<[u32; 3]> {
        let mut triangles = Vec::new();
        for facet in &self.facets {
            let mut rest = facet.corners.clone();
            while rest.len() > 3 {
                let n = rest.len();
                let at = |k: u32| self.vertices[k as usize];
                let area = |corners: &[u32]| {
                    corners
                        .windows(2)
                        .map(|w| (at(w[0]) - at(corners[0])).cross(at(w[1]) - at(corners[0])))
                        .sum::<DVec3>()
                        .length()
                };
                let ear = |k: usize| [rest[(k + n - 1) % n], rest[k], rest[(k + 1) % n]];
                let whole = area(&rest);
                // Neither the ear nor the remainder may be flat.
                let worth = |k: usize| {
                    let cut = area(&ear(k));
                    cut.min(whole - cut)
                };
                let best = (0..n).max_by(|&a, &b| worth(a).total_cmp(&worth(b))).unwrap_or(0);
                triangles.push(ear(best));
                rest.remove(best);
            }
            triangles.push([rest[0], rest[1], rest[2]]);
        }
        triangles
    }

    /// Distance of a point from the surface, in D.
    pub fn distance(&self, point: DVec3) -> f64 {
        let at = |i: u32| self.vertices[i as usize];
        let from = |facet: &Facet| {
            let n = facet.corners.len();
            let sides = || (0..n).map(|k| [at(facet.corners[k]), at(facet.corners[(k + 1) % n])]);
            if sides().all(|[a, b]| facet.normal.dot((b - a).cross(point - a)) >= 0.0) {
                return facet.normal.dot(point - at(facet.corners[0])).abs();
            }
            let beside = |[a, b]: [DVec3; 2]| {
                let share = (point - a).dot(b - a) / (b - a).length_squared();
                point.distance(a.lerp(b, share.clamp(0.0, 1.0)))
            };
            sides().map(beside).fold(f64::INFINITY, f64::min)
        };
        self.facets.iter().map(from).fold(f64::INFINITY, f64::min)
    }

    /// Enclosed volume, in D³.
    pub fn volume(&self) -> f64 {
        let at = |i: u32| self.vertices[i as usize];
        self.facets
            .iter()
            .map(|f| {
                let origin = at(f.corners[0]);
                f.corners.windows(2).map(|w| origin.dot(at(w[0]).cross(at(w[1])))).sum::<f64>() / 6.0
            })
            .sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A box [0,1]³ as six squares.
    fn cube() -> (Vec<DVec3>, Vec<Vec<u32>>) {
        let vertices = (0..8u32)
            .map(|i| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)))
            .collect();
        let polygons = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        (vertices, polygons.iter().map(|p| p.to_vec()).collect())
    }

    #[test]
    fn a_cube_is_closed_convex_and_has_twelve_edges() {
        let (v, p) = cube();
        let cube = Surface::from_polygons(v, &p).unwrap();
        assert!(cube.convex);
        assert_eq!(cube.edges.len(), 12);
        assert!((cube.volume() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn a_missing_face_leaves_the_surface_open() {
        let (v, mut p) = cube();
        p.pop();
        assert!(matches!(Surface::from_polygons(v, &p), Err(SurfaceError::Open { .. })));
    }

    #[test]
    fn inside_out_is_distinguished_from_open() {
        let (v, mut p) = cube();
        for polygon in &mut p {
            polygon.reverse();
        }
        assert!(matches!(Surface::from_polygons(v, &p), Err(SurfaceError::InsideOut { .. })));
    }
}
