//! A surface prepared for contact: the features that can touch, and the directions in which they support.
//!
//! A first contact needs a locally convex solid: a corner, a convex edge, a facet. A feature *supports* a
//! contact normal n (from the fixed to the moving half) if the solid lies locally on one side of the plane
//! through it with normal n:
//!
//! ```text
//!   corner v   n·(w − v) ≤ 0 for every neighbour w
//!   edge       n·s ≤ 0 for the two directions s that lead from it into its facets
//! ```
//!
//! This holds for the fixed half; for the moving half with ≥. All other contacts are dominated by a supported
//! contact.

use super::candidates::FLUSH;
use super::plan::{Plan, PlanTree};
use crate::connector::{Facet, Surface};
use glam::DVec3;
use std::ops::Range;

/// A corner that may touch.
#[derive(Debug, Clone)]
pub(super) struct Corner {
    /// Index into the vertices.
    pub(super) vertex: u32,
    /// Which of [`Shape::spokes`] lead from it.
    pub(super) spokes: Range<u32>,
}

/// A convex edge.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ridge {
    /// Its two ends.
    pub(super) ends: [u32; 2],
    /// Unit vector from its first end to its second.
    pub(super) along: DVec3,
    /// Outward normals of the facets to its left and right, seen from outside.
    pub(super) normals: [DVec3; 2],
}

/// A side of a facet, which lies to its left.
#[derive(Debug, Clone, Copy)]
pub(super) struct FacetSide {
    pub(super) from: DVec3,
    /// Unit vector.
    pub(super) along: DVec3,
}

/// A feature that is touched against all of its facets, by more than this cosine, is touched from inside.
pub(super) const INSIDE: f64 = 0.5;

/// Plan views of all features of a shape.
#[derive(Debug, Clone)]
pub(super) struct Plans {
    pub(super) facets: PlanTree,
    pub(super) corners: PlanTree,
    pub(super) ridges: PlanTree,
}

/// The heights that a feature reaches over.
#[derive(Debug, Clone, Copy)]
pub(super) struct Span {
    low: f64,
    high: f64,
}

impl Span {
    pub(super) fn of(points: impl Iterator<Item = DVec3>) -> Self {
        let nowhere = Self { low: f64::INFINITY, high: f64::NEG_INFINITY };
        points.fold(nowhere, |span, p| Self { low: span.low.min(p.z), high: span.high.max(p.z) })
    }

    /// Larger by `by` on both sides.
    pub(super) const fn widened(self, by: f64) -> Self {
        Self { low: self.low - by, high: self.high + by }
    }

    /// Whether the two have a height in common.
    pub(super) const fn meets(&self, other: &Self) -> bool {
        self.low <= other.high && self.high >= other.low
    }
}

/// A surface with its touching features.
#[derive(Debug, Clone)]
pub(super) struct Shape {
    pub(super) vertices: Vec<DVec3>,
    pub(super) facets: Vec<Facet>,
    /// `normal·p` for the points p of each facet.
    pub(super) levels: Vec<f64>,
    /// Heights of all facets together, and of each.
    pub(super) span: Span,
    pub(super) spans: Vec<Span>,
    /// The sides of all facets, one facet after the other, and the start of each facet.
    sides: Vec<FacetSide>,
    first_sides: Vec<u32>,
    pub(super) corners: Vec<Corner>,
    /// Unit vectors from the corners to their neighbours along edges.
    pub(super) spokes: Vec<DVec3>,
    /// Outward normals of the facets that the spokes border on.
    pub(super) normals: Vec<DVec3>,
    pub(super) ridges: Vec<Ridge>,
    pub(super) plans: Plans,
}

