//! Triangles without area whose three corners lie on a line.
//!
//! ```text
//!        c                   c
//!       ╱ ╲                 ╱│╲         a, m, b lie on a line: the triangle a b m has no area, and without it the edge a b
//!      ╱   ╲      ──▶      ╱ │ ╲        would be open. Its neighbour across that edge is divided at m instead; every side that
//!     a─────b             a──m──b       was there is there afterwards, in the same sense.
//!      ╲_m_╱
//! ```
//!
//! The triangle with the longest edge is repaired first: the third corner of a flat neighbour then lies
//! between a and b, and its remainder is shorter, so the process ends. The surface moves by the height of the
//! triangle, less than 1e-7 of its length; no corner moves.

use crate::mesh::check::is_flat;
use crate::mesh::indexed::Indexed;
use std::collections::BinaryHeap;

/// Most steps for each flat triangle that there is: far more than ever needed.
const MOST_STEPS: usize = 64;

/// A flat triangle in the queue, the longest first; among equals the first in the file.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Waiting {
    /// Bits of the length of its longest edge: for positive numbers in the order of the lengths.
    length: u64,
    triangle: std::cmp::Reverse<u32>,
}

/// Takes flat triangles away; how many.
pub(super) fn drop(mesh: &mut Indexed) -> usize {
    let mut heap: BinaryHeap<Waiting> =
        (0..mesh.triangles.len()).filter(|&k| is_flat(mesh, k)).map(|k| waiting(mesh, k)).collect();
    if heap.is_empty() {
        return 0;
    }
    let mut left = MOST_STEPS * heap.len();
    let mut around = mesh.around();
    let mut is_gone = vec![false; mesh.triangles.len()];
    let mut count = 0;
    while let Some(Waiting { length, triangle: std::cmp::Reverse(k) }) = heap.pop() {
        let flat = k as usize;
        // It may have changed since it began to wait.
        if is_gone[flat] || !is_flat(mesh, flat) || waiting(mesh, flat).length != length {
            continue;
        }
        if left == 0 {
            break;
        }
        left -= 1;
        count += 1;
        let [a, b, m] = from_longest(mesh, flat);
        is_gone[flat] = true;
        mesh.triangles[flat].iter().for_each(|corner| around[*corner as usize].retain(|t| *t != k));
        if m == a || m == b {
            continue;
        }
        // The neighbour that runs along the edge the other way.
        let other = around[a as usize].iter().copied().find(|t| {
            let [p, q, r] = mesh.triangles[*t as usize];
            [[p, q], [q, r], [r, p]].contains(&[b, a])
        });
        let Some(other) = other else { continue };
        let corners = mesh.triangles[other as usize];
        let Some(c) = corners.into_iter().find(|corner| *corner != a && *corner != b) else { continue };
        if c == m {
            // The neighbour lies on it: both go.
            is_gone[other as usize] = true;
            for corner in corners {
                around[corner as usize].retain(|t| *t != other);
            }
            continue;
        }
        // The first half replaces the neighbour, the second half replaces the flat triangle. Both take the
        // neighbour's place in the file.
        mesh.triangles[other as usize] = [b, m, c];
        mesh.triangles[flat] = [m, a, c];
        mesh.places[flat] = mesh.places[other as usize];
        is_gone[flat] = false;
        around[a as usize].retain(|t| *t != other);
        around[a as usize].push(k);
        around[m as usize].extend([other, k]);
        around[c as usize].push(k);
        for changed in [flat, other as usize] {
            if is_flat(mesh, changed) {
                heap.push(waiting(mesh, changed));
            }
        }
    }
    mesh.retain(|k| !is_gone[k]);
    count
}

fn waiting(mesh: &Indexed, k: usize) -> Waiting {
    let [a, b, _] = from_longest(mesh, k);
    let length = mesh.at(a).distance(mesh.at(b)).to_bits();
    Waiting { length, triangle: std::cmp::Reverse(k as u32) }
}

/// The corners of a triangle, in its sense, its longest edge between the first two.
fn from_longest(mesh: &Indexed, k: usize) -> [u32; 3] {
    let t = mesh.triangles[k];
    let length = |i: usize| mesh.at(t[i]).distance_squared(mesh.at(t[(i + 1) % 3]));
    let longest = (0..3).max_by(|&i, &j| length(i).total_cmp(&length(j))).unwrap_or_default();
    [t[longest], t[(longest + 1) % 3], t[(longest + 2) % 3]]
}
