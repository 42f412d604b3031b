//! Simplification of a closed mesh to fewer triangles.
//!
//! ```text
//!   mesh ──2ᵏ──▶ ──2ᵏ⁺¹──▶ ──2ᵏ⁺²──▶ … ──▶ 2ⁿ ≤ limit     each from the previous mesh; the full mesh is simplified once or twice
//!                                 └── the last within the limit, in both directions ──2ᵏ⁺²·√2──▶ used if it is, too
//! ```
//!
//! `manifold-rust` collapses edges whose removal moves the surface by less than a tolerance. Its result is
//! verified: its distance from the original surface is measured in both directions
//! ([`deviation`](super::deviation)) and must not exceed the requested deviation, and it must pass every
//! check of a mesh; if it fails, the previous result is tried. Every part of the surface is kept. The
//! tolerances are powers of two, independent of the request, so that a larger permitted deviation never
//! yields more triangles.
//!
//! Not promised: the minimum number of triangles.

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
/// Smallest number of tolerances, each twice the one before.
const LEAST: i32 = 4;

/// A simplified mesh.
pub(super) struct Simplified {
    pub(super) mesh: Indexed,
    /// Largest distance from the surface before, in the coordinates of the mesh.
    pub(super) deviation: f64,
}

/// Simplifies a mesh with which nothing is wrong; the surface moves by no more than `most`, in its coordinates.
pub(super) fn simplified(mesh: &Indexed, most: f64, scale: f64) -> Result<Simplified, Vec<MeshProblem>> {
    let refused = || vec![MeshProblem::NotSimplified { most: most * scale }];
    let mut fewer = manifold(mesh).ok_or_else(refused)?;
    let (low, high) = mesh.bounds();
    let size = (high - low).max_element();
    let power = |length: f64| length.log2().floor() as i32;
    // A part that may move by its own size would vanish, so the size limits the tolerance.
    let last = power(most.min(size));
    let first = power(FIRST * size).min(last + 1 - LEAST);
    let mut chain = Vec::new();
    for tolerance in (first..=last).map(|k| f64::from(k).exp2()) {
        fewer = fewer.simplify(tolerance);
        let Some(result) = indexed(&fewer, mesh.tolerance) else { break };
        chain.push((tolerance, result));
    }
    drop(fewer);
    let near_enough = |result: &Indexed| {
        let deviation = one_sided(mesh, result, most);
        let deviation =
            if deviation > most { deviation } else { deviation.max(one_sided(result, mesh, most)) };
        let is_sound = || check::problems(result, &Sides::of(&result.triangles)).is_empty();
        (deviation <= most && is_sound()).then_some(deviation)
    };
    while let Some((tolerance, result)) = chain.pop() {
        let Some(deviation) = near_enough(&result) else { continue };
        // Twice as much was too much; half of that may do.
        let tolerance = tolerance * std::f64::consts::SQRT_2;
        let farther = manifold(&result).filter(|_| tolerance <= most).map(|whole| whole.simplify(tolerance));
        let farther = farther.and_then(|fewer| indexed(&fewer, mesh.tolerance));
        let farther =
            farther.and_then(|mesh| near_enough(&mesh).map(|deviation| Simplified { mesh, deviation }));
        return Ok(farther.unwrap_or(Simplified { mesh: result, deviation }));
    }
    Err(refused())
}

/// The library's form of a mesh, if it takes it for a solid.
fn manifold(mesh: &Indexed) -> Option<Manifold> {
    let given = MeshGL64 {
        num_prop: 3,
        vert_properties: mesh.vertices.iter().flat_map(DVec3::to_array).collect(),
        tri_verts: mesh.triangles.iter().flatten().map(|k| u64::from(*k)).collect(),
        ..MeshGL64::default()
    };
    let whole = Manifold::from_mesh_gl64(&given);
    (whole.status() == Error::NoError).then_some(whole)
}

/// Ours of the library's, if there is anything left.
fn indexed(results: &Manifold, tolerance: f64) -> Option<Indexed> {
    let is_solid = results.status() == Error::NoError && !results.is_empty();
    is_solid.then(|| Indexed::made(&results.get_mesh_gl64(-1), tolerance))
}
