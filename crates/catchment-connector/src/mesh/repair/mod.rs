//! Repair of a mesh that does not bound a solid as written, if the intended solid is unambiguous.
//!
//! ```text
//! weld, divide ─▶ defects? ─▶ none: unchanged
//!                       │
//!                       └▶ doubled ─▶ flat ─▶ divide ─▶ lids ─▶ winding ─▶ crowded ─▶ defects? ─▶ crossings: unite, and repeat
//! ```
//!
//! Each step has its own file, which describes its changes. Corners do not move, except for those that
//! welding merges; new corners arise on edges and at crossings of surfaces. [`Repairs`] counts the repairs
//! and gives the largest displacement of the surface.
//!
//! Not promised: holes are not closed, and meshes with remaining open, crowded or crossed edges are rejected
//! as without repair.

mod crowded;
mod doubled;
mod flat;
mod lids;
mod short;
mod unite;
mod winding;

pub(super) use crowded::part as part_crowded;

use super::check;
use super::crossing::crossings;
use super::deviation::one_sided;
use super::divide::divide;
use super::indexed::Indexed;
use super::sides::Sides;
use super::{MAX_TRIANGLES, MeshProblem};
use catchment_design::design::Repairs;

/// Largest number of crossings that are united: a surface with more is not a part but a tangle.
const MOST_CROSSINGS: usize = 20_000;
/// Most rounds of uniting: rounding the corners of a union may leave a crossing of its own.
const ROUNDS: usize = 3;

/// Largest displacement of the surface by a repair, in tolerances: several steps move it by one tolerance
/// each.
const MOST_MOVED: f64 = 20.0;

/// A mesh as far as it could be mended.
pub(super) struct Mended {
    pub(super) mesh: Indexed,
    /// The repairs; their deviation is in the coordinates of the mesh.
    pub(super) repairs: Repairs,
    /// The remaining defects.
    pub(super) problems: Vec<MeshProblem>,
}

/// Mends a mesh with which something is wrong.
pub(super) fn mended(before: &Indexed) -> Mended {
    let mut mesh = before.clone();
    let mut repairs = Repairs::default();
    let mut problems = tidied(&mut mesh, &mut repairs);
    for _ in 0..ROUNDS {
        if !needs_union(&problems) || mesh.triangles.len() > MAX_TRIANGLES {
            break;
        }
        let (result, not_looked_at) = crossings(&mesh, MOST_CROSSINGS);
        if not_looked_at > 0 {
            break;
        }
        let Some(mut united) = unite::united(&mesh) else { break };
        crowded::part(&mut united);
        short::collapse(&mut united);
        // The clean-up after a union counts as part of the union.
        let left = tidied(&mut united, &mut Repairs::default());
        repairs.united += result.len().max(1);
        (mesh, problems) = (united, left);
    }
    if mesh.triangles.is_empty() {
        // Nothing is left, so the defects of the original mesh are more informative.
        problems = check::problems(before, &Sides::of(&before.triangles));
    }
    if problems.is_empty() && !repairs.is_none() {
        // The union removed walls inside the solid; their distance from the remaining surface has no meaning.
        let is_less = repairs.united + repairs.doubled + repairs.lids > 0;
        repairs.deviation = one_sided(&mesh, before, f64::INFINITY);
        if !is_less {
            repairs.deviation = repairs.deviation.max(one_sided(before, &mesh, f64::INFINITY));
        }
        if repairs.deviation > MOST_MOVED * before.tolerance {
            problems = check::problems(before, &Sides::of(&before.triangles));
        }
    }
    Mended { mesh, repairs, problems }
}

/// Applies `tidy`; returns the remaining defects.
fn tidied(mesh: &mut Indexed, repairs: &mut Repairs) -> Vec<MeshProblem> {
    tidy(mesh, repairs);
    mesh.compact();
    if mesh.triangles.is_empty() {
        return Vec::new();
    }
    check::problems(mesh, &Sides::of(&mesh.triangles))
}

/// Whether a union may help: surfaces cross, or more than two triangles share an edge that could not be parted.
fn needs_union(problems: &[MeshProblem]) -> bool {
    let crossing =
        |p: &MeshProblem| matches!(p, MeshProblem::SelfIntersection { .. } | MeshProblem::NonManifold { .. });
    let open = |p: &MeshProblem| matches!(p, MeshProblem::Open { .. } | MeshProblem::Winding { .. });
    problems.iter().any(crossing) && !problems.iter().any(open)
}

/// Applies all repairs that do not move the surface.
fn tidy(mesh: &mut Indexed, repairs: &mut Repairs) {
    let doubled = doubled::drop(mesh);
    repairs.without_area += doubled.without_area;
    repairs.doubled += doubled.doubled;
    // A neighbour is known by its sense.
    repairs.turned += winding::unify(mesh, &Sides::of(&mesh.triangles));
    repairs.without_area += flat::drop(mesh);
    // Taking flat triangles away may lay others on each other.
    repairs.doubled += doubled::drop(mesh).doubled;
    let mut sides = divide(mesh);
    let lids = lids::drop(mesh, &sides);
    if lids > 0 {
        repairs.lids += lids;
        sides = Sides::of(&mesh.triangles);
    }
    repairs.turned += winding::unify(mesh, &sides);
    let parted = crowded::part(mesh);
    repairs.parted += parted;
    if parted > 0 {
        repairs.turned += winding::unify(mesh, &Sides::of(&mesh.triangles));
    }
}
