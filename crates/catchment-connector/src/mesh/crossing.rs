//! Pairs of triangles that cross: an edge of the first pierces the second, or the first is folded flat onto
//! its neighbour.
//!
//! The search tests every pair whose boxes overlap, in the order of their lowest x, and ends after the first
//! few crossings: in a mesh with crossings everywhere the number of pairs grows with the square of the number
//! of triangles.
//!
//! Not promised: overlapping coplanar triangles are not found.

use super::check::NO_AREA;
use super::indexed::Indexed;
use super::tree::{Tree, around, overlap};
use glam::DVec3;

/// Triangles cross if they share a line longer than this many tolerances: shorter lines come from rounded
/// corners.
const SHORT: f64 = 4.0;

/// Two triangles that cross, by their numbers, the lower number first.
#[derive(Debug, Clone, Copy)]
pub(super) struct Crossing {
    pub(super) pair: [usize; 2],
    pub(super) at: DVec3,
}

/// The first `most` crossings, and the number of triangles that were not tested if there were more.
pub(super) fn crossings(mesh: &Indexed, most: usize) -> (Vec<Crossing>, usize) {
    let boxes: Vec<_> = (0..mesh.triangles.len()).map(|k| around(mesh.corners(k))).collect();
    let tree = Tree::over(&boxes);
    let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
    order.sort_by(|&a, &b| boxes[a as usize].0.x.total_cmp(&boxes[b as usize].0.x).then(a.cmp(&b)));
    let mut position = vec![0u32; boxes.len()];
    for (at, k) in order.iter().enumerate() {
        position[*k as usize] = at as u32;
    }
    let mut result = Vec::new();
    let mut near: Vec<u32> = Vec::new();
    for (at, &i) in order.iter().enumerate() {
        let i = i as usize;
        near.clear();
        tree.visit(
            |bounds| overlap(bounds, boxes[i]),
            |j| {
                if position[j] > at as u32 && overlap(boxes[i], boxes[j]) {
                    near.push(position[j]);
                }
            },
        );
        if near.is_empty() {
            continue;
        }
        near.sort_unstable();
        let sheet = Sheet::of(mesh.corners(i));
        for j in near.iter().map(|at| order[*at as usize] as usize) {
            let (first, second) = (mesh.triangles[i], mesh.triangles[j]);
            let other = Sheet::of(mesh.corners(j));
            if sheet.is_clear_of(&other, mesh.tolerance) && !share_a_side(first, second) {
                continue;
            }
            let Some(point) = cross(mesh, first, second) else { continue };
            if result.len() == most {
                return (result, order.len() - at);
            }
            result.push(Crossing { pair: [i.min(j), i.max(j)], at: point });
        }
    }
    (result, 0)
}

/// A triangle and the plane that it lies in.
struct Sheet {
    corners: [DVec3; 3],
    normal: DVec3,
}

impl Sheet {
    fn of(corners: [DVec3; 3]) -> Self {
        let [a, b, c] = corners;
        Self { corners, normal: (b - a).cross(c - a).normalize_or_zero() }
    }

    /// Whether no side of either can pierce the other: each lies on one side of the other's plane. By the same numbers as
    /// [`pierced`], so that nothing is missed.
    fn is_clear_of(&self, other: &Self, tolerance: f64) -> bool {
        self.has_on_one_side(other, tolerance) && other.has_on_one_side(self, tolerance)
    }

    fn has_on_one_side(&self, other: &Self, tolerance: f64) -> bool {
        let heights = other.corners.map(|corner| self.normal.dot(corner - self.corners[0]));
        heights.iter().all(|h| *h <= tolerance) || heights.iter().all(|h| *h >= -tolerance)
    }
}

fn share_a_side(first: [u32; 3], second: [u32; 3]) -> bool {
    first.iter().filter(|k| second.contains(k)).count() >= 2
}

/// A point of the crossing of two triangles, if they cross. Sharing a corner or a side is not a crossing,
/// folding over it is.
fn cross(mesh: &Indexed, first: [u32; 3], second: [u32; 3]) -> Option<DVec3> {
    let tolerance = mesh.tolerance;
    let shared = first.iter().filter(|k| second.contains(k)).count();
    let (a, b) = (first.map(|k| mesh.at(k)), second.map(|k| mesh.at(k)));
    if shared >= 2 {
        let apex = |of: [u32; 3], other: [u32; 3]| of.into_iter().find(|k| !other.contains(k));
        let (Some(p), Some(q)) = (apex(first, second), apex(second, first)) else { return Some(a[0]) };
        let hinge = mesh.at(first.into_iter().find(|k| second.contains(k))?);
        let (p, q) = (mesh.at(p), mesh.at(q));
        let (n, m) = ((a[1] - a[0]).cross(a[2] - a[0]), (b[1] - b[0]).cross(b[2] - b[0]));
        // Folded flat on itself: opposite normals, apexes on the same side of the common edge.
        let folded = n.dot(m) < 0.0 && n.cross(m).length() <= NO_AREA * n.length() * m.length();
        return folded.then(|| hinge.lerp(p.midpoint(q), 0.5));
    }
    let pierce = |edges: [u32; 3], corners_of: [DVec3; 3], other: [u32; 3]| {
        (0..3).find_map(|k| {
            let (p, q) = (edges[k], edges[(k + 1) % 3]);
            if other.contains(&p) || other.contains(&q) {
                return None;
            }
            pierced(mesh.at(p), mesh.at(q), corners_of, tolerance)
        })
    };
    let at = pierce(first, b, second).or_else(|| pierce(second, a, first))?;
    (common(a, b) > SHORT * tolerance).then_some(at)
}

/// Length of the line that two crossing triangles share; infinite if they are nearly coplanar.
fn common(a: [DVec3; 3], b: [DVec3; 3]) -> f64 {
    let plane = |[p, q, r]: [DVec3; 3]| ((q - p).cross(r - p).normalize_or_zero(), p);
    let (of_a, of_b) = (plane(a), plane(b));
    let Some(along) = of_a.0.cross(of_b.0).try_normalize() else { return f64::INFINITY };
    // The interval of the common line of both planes that lies in a triangle.
    let part = |t: [DVec3; 3], (normal, origin): (DVec3, DVec3)| {
        let height = t.map(|p| normal.dot(p - origin));
        let mut part = (f64::INFINITY, f64::NEG_INFINITY);
        for k in 0..3 {
            let (p, q, above, below) = (t[k], t[(k + 1) % 3], height[k], height[(k + 1) % 3]);
            if (above > 0.0) != (below > 0.0) {
                let at = along.dot(p.lerp(q, above / (above - below)) - a[0]);
                part = (part.0.min(at), part.1.max(at));
            }
        }
        part
    };
    let (in_a, in_b) = (part(a, of_b), part(b, of_a));
    in_a.1.min(in_b.1) - in_a.0.max(in_b.0)
}

/// The point at which the segment p–q passes through a triangle from one side to the other.
fn pierced(p: DVec3, q: DVec3, [a, b, c]: [DVec3; 3], tolerance: f64) -> Option<DVec3> {
    let normal = (b - a).cross(c - a).normalize_or_zero();
    let (above, below) = (normal.dot(p - a), normal.dot(q - a));
    if above.abs() <= tolerance || below.abs() <= tolerance || above.signum() == below.signum() {
        return None;
    }
    let at = p.lerp(q, above / (above - below));
    let inside = [(a, b), (b, c), (c, a)].into_iter().all(|(u, v)| (v - u).cross(at - u).dot(normal) >= 0.0);
    inside.then_some(at)
}
