//! The features of a half that a designer would change: faces, edges and corners in the sense of a designer,
//! not of a mesh.
//!
//! ```text
//!   face     facets that meet at less than 30°                           the wall of a hole, a ball, a floor cut into triangles
//!   edge     convex edges, end to end, between the same two faces        the rim of a hole
//!   corner   ends of different edges, and points without edges           the tip of a cone
//! ```
//!
//! A contact is between two features, one of each half. It is described by the largest features that touch
//! there: flush surfaces touch face on face even if corners carry them, and an edge that lies on a face is
//! not described as a pair of corners.
//!
//! Features belong to the same class if a rotation or reflection of their half about the approach axis maps
//! them onto each other.
//!
//! Not promised: round surfaces meshed with twelve sides or fewer are not recognised; they count as corners
//! and edges. Lengths in D, angles in radians.

use super::element::Elements;
use super::{Contact, Meeting, Pair};
use crate::connector::{Half, HalfRole, Surface};
use crate::disjoint::DisjointSets;
use crate::tolerance;
use glam::{DMat3, DVec3};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::FRAC_PI_2;

mod classes;
pub(crate) use classes::Symmetries;

/// Cosine of 30°: facets that meet at less belong to one face. A round of thirteen sides is one face, a
/// chamfer of 45° is another.
const BEND: f64 = 0.866;
/// Cosine of 60°: facets around a corner that spread wider make it a point, even if no two neighbours meet at
/// an edge.
const POINTED: f64 = 0.5;
/// Sine of half a degree: features within this angle of a plane lie in it. Motions come to rest far closer.
const IN_PLANE: f64 = 0.009;
/// Inclinations that differ by less are equal, radians: 2°.
const EVEN: f64 = 0.035;
/// Heights that differ by less are equal, in D.
const LEVEL: f64 = tolerance::SINGLE;

/// Kind of a feature.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum FeatureKind {
    /// Part of the surface without an edge inside it.
    Face,
    /// Convex intersection of two faces.
    Edge,
    /// A point.
    Corner,
}

impl FeatureKind {
    /// The lower-case name used in reports.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Face => "face",
            Self::Edge => "edge",
            Self::Corner => "corner",
        }
    }
}

/// How a face lies, seen on its own half that faces up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FaceOrientation {
    /// Least angle between an outward normal and the way the half faces, in [0, π].
    pub least: f64,
    /// Greatest.
    pub most: f64,
    /// Whether it is a flat at the very top of its half.
    pub is_top: bool,
}

/// A face, an edge or a corner of a half.
#[derive(Debug, Clone, PartialEq)]
pub struct Feature {
    /// Kind of the feature.
    pub kind: FeatureKind,
    /// The number of its surface in the half.
    pub surface: usize,
    /// How the faces lie that it is, or that meet in it.
    pub faces: Vec<FaceOrientation>,
}

impl FaceOrientation {
    /// `top`, `flat`, `wall`, `slope of 45°`, `rounded surface`.
    pub fn name(&self) -> String {
        if self.most <= EVEN / 2.0 {
            if self.is_top { "top" } else { "flat" }.to_owned()
        } else if self.least >= FRAC_PI_2 - EVEN / 2.0 && self.most <= FRAC_PI_2 + EVEN / 2.0 {
            "wall".to_owned()
        } else if self.least > FRAC_PI_2 + EVEN / 2.0 {
            "underside".to_owned()
        } else if self.most - self.least <= EVEN {
            format!("slope of {:.0}°", f64::midpoint(self.least, self.most).to_degrees())
        } else {
            "rounded surface".to_owned()
        }
    }
}

