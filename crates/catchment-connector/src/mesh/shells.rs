//! The connected parts of a mesh, their volumes, and their nesting.
//!
//! ```text
//! V = Σ a·(b × c)/6        w(p) = Σ Ω(a − p, b − p, c − p)/4π        over the triangles of a shell
//! ```
//!
//! A shell lies in another if the other winds around one of its corners, |w| > ½, by the solid angles of van
//! Oosterom and Strackee (1983). Not promised: a result for crossing shells, which are neither inside nor
//! outside of each other.

use super::indexed::Indexed;
use super::sides::Sides;
use super::tree::{Bounds, around};
use catchment_base::disjoint::DisjointSets;
use glam::DVec3;
use std::f64::consts::PI;

/// Step budget for the nesting of shells; beyond it a shell counts as inside another if its box is.
const MOST_STEPS: usize = 50_000_000;

/// Triangles that hang together by their edges.
#[derive(Debug)]
pub(super) struct Shell {
    /// Their numbers, ascending.
    pub(super) triangles: Vec<u32>,
    /// Enclosed volume, negative if it is inside out.
    pub(super) volume: f64,
    bounds: Bounds,
}

/// The shells of a mesh, in the order of their first triangles. Triangles are neighbours across edges that just two of them share.
pub(super) fn of(mesh: &Indexed, sides: &Sides) -> Vec<Shell> {
    let count = mesh.triangles.len();
    let mut parts = DisjointSets::new(count);
    for sides in sides.edges() {
        if let [a, b] = sides {
            parts.join(a.triangle, b.triangle);
        }
    }
    let mut number = vec![u32::MAX; count];
    let mut lists: Vec<Vec<u32>> = Vec::new();
    for k in 0..count as u32 {
        let root = parts.find(k) as usize;
        if number[root] == u32::MAX {
            number[root] = lists.len() as u32;
            lists.push(Vec::new());
        }
        lists[number[root] as usize].push(k);
    }
    lists
        .into_iter()
        .map(|triangles| {
            let volume = volume(mesh, &triangles);
            let bounds = triangles
                .iter()
                .map(|k| around(mesh.corners(*k as usize)))
                .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), (a, b)| (lo.min(a), hi.max(b)));
            Shell { triangles, volume, bounds }
        })
        .collect()
}

/// In how many of the others a shell lies.
pub(super) fn depth(mesh: &Indexed, shells: &[Shell], shell: &Shell) -> usize {
    let others = || {
        shells.iter().filter(|other| {
            !std::ptr::eq(*other, shell)
                && other.bounds.0.cmple(shell.bounds.0).all()
                && shell.bounds.1.cmple(other.bounds.1).all()
        })
    };
    let steps: usize = others().map(|other| other.triangles.len()).sum();
    if steps.saturating_mul(shells.len().min(mesh.triangles.len())) > MOST_STEPS {
        return others().count();
    }
    let [a, b, c] = mesh.corners(shell.triangles[0] as usize);
    // In the middle of a triangle: at its corners it may touch another shell.
    let point = (a + b + c) / 3.0;
    others().filter(|other| winding(mesh, &other.triangles, point).abs() > 0.5).count()
}

/// How many times triangles wind around a point.
pub(super) fn winding(mesh: &Indexed, triangles: &[u32], point: DVec3) -> f64 {
    triangles.iter().map(|k| solid_angle(mesh.corners(*k as usize), point)).sum::<f64>() / (4.0 * PI)
}

/// The solid angle of a triangle seen from a point, positive from inside: tan(Ω/2) = a·(b × c) / (abc + (a·b)c + (b·c)a + (c·a)b).
pub(super) fn solid_angle(corners: [DVec3; 3], point: DVec3) -> f64 {
    let [a, b, c] = corners.map(|corner| corner - point);
    let [la, lb, lc] = [a, b, c].map(DVec3::length);
    let numerator = a.dot(b.cross(c));
    let denominator = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    2.0 * numerator.atan2(denominator)
}

fn volume(mesh: &Indexed, triangles: &[u32]) -> f64 {
    // Relative to a corner of the shell: far from the origin the sum would lose its digits.
    let origin = mesh.corners(triangles[0] as usize)[0];
    triangles
        .iter()
        .map(|k| {
            let [a, b, c] = mesh.corners(*k as usize).map(|p| p - origin);
            a.dot(b.cross(c)) / 6.0
        })
        .sum()
}
