//! A surface prepared for contact: what can touch, and in which directions it supports.
//!
//! Something touches first only where its solid is locally convex: a corner, a convex edge, a facet. A contact
//! normal n (pointing from the fixed to the moving half) is *supported* by a feature when the solid lies
//! locally on one side of the plane through it with normal n:
//!
//! ```text
//!   corner v   n·(w − v) ≤ 0 for every neighbour w
//!   edge       n·s ≤ 0 for the two directions s that lead from it into its facets
//! ```
//!
//! (for the fixed half; ≥ for the moving one). All other contacts are dominated by a supported one.

use crate::connector::{Facet, Surface};
use glam::{DMat3, DVec2, DVec3};
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
pub(super) struct Side {
    /// Its two ends.
    pub(super) ends: [u32; 2],
    /// Its two facets.
    pub(super) facets: [u32; 2],
    /// Unit vector from its first end to its second.
    pub(super) along: DVec3,
    /// Unit vectors from the edge into its two facets, perpendicular to it.
    pub(super) into: [DVec3; 2],
}

/// Bounds of a feature in plan view.
#[derive(Debug, Clone, Copy)]
pub(super) struct Plan {
    pub(super) low: DVec2,
    pub(super) high: DVec2,
}

impl Plan {
    fn around(points: impl Iterator<Item = DVec3>) -> Self {
        let nothing = Self { low: DVec2::INFINITY, high: DVec2::NEG_INFINITY };
        points.map(DVec3::truncate).fold(nothing, |b, p| Self { low: b.low.min(p), high: b.high.max(p) })
    }

    /// Whether the other, moved by `by`, comes within `reach`.
    pub(super) fn meets(&self, other: &Self, by: DVec2, reach: f64) -> bool {
        other.low.x + by.x <= self.high.x + reach
            && other.high.x + by.x + reach >= self.low.x
            && other.low.y + by.y <= self.high.y + reach
            && other.high.y + by.y + reach >= self.low.y
    }
}

/// Plan views of all features of a shape.
#[derive(Debug, Clone, Default)]
pub(super) struct Plans {
    pub(super) facets: Vec<Plan>,
    pub(super) corners: Vec<Plan>,
    pub(super) sides: Vec<Plan>,
}