impl Feature {
    /// The feature in words: `wall`, `edge between top and wall`, `corner of slopes of 45°`.
    pub fn name(&self) -> String {
        // The flattest first, whichever way the mesh goes round.
        let mut faces = self.faces.clone();
        faces.sort_by(|a, b| a.least.total_cmp(&b.least).then(a.most.total_cmp(&b.most)));
        let mut names: Vec<String> = Vec::new();
        for name in faces.iter().map(FaceOrientation::name) {
            if !names.contains(&name) {
                names.push(name);
            }
        }
        match (self.kind, names.as_slice()) {
            (FeatureKind::Face, [name, ..]) => name.clone(),
            (FeatureKind::Edge, [one]) => format!("edge between two {}", plural(one)),
            (FeatureKind::Edge, [one, other, ..]) => format!("edge between {one} and {other}"),
            (FeatureKind::Corner, [one]) => format!("corner of {}", plural(one)),
            (FeatureKind::Corner, [others @ .., last]) => {
                format!("corner of {} and {last}", others.join(", "))
            }
            (kind, []) => kind.name().to_owned(),
        }
    }
}

/// Several of a kind: `walls`, `slopes of 45°`.
fn plural(name: &str) -> String {
    name.strip_prefix("slope of ").map_or_else(|| format!("{name}s"), |rest| format!("slopes of {rest}"))
}

/// The features of a pair.
#[derive(Debug, Clone)]
pub struct Features {
    halves: [Anatomy; 2],
}

/// The features of a half.
#[derive(Debug, Clone)]
struct Anatomy {
    features: Vec<Feature>,
    classes: Vec<u32>,
    turns: Symmetries,
    surfaces: Vec<Lookup>,
}

/// Which feature the elements of a surface belong to.
#[derive(Debug, Clone)]
struct Lookup {
    vertices: Vec<DVec3>,
    /// Outward normals of the facets.
    normals: Vec<DVec3>,
    /// Of every facet.
    faces: Vec<u32>,
    /// Of every edge at which faces meet, by its ends in order, with its two facets.
    edges: BTreeMap<(u32, u32), (u32, [u32; 2])>,
    /// Of every corner.
    corners: BTreeMap<u32, u32>,
    /// The facets around every vertex.
    around: Vec<Vec<u32>>,
    /// The edges at a vertex: the other end, and the feature.
    spokes: BTreeMap<u32, Vec<(u32, u32)>>,
}

/// An element of a surface that touches.
#[derive(Debug, Clone, Copy)]
enum Touching {
    Facet(u32),
    Edge([u32; 2]),
    Vertex(u32),
}

const fn index(side: HalfRole) -> usize {
    match side {
        HalfRole::Fixed => 0,
        HalfRole::Moving => 1,
    }
}

impl Features {
    /// The features of the two halves of a pair.
    pub fn of(pair: &Pair) -> Self {
        Self { halves: [Anatomy::of(&pair.fixed, DVec3::Z), Anatomy::of(&pair.moving, DVec3::NEG_Z)] }
    }

    /// A feature by its number.
    ///
    /// # Panics
    /// When the half has no such feature.
    pub fn get(&self, side: HalfRole, number: u32) -> &Feature {
        &self.halves[index(side)].features[number as usize]
    }

    /// The class of a feature: the least number of those that symmetries of its half map onto it.
    ///
    /// # Panics
    /// When the half has no such feature.
    pub fn class(&self, side: HalfRole, number: u32) -> u32 {
        self.halves[index(side)].classes[number as usize]
    }

    /// The turns and reflections about the approach axis that map a half onto itself.
    pub(crate) fn turns(&self, side: HalfRole) -> &Symmetries {
        &self.halves[index(side)].turns
    }

    /// The numbers of the two features, of the fixed and of the moving half, that meet in a contact at a rotation.
    pub fn meeting(&self, contact: &Contact, meeting: &Meeting, rotation: &DMat3) -> [u32; 2] {
        let (fixed, moving) = match meeting.features {
            Elements::FacetCorner { facet, vertex } => (Touching::Facet(facet), Touching::Vertex(vertex)),
            Elements::CornerFacet { vertex, facet } => (Touching::Vertex(vertex), Touching::Facet(facet)),
            Elements::EdgeEdge { fixed, moving } => (Touching::Edge(fixed), Touching::Edge(moving)),
        };
        let seen = rotation.transpose() * -contact.normal;
        let [first, second] = meeting.shapes.map(|shape| shape as usize);
        [self.halves[0].touched(first, fixed, contact.normal), self.halves[1].touched(second, moving, seen)]
    }
}

