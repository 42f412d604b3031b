//! The defects that keep a mesh from bounding a solid, and the surface of a mesh without defects.

use super::crossing::crossings;
use super::indexed::Indexed;
use super::polygons;
use super::shells::{self, Shell};
use super::sides::Sides;
use super::{MAX_REPORTED, MeshPoint, MeshProblem, Reported};
use crate::Surface;

/// Area of a triangle, relative to the square of its longest side, below which it counts as zero: the
/// rounding of single-precision corners changes the area of a unit triangle by about 1e-7.
pub(super) const NO_AREA: f64 = 1e-7;

/// Everything that is wrong with a mesh, a few of each kind.
pub(super) fn problems(mesh: &Indexed, sides: &Sides) -> Vec<MeshProblem> {
    let mut reported = Reported::default();
    reported.extend(zero_areas(mesh));
    reported.extend(open_edges(mesh, sides));
    reported.extend(crowded_edges(mesh, sides));
    reported.extend(wrong_windings(mesh, sides));
    if reported.problems.is_empty() {
        reported.extend(inside_out(mesh, sides));
        let (result, not_looked_at) = crossings(mesh, MAX_REPORTED);
        let place = |k: usize| mesh.places[k];
        reported.extend(result.into_iter().map(|crossing| MeshProblem::SelfIntersection {
            first: place(crossing.pair[0]),
            second: place(crossing.pair[1]),
            at: crossing.at.into(),
        }));
        if not_looked_at > 0 {
            reported.extend([MeshProblem::NotLookedAt { count: not_looked_at }]);
        }
    }
    reported.problems
}

/// The surface of a mesh with which nothing is wrong, in D.
pub(super) fn surface(mesh: &Indexed, scale: f64) -> Result<Surface, Vec<MeshProblem>> {
    let (vertices, polygons) = polygons::of(mesh, polygons::FLAT * mesh.tolerance);
    // The checks above cover every defect that `Surface` rejects; a remaining error can only be rounding.
    Surface::from_polygons(vertices.into_iter().map(|v| v * scale).collect(), &polygons)
        .map_err(|_| vec![MeshProblem::InsideOut { at: mesh.at(0).into() }])
}

/// Whether a triangle has no area.
pub(super) fn is_flat(mesh: &Indexed, triangle: usize) -> bool {
    let [a, b, c] = mesh.corners(triangle);
    let longest = [b - a, c - b, a - c].into_iter().map(glam::DVec3::length_squared).fold(0.0, f64::max);
    (b - a).cross(c - a).length() <= NO_AREA * longest
}

fn zero_areas(mesh: &Indexed) -> impl Iterator<Item = MeshProblem> {
    (0..mesh.triangles.len())
        .filter(|&k| is_flat(mesh, k))
        .map(|k| MeshProblem::ZeroArea { place: mesh.places[k], at: mesh.corners(k)[0].into() })
}

/// Both ends of an edge.
fn ends(mesh: &Indexed, edge: [u32; 2]) -> [MeshPoint; 2] {
    edge.map(|k| mesh.at(k).into())
}

fn open_edges(mesh: &Indexed, sides: &Sides) -> impl Iterator<Item = MeshProblem> {
    sides.edges().filter(|sides| sides.len() == 1).map(|sides| {
        let [from, to] = ends(mesh, sides[0].edge);
        MeshProblem::Open { place: mesh.places[sides[0].triangle as usize], from, to }
    })
}

fn crowded_edges(mesh: &Indexed, sides: &Sides) -> impl Iterator<Item = MeshProblem> {
    sides.edges().filter(|sides| sides.len() > 2).map(|sides| {
        let [from, to] = ends(mesh, sides[0].edge);
        MeshProblem::NonManifold { count: sides.len(), from, to }
    })
}

fn wrong_windings(mesh: &Indexed, sides: &Sides) -> impl Iterator<Item = MeshProblem> {
    sides.edges().filter_map(|sides| match sides {
        [first, second] if first.is_up == second.is_up => {
            let [from, to] = first.edge.map(|k| mesh.at(k));
            let [first, second] = [first, second].map(|side| mesh.places[side.triangle as usize]);
            Some(MeshProblem::Winding { first, second, at: from.midpoint(to).into() })
        }
        _ => None,
    })
}

/// Shells that are inside out: all of them together, or a shell that lies in no other.
fn inside_out(mesh: &Indexed, sides: &Sides) -> Vec<MeshProblem> {
    let shells = shells::of(mesh, sides);
    let at = |shell: &Shell| mesh.corners(shell.triangles[0] as usize)[0].into();
    shells
        .iter()
        .filter(|shell| shell.volume <= 0.0 && shells::depth(mesh, &shells, shell) == 0)
        .map(|shell| MeshProblem::InsideOut { at: at(shell) })
        .collect()
}