/// A surface with its touching features.
#[derive(Debug, Clone)]
pub(super) struct Shape {
    pub(super) vertices: Vec<DVec3>,
    pub(super) facets: Vec<Facet>,
    pub(super) corners: Vec<Corner>,
    /// Unit vectors from the corners to their neighbours along edges.
    pub(super) spokes: Vec<DVec3>,
    pub(super) sides: Vec<Side>,
    pub(super) convex: bool,
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
                neighbors[facet.corners[k] as usize].push(facet.corners[(k + 1) % n]);
            }
        }
        let mut pointed = vec![false; surface.vertices.len()];
        let mut sides = Vec::with_capacity(surface.edges.len());
        for edge in &surface.edges {
            let [a, b] = edge.ends;
            let along = (at(b) - at(a)).normalize_or_zero();
            // Counter-clockwise seen from outside, the inside of a facet lies to the left of its edges.
            let left = surface.facets[edge.facets[0] as usize].normal.cross(along);
            let right = along.cross(surface.facets[edge.facets[1] as usize].normal);
            sides.push(Side { ends: edge.ends, facets: edge.facets, along, into: [left, right] });
            pointed[a as usize] = true;
            pointed[b as usize] = true;
        }
        let mut corners = Vec::new();
        let mut spokes = Vec::new();
        for (v, neighbors) in neighbors.iter().enumerate().filter(|(v, _)| pointed[*v]) {
            let first = spokes.len() as u32;
            let from = surface.vertices[v];
            spokes.extend(neighbors.iter().map(|&w| (at(w) - from).normalize_or_zero()));
            corners.push(Corner { vertex: v as u32, spokes: first..spokes.len() as u32 });
        }
        let mut shape = Self {
            vertices: surface.vertices.clone(),
            facets: surface.facets.clone(),
            corners,
            spokes,
            sides,
            convex: surface.convex,
            plans: Plans::default(),
        };
        shape.draw_plans();
        shape
    }

    /// Brings the plan views up to date.
    pub(super) fn draw_plans(&mut self) {
        let mut plans = std::mem::take(&mut self.plans);
        let around = |ids: &[u32]| Plan::around(ids.iter().map(|&k| self.at(k)));
        plans.facets.clear();
        plans.facets.extend(self.facets.iter().map(|f| around(&f.corners)));
        plans.corners.clear();
        plans.corners.extend(self.corners.iter().map(|c| around(&[c.vertex])));
        plans.sides.clear();
        plans.sides.extend(self.sides.iter().map(|s| around(&s.ends)));
        self.plans = plans;
    }

    /// Turns the shape about its origin, writing into `out` (same topology) without allocating.
    pub(super) fn rotate_into(&self, rotation: &DMat3, out: &mut Self) {
        for (o, v) in out.vertices.iter_mut().zip(&self.vertices) {
            *o = *rotation * *v;
        }
        for (o, f) in out.facets.iter_mut().zip(&self.facets) {
            o.normal = *rotation * f.normal;
        }
        for (o, s) in out.sides.iter_mut().zip(&self.sides) {
            o.along = *rotation * s.along;
            o.into = [*rotation * s.into[0], *rotation * s.into[1]];
        }
        for (o, s) in out.spokes.iter_mut().zip(&self.spokes) {
            *o = *rotation * *s;
        }
    }

    /// Whether a corner is locally extreme against `toward`: no neighbour lies further along −`toward`, up to
    /// the sine `slack`.
    pub(super) fn supports(&self, corner: &Corner, toward: DVec3, slack: f64) -> bool {
        let spokes = &self.spokes[corner.spokes.start as usize..corner.spokes.end as usize];
        spokes.iter().all(|s| toward.dot(*s) >= -slack)
    }

    /// Whether an edge of this shape, moved by `seen` into the other's frame, passes through a facet of the other.
    pub(super) fn pierces(&self, other: &Self, seen: impl Fn(DVec3) -> DVec3) -> bool {
        /// What counts as through rather than touching, in D.
        const THROUGH: f64 = 1e-6;
        self.facets.iter().any(|own| {
            let n = own.corners.len();
            (0..n).any(|k| {
                let (a, b) = (own.corners[k], own.corners[(k + 1) % n]);
                // Every edge is met once in each direction.
                if a > b {
                    return false;
                }
                let (a, b) = (seen(self.at(a)), seen(self.at(b)));
                other.facets.iter().any(|facet| {
                    let origin = other.at(facet.corners[0]);
                    let (above, below) = (facet.normal.dot(a - origin), facet.normal.dot(b - origin));
                    if above.min(below) > -THROUGH || above.max(below) < THROUGH {
                        return false;
                    }
                    let point = a + (b - a) * (above / (above - below));
                    let m = facet.corners.len();
                    (0..m).all(|k| {
                        let (p, q) = (other.at(facet.corners[k]), other.at(facet.corners[(k + 1) % m]));
                        let along = (q - p).normalize_or_zero();
                        facet.normal.dot(along.cross(point - p)) > THROUGH
                    })
                })
            })
        })
    }

    pub(super) fn at(&self, vertex: u32) -> DVec3 {
        self.vertices[vertex as usize]
    }

    /// Whether a point lies strictly inside a convex shape, by more than `margin`.
    pub(super) fn contains(&self, point: DVec3, margin: f64) -> bool {
        self.convex && self.facets.iter().all(|f| f.normal.dot(point - self.at(f.corners[0])) < -margin)
    }

    /// Largest z-component of a normal that this side supports, over its two facets.
    pub(super) fn steepest(&self, side: &Side) -> (f64, f64) {
        let [a, b] = side.facets.map(|f| self.facets[f as usize].normal.z);
        (a.min(b), a.max(b))
    }
}
