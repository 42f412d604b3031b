//! Merging of shallow basins.
//!
//! ```text
//!   ╲    ╱╲  s    ╱      depth of B = s − (minimum of B), s its lowest boundary point;
//!    ╲  ╱  ╲╱╲   ╱       shallower than the tolerance, B joins the basin across s
//!   A ╲╱    B ╲_╱ C
//! ```

use super::basins::{DAM, Flooded, Height, is_basin};
use super::neighbourhood::Neighbourhood;
use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

/// The lowest pass to each neighbouring basin.
pub(super) type Passes = BTreeMap<u32, f64>;

/// The lowest pass between every two basins that meet at a dam; a map for each basin number.
///
/// The pass over a dam cell has the height of the cell or of the lowest cell of either adjacent basin,
/// whichever is highest.
pub(super) fn passes<H: Height>(heights: &[H], around: &Neighbourhood, flooded: &Flooded) -> Vec<Passes> {
    let mut passes = vec![Passes::new(); flooded.minima.len()];
    let mut beside: Vec<(u32, f64)> = Vec::new();
    for (cell, label) in flooded.labels.iter().enumerate() {
        if *label != DAM {
            continue;
        }
        beside.clear();
        for near in around.of(cell) {
            let (label, height) = (flooded.labels[near], heights[near].into());
            if !is_basin(label) {
                continue;
            }
            match beside.iter_mut().find(|(l, _)| *l == label) {
                Some((_, lowest)) => *lowest = f64::min(*lowest, height),
                None => beside.push((label, height)),
            }
        }
        let dam = heights[cell].into();
        for (k, &(a, height_a)) in beside.iter().enumerate() {
            for &(b, height_b) in &beside[..k] {
                let pass = dam.max(height_a).max(height_b);
                for (from, to) in [(a, b), (b, a)] {
                    let lowest = passes[from as usize].entry(to).or_insert(pass);
                    *lowest = lowest.min(pass);
                }
            }
        }
    }
    passes
}

/// Result of merging the basins.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Merged {
    /// For every basin number, the number of the basin it ended up in.
    pub(super) into: Vec<u32>,
    /// For every number still in use: the height of the minimum.
    pub(super) bottom: Vec<f64>,
}

/// A depth that orders like a number; depths are never NaN.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Depth(f64);

impl Eq for Depth {}

impl PartialOrd for Depth {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Depth {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}

/// Merges, as long as there is one, the shallowest basin of a depth below `tolerance` into the basin across
/// its lowest pass, which keeps its number. Among equals the smallest number is merged first.
pub(super) fn merge(bottoms: Vec<f64>, mut passes: Vec<Passes>, tolerance: f64) -> Merged {
    let count = bottoms.len();
    let mut bottom = bottoms;
    let mut into: Vec<u32> = (0..count as u32).collect();
    let mut depth: Vec<f64> = (0..count).map(|k| depth_of(bottom[k], &passes[k])).collect();
    let mut queue: BinaryHeap<Reverse<(Depth, u32)>> =
        (0..count).filter(|k| depth[*k] < tolerance).map(|k| Reverse((Depth(depth[k]), k as u32))).collect();
    while let Some(Reverse((Depth(old), shallow))) = queue.pop() {
        if into[shallow as usize] != shallow || depth[shallow as usize] != old {
            continue; // merged, or its depth has changed, since it was queued
        }
        let Some((neighbour, _)) = lowest_pass(&passes[shallow as usize]) else { continue };
        into[shallow as usize] = neighbour;
        let k = neighbour as usize;
        bottom[k] = bottom[k].min(bottom[shallow as usize]);
        for (other, pass) in std::mem::take(&mut passes[shallow as usize]) {
            passes[other as usize].remove(&shallow);
            if other != neighbour {
                for (from, to) in [(k, other), (other as usize, neighbour)] {
                    let lowest = passes[from].entry(to).or_insert(pass);
                    *lowest = lowest.min(pass);
                }
            }
        }
        // The lowest passes of the other basins keep their heights; only the basins behind them changed.
        depth[k] = depth_of(bottom[k], &passes[k]);
        if depth[k] < tolerance {
            queue.push(Reverse((Depth(depth[k]), neighbour)));
        }
    }
    for number in 0..count {
        let mut last = number;
        while into[last] as usize != last {
            last = into[last] as usize;
        }
        into[number] = last as u32;
    }
    Merged { into, bottom }
}

/// The lowest pass and the basin behind it, the smallest number among equals.
fn lowest_pass(passes: &Passes) -> Option<(u32, f64)> {
    passes.iter().map(|(n, p)| (*n, *p)).reduce(|best, next| if next.1 < best.1 { next } else { best })
}

fn depth_of(bottom: f64, passes: &Passes) -> f64 {
    lowest_pass(passes).map_or(f64::INFINITY, |(_, pass)| pass - bottom)
}
