//! Candidates: the features of the two halves that may touch, found once for a neighbourhood of poses and
//! tried at every pose in it.
//!
//! ```text
//!   all pairs of features ──sieve──▶ candidates ──try_at(R)──▶ elements at rotation R
//!                          (seldom)               (every step)
//! ```
//!
//! A pair passes the sieve if it could be an element at *some* rotation R' with chord |R' − R| ≤ `skin`. The chord
//! 2 sin(θ/2) bounds how far a unit vector moves, so each condition on directions is widened by it:
//!
//! ```text
//!   corner supports n     n·s ≥ −slack                for its spokes s     widened to  −(slack + skin)
//!   edges u × w support   (u × w)·s ≥ −slack·|u × w|  for its facets s     widened to  −(slack·(|u × w| + skin) + skin)
//!   facet faces up        n_z > lowest                                     widened to  lowest − skin
//! ```
//!
//! The owner must widen the window in plan view as well. Directions are compared in the frame that needs no
//! copy of a rotated shape; (u × w)·s reduces to ±w·n and ±u·n with the normals n of the facets beside the
//! edges.

use super::Pair;
use super::element::{Element, Elements, Meeting};
use super::plan::Plan;
use super::shape::{INSIDE, Ridge, Shape};
use crate::tolerance::{self, PARALLEL};
use glam::{DMat3, DVec2, DVec3};

/// Sine of the angle by which a feature may fail to support a normal and still count, at least: rounding.
pub(super) const ROUNDING: f64 = tolerance::PARALLEL;
/// The same for heights: above the angle by which coplanar facets may differ (1e-6), so that for flush halves
/// some feature always counts. Superfluous features lie above the other half, and do not raise any height.
pub(crate) const FLUSH: f64 = 4e-6;

/// Criteria of the sieve.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sieve {
    /// Sine of the angle by which a feature may fail to support a normal and still count.
    pub(super) slack: f64,
    /// Normals must have a z-component above this.
    pub(super) lowest: f64,
    /// Chord of the rotations for which the candidates hold.
    pub(super) skin: f64,
    /// Region in plan view; `None`: everywhere.
    pub(super) window: Option<Window>,
}

/// Which elements count at a rotation.
#[derive(Debug, Clone, Copy)]
pub(super) struct Counts {
    /// Sine of the angle by which a feature may fail to support a normal and still count.
    pub(super) slack: f64,
    /// Normals must have a z-component above this.
    pub(super) lowest: f64,
}

/// Position of the COR in plan view, and the distance at which features count as near.
#[derive(Debug, Clone, Copy)]
pub(super) struct Window {
    pub(super) lateral: DVec2,
    pub(super) reach: f64,
}

/// A feature of a fixed shape and a feature of a moving shape; indices into the corners, facets or ridges of
/// the shapes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Candidate {
    pub(super) shapes: [u32; 2],
    pub(super) fixed: u32,
    pub(super) moving: u32,
}

/// The pairs of features that passed a sieve.
#[derive(Debug, Clone, Default)]
pub(super) struct Candidates {
    facet_corner: Vec<Candidate>,
    corner_facet: Vec<Candidate>,
    edge_edge: Vec<Candidate>,
    scratch: Scratch,
}

/// A shape's features in the frame of the other half, kept to avoid allocations.
#[derive(Debug, Clone, Default)]
struct Scratch {
    vertices: Vec<DVec3>,
    /// Of the fixed facets, in the moving frame.
    normals: Vec<DVec3>,
    /// Of the fixed ridges, in the moving frame.
    along: Vec<DVec3>,
}

impl Candidates {
    /// Finds every pair that passes the sieve about `rotation`.
    pub(super) fn collect(&mut self, pair: &Pair, rotation: &DMat3, sieve: &Sieve) {
        let mut scratch = std::mem::take(&mut self.scratch);
        self.facet_corner.clear();
        self.corner_facet.clear();
        self.edge_edge.clear();
        for (m, moving) in pair.moving_shapes.iter().enumerate() {
            scratch.vertices.clear();
            scratch.vertices.extend(moving.vertices.iter().map(|v| *rotation * *v));
            for (f, fixed) in pair.fixed_shapes.iter().enumerate() {
                self.collect_pair([f as u32, m as u32], fixed, moving, rotation, sieve, &mut scratch);
            }
        }
        // In the order of the features, however the trees were walked.
        self.facet_corner.sort_unstable();
        self.corner_facet.sort_unstable();
        self.edge_edge.sort_unstable();
        self.scratch = scratch;
    }

