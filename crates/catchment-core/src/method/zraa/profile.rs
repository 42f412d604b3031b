//! The profile of a single-piece planar connector: the curve along which its two halves meet.
//!
//! ```text
//!    ▓▓▓▓▓▓▓▓▓▓▓        moving half, mated: its lower border is the same curve
//!    ▓▓╱╲▓▓▓▓▓▓▓
//!    ▓╱  ╲▓▓▓╱▓▓        z = f(x) on [a, b], continuous, straight from corner to corner
//!    ╱    ╲▓╱
//!    ░░░░░░░░░░░        fixed half
//! ```
//!
//! Lengths in D. A pair has such a profile if both halves are prisms along y in the same slab, and the upper
//! border of the fixed half is the lower border of the moving half over the same x, without a vertical step.
//!
//! Not promised: a profile for halves in layers (X-Face), with play between them, or with steps: they have no
//! profile.

use super::line::{Segment, Top, envelope};
use crate::connector::{Half, Surface};
use crate::contact::Pair;
use crate::tolerance::SINGLE;
use glam::{DVec2, DVec3};

/// A continuous curve z = f(x) of straight pieces.
#[derive(Debug, Clone, PartialEq)]
pub struct HeightProfile {
    /// From left to right, x rising, no three in a line.
    corners: Vec<DVec2>,
}

impl HeightProfile {
    /// Of corners from left to right, in D; `None` unless there are two or more and x rises from each to the next.
    pub fn new(corners: &[DVec2]) -> Option<Self> {
        let rising = corners.windows(2).all(|w| w[0].x < w[1].x) && corners.iter().all(|p| p.is_finite());
        if corners.len() < 2 || !rising {
            return None;
        }
        let tolerance = SINGLE * (corners[corners.len() - 1].x - corners[0].x);
        let mut kept: Vec<DVec2> = Vec::with_capacity(corners.len());
        for (k, &corner) in corners.iter().enumerate() {
            let straight = kept.last().zip(corners.get(k + 1)).is_some_and(|(before, after)| {
                let along = *after - *before;
                along.perp_dot(corner - *before).abs() <= tolerance * along.length()
            });
            if !straight {
                kept.push(corner);
            }
        }
        Some(Self { corners: kept })
    }

    /// The profile along which the halves of a pair meet when they are mated, if they meet along a single
    /// profile: see above.
    pub fn of(pair: &Pair) -> Option<Self> {
        let fixed = Self::border(&pair.fixed, 1.0)?;
        let moving = Self::border(&pair.moving, -1.0)?;
        let tolerance = SINGLE * fixed.width();
        let close = |a: &DVec2, b: &DVec2| {
            (a.x - b.x).abs() <= tolerance
                && (a.y + b.y - fixed.corners[0].y - moving.corners[0].y).abs() <= tolerance
        };
        let mate = fixed.corners.len() == moving.corners.len()
            && fixed.corners.iter().zip(&moving.corners).all(|(a, b)| close(a, b));
        mate.then_some(fixed)
    }

    /// The upper border of a half that is a prism along y; with `sign` −1 the lower border, upside down.
    fn border(half: &Half, sign: f64) -> Option<Self> {
        let (lo, hi) =
            half.surfaces.iter().map(Surface::bounds).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))?;
        let tolerance = SINGLE * (hi.x - lo.x);
        let in_slab = |p: &DVec3| (p.y - lo.y).abs() <= tolerance || (p.y - hi.y).abs() <= tolerance;
        let mut segments = Vec::new();
        for surface in &half.surfaces {
            if !surface.vertices.iter().all(in_slab) {
                return None;
            }
            for facet in &surface.facets {
                let n = facet.normal;
                if n.y.abs() > SINGLE && n.y.abs() < 1.0 - SINGLE {
                    return None;
                }
                if n.z * sign > SINGLE && n.y.abs() <= SINGLE {
                    let corners = || facet.corners.iter().map(|&k| surface.vertices[k as usize]);
                    let from = corners().map(|p| p.x).fold(f64::INFINITY, f64::min);
                    let to = corners().map(|p| p.x).fold(f64::NEG_INFINITY, f64::max);
                    let at = surface.vertices[facet.corners[0] as usize];
                    let slope = -sign * n.x / n.z;
                    segments.push(Segment { from, to, offset: sign * at.z - slope * at.x, slope });
                }
            }
        }
        // A wall or a gap between two stretches is a step.
        let tops = envelope(&segments);
        let end = |top: &Top<'_>, x: f64| DVec2::new(x, top.segment.height(x));
        let together = |w: &[Top<'_>]| end(&w[0], w[0].to).distance(end(&w[1], w[1].from)) <= tolerance;
        if !tops.windows(2).all(together) {
            return None;
        }
        let mut corners: Vec<DVec2> = tops.iter().map(|top| end(top, top.from)).collect();
        corners.extend(tops.last().map(|top| end(top, top.to)));
        // Segments shorter than the tolerance are removed.
        corners.dedup_by(|b, a| b.x - a.x <= tolerance);
        Self::new(&corners)
    }

    /// Its corners from left to right, ends included, in D.
    pub fn corners(&self) -> &[DVec2] {
        &self.corners
    }

    /// Distance from its left to its right end, in D.
    pub fn width(&self) -> f64 {
        self.corners[self.corners.len() - 1].x - self.corners[0].x
    }

    /// Whether a half turn in the plane maps it onto itself, f(a + b − x) = c − f(x): then both halves are alike.
    pub fn is_point_symmetric(&self) -> bool {
        let tolerance = 2.0 * SINGLE * self.width();
        let sum = self.corners[0] + self.corners[self.corners.len() - 1];
        self.corners.iter().zip(self.corners.iter().rev()).all(|(a, b)| (*a + *b).distance(sum) <= tolerance)
    }

    /// The same seen from behind.
    pub(super) fn mirrored(&self) -> Self {
        Self { corners: self.corners.iter().rev().map(|p| DVec2::new(-p.x, p.y)).collect() }
    }
}
