//! A closed mesh described with fewer triangles.
//!
//! ```text
//!   mesh ──2ᵏ──▶ ──2ᵏ⁺¹──▶ ──2ᵏ⁺²──▶ … ──▶ 2ⁿ ≤ what was asked     each from the one before: the whole is looked at once or twice
//!                                 └── the last that lies near enough to the mesh, both ways
//! ```
//!
//! `manifold-rust` collapses edges whose removal moves the surface by less than a tolerance. What comes out is not believed: its distance from the surface
//! before is measured both ways ([`deviation`](super::deviation)) and has to keep to what was asked for, and it passes every check of a mesh; if it
//! does not, the one before it is asked. Nothing of the surface is left out. The tolerances are powers of two whatever was asked for, so that who lets
//! the surface move farther gets no more triangles.
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

/// The first tolerance, as a share of the mesh's largest side: an edge in a thousand of its length is hardly bent by less.
const FIRST: f64 = 2e-5;
/// Tolerances at least, each twice the one before it.
const LEAST: i32 = 4;

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
    let last = most.log2().floor() as i32;
    let (low, high) = mesh.bounds();
    let first = ((FIRST * (high - low).max_element()).log2().floor() as i32).min(last + 1 - LEAST);
    let (mut fewer, mut chain) = (whole, Vec::new());
    for tolerance in (first..=last).map(|k| f64::from(k).exp2()) {
        fewer = fewer.simplify(tolerance);
        if fewer.status() != Error::NoError || fewer.is_empty() {
            break;
        }
        chain.push(Indexed::made(&fewer.get_mesh_gl64(-1), mesh.tolerance));
    }
    let near_enough = |result: &Indexed| {
        let deviation = one_sided(mesh, result, most);
        let deviation =
            if deviation > most { deviation } else { deviation.max(one_sided(result, mesh, most)) };
        let is_sound = || check::problems(result, &Sides::of(&result.triangles)).is_empty();
        (deviation <= most && is_sound()).then_some(deviation)
    };
    while let Some(mesh) = chain.pop() {
        if let Some(deviation) = near_enough(&mesh) {
            return Ok(Simplified { mesh, deviation });
        }
    }
    Err(refused)
}
