//! Edges that more than two triangles share, for example if solids touch along an edge.
//!
//! ```text
//!          D                       Seen along the edge a → b, by angle, counter-clockwise. U runs along it from a to b and has
//!      air │ ░ solid               its solid on the clockwise side, D runs back and has it on the other: solid lies from each D
//!     U ───●─── U                  to the next U. Each such wedge becomes a sheet of its own: its two triangles are neighbours,
//!    solid ░ │ air                 and each fan of triangles gets its own copy of the corners.
//!            D
//! ```
//!
//! If both ends of an edge belong to the same fan, as when a solid touches itself only along that edge, each
//! wedge receives its own corner at the edge's midpoint. No corner moves. Not promised: edges around which U
//! and D do not alternate remain, for example if triangles lie on each other.

use crate::mesh::indexed::Indexed;
use crate::mesh::sides::{Side, Sides};
use catchment_base::disjoint::DisjointSets;
use catchment_base::tolerance;
use glam::DVec3;
use std::f64::consts::TAU;

/// Angles closer than this, in radians, are in no order: the rounding of single precision over a sliver.
const SAME: f64 = tolerance::SINGLE;
/// Most passes of cutting edges in the middle.
const PASSES: usize = 16;

/// Parts crowded edges; how many.
pub(in crate::mesh) fn part(mesh: &mut Indexed) -> usize {
    let sides = Sides::of(&mesh.triangles);
    let crowded: Vec<&[Side]> = sides.edges().filter(|sides| sides.len() > 2).collect();
    if crowded.is_empty() {
        return 0;
    }
    let mut ends = vec![false; mesh.vertices.len()];
    let mut fans = DisjointSets::new(3 * mesh.triangles.len());
    let mut parted = 0;
    for sides in sides.edges() {
        if sides.len() == 2 {
            join(&mut fans, mesh, sides[0], sides[1]);
            continue;
        }
        let Some(pairs) = wedges(mesh, sides).filter(|_| sides.len() > 2) else { continue };
        parted += 1;
        sides[0].edge.iter().for_each(|end| ends[*end as usize] = true);
        for [down, up] in pairs {
            join(&mut fans, mesh, down, up);
        }
    }
    // Corners of crowded edges that could not be separated stay merged.
    for sides in crowded.iter().filter(|sides| wedges(mesh, sides).is_none()) {
        sides[0].edge.iter().for_each(|end| ends[*end as usize] = false);
    }
    // The first fan of a corner keeps it.
    let mut owner: Vec<u32> = vec![u32::MAX; mesh.vertices.len()];
    let mut given: Vec<u32> = vec![u32::MAX; 3 * mesh.triangles.len()];
    for k in 0..mesh.triangles.len() {
        for slot in 0..3 {
            let corner = mesh.triangles[k][slot] as usize;
            if !ends.get(corner).copied().unwrap_or_default() {
                continue;
            }
            let fan = fans.find((3 * k + slot) as u32) as usize;
            if given[fan] == u32::MAX {
                given[fan] = if owner[corner] == u32::MAX {
                    owner[corner] = fan as u32;
                    corner as u32
                } else {
                    mesh.vertices.push(mesh.vertices[corner]);
                    mesh.vertices.len() as u32 - 1
                };
            }
            mesh.triangles[k][slot] = given[fan];
        }
    }
    for _ in 0..PASSES {
        if !cut_in_the_middle(mesh) {
            break;
        }
    }
    parted
}

/// Joins the triangles on either side of an edge in the fans at both of its ends.
fn join(fans: &mut DisjointSets, mesh: &Indexed, a: Side, b: Side) {
    for end in a.edge {
        let slot = |side: Side| {
            let t = mesh.triangles[side.triangle as usize];
            3 * side.triangle + t.iter().position(|corner| *corner == end).unwrap_or_default() as u32
        };
        fans.join(slot(a), slot(b));
    }
}

/// The pairs of sides that enclose solid around an edge, the side that runs down first; `None` if they do not
/// alternate.
fn wedges(mesh: &Indexed, sides: &[Side]) -> Option<Vec<[Side; 2]>> {
    let [a, b] = sides.first()?.edge.map(|end| mesh.at(end));
    let along = (b - a).try_normalize()?;
    let (right, up) = along.any_orthonormal_pair();
    let angle = |side: &Side| {
        let t = mesh.triangles[side.triangle as usize];
        let apex = t.into_iter().find(|corner| !side.edge.contains(corner))?;
        let out: DVec3 = mesh.at(apex) - a;
        Some(out.dot(up).atan2(out.dot(right)))
    };
    let mut order: Vec<(f64, Side)> =
        sides.iter().map(|side| Some((angle(side)?, *side))).collect::<Option<_>>()?;
    order.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
    let count = order.len();
    let gap = |k: usize| (order[(k + 1) % count].0 - order[k].0).rem_euclid(TAU);
    let alternate = (0..count).all(|k| order[k].1.is_up != order[(k + 1) % count].1.is_up && gap(k) > SAME);
    if !alternate || count % 2 == 1 {
        return None;
    }
    let first = order.iter().position(|(_, side)| !side.is_up)?;
    Some((0..count / 2).map(|k| [0, 1].map(|n| order[(first + 2 * k + n) % count].1)).collect())
}

/// Gives each wedge around an edge that is still crowded a corner of its own in the middle; whether there was any.
fn cut_in_the_middle(mesh: &mut Indexed) -> bool {
    let sides = Sides::of(&mesh.triangles);
    let mut is_changed = vec![false; mesh.triangles.len()];
    let mut any = false;
    for sides in sides.edges().filter(|sides| sides.len() > 2) {
        let Some(pairs) = wedges(mesh, sides) else { continue };
        if sides.iter().any(|side| is_changed[side.triangle as usize]) {
            continue;
        }
        any = true;
        let [a, b] = sides[0].edge.map(|end| mesh.at(end));
        for pair in pairs {
            let middle = mesh.vertices.len() as u32;
            mesh.vertices.push(a.midpoint(b));
            for side in pair {
                let k = side.triangle as usize;
                is_changed[k] = true;
                let [from, to] = if side.is_up { side.edge } else { [side.edge[1], side.edge[0]] };
                let whole = mesh.triangles[k];
                mesh.triangles[k] = whole.map(|corner| if corner == to { middle } else { corner });
                mesh.triangles.push(whole.map(|corner| if corner == from { middle } else { corner }));
                mesh.places.push(mesh.places[k]);
            }
        }
    }
    any
}
