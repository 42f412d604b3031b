//! Edges shorter than the welding tolerance, as they arise at crossings of surfaces under small angles.
//!
//! ```text
//!      c               c            The edge from a to b is removed, with the two triangles next to it; triangles at b
//!     ╱ ╲              │            move to a. This requires that a and b have no common neighbours except c and d, so that
//!    a───b     ──▶     a            the topology is unchanged, and that no other triangle is turned over.
//!     ╲ ╱              │
//!      d               d
//! ```
//!
//! The surface moves by less than the tolerance of the mesh. Not promised: edges that cannot be removed
//! remain.

use crate::mesh::indexed::Indexed;
use glam::DVec3;

/// Collapses short edges; how many.
pub(super) fn collapse(mesh: &mut Indexed) -> usize {
    let is_short = |mesh: &Indexed, a: u32, b: u32| mesh.at(a).distance(mesh.at(b)) < mesh.tolerance;
    let any = mesh.triangles.iter().any(|t| (0..3).any(|k| is_short(mesh, t[k], t[(k + 1) % 3])));
    if !any {
        return 0;
    }
    let mut around = mesh.around();
    let mut is_gone = vec![false; mesh.triangles.len()];
    let mut count = 0;
    for k in 0..mesh.triangles.len() {
        for side in 0..3 {
            let t = mesh.triangles[k];
            let [a, b] = [t[side], t[(side + 1) % 3]];
            if is_gone[k] || !is_short(mesh, a, b) {
                continue;
            }
            // Either end may go; the first that can does.
            if let Some((stays, goes)) =
                [(a, b), (b, a)].into_iter().find(|(stays, goes)| may_go(mesh, &around, *stays, *goes))
            {
                count += 1;
                for t in std::mem::take(&mut around[goes as usize]) {
                    let corners = &mut mesh.triangles[t as usize];
                    if corners.contains(&stays) {
                        is_gone[t as usize] = true;
                        corners
                            .iter()
                            .filter(|corner| **corner != goes)
                            .for_each(|corner| around[*corner as usize].retain(|other| *other != t));
                    } else {
                        *corners = corners.map(|corner| if corner == goes { stays } else { corner });
                        around[stays as usize].push(t);
                    }
                }
            }
        }
    }
    mesh.retain(|k| !is_gone[k]);
    count
}

/// Whether a given end of an edge may be moved to the other.
fn may_go(mesh: &Indexed, around: &[Vec<u32>], stays: u32, goes: u32) -> bool {
    let neighbours = |of: u32| {
        let mut list: Vec<u32> = around[of as usize]
            .iter()
            .flat_map(|t| mesh.triangles[*t as usize])
            .filter(|v| *v != of)
            .collect();
        list.sort_unstable();
        list.dedup();
        list
    };
    let (of_stays, of_goes) = (neighbours(stays), neighbours(goes));
    let common = of_goes.iter().filter(|v| of_stays.binary_search(v).is_ok()).count();
    let beside =
        around[goes as usize].iter().filter(|t| mesh.triangles[**t as usize].contains(&stays)).count();
    if beside != 2 || common != 2 {
        return false;
    }
    around[goes as usize].iter().map(|t| mesh.triangles[*t as usize]).filter(|t| !t.contains(&stays)).all(
        |t| {
            let before = normal(t.map(|corner| mesh.at(corner)));
            let after = normal(t.map(|corner| mesh.at(if corner == goes { stays } else { corner })));
            // A triangle thinner than the tolerance has no normal to preserve.
            let longest = (0..3).map(|k| mesh.at(t[k]).distance(mesh.at(t[(k + 1) % 3]))).fold(0.0, f64::max);
            let sliver = before.length() <= 2.0 * mesh.tolerance * longest;
            sliver || before.dot(after) > 0.0
        },
    )
}

fn normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a)
}