impl Shape {
    pub(super) fn new(surface: &Surface) -> Self {
        let at = |i: u32| surface.vertices[i as usize];
        let mut neighbors = vec![Vec::new(); surface.vertices.len()];
        for facet in &surface.facets {
            let n = facet.corners.len();
            for k in 0..n {
                // Each edge is met once in each direction, so every neighbour is entered exactly once.
                neighbors[facet.corners[k] as usize].push((facet.corners[(k + 1) % n], facet.normal));
            }
        }
        let mut pointed = vec![false; surface.vertices.len()];
        let mut ridges = Vec::with_capacity(surface.edges.len());
        for edge in &surface.edges {
            let [a, b] = edge.ends;
            let along = (at(b) - at(a)).normalize_or_zero();
            let normals = edge.facets.map(|f| surface.facets[f as usize].normal);
            ridges.push(Ridge { ends: edge.ends, along, normals });
            pointed[a as usize] = true;
            pointed[b as usize] = true;
        }
        let mut corners = Vec::new();
        let (mut spokes, mut normals) = (Vec::new(), Vec::new());
        for (v, neighbors) in neighbors.iter().enumerate().filter(|(v, _)| pointed[*v]) {
            let first = spokes.len() as u32;
            let from = surface.vertices[v];
            spokes.extend(neighbors.iter().map(|(w, _)| (at(*w) - from).normalize_or_zero()));
            normals.extend(neighbors.iter().map(|(_, normal)| normal));
            corners.push(Corner { vertex: v as u32, spokes: first..spokes.len() as u32 });
        }
        let (mut sides, mut first_sides) = (Vec::new(), vec![0]);
        for facet in &surface.facets {
            let corners = facet.corners.iter().map(|k| at(*k));
            let next = corners.clone().cycle().skip(1);
            sides.extend(
                corners
                    .zip(next)
                    .map(|(from, to)| FacetSide { from, along: (to - from).normalize_or_zero() }),
            );
            first_sides.push(sides.len() as u32);
        }
        let around = |ids: &[u32]| Plan::around(ids.iter().map(|&k| at(k).truncate()));
        let plans = Plans {
            facets: PlanTree::over(surface.facets.iter().map(|f| around(&f.corners))),
            corners: PlanTree::over(corners.iter().map(|c: &Corner| around(&[c.vertex]))),
            ridges: PlanTree::over(ridges.iter().map(|s: &Ridge| around(&s.ends))),
        };
        Self {
            vertices: surface.vertices.clone(),
            levels: surface.facets.iter().map(|f| f.normal.dot(at(f.corners[0]))).collect(),
            span: Span::of(surface.vertices.iter().copied()),
            spans: surface.facets.iter().map(|f| Span::of(f.corners.iter().map(|&k| at(k)))).collect(),
            facets: surface.facets.clone(),
            sides,
            first_sides,
            corners,
            spokes,
            normals,
            ridges,
            plans,
        }
    }

    /// Whether a corner is locally extreme against `toward`: no neighbour lies further along −`toward`, up to
    /// the sine `slack`. Within it a corner that is nearly flat would touch from inside, too, which is not meant.
    pub(super) fn supports(&self, corner: &Corner, toward: DVec3, slack: f64) -> bool {
        // All are compared: which spoke is the first to lie further along is a guess that a processor mostly loses.
        self.spokes_of(corner).iter().filter(|s| toward.dot(**s) < -slack).count() == 0
            && (slack <= FLUSH || self.normals_of(corner).iter().any(|n| toward.dot(*n) < INSIDE))
    }

    /// The sides of a facet, in the order of its corners.
    pub(super) fn sides_of(&self, facet: u32) -> &[FacetSide] {
        let [first, end] = [0, 1].map(|k| self.first_sides[facet as usize + k] as usize);
        &self.sides[first..end]
    }

    /// Unit vectors from a corner to its neighbours.
    pub(super) fn spokes_of(&self, corner: &Corner) -> &[DVec3] {
        &self.spokes[corner.spokes.start as usize..corner.spokes.end as usize]
    }

    /// Outward normals of the facets around a corner.
    pub(super) fn normals_of(&self, corner: &Corner) -> &[DVec3] {
        &self.normals[corner.spokes.start as usize..corner.spokes.end as usize]
    }

    pub(super) fn at(&self, vertex: u32) -> DVec3 {
        self.vertices[vertex as usize]
    }
}
