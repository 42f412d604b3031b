//! Union of the regions that a mesh winds around: shells that cross or touch become a single surface.
//!
//! ```text
//! solid = { p : w(p) ≥ 1 }         w: how many times the surface winds around p
//! ```
//!
//! `manifold-rust` does the work, in exact arithmetic (Barki, Guennebaud, Foufou 2015; Zhou, Grinspun, Zorin,
//! Jacobson 2016): the arrangement of all triangles, the cells that it divides space into, and the winding
//! number of the surface around each. Its later processing of the result, which sometimes moves a corner by a
//! millimetre, is not used. The library is young and has a single maintainer, so it is isolated behind this
//! function and its results are verified: the result must wind exactly once around the regions that the mesh
//! winds around and not at all around the rest, at points on both sides of its triangles and at others spread
//! over its box, and then pass every check of a mesh.
//!
//! Not promised: meshes that are not closed are not united, because they have no solid. Corners at crossings
//! of surfaces are rounded.

use crate::mesh::indexed::Indexed;
use crate::mesh::shells::winding as winding_around;
use crate::mesh::sides::Sides;
use catchment_base::exec::attempt;
use glam::DVec3;
use manifold_rust::linalg::Vec3;
use manifold_rust::robust::cells::{build_cells, extract, windings};
use manifold_rust::robust::intersection_graph::build_graph;
use manifold_rust::types::{OpType, WindingRule};

/// Largest number of points at which both winding numbers are compared: each costs a pass over all triangles.
const POINTS: usize = 96;
/// Largest number of triangle tests over all points together.
const MOST_STEPS: usize = 20_000_000;
/// Distance of the points from the surface, relative to the tolerance of the mesh.
const OFF: f64 = 20.0;

/// The union, if it passes verification.
pub(super) fn united(mesh: &Indexed) -> Option<Indexed> {
    let result = solid(mesh)?;
    holds(mesh, &result).then_some(result)
}

fn solid(mesh: &Indexed) -> Option<Indexed> {
    // The winding number is an integer only for a closed surface.
    if Sides::of(&mesh.triangles)
        .edges()
        .any(|sides| 2 * sides.iter().filter(|s| s.is_up).count() != sides.len())
    {
        return None;
    }
    let soup: Vec<[Vec3; 3]> = (0..mesh.triangles.len())
        .map(|k| mesh.corners(k).map(|corner| Vec3::new(corner.x, corner.y, corner.z)))
        .collect();
    // Of corners on a lattice, every ray that it tries may run along something: it panics then.
    let (graph, walls) = attempt(|| {
        let graph = build_graph(&soup, &[]);
        let cells = build_cells(&graph);
        let winding = windings(&graph, &cells, [&soup, &[]]);
        let walls = extract(&graph, &cells, &winding, OpType::Add, WindingRule::Positive);
        (graph, walls)
    })?;
    let mut united = Indexed {
        vertices: graph.verts_f64.iter().map(|p| DVec3::new(p.x, p.y, p.z)).collect(),
        triangles: walls.iter().map(|wall| wall.vi).collect(),
        places: walls.iter().map(|wall| mesh.places[wall.tri]).collect(),
        tolerance: mesh.tolerance,
    };
    united.compact();
    Some(united).filter(|united| !united.triangles.is_empty())
}

/// Whether the result winds once around the regions that the mesh winds around, and not around the rest.
fn holds(before: &Indexed, after: &Indexed) -> bool {
    let all = |mesh: &Indexed| (0..mesh.triangles.len() as u32).collect::<Vec<_>>();
    let (of_before, of_after) = (all(before), all(after));
    let points = POINTS.min(MOST_STEPS / (of_before.len() + of_after.len()).max(1)).max(8);
    let agree = |point: DVec3| {
        let is_in = winding_around(before, &of_before, point).round() >= 1.0;
        let times = winding_around(after, &of_after, point).round();
        times == if is_in { 1.0 } else { 0.0 }
    };
    let (lo, hi) = before.bounds();
    let random = (0..points / 2).map(|k| lo + (hi - lo) * halton(k + 1));
    let step = (after.triangles.len() / (points / 4).max(1)).max(1);
    let beside = (0..after.triangles.len()).step_by(step).flat_map(|k| {
        let [a, b, c] = after.corners(k);
        let middle = (a + b + c) / 3.0;
        let off = (b - a).cross(c - a).normalize_or_zero() * (OFF * after.tolerance);
        [middle + off, middle - off]
    });
    // A wall may be thinner than the distance of a test point from it: one in twenty of these points may
    // disagree, but no random point.
    let beside: Vec<bool> = beside.map(agree).collect();
    let wrong = beside.iter().filter(|agrees| !**agrees).count();
    20 * wrong <= beside.len() && random.into_iter().all(agree)
}

/// The k-th point of the Halton sequence in the unit cube.
fn halton(k: usize) -> DVec3 {
    let along = |base: usize| {
        let (mut k, mut part, mut sum) = (k, 1.0, 0.0);
        while k > 0 {
            part /= base as f64;
            sum += part * (k % base) as f64;
            k /= base;
        }
        sum
    };
    DVec3::new(along(2), along(3), along(5))
}
