//! Lids: sheets without thickness that close a hole of a body.
//!
//! ```text
//!   ░░░░░│     │░░░░░      Seen from the side: a hole through a plate, and a lid that an export left across its mouth. Along the rim three
//!   ░░░░░│     │░░░░░      triangles meet, two of the body and one of the lid. The body closes without the lid, and a sheet without
//!   ░░░░░╰┄┄┄┄┄╯░░░░░      thickness bounds nothing.
//! ```
//!
//! Triangles belong to the same patch if exactly two of them share an edge. A patch is a lid if every edge of
//! its border has three sides and the other two belong to a single patch, the same along the whole border.
//!
//! Not promised: if three patches meet along a rim, as over a blind hole, any two of them bound a solid, and
//! the mesh is rejected.

use crate::mesh::indexed::Indexed;
use crate::mesh::sides::Sides;
use catchment_base::disjoint::DisjointSets;
use std::collections::BTreeMap;

/// Takes lids away; how many triangles they had.
pub(super) fn drop(mesh: &mut Indexed, sides: &Sides) -> usize {
    if sides.edges().all(|sides| sides.len() != 3) {
        return 0;
    }
    let mut patches = DisjointSets::new(mesh.triangles.len());
    for sides in sides.edges() {
        if let [a, b] = sides {
            patches.join(a.triangle, b.triangle);
        }
    }
    // For each patch on a border, the patch that it lies on; `None` if there is no such patch, or more than
    // one.
    let mut bodies: BTreeMap<u32, Option<u32>> = BTreeMap::new();
    for sides in sides.edges().filter(|sides| sides.len() != 2) {
        let around: Vec<u32> = sides.iter().map(|side| patches.find(side.triangle)).collect();
        for patch in &around {
            let others: Vec<u32> = around.iter().copied().filter(|other| other != patch).collect();
            let body = match others[..] {
                [a, b] if a == b => Some(a),
                _ => None,
            };
            let known = bodies.entry(*patch).or_insert(body);
            if *known != body {
                *known = None;
            }
        }
    }
    let stays: Vec<bool> = (0..mesh.triangles.len() as u32)
        .map(|k| bodies.get(&patches.find(k)).copied().flatten().is_none())
        .collect();
    mesh.retain(|k| stays[k])
}
