//! The union of closed surfaces as one closed, oriented surface: no inner walls, no T-junctions.
//!
//! ```text
//!   ┌─────┬───┐        ┌─────────┐      In the plane of each facet, per solid: the facet minus the area that the other
//!   │  A  │ B │        │         │      solids fill just above it, minus the area of an earlier solid in the same face.
//!   │  ┌──┼─┐ │  ──▶   │         │
//!   └──┼──┘ ├─┘        └──┐   ┌──┘      ∂(A ∪ B ∪ …) = ⋃ facets F:  F \ ⋃ₜ (T ∩ plane of F, seen from above)
//!      └────┘             └───┘
//! ```
//!
//! ```text
//! corners ──weld──▶ planes ──section, overlay──▶ rest of each facet ──stitch──▶ faces ──triangles──▶ polygons ──verify──▶ Surface
//! ```
//!
//! Coordinates written with a few decimals abut only to rounding, and planes through rounded corners meet in
//! no common point. Equality is therefore decided once, with a tolerance w, before any cut: corners closer
//! than w are merged, corners closer than 2w to a plane lie in it, and all later steps use these decisions.
//! Cuts within a plane are decided in integers (`i_overlay`, 64 bits). Every edge is then divided at all
//! corners on it, and opposite edges of two facets cancel, which removes slivers.
//!
//! The result is verified: it must close, must not cross itself, and must separate inside from outside as the
//! given solids do, at points on both sides of its own facets and of the given facets. A failed union is
//! repeated with other tolerances, and then rejected with its place.
//!
//! Solids that share no area and no volume remain separate surfaces, bit for bit. Not promised: details
//! smaller than w may vanish.

mod faces;
mod overlay;
mod planes;
mod section;
mod stitch;
mod verify;

use super::indexed::Indexed;
use super::polygons;
use super::repair::part_crowded;
use super::{FileOffset, MeshPoint, TriangleLocation};
use crate::{Surface, SurfaceError};
use catchment_base::exec::{Cancelled, Exec};
use glam::DVec3;
use planes::Model;

/// The tolerance w, as a share of the largest coordinate, for coordinates in double precision or with eight decimals.
pub(crate) const EXACT: f64 = 1e-8;
/// The same for coordinates from files in single precision, whose rounding is 6e-8.
pub(crate) const SINGLE: f64 = 2e-7;
/// Tolerances that are tried, as multiples of the base: thin features may need a smaller one, coordinates
/// with few digits larger ones.
const TRIED: [f64; 4] = [1.0, 0.1, 10.0, 100.0];
/// The largest tolerance that is tried: that of welding the corners of a mesh.
const LARGEST: f64 = 1.001 * super::WELD;

/// Why solids have no union that holds.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum UnionProblem {
    /// Its facets do not close.
    #[error("{}", explained("does not close", .at))]
    Open {
        /// Position.
        at: MeshPoint,
    },
    /// The border of a face crosses itself.
    #[error("{}", explained("has a face that crosses itself", .at))]
    Tangled {
        /// Position.
        at: MeshPoint,
    },
    /// Facets pass through each other.
    #[error("{}", explained("crosses itself", .at))]
    Crossed {
        /// Position.
        at: MeshPoint,
    },
    /// It encloses another region than the solids fill.
    #[error("{}", explained("encloses something else than they fill", .at))]
    Differs {
        /// Position.
        at: MeshPoint,
    },
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

fn explained(what: &str, at: &MeshPoint) -> String {
    format!(
        "the union of its solids {what} near {at}: let them overlap clearly there or share whole faces, or give one closed mesh"
    )
}

/// The union of closed surfaces (in D) as surfaces that share no area and no volume, in the order of their first solids.
///
/// `exactness` is [`EXACT`] or [`SINGLE`].
///
/// # Errors
/// No tolerance gives a valid union; with the place at which the first one fails.
pub(crate) fn united(
    surfaces: &[Surface],
    exactness: f64,
    exec: &Exec,
) -> Result<Vec<Surface>, UnionProblem> {
    if surfaces.len() < 2 {
        return Ok(surfaces.to_vec());
    }
    let size = surfaces
        .iter()
        .flat_map(|surface| &surface.vertices)
        .fold(0.0, |size: f64, p| size.max(p.abs().max_element()));
    let mut first = None;
    for times in TRIED.into_iter().filter(|times| times * exactness <= LARGEST) {
        match attempt(surfaces, times * exactness * size, exec) {
            Err(UnionProblem::Cancelled(cancelled)) => return Err(cancelled.into()),
            Err(problem) => first = first.or(Some(problem)),
            Ok(union) => return Ok(union),
        }
    }
    Err(first.unwrap_or(UnionProblem::Open { at: DVec3::ZERO.into() }))
}

/// The union with a given tolerance.
fn attempt(surfaces: &[Surface], w: f64, exec: &Exec) -> Result<Vec<Surface>, UnionProblem> {
    let mut model = Model::of(surfaces, w);
    let left = overlay::left(&mut model, exec)?;
    let mut clusters = left.joined;
    let roots: Vec<u32> = (0..surfaces.len() as u32).map(|solid| clusters.find(solid)).collect();
    let is_alone = |solid: u32| roots.iter().filter(|root| **root == roots[solid as usize]).count() == 1;
    let cluster = |solid: u32| (!is_alone(solid)).then(|| roots[solid as usize]);
    let stitched = stitch::stitched(&mut model, left.loops, cluster)?;
    let mut united = Vec::new();
    for root in (0..surfaces.len() as u32).filter(|solid| roots[*solid as usize] == *solid) {
        exec.check()?;
        if is_alone(root) {
            united.push(surfaces[root as usize].clone());
            continue;
        }
        let mut triangles = Vec::new();
        for face in stitched.iter().filter(|face| face.cluster == root) {
            triangles.extend(faces::triangles(&model, face)?);
        }
        let members: Vec<&Surface> =
            surfaces.iter().zip(&roots).filter(|(_, r)| **r == root).map(|(surface, _)| surface).collect();
        united.push(surface(&model.points, triangles, &members, w)?);
    }
    Ok(united)
}

/// Corners of a facet may lie off its plane and its lines by this share of w and still be merged: the rounding of written decimals.
const FLAT: f64 = 0.1;

/// The surface that triangles bound, if it is the union of `solids`.
fn surface(
    points: &[DVec3],
    triangles: Vec<[u32; 3]>,
    solids: &[&Surface],
    w: f64,
) -> Result<Surface, UnionProblem> {
    let somewhere = triangles.first().map_or(DVec3::ZERO, |t| points[t[0] as usize]);
    let places =
        (0..triangles.len()).map(|triangle| TriangleLocation { triangle, start: FileOffset::Made }).collect();
    let mut mesh = Indexed { vertices: points.to_vec(), triangles, places, tolerance: stitch::SPLIT * w };
    mesh.compact();
    part_crowded(&mut mesh);
    if let Some(crossing) = super::crossing::crossings(&mesh, 1).0.first() {
        return Err(UnionProblem::Crossed { at: crossing.at.into() });
    }
    verify::holds(&mesh, solids, w)?;
    let (vertices, polygons) = polygons::of(&mesh, FLAT * w);
    Surface::from_polygons(vertices, &polygons).map_err(|error| {
        let at = match error {
            SurfaceError::Open { from, to } | SurfaceError::NonManifold { from, to } => from.midpoint(to),
            SurfaceError::ZeroArea { .. } | SurfaceError::InsideOut { .. } => somewhere,
        };
        UnionProblem::Open { at: at.into() }
    })
}

#[cfg(test)]
mod tests;
