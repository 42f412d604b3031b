//! A closed triangle mesh as half of a connector: from loose triangles to a [`Surface`], or to the list of
//! all reasons against it.
//!
//! ```text
//! triangles, each with its place ──weld──▶ corners shared ──check──▶ [repair] ──▶ [simplify] ──▶ polygons ──▶ Surface, in D
//! ```
//!
//! Every source of triangles uses this module, from files to triangles in memory. Corners closer than
//! [`WELD`] of the model's size are merged, and an edge is divided if a corner of its neighbours lies on it
//! within the same distance. The winding matters: counter-clockwise seen from outside. A mesh that is then
//! closed, wound outward and free of self-intersections is used unchanged. Any other mesh is repaired if the
//! [`MeshPreparation`] allows it, and the report lists the repairs. If defects remain, each of them is reported
//! with its place. Messages give coordinates in those of the source. Triangles in memory are never repaired.
//! Coplanar triangles become polygons.
//!
//! Not promised: holes are not closed, and coplanar overlaps of separate shells are not searched for.

mod bodies;
mod check;
mod crossing;
pub(crate) mod cut;
mod deviation;
mod divide;
mod indexed;
mod point;
mod polygons;
mod problem;
mod repair;
mod shells;
mod sides;
mod simplify;
mod tree;
pub(crate) mod union;

pub use point::MeshPoint;
pub(super) use problem::MAX_REPORTED;
pub use problem::{FileOffset, MeshProblem, TriangleLocation};

use super::{Half, Surface};
use catchment_base::budget::{Budget, Limit, Overspent};
use catchment_base::exec::{Bytes, Exec};
use catchment_base::tolerance;
use catchment_design::design::{MeshPreparation, Repairs};
use glam::DVec3;
use indexed::Indexed;
use problem::Reported;

/// Most triangles of a half as it is used: the largest for which a motion was measured to take seconds rather than minutes. Docking faces need
/// hundreds, as CAD exports them ten thousands.
pub const MAX_TRIANGLES: usize = 200_000;
/// Most triangles of a file that is simplified: measured to take a minute and a half and 3.3 GiB.
pub const MOST_READ: usize = 5_000_000;
/// Bodies of a file: their surfaces are compared with each other wherever they may touch.
pub(super) const BODIES: Limit =
    Limit { most: 256, of: "bodies", remedy: "unite the solids before exporting" };
/// Bytes that reading, repairing and simplifying take for each triangle, as measured.
const BYTES_PER_TRIANGLE: u64 = 900;
/// Corners closer than this, relative to the largest coordinate, are merged: ten times the rounding of single
/// precision.
pub const WELD: f64 = tolerance::SINGLE;
/// Widths of a half as drawn, in D, that can be meant: a pin in a plate is far narrower than the plate; an inch is 25 mm.
pub const PLAUSIBLE_WIDTH: std::ops::RangeInclusive<f64> = 0.1..=16.0;

/// A triangle in the coordinates of its source.
#[derive(Debug, Clone, Copy)]
pub(super) struct Triangle {
    pub(super) corners: [DVec3; 3],
    pub(super) place: TriangleLocation,
}

/// Most triangles that are read.
pub(super) const fn most_read(treatment: MeshPreparation) -> usize {
    if treatment.simplify.is_some() { MOST_READ } else { MAX_TRIANGLES }
}

/// The error for more triangles than allowed.
pub(super) const fn too_many(treatment: MeshPreparation, count: u64) -> MeshProblem {
    if treatment.simplify.is_some() {
        MeshProblem::TooManyToSimplify { count }
    } else {
        MeshProblem::TooMany { count }
    }
}

/// Largest number of vertices of a file: three for every triangle, as if no vertex were shared.
pub(super) const fn vertex_limit(treatment: MeshPreparation) -> Limit {
    let most = 3 * most_read(treatment) as u64;
    Limit { most, of: "vertices", remedy: "export the mesh with a coarser tolerance" }
}

/// The error for a file that exceeds a limit at a place.
pub(super) fn overspent(place: impl Into<String>, over: Overspent) -> Vec<MeshProblem> {
    vec![MeshProblem::Overspent { place: place.into(), over }]
}

