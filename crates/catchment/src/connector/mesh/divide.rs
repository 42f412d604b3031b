//! Edges that one neighbour divides and the other does not.
//!
//! ```text
//!        c                    c
//!       ╱ ╲                  ╱│╲
//!      ╱   ╲       ──▶      ╱ │ ╲        p, a corner of the neighbours, lies on the edge from a to b: the triangle
//!     a──p──b              a──p──b       is divided there, and the neighbours share its edges
//!      ╲ │ ╱                ╲ │ ╱
//! ```
//!
//! Subdivision of single faces leaves such edges. Nothing moves: p counts as on the edge where welding would have joined it with a corner there.
//!
//! Not promised: anything for meshes with more open edges than [`MOST`], which are no solids.

use super::Triangle;
use super::check::{Sides, sides};
use glam::DVec3;

/// Most open edges that are looked at: each is compared with the ends of all others.
const MOST: usize = 4096;
/// Most passes: one divides one edge of a triangle.
const PASSES: usize = 3;

/// Divides triangles along edges that nothing else shares as a whole, at corners of other such edges on them; who shares which edge then.
pub(super) fn divide(
    triangles: &mut Vec<Triangle>,
    indexed: &mut Vec<[u32; 3]>,
    vertices: &[DVec3],
    tolerance: f64,
) -> Sides {
    let mut shared = sides(indexed);
    for _ in 0..PASSES {
        let open: Vec<([u32; 2], usize)> = shared
            .iter()
            .filter(|(_, owners)| owners.len() == 1)
            .map(|(edge, owners)| (*edge, owners[0].0))
            .take(MOST + 1)
            .collect();
        if open.is_empty() || open.len() > MOST {
            break;
        }
        let mut ends: Vec<u32> = open.iter().flat_map(|(edge, _)| *edge).collect();
        ends.sort_unstable();
        ends.dedup();
        let mut is_done = vec![false; indexed.len()];
        let mut any = false;
        for (edge, owner) in open {
            if std::mem::replace(&mut is_done[owner], true) {
                continue;
            }
            let triangle = indexed[owner];
            // As the triangle has it: from a to b, across from c.
            let k = (0..3).find(|&k| edge.contains(&triangle[k]) && edge.contains(&triangle[(k + 1) % 3]));
            let Some(k) = k else { continue };
            let [a, b, c] = [triangle[k], triangle[(k + 1) % 3], triangle[(k + 2) % 3]];
            let on = on_edge([a, b], &ends, vertices, tolerance);
            if on.is_empty() {
                is_done[owner] = false;
                continue;
            }
            any = true;
            let stops: Vec<u32> = std::iter::once(a).chain(on).chain([b]).collect();
            let place = triangles[owner].place;
            for (n, pair) in stops.windows(2).enumerate() {
                let part = [pair[0], pair[1], c];
                let piece = Triangle { corners: part.map(|v| vertices[v as usize]), place };
                if n == 0 {
                    (indexed[owner], triangles[owner]) = (part, piece);
                } else {
                    indexed.push(part);
                    triangles.push(piece);
                }
            }
        }
        if !any {
            break;
        }
        shared = sides(indexed);
    }
    shared
}

/// Those of `ends` that lie between the ends of an edge, on it, in their order from its first.
fn on_edge([a, b]: [u32; 2], ends: &[u32], vertices: &[DVec3], tolerance: f64) -> Vec<u32> {
    let (from, to) = (vertices[a as usize], vertices[b as usize]);
    let Some(along) = (to - from).try_normalize() else { return Vec::new() };
    let length = (to - from).dot(along);
    let mut found: Vec<(f64, u32)> = ends
        .iter()
        .filter_map(|&p| {
            let to_p = vertices[p as usize] - from;
            let at = to_p.dot(along);
            let beside = (to_p - along * at).length();
            (at > tolerance && at < length - tolerance && beside <= tolerance).then_some((at, p))
        })
        .collect();
    found.sort_by(|x, y| x.0.total_cmp(&y.0));
    found.into_iter().map(|(_, p)| p).collect()
}
