//! Basins of heights over a lattice, with the climb needed to leave each.
//!
//! ```text
//!      ────┐        ┌──── pass           climb of A = pass − height of A: to the outside, or to a deeper basin
//!          │  ┌──┐  │
//!          └──┘B └A─┘
//! ```
//!
//! Points are flooded from low to high. If two basins meet, the shallower basin ends: its climb is the level of
//! the meeting minus its lowest height. Points with nothing below, and points beyond the lattice, are
//! outlets.

use super::height::NOTHING;

/// A basin: its lowest point, and the climb out of it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Basin {
    pub(super) at: usize,
    pub(super) climb: f32,
}

/// A point that is not flooded yet.
const NONE: u32 = u32::MAX;

/// The point that stands for a basin.
fn root(parent: &mut [u32], mut k: u32) -> u32 {
    while parent[k as usize] != k {
        let next = parent[parent[k as usize] as usize];
        parent[k as usize] = next;
        k = next;
    }
    k
}

/// The basins of a lattice of this width, highest climb first.
pub(super) fn basins(z: &[f32], wide: usize, least: f32) -> Vec<Basin> {
    let deep = z.len() / wide;
    let mut order: Vec<u32> = (0..z.len() as u32).filter(|k| z[*k as usize] > NOTHING).collect();
    order.sort_unstable_by(|a, b| z[*a as usize].total_cmp(&z[*b as usize]));
    // The outside is an extra point, the lowest of all.
    let outside = z.len();
    let mut parent: Vec<u32> = vec![NONE; z.len() + 1];
    // The lowest point of each root.
    let mut lowest: Vec<u32> = (0..=z.len() as u32).collect();
    parent[outside] = outside as u32;
    let level = |k: u32| if k as usize == outside { NOTHING } else { z[k as usize] };
    let mut result = Vec::new();
    for k in order {
        let (i, j) = (k as usize % wide, k as usize / wide);
        parent[k as usize] = k;
        let mut own = k;
        for (di, dj) in [(-1, 0), (1, 0), (0, -1), (0, 1), (-1, -1), (1, -1), (-1, 1), (1, 1)] {
            let inside = i.checked_add_signed(di).filter(|i| *i < wide);
            let inside = inside.zip(j.checked_add_signed(dj).filter(|j| *j < deep));
            let other = inside.map_or(outside, |(i, j)| j * wide + i);
            let other = if other < outside && z[other] == NOTHING { outside } else { other };
            if parent[other] == NONE {
                continue;
            }
            let other = root(&mut parent, other as u32);
            if other == own {
                continue;
            }
            let (a, b) = (lowest[own as usize], lowest[other as usize]);
            let (keep, end, deeper, ends) =
                if level(a) < level(b) { (own, other, a, b) } else { (other, own, b, a) };
            let climb = z[k as usize] - level(ends);
            if climb >= least {
                result.push(Basin { at: ends as usize, climb });
            }
            parent[end as usize] = keep;
            lowest[keep as usize] = deeper;
            own = keep;
        }
    }
    result.sort_by(|a, b| b.climb.total_cmp(&a.climb));
    result
}