impl Anatomy {
    fn of(half: &Half, facing: DVec3) -> Self {
        let vertices = half.surfaces.iter().flat_map(|surface| &surface.vertices);
        let top = vertices.map(|v| v.dot(facing)).fold(f64::NEG_INFINITY, f64::max);
        let (mut features, mut surfaces) = (Vec::new(), Vec::new());
        for (number, surface) in half.surfaces.iter().enumerate() {
            surfaces.push(Lookup::of(surface, number, facing, top, &mut features));
        }
        let turns = Symmetries::of(half);
        let classes = classes::of(half, &surfaces, features.len(), &turns);
        Self { features, classes, turns, surfaces }
    }

    /// The largest feature of a surface that touches along the outward direction `normal` at an element.
    fn touched(&self, surface: usize, element: Touching, normal: DVec3) -> u32 {
        let lookup = &self.surfaces[surface];
        let flush = |facet: &u32| lookup.is_flush(*facet, normal);
        match element {
            Touching::Facet(facet) => lookup.faces[facet as usize],
            Touching::Edge([a, b]) => {
                let both = |v: u32| lookup.around[v as usize].iter();
                let shared = both(a).filter(|facet| both(b).any(|other| other == *facet));
                let result = shared.clone().find(|facet| flush(facet)).map(|f| lookup.faces[*f as usize]);
                let edge = lookup.edges.get(&(a.min(b), a.max(b))).map(|(feature, _)| *feature);
                let seam = || shared.clone().next().map(|facet| lookup.faces[*facet as usize]);
                result.or(edge).or_else(seam).unwrap_or_default()
            }
            Touching::Vertex(v) => {
                let around = &lookup.around[v as usize];
                let face = |facet: &u32| lookup.faces[*facet as usize];
                let spokes = lookup.spokes.get(&v).map_or(&[][..], Vec::as_slice);
                let along = |(other, _): &&(u32, u32)| lookup.lies_in(v, *other, normal);
                let flush = around.iter().find(|facet| flush(facet)).map(face);
                let edge = || spokes.iter().find(along).map(|(_, feature)| *feature);
                let corner = || lookup.corners.get(&v).copied();
                let any_edge = || spokes.first().map(|(_, feature)| *feature);
                let seam = || around.first().map(face);
                flush.or_else(edge).or_else(corner).or_else(any_edge).or_else(seam).unwrap_or_default()
            }
        }
    }
}

impl Lookup {
    /// Finds the features of a surface, and adds them to those of its half.
    fn of(surface: &Surface, number: usize, facing: DVec3, top: f64, features: &mut Vec<Feature>) -> Self {
        let normals: Vec<DVec3> = surface.facets.iter().map(|facet| facet.normal).collect();
        let mut around = vec![Vec::new(); surface.vertices.len()];
        let mut sides: BTreeMap<(u32, u32), Vec<u32>> = BTreeMap::new();
        for (facet, corners) in (0u32..).zip(surface.facets.iter().map(|facet| &facet.corners)) {
            for (k, a) in corners.iter().enumerate() {
                let b = corners[(k + 1) % corners.len()];
                around[*a as usize].push(facet);
                sides.entry(((*a).min(b), (*a).max(b))).or_default().push(facet);
            }
        }
        let mut sets = DisjointSets::new(surface.facets.len());
        for facets in sides.values() {
            if let [f, g] = facets[..]
                && normals[f as usize].dot(normals[g as usize]) >= BEND
            {
                sets.join(f, g);
            }
        }
        let mut lookup = Self {
            vertices: surface.vertices.clone(),
            normals,
            faces: Vec::new(),
            edges: BTreeMap::new(),
            corners: BTreeMap::new(),
            around,
            spokes: BTreeMap::new(),
        };
        lookup.name_faces(surface, number, facing, top, &mut sets, features);
        lookup.name_edges(surface, number, features);
        lookup.name_corners(number, features);
        lookup
    }

