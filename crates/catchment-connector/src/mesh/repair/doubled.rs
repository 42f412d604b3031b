//! Triangles with coinciding corners, and duplicate triangles on the same three corners.
//!
//! A triangle with two coinciding corners has no area, and its sides cancel: without it the rest of the mesh
//! still meets. Triangles of opposite winding on the same corners cancel, because a sheet without thickness
//! bounds nothing; of the remaining duplicates only the first is kept.

use crate::mesh::indexed::Indexed;

/// Number of removed triangles.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Dropped {
    pub(super) without_area: usize,
    pub(super) doubled: usize,
}

/// Drops both kinds.
pub(super) fn drop(mesh: &mut Indexed) -> Dropped {
    let triangles = std::mem::take(&mut mesh.triangles);
    let is_point_or_line = |t: [u32; 3]| t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
    let lines: Vec<bool> = triangles.iter().map(|t| is_point_or_line(*t)).collect();
    mesh.triangles = triangles;
    let without_area = mesh.retain(|k| !lines[k]);
    let mut order: Vec<([u32; 3], bool, u32)> = mesh
        .triangles
        .iter()
        .enumerate()
        .map(|(k, t)| {
            let mut sorted = *t;
            sorted.sort_unstable();
            let first = t.iter().position(|c| *c == sorted[0]).unwrap_or_default();
            (sorted, t[(first + 1) % 3] == sorted[1], k as u32)
        })
        .collect();
    order.sort_unstable();
    let mut keep = vec![true; mesh.triangles.len()];
    for same in order.chunk_by(|a, b| a.0 == b.0).filter(|same| same.len() > 1) {
        let forward = same.iter().filter(|(_, is_forward, _)| *is_forward).count();
        let backward = same.len() - forward;
        // The first of the winding that prevails.
        let stays = same.iter().find(|(_, is_forward, _)| *is_forward == (forward > backward));
        for (_, _, k) in same {
            keep[*k as usize] = forward != backward && stays.is_some_and(|(_, _, stays)| stays == k);
        }
    }
    let doubled = mesh.retain(|k| keep[k]);
    Dropped { without_area, doubled }
}