/// A half, or a part of a half, with the changes to its meshes.
#[derive(Debug)]
pub(super) struct Ready {
    pub(super) half: Half,
    /// Of which so many triangles were made.
    pub(super) triangles: usize,
    pub(super) repairs: Repairs,
}

/// The triangles of a file of faces, numbered in their order.
#[derive(Debug)]
pub(super) struct Triangles {
    pub(super) list: Vec<Triangle>,
    treatment: MeshPreparation,
    /// For cutting faces.
    steps: Budget,
}

impl Triangles {
    /// An empty collection.
    pub(super) const fn new(treatment: MeshPreparation) -> Self {
        Self { list: Vec::new(), treatment, steps: Budget::new(cut::STEPS) }
    }

    /// Appends a face, cut into triangles; `place` is its place in the file.
    pub(super) fn push(
        &mut self,
        corners: &[DVec3],
        place: impl Fn() -> String,
    ) -> Result<(), Vec<MeshProblem>> {
        // A triangle needs no cutting. Zero areas and non-finite numbers are checked later, for all triangles
        // together.
        let cut = if corners.len() == 3 || !corners.iter().all(|corner| corner.is_finite()) {
            Some(vec![[0, 1, 2]])
        } else {
            cut::triangles(corners, &mut self.steps).map_err(|over| overspent(place(), over))?
        };
        let first = self.list.len();
        let at = corners.first().copied().unwrap_or_default().into();
        let cut = cut.ok_or_else(|| vec![MeshProblem::NotSimple { triangle: first, at }])?;
        self.list.extend(cut.into_iter().enumerate().map(|(k, ids)| Triangle {
            corners: ids.map(|id| corners[id]),
            place: TriangleLocation { triangle: first + k, start: FileOffset::Memory },
        }));
        if self.list.len() > most_read(self.treatment) {
            return Err(vec![too_many(self.treatment, self.list.len() as u64)]);
        }
        Ok(())
    }
}

/// A half from triangles (in D), by the rules of every mesh file; they are taken as they are.
///
/// # Errors
/// Everything that is wrong with the mesh, at most a few problems of each kind, by the number of the triangle.
pub fn from_triangles(triangles: &[[DVec3; 3]]) -> Result<Half, Vec<MeshProblem>> {
    let placed = |(triangle, &corners)| Triangle {
        corners,
        place: TriangleLocation { triangle, start: FileOffset::Memory },
    };
    let triangles: Vec<Triangle> = triangles.iter().enumerate().map(placed).collect();
    half(vec![triangles], 1.0, MeshPreparation::AS_IT_IS).map(|ready| ready.half)
}

/// A half from the triangles of a file, body by body, with the given treatment; `scale` converts its
/// coordinates to D.
pub(super) fn half(
    bodies: Vec<Vec<Triangle>>,
    scale: f64,
    treatment: MeshPreparation,
) -> Result<Ready, Vec<MeshProblem>> {
    check_scale(scale)?;
    let bodies = bodies::chosen(bodies, treatment.body)?;
    let treatment = MeshPreparation { body: None, ..treatment };
    let corners = bodies.iter().flatten().flat_map(|triangle| triangle.corners);
    let width = implausible_width(corners.map(|c| c * scale));
    let (ready, mut problems) = match part(bodies, scale, treatment) {
        Ok(ready) => (Some(ready), Vec::new()),
        Err(problems) => (None, problems),
    };
    // Without numbers there is no width.
    let is_sized = !problems.iter().any(|problem| {
        use MeshProblem::{NoTriangles, NotFinite, TooMany, TooManyToSimplify};
        matches!(problem, NotFinite { .. } | NoTriangles | TooMany { .. } | TooManyToSimplify { .. })
    });
    problems.extend(width.filter(|_| is_sized));
    ready.filter(|_| problems.is_empty()).ok_or(problems)
}