    fn collect_pair(
        &mut self,
        shapes: [u32; 2],
        fixed: &Shape,
        moving: &Shape,
        rotation: &DMat3,
        sieve: &Sieve,
        scratch: &mut Scratch,
    ) {
        let Sieve { slack, lowest, skin, window } = *sieve;
        let back = rotation.transpose();
        let Scratch { vertices, normals, along } = scratch;
        let at = |k: u32| vertices[k as usize];
        // The window around a moving feature, as the tree of the fixed half sees it.
        let around = |ids: &[u32]| {
            window.map_or(Plan::EVERYWHERE, |w| {
                Plan::around(ids.iter().map(|&k| at(k).truncate() + w.lateral)).widened(w.reach)
            })
        };
        if !fixed.plans.facets.bounds().meets(&window.map_or(Plan::EVERYWHERE, |w| {
            Plan::around(vertices.iter().map(|v| v.truncate() + w.lateral)).widened(w.reach)
        })) {
            return;
        }
        normals.clear();
        normals.extend(fixed.facets.iter().map(|f| back * f.normal));
        along.clear();
        along.extend(fixed.ridges.iter().map(|s| back * s.along));
        for (c, corner) in moving.corners.iter().enumerate() {
            fixed.plans.facets.visit(&around(&[corner.vertex]), |facet| {
                if fixed.facets[facet as usize].normal.z > lowest
                    && moving.supports(corner, normals[facet as usize], slack + skin)
                {
                    self.facet_corner.push(Candidate { shapes, fixed: facet, moving: c as u32 });
                }
            });
        }
        // World z seen from the moving half.
        let up = back.z_axis;
        for (k, facet) in moving.facets.iter().enumerate().filter(|(_, m)| up.dot(m.normal) < skin - lowest) {
            let normal = *rotation * facet.normal;
            fixed.plans.corners.visit(&around(&facet.corners), |c| {
                if fixed.supports(&fixed.corners[c as usize], normal, slack + skin) {
                    self.corner_facet.push(Candidate { shapes, fixed: c, moving: k as u32 });
                }
            });
        }
        for (k, ridge) in moving.ridges.iter().enumerate() {
            if ridge.normals.iter().all(|n| up.dot(*n) >= skin - lowest) {
                continue;
            }
            let edges = EdgesAt { w: *rotation * ridge.along, moving: ridge };
            fixed.plans.ridges.visit(&around(&ridge.ends), |f| {
                let fixed = &fixed.ridges[f as usize];
                if fixed.normals.iter().any(|n| n.z > lowest)
                    && edges.may_touch(fixed, along[f as usize], slack, lowest, skin)
                {
                    self.edge_edge.push(Candidate { shapes, fixed: f, moving: k as u32 });
                }
            });
        }
    }

    /// The elements among the candidates at `rotation`.
    pub(super) fn try_at(
        &self,
        pair: &Pair,
        rotation: &DMat3,
        Counts { slack, lowest }: Counts,
        out: &mut Vec<Element>,
    ) {
        out.clear();
        let back = rotation.transpose();
        let of = |c: &Candidate| {
            (&pair.fixed_shapes[c.shapes[0] as usize], &pair.moving_shapes[c.shapes[1] as usize])
        };
        let mut last = None;
        let mut seen = DVec3::ZERO;
        for candidate in &self.facet_corner {
            let (fixed, moving) = of(candidate);
            if last != Some((candidate.shapes[0], candidate.fixed)) {
                last = Some((candidate.shapes[0], candidate.fixed));
                seen = back * fixed.facets[candidate.fixed as usize].normal;
            }
            out.extend(facet_corner(candidate, fixed, moving, seen, slack));
        }
        for candidate in &self.corner_facet {
            let (fixed, moving) = of(candidate);
            let normal = *rotation * moving.facets[candidate.moving as usize].normal;
            out.extend(corner_facet(candidate, fixed, moving, normal, slack, lowest));
        }
        last = None;
        for candidate in &self.edge_edge {
            let (fixed, moving) = of(candidate);
            if last != Some((candidate.shapes[0], candidate.fixed)) {
                last = Some((candidate.shapes[0], candidate.fixed));
                seen = back * fixed.ridges[candidate.fixed as usize].along;
            }
            out.extend(edge_edge(candidate, fixed, moving, rotation, seen, slack, lowest));
        }
    }
}

/// A fixed facet that faces up enough under a moving corner, if that supports its normal, `seen` in the moving frame.
pub(super) fn facet_corner(
    candidate: &Candidate,
    fixed: &Shape,
    moving: &Shape,
    seen: DVec3,
    slack: f64,
) -> Option<Element> {
    let facet = candidate.fixed as usize;
    let corner = &moving.corners[candidate.moving as usize];
    moving.supports(corner, seen, slack).then(|| {
        let features = Elements::FacetCorner { facet: candidate.fixed, vertex: corner.vertex };
        let offset = seen.dot(moving.at(corner.vertex)) - fixed.levels[facet];
        let meeting = Meeting { shapes: candidate.shapes, features };
        Element { meeting, normal: fixed.facets[facet].normal, offset }
    })
}

/// A fixed corner under a moving facet with this normal in the world, if it faces down enough and the corner supports it.
pub(super) fn corner_facet(
    candidate: &Candidate,
    fixed: &Shape,
    moving: &Shape,
    normal: DVec3,
    slack: f64,
    lowest: f64,
) -> Option<Element> {
    let corner = &fixed.corners[candidate.fixed as usize];
    (-normal.z > lowest && fixed.supports(corner, normal, slack)).then(|| {
        let features = Elements::CornerFacet { vertex: corner.vertex, facet: candidate.moving };
        let offset = normal.dot(fixed.at(corner.vertex)) - moving.levels[candidate.moving as usize];
        let meeting = Meeting { shapes: candidate.shapes, features };
        Element { meeting, normal: -normal, offset }
    })
}

