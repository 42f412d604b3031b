//! The relevant passes between basins: a minimum spanning tree over all of them.
//!
//! Two cells are neighbours if some unit cube of 2ⁿ cells contains both, and the pass over them has the
//! height of the higher cell. Within a cube all cells are neighbours, so a knock-out tournament finds all
//! relevant passes: each cell loses once, to a lower cell, and the games connect all cells of the cube at the
//! same heights as their neighbourhood does. Cubes share their early games: n games per cell instead of (3ⁿ −
//! 1)/2 neighbours.
//!
//! ```text
//!   3 ─ 7      games: 3–7, 5–4, then 3–4, in which 7, 5 and 4 lose: passes of height 7, 5 and 4.
//!   5 ─ 4      The neighbours 7 and 5 are connected at height 7 nevertheless: 7 ▸ 3 ▸ 4 ◂ 5.
//! ```
//!
//! Of all games between different basins only those in the minimum spanning tree (Kruskal 1956) are kept:
//! water that rises in any basin first overflows a pass of that tree. Memory: O(basins).

use super::drain::Basins;
use super::sweep::{Slabs, level_of, number_of};
use crate::disjoint::DisjointSets;
use crate::exec::{Cancelled, Exec};

/// A pass between two basins; passes order by level first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Pass {
    /// Level of its height.
    pub(super) level: u32,
    /// The basin of the smaller number.
    pub(super) a: u32,
    /// The other basin.
    pub(super) b: u32,
}

/// The shortest spanning tree of the basins, in ascending order.
pub(super) fn passes(
    shape: &[usize],
    heights: &[f32],
    basins: &Basins,
    exec: &Exec,
) -> Result<Vec<Pass>, Cancelled> {
    let slabs = Slabs::new(shape);
    let count = basins.minima.len();
    if count < 2 {
        return Ok(Vec::new());
    }
    let runs = slabs.runs(exec);
    let of_run = |number: usize| -> Result<Vec<Pass>, Cancelled> {
        let run = runs[number].clone();
        let mut found = PassTable::new(count);
        let (mut here, mut next) = (Vec::new(), Vec::new());
        let load = |k: usize, words: &mut Vec<u64>, found: &mut PassTable| {
            slabs.load(heights, k, |cell| basins.labels[cell], words);
            slabs.least_of_cubes(words, |u, v| found.meet(u, v), exec)
        };
        load(run.start, &mut here, &mut found)?;
        for k in run {
            if k + 1 < slabs.count {
                load(k + 1, &mut next, &mut found)?;
                for (u, v) in here.iter().zip(&next) {
                    found.meet(*u, *v);
                }
                std::mem::swap(&mut here, &mut next);
            }
        }
        found.flush();
        Ok(found.passes)
    };
    let mut passes = exec.try_map(runs.len(), of_run)?.concat();
    thin(&mut passes, count);
    Ok(passes)
}

/// Bytes that the passes of so many basins take in every run.
pub(super) const fn bytes(basins: u64) -> u64 {
    let kept = basins.saturating_mul(ROOM as u64).saturating_add(LEAST_ROOM as u64);
    kept.saturating_mul(2 * size_of::<Pass>() as u64)
}

/// Passes of a run.
struct PassTable {
    basins: usize,
    /// The lowest pass of pairs met lately; most cells lie between the same basins as the cell before.
    lately: Vec<Pass>,
    passes: Vec<Pass>,
    /// Thinned when it holds as many.
    room: usize,
}

/// A power of two; a table of these passes stays in the nearest cache.
const LATELY: usize = 1 << 11;
/// Number of passes per basin that are held before they are reduced to one, and the minimum number.
const ROOM: usize = 4;
const LEAST_ROOM: usize = 1 << 14;
/// No pass.
const NONE: Pass = Pass { level: u32::MAX, a: u32::MAX, b: u32::MAX };

impl PassTable {
    fn new(basins: usize) -> Self {
        let room = basins.saturating_mul(ROOM).max(LEAST_ROOM);
        Self { basins, lately: vec![NONE; LATELY], passes: Vec::new(), room }
    }

    /// Two cells next to each other, each with its basin.
    #[inline]
    fn meet(&mut self, u: u64, v: u64) {
        if number_of(u ^ v) != 0 {
            self.between(u, v);
        }
    }

    #[inline]
    fn between(&mut self, u: u64, v: u64) {
        /// An odd number near 2³²/φ scatters neighbouring numbers (Knuth, TAOCP 3, 6.4).
        const SCATTER: u32 = 0x9e37_79b9;
        let (p, q) = (number_of(u), number_of(v));
        let (a, b) = (p.min(q), p.max(q));
        let pass = Pass { level: level_of(u.max(v)), a, b };
        let slot = (a.wrapping_mul(SCATTER) ^ b).wrapping_mul(SCATTER) >> (32 - LATELY.trailing_zeros());
        let slot = &mut self.lately[slot as usize];
        if (slot.a, slot.b) == (a, b) {
            slot.level = slot.level.min(pass.level);
            return;
        }
        let old = std::mem::replace(slot, pass);
        if old != NONE {
            self.push(old);
        }
    }

    fn push(&mut self, pass: Pass) {
        if self.passes.len() >= self.room {
            thin(&mut self.passes, self.basins);
        }
        self.passes.push(pass);
    }

    fn flush(&mut self) {
        for pass in std::mem::take(&mut self.lately) {
            if pass != NONE {
                self.push(pass);
            }
        }
        thin(&mut self.passes, self.basins);
    }
}

/// Keeps the shortest spanning tree. The tree of a union is that of the union of the trees, and no two passes are
/// equal in order without being the same: the order of thinning changes nothing.
fn thin(passes: &mut Vec<Pass>, basins: usize) {
    passes.sort_unstable();
    let mut sets = DisjointSets::new(basins);
    passes.retain(|pass| sets.join(pass.a, pass.b).is_some());
}