    fn name_faces(
        &mut self,
        surface: &Surface,
        number: usize,
        facing: DVec3,
        top: f64,
        sets: &mut DisjointSets,
        features: &mut Vec<Feature>,
    ) {
        let mut numbers: BTreeMap<u32, u32> = BTreeMap::new();
        for (facet, normal) in (0u32..).zip(&self.normals) {
            let set = sets.find(facet);
            let feature = *numbers.entry(set).or_insert_with(|| {
                let none = FaceOrientation { least: f64::INFINITY, most: 0.0, is_top: true };
                features.push(Feature { kind: FeatureKind::Face, surface: number, faces: vec![none] });
                features.len() as u32 - 1
            });
            let lie = &mut features[feature as usize].faces[0];
            let inclination = normal.dot(facing).clamp(-1.0, 1.0).acos();
            (lie.least, lie.most) = (lie.least.min(inclination), lie.most.max(inclination));
            let corners = &surface.facets[facet as usize].corners;
            lie.is_top &= corners.iter().all(|v| self.vertices[*v as usize].dot(facing) >= top - LEVEL);
            self.faces.push(feature);
        }
    }

    fn name_edges(&mut self, surface: &Surface, number: usize, features: &mut Vec<Feature>) {
        // Edges between the same two faces that share an end are merged.
        let mut between: BTreeMap<[u32; 2], Vec<usize>> = BTreeMap::new();
        for (k, edge) in surface.edges.iter().enumerate() {
            let mut faces = edge.facets.map(|facet| self.faces[facet as usize]);
            faces.sort_unstable();
            if faces[0] != faces[1] {
                between.entry(faces).or_default().push(k);
            }
        }
        for (faces, edges) in between {
            let mut sets = DisjointSets::new(edges.len());
            let mut met: BTreeMap<u32, u32> = BTreeMap::new();
            for (k, edge) in (0u32..).zip(&edges) {
                for end in surface.edges[*edge].ends {
                    let first = *met.entry(end).or_insert(k);
                    sets.join(first, k);
                }
            }
            let mut numbers: BTreeMap<u32, u32> = BTreeMap::new();
            for (k, edge) in (0u32..).zip(&edges) {
                let feature = *numbers.entry(sets.find(k)).or_insert_with(|| {
                    let lies = faces.map(|face| features[face as usize].faces[0]).to_vec();
                    features.push(Feature { kind: FeatureKind::Edge, surface: number, faces: lies });
                    features.len() as u32 - 1
                });
                let [a, b] = surface.edges[*edge].ends;
                self.edges.insert((a.min(b), a.max(b)), (feature, surface.edges[*edge].facets));
                self.spokes.entry(a).or_default().push((b, feature));
                self.spokes.entry(b).or_default().push((a, feature));
            }
        }
    }

    fn name_corners(&mut self, number: usize, features: &mut Vec<Feature>) {
        for v in 0..self.vertices.len() as u32 {
            let around = &self.around[v as usize];
            let edges: BTreeSet<u32> =
                self.spokes.get(&v).into_iter().flatten().map(|(_, feature)| *feature).collect();
            let is_point = || {
                let apart =
                    |f: &u32, g: &u32| self.normals[*f as usize].dot(self.normals[*g as usize]) < POINTED;
                edges.is_empty() && around.iter().any(|f| around.iter().any(|g| apart(f, g)))
            };
            if edges.len() > 1 || is_point() {
                let faces: BTreeSet<u32> = around.iter().map(|facet| self.faces[*facet as usize]).collect();
                let lies = faces.iter().map(|face| features[*face as usize].faces[0]).collect();
                features.push(Feature { kind: FeatureKind::Corner, surface: number, faces: lies });
                self.corners.insert(v, features.len() as u32 - 1);
            }
        }
    }

    /// Whether a facet lies in the plane of a contact.
    fn is_flush(&self, facet: u32, normal: DVec3) -> bool {
        let own = self.normals[facet as usize];
        own.dot(normal) > 0.0 && own.cross(normal).length() <= IN_PLANE
    }

    /// Whether an edge lies in the plane of a contact at its first end.
    fn lies_in(&self, v: u32, other: u32, normal: DVec3) -> bool {
        let along = (self.vertices[other as usize] - self.vertices[v as usize]).normalize_or_zero();
        along.dot(normal).abs() <= IN_PLANE
    }
}

#[cfg(test)]
mod tests;
