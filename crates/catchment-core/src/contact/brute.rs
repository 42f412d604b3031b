//! The definition of the height in executable form: every facet against every corner, every edge against
//! every edge. Slow and plain: the reference for every fast path.

use super::Pair;
use crate::connector::Surface;
use crate::pose::CorPose;
use crate::tolerance;
use glam::{DVec2, DVec3};

/// Distance beyond the border of a facet or edge at which a contact still counts, relative to D: wide enough
/// to close the cracks that rounding (1e-16) opens between neighbouring facets, far below any length that
/// matters.
pub(super) const SEAM: f64 = tolerance::ROUNDING;

/// z of the COR at first contact, in D; `None` if the halves pass each other by.
pub fn height(pair: &Pair, pose: &CorPose) -> Option<f64> {
    let lateral = pose.lateral.extend(0.0);
    let place = |s: &Surface| s.mapped(|p| pose.rotation * p + lateral);
    let moving: Vec<Surface> = pair.moving.surfaces.iter().map(place).collect();
    let mut highest = f64::NEG_INFINITY;
    for fixed in &pair.fixed.surfaces {
        for moving in &moving {
            highest = highest.max(surfaces(fixed, moving));
        }
    }
    highest.is_finite().then_some(highest)
}

/// Height by which `moving` must be lifted to just touch `fixed` from above; −∞ if no vertical line meets
/// both.
fn surfaces(fixed: &Surface, moving: &Surface) -> f64 {
    let mut lift = f64::NEG_INFINITY;
    for polygon in polygons(fixed) {
        for corner in &moving.vertices {
            if let Some(z) = z_over(&polygon, corner.truncate()) {
                lift = lift.max(z - corner.z);
            }
        }
    }
    for polygon in polygons(moving) {
        for corner in &fixed.vertices {
            if let Some(z) = z_over(&polygon, corner.truncate()) {
                lift = lift.max(corner.z - z);
            }
        }
    }
    for f in polygons(fixed) {
        for m in polygons(moving) {
            for (a, b) in sides(&f) {
                for (c, d) in sides(&m) {
                    if let Some(dz) = crossing(a, b, c, d) {
                        lift = lift.max(dz);
                    }
                }
            }
        }
    }
    lift
}

fn polygons(surface: &Surface) -> impl Iterator<Item = Vec<DVec3>> + '_ {
    surface.facets.iter().map(|f| f.corners.iter().map(|&i| surface.vertices[i as usize]).collect())
}

fn sides(polygon: &[DVec3]) -> impl Iterator<Item = (DVec3, DVec3)> + '_ {
    (0..polygon.len()).map(|k| (polygon[k], polygon[(k + 1) % polygon.len()]))
}

/// z of a convex planar polygon above the point `p` of the plane; `None` beside it or if it is vertical.
fn z_over(polygon: &[DVec3], p: DVec2) -> Option<f64> {
    let normal: DVec3 = sides(polygon).map(|(a, b)| (a - polygon[0]).cross(b - polygon[0])).sum();
    let normal = normal.normalize_or_zero();
    if normal.z.abs() < 1e-9 {
        return None; // vertical: its edges speak for it
    }
    let turn = normal.z.signum();
    for (a, b) in sides(polygon) {
        let along = (b - a).truncate();
        if turn * along.perp_dot(p - a.truncate()) < -SEAM * along.length() {
            return None;
        }
    }
    Some(polygon[0].z - normal.truncate().dot(p - polygon[0].truncate()) / normal.z)
}

/// `z` of the first segment minus `z` of the second at their crossing in plan view.
fn crossing(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> Option<f64> {
    let (u, v) = (b - a, d - c);
    let (ul, vl) = (u.truncate().length(), v.truncate().length());
    let turn = u.truncate().perp_dot(v.truncate());
    if turn.abs() <= 1e-9 * ul * vl {
        return None; // parallel in plan view: their ends speak for them
    }
    let ac = (c - a).truncate();
    let (s, t) = (ac.perp_dot(v.truncate()) / turn, ac.perp_dot(u.truncate()) / turn);
    let inside = |k: f64, length: f64| k >= -SEAM / length && k <= 1.0 + SEAM / length;
    let lift = (a.z + s * u.z) - (c.z + t * v.z);
    (inside(s, ul) && inside(t, vl)).then_some(lift)
}
