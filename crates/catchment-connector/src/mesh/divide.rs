//! Edges that are divided in one neighbouring triangle but not in the other.
//!
//! ```text
//!        c                    c
//!       ╱ ╲                  ╱│╲
//!      ╱   ╲       ──▶      ╱ │ ╲        p, a corner of the neighbours, lies on the edge from a to b: the triangle
//!     a──p──b              a──p──b       is divided there, and the neighbours share its edges
//!      ╲ │ ╱                ╲ │ ╱
//! ```
//!
//! Subdivision of single faces leaves such edges. No corner moves: p counts as on the edge if welding would
//! have merged it with a corner there.
//!
//! Not promised: meshes with more than [`MOST`] open edges are not repaired; they are not solids.

use super::indexed::Indexed;
use super::sides::Sides;

/// Largest number of open edges that are tested: each is compared with the ends of all others.
const MOST: usize = 4096;
/// Largest number of passes: each pass divides one edge of a triangle.
const PASSES: usize = 3;

/// Divides triangles along edges that nothing else shares as a whole, at corners of other such edges on them; who shares which edge then.
pub(super) fn divide(mesh: &mut Indexed) -> Sides {
    let mut shared = Sides::of(&mesh.triangles);
    for _ in 0..PASSES {
        let open: Vec<([u32; 2], usize)> = shared
            .edges()
            .filter(|sides| sides.len() == 1)
            .map(|sides| (sides[0].edge, sides[0].triangle as usize))
            .take(MOST + 1)
            .collect();
        if open.is_empty() || open.len() > MOST {
            break;
        }
        let mut ends: Vec<u32> = open.iter().flat_map(|(edge, _)| *edge).collect();
        ends.sort_unstable();
        ends.dedup();
        let mut is_done = vec![false; mesh.triangles.len()];
        let mut any = false;
        for (edge, owner) in open {
            if std::mem::replace(&mut is_done[owner], true) {
                continue;
            }
            let triangle = mesh.triangles[owner];
            // As the triangle has it: from a to b, across from c.
            let k = (0..3).find(|&k| edge.contains(&triangle[k]) && edge.contains(&triangle[(k + 1) % 3]));
            let Some(k) = k else { continue };
            let [a, b, c] = [triangle[k], triangle[(k + 1) % 3], triangle[(k + 2) % 3]];
            let on = on_edge([a, b], &ends, mesh);
            if on.is_empty() {
                is_done[owner] = false;
                continue;
            }
            any = true;
            let stops: Vec<u32> = std::iter::once(a).chain(on).chain([b]).collect();
            for (n, pair) in stops.windows(2).enumerate() {
                let part = [pair[0], pair[1], c];
                if n == 0 {
                    mesh.triangles[owner] = part;
                } else {
                    mesh.triangles.push(part);
                    mesh.places.push(mesh.places[owner]);
                }
            }
        }
        if !any {
            break;
        }
        shared = Sides::of(&mesh.triangles);
    }
    shared
}

/// Those of `ends` that lie between the ends of an edge, on it, in their order from its first.
fn on_edge([a, b]: [u32; 2], ends: &[u32], mesh: &Indexed) -> Vec<u32> {
    let (from, to, tolerance) = (mesh.at(a), mesh.at(b), mesh.tolerance);
    let Some(along) = (to - from).try_normalize() else { return Vec::new() };
    let length = (to - from).dot(along);
    let mut result: Vec<(f64, u32)> = ends
        .iter()
        .filter_map(|&p| {
            let to_p = mesh.at(p) - from;
            let at = to_p.dot(along);
            let beside = (to_p - along * at).length();
            (at > tolerance && at < length - tolerance && beside <= tolerance).then_some((at, p))
        })
        .collect();
    result.sort_by(|x, y| x.0.total_cmp(&y.0));
    result.into_iter().map(|(_, p)| p).collect()
}