/// Two edges, if they support their common normal and it points up enough; `seen` is the direction of the
/// fixed edge in the moving frame.
pub(super) fn edge_edge(
    candidate: &Candidate,
    fixed: &Shape,
    moving: &Shape,
    rotation: &DMat3,
    seen: DVec3,
    slack: f64,
    lowest: f64,
) -> Option<Element> {
    let (f, m) = (&fixed.ridges[candidate.fixed as usize], &moving.ridges[candidate.moving as usize]);
    // World z seen from the moving half.
    let up = rotation.transpose().z_axis;
    if m.normals.iter().all(|n| up.dot(*n) >= -lowest) {
        return None;
    }
    let edges = EdgesAt { w: *rotation * m.along, moving: m };
    let normal = edges.normal(f, seen, slack).filter(|n| n.z > lowest)?;
    if slack > FLUSH {
        // As of corners: see `Shape::supports`.
        let own = rotation.transpose() * normal;
        let outside = f.normals.iter().any(|n| normal.dot(*n) > -INSIDE)
            && m.normals.iter().any(|n| own.dot(*n) < INSIDE);
        outside.then_some(())?;
    }
    let offset = normal.dot(*rotation * moving.at(m.ends[0]) - fixed.at(f.ends[0]));
    let features = Elements::EdgeEdge { fixed: f.ends, moving: m.ends };
    Some(Element { meeting: Meeting { shapes: candidate.shapes, features }, normal, offset })
}

/// Whether two edges pass the sieve, regardless of its window; `seen` is the direction of the fixed edge in
/// the moving frame.
pub(super) fn edges_may_touch(
    fixed: &Ridge,
    moving: &Ridge,
    rotation: &DMat3,
    seen: DVec3,
    sieve: &Sieve,
) -> bool {
    let edges = EdgesAt { w: *rotation * moving.along, moving };
    edges.may_touch(fixed, seen, sieve.slack, sieve.lowest, sieve.skin)
}

/// A moving edge at a given rotation.
struct EdgesAt<'a> {
    /// Its direction in the world.
    w: DVec3,
    moving: &'a Ridge,
}

impl EdgesAt<'_> {
    /// (u × w)·s for the directions s into the facets of the fixed edge, then of the moving edge; `seen` is u
    /// in the moving frame.
    fn products(&self, fixed: &Ridge, seen: DVec3) -> ([f64; 2], [f64; 2]) {
        let [left, right] = fixed.normals.map(|n| self.w.dot(n));
        let [port, starboard] = self.moving.normals.map(|n| seen.dot(n));
        ([-left, right], [port, -starboard])
    }

    /// Whether the edges may touch at some rotation within the chord `skin`.
    fn may_touch(&self, fixed: &Ridge, seen: DVec3, slack: f64, lowest: f64, skin: f64) -> bool {
        let (below, above) = self.products(fixed, seen);
        // |u × w| ≤ 1, so this rejects nothing that the exact test below accepts.
        let widest = slack * (1.0 + skin) + skin;
        let supports = |sign: f64, by: f64| {
            below.iter().all(|b| sign * b <= by) && above.iter().all(|a| sign * a >= -by)
        };
        if !supports(1.0, widest) && !supports(-1.0, widest) {
            return false;
        }
        let across = fixed.along.cross(self.w);
        let length = across.length() + skin;
        let wide = slack * length + skin;
        let lowest = lowest * if lowest < 0.0 { length } else { (length - 2.0 * skin).max(0.0) } - skin;
        [1.0, -1.0].into_iter().any(|sign| supports(sign, wide) && sign * across.z > lowest)
    }

    /// The unit common normal of the edges in the sense that both support, if either does.
    fn normal(&self, fixed: &Ridge, seen: DVec3, slack: f64) -> Option<DVec3> {
        let (below, above) = self.products(fixed, seen);
        let up = below.iter().all(|b| *b <= slack) && above.iter().all(|a| *a >= -slack);
        let down = below.iter().all(|b| *b >= -slack) && above.iter().all(|a| *a <= slack);
        if !(up || down) {
            return None;
        }
        // By how much the worse of the two facets fails to support the contact, for one sense of the normal.
        // Two nearly parallel edges may pass in both senses within the slack; the better sense counts.
        let lacks = |sign: f64| {
            let below = (sign * below[0]).max(sign * below[1]);
            below.max(-sign * above[0]).max(-sign * above[1])
        };
        let sign = if up && !(down && lacks(-1.0) < lacks(1.0)) { 1.0 } else { -1.0 };
        let across = fixed.along.cross(self.w);
        let length = across.length();
        // Parallel edges have no normal of their own: their ends stand for them.
        (length > PARALLEL && lacks(sign) <= slack * length).then(|| across / (sign * length))
    }
}
