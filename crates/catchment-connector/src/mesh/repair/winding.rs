//! Consistent winding of all triangles of a shell, and orientation of shells.
//!
//! Neighbours across an edge with exactly two triangles run along it in opposite directions: a flood over
//! those edges determines for each triangle whether its winding agrees with that of the first triangle of its
//! shell. A shell with mixed windings is then oriented so that it encloses a positive volume, or a negative
//! volume if it lies in an odd number of other shells, as a cavity does. A shell with consistent winding is
//! kept, unless it lies in no other shell and its volume is negative.
//!
//! Not promised: single-sided shells (a Möbius band) remain, and are rejected.

use crate::mesh::indexed::Indexed;
use crate::mesh::shells;
use crate::mesh::sides::Sides;

/// Turns triangles over; how many.
pub(super) fn unify(mesh: &mut Indexed, sides: &Sides) -> usize {
    let count = mesh.triangles.len();
    let mut is_turned = vec![false; count];
    let is_mixed = sides.edges().any(|s| s.len() == 2 && s[0].is_up == s[1].is_up);
    if is_mixed && !flood(count, sides, &mut is_turned) {
        return 0;
    }
    turn(mesh, &is_turned);
    let shells = shells::of(mesh, sides);
    let turn_whole: Vec<bool> = shells
        .iter()
        .map(|shell| {
            let turned = shell.triangles.iter().filter(|k| is_turned[**k as usize]).count();
            let is_mixed = turned > 0;
            if shell.volume > 0.0 && !is_mixed {
                return false;
            }
            let depth = shells::depth(mesh, &shells, shell);
            if is_mixed {
                (shell.volume > 0.0) != depth.is_multiple_of(2)
            } else {
                depth == 0 && shell.volume < 0.0
            }
        })
        .collect();
    let mut whole = vec![false; count];
    for (shell, _) in shells.iter().zip(&turn_whole).filter(|(_, turn)| **turn) {
        shell.triangles.iter().for_each(|k| whole[*k as usize] = true);
    }
    turn(mesh, &whole);
    is_turned.iter().zip(&whole).filter(|(a, b)| a != b).count()
}

fn turn(mesh: &mut Indexed, which: &[bool]) {
    mesh.triangles.iter_mut().zip(which).filter(|(_, turn)| **turn).for_each(|(t, _)| t.swap(1, 2));
}

/// Finds the triangles with the opposite winding to the first of their shell; `false` for a single-sided
/// shell.
fn flood(count: usize, sides: &Sides, is_turned: &mut [bool]) -> bool {
    // Of each triangle its neighbours, and whether they are wound unlike it.
    let mut neighbours: Vec<[(u32, bool); 3]> = vec![[(u32::MAX, false); 3]; count];
    let mut add = |of: u32, other: u32, unlike: bool| {
        if let Some(free) = neighbours[of as usize].iter_mut().find(|n| n.0 == u32::MAX) {
            *free = (other, unlike);
        }
    };
    for sides in sides.edges() {
        if let [a, b] = sides {
            let unlike = a.is_up == b.is_up;
            add(a.triangle, b.triangle, unlike);
            add(b.triangle, a.triangle, unlike);
        }
    }
    let mut is_seen = vec![false; count];
    let mut left = Vec::new();
    for first in 0..count as u32 {
        if std::mem::replace(&mut is_seen[first as usize], true) {
            continue;
        }
        left.push(first);
        while let Some(k) = left.pop() {
            for (other, unlike) in neighbours[k as usize] {
                if other == u32::MAX {
                    continue;
                }
                let wanted = is_turned[k as usize] != unlike;
                if std::mem::replace(&mut is_seen[other as usize], true) {
                    if is_turned[other as usize] != wanted {
                        is_turned.fill(false);
                        return false;
                    }
                } else {
                    is_turned[other as usize] = wanted;
                    left.push(other);
                }
            }
        }
    }
    true
}
