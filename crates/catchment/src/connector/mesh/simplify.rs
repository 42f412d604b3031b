//! A closed mesh described with fewer triangles.
//!
//! `manifold-rust` collapses edges whose removal moves the surface by less than a tolerance. What comes out is not believed: its distance from the surface
//! before is measured both ways ([`deviation`](super::deviation)) and has to keep to what was asked for, and it passes every check of a mesh; if it
//! does not, a smaller tolerance is tried. Nothing of the surface is left out. The tolerances that are tried are the same for every file and whatever was asked
//! for, so that who lets the surface move farther gets what was good enough for less, or better.
//!
//! Not promised: the fewest triangles possible.

use super::MeshProblem;
use super::check;
use super::deviation::one_sided;
use super::indexed::Indexed;
use super::sides::Sides;
use glam::DVec3;
use manifold_rust::manifold::Manifold;
use manifold_rust::types::{Error, MeshGL64};

/// Tolerances tried at most.
const TRIES: i32 = 10;
/// Each is a power of this.
const STEP: f64 = std::f64::consts::SQRT_2;

/// A simplified mesh.
pub(super) struct Simplified {
    pub(super) mesh: Indexed,
    /// Largest distance from the surface before, in the coordinates of the mesh.
    pub(super) deviation: f64,
}

/// Simplifies a mesh with which nothing is wrong; the surface moves by no more than `most`, in its coordinates.
pub(super) fn simplified(mesh: &Indexed, most: f64, scale: f64) -> Result<Simplified, Vec<MeshProblem>> {
    let refused = vec![MeshProblem::NotSimplified { most: most * scale }];
    let given = MeshGL64 {
        num_prop: 3,
        vert_properties: mesh.vertices.iter().flat_map(DVec3::to_array).collect(),
        tri_verts: mesh.triangles.iter().flatten().map(|k| u64::from(*k)).collect(),
        ..MeshGL64::default()
    };
    let whole = Manifold::from_mesh_gl64(&given);
    drop(given);
    if whole.status() != Error::NoError {
        return Err(refused);
    }
    let first = most.log(STEP).floor() as i32;
    for tolerance in (0..TRIES).map(|k| STEP.powi(first - k)) {
        let fewer = whole.simplify(tolerance);
        if fewer.status() != Error::NoError || fewer.is_empty() {
            continue;
        }
        let result = Indexed::made(&fewer.get_mesh_gl64(-1), mesh.tolerance);
        let deviation = one_sided(mesh, &result, most);
        if deviation > most {
            continue;
        }
        let deviation = deviation.max(one_sided(&result, mesh, most));
        let is_sound = || check::problems(&result, &Sides::of(&result.triangles)).is_empty();
        if deviation <= most && is_sound() {
            return Ok(Simplified { mesh: result, deviation });
        }
    }
    Err(refused)
}
