//! Content of a half given in memory: a digest of its triangles' corners.

use crate::Surface;
use catchment_design::design::MeshContent;
use glam::DVec3;

/// Of loose triangles: nine numbers each, in D, as little-endian doubles.
pub(super) fn of_triangles(triangles: &[[DVec3; 3]]) -> MeshContent {
    // −0 and 0 are the same place: adding 0 makes them the same bytes.
    let numbers = triangles.iter().flatten().flat_map(DVec3::to_array);
    let bytes: Vec<u8> = numbers.flat_map(|number| (number + 0.0).to_le_bytes()).collect();
    MeshContent::of(&bytes, triangles.len())
}

/// Of a surface: its facets cut into triangles.
pub(super) fn of_surface(surface: &Surface) -> MeshContent {
    let corners = |triangle: [u32; 3]| triangle.map(|k| surface.vertices[k as usize]);
    of_triangles(&surface.triangles().into_iter().map(corners).collect::<Vec<_>>())
}