/// The same of a part of a half, which may have any size.
pub(super) fn part(
    bodies: Vec<Vec<Triangle>>,
    scale: f64,
    treatment: MeshPreparation,
) -> Result<Ready, Vec<MeshProblem>> {
    check_scale(scale)?;
    let bodies = bodies::chosen(bodies, treatment.body)?;
    let count = bodies.iter().map(Vec::len).sum::<usize>();
    if count > most_read(treatment) {
        return Err(vec![too_many(treatment, count as u64)]);
    }
    BODIES.allows(bodies.len() as u64).map_err(|over| overspent("the file", over))?;
    sound_numbers(&bodies)?;
    let mut ready = Ready { half: Half::default(), triangles: 0, repairs: Repairs::default() };
    let mut problems = Vec::new();
    for body in bodies.into_iter().filter(|body| !body.is_empty()) {
        match solid(body, scale, treatment) {
            Ok(solid) => {
                ready.half.surfaces.push(solid.surface);
                ready.triangles += solid.triangles;
                ready.repairs.add(&solid.repairs);
            }
            Err(result) => problems.extend(result),
        }
        if problems.len() > MAX_REPORTED * MAX_REPORTED {
            break;
        }
    }
    if problems.is_empty() { Ok(ready) } else { Err(problems) }
}

/// Reports a half with an implausible width in D.
pub(super) fn implausible_width(corners: impl Iterator<Item = DVec3>) -> Option<MeshProblem> {
    let (lo, hi) = corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), v| (lo.min(v), hi.max(v)));
    let width = (hi - lo).truncate().max_element();
    (!PLAUSIBLE_WIDTH.contains(&width)).then_some(MeshProblem::Unit { width })
}

/// A closed surface from the triangles of a body, with the changes made to it.
#[derive(Debug)]
struct Solid {
    surface: Surface,
    triangles: usize,
    repairs: Repairs,
}

/// The solid that triangles bound.
fn solid(
    triangles: Vec<Triangle>,
    scale: f64,
    treatment: MeshPreparation,
) -> Result<Solid, Vec<MeshProblem>> {
    fits(triangles.len())?;
    let (mut mesh, sides) = Indexed::of(triangles);
    let mut problems = check::problems(&mesh, &sides);
    drop(sides);
    let mut repairs = Repairs::default();
    if treatment.repair && !problems.is_empty() {
        let mended = repair::mended(&mesh);
        problems = mended.problems;
        if problems.is_empty() {
            (mesh, repairs) = (mended.mesh, mended.repairs);
        }
    }
    if !problems.is_empty() {
        return Err(problems);
    }
    if let Some(most) = treatment.simplify {
        let simplified = simplify::simplified(&mesh, most / scale, scale)?;
        repairs.simplified = Some([mesh.triangles.len(), simplified.mesh.triangles.len()]);
        // Repair and simplification moved the mesh one after the other, so the bounds add.
        repairs.deviation += simplified.deviation;
        mesh = simplified.mesh;
    }
    repairs.deviation *= scale;
    if mesh.triangles.len() > MAX_TRIANGLES {
        return Err(vec![MeshProblem::TooManyLeft { count: mesh.triangles.len() }]);
    }
    Ok(Solid { surface: check::surface(&mesh, scale)?, triangles: mesh.triangles.len(), repairs })
}

/// Refuses a large mesh for which there is too little memory.
fn fits(count: usize) -> Result<(), Vec<MeshProblem>> {
    let (needed, budget) = (BYTES_PER_TRIANGLE * count as u64, Exec::new().memory_budget());
    if count <= MAX_TRIANGLES || needed <= budget {
        return Ok(());
    }
    Err(vec![MeshProblem::Memory { count, needed: Bytes(needed), budget: Bytes(budget) }])
}

/// Refuses a scale that is no positive number.
fn check_scale(scale: f64) -> Result<(), Vec<MeshProblem>> {
    if scale.is_finite() && scale > 0.0 { Ok(()) } else { Err(vec![MeshProblem::Scale { scale }]) }
}

/// Refuses a mesh without triangles, and coordinates that are no numbers.
fn sound_numbers(bodies: &[Vec<Triangle>]) -> Result<(), Vec<MeshProblem>> {
    let mut reported = Reported::default();
    if bodies.iter().all(Vec::is_empty) {
        reported.extend([MeshProblem::NoTriangles]);
    }
    reported.extend(
        bodies
            .iter()
            .flatten()
            .filter_map(|t| Some((t, t.corners.iter().find(|corner| !corner.is_finite())?)))
            .map(|(t, corner)| MeshProblem::NotFinite { place: t.place, at: (*corner).into() }),
    );
    reported.done()
}

#[cfg(test)]
mod tests;
