//! The cell to which every cell drains: the basins before any merging.
//!
//! ```text
//!   lowest     to the lowest of the 3ⁿ − 1 neighbours, the first in memory among equals
//!   steepest   to the neighbour with the largest fall per distance (see `steepest`)
//! ```
//!
//! A cell without a lower neighbour is *flat*. On a plateau that drains, flat cells lead to its rim by the
//! shortest path (in cells; the first in memory among equals); a plateau without a rim is a single minimum,
//! however large. Cells without contact (height −∞) form a single basin, the outside.
//!
//! Memory: 4 bytes per cell, which hold first the next cell downhill and then the number of the basin; the
//! slabs of a sweep; and the rim of the widest plateau.

use super::meyer::neighbourhood::Neighbourhood;
use super::steepest::Metric;
use super::sweep::{Slabs, level, level_of, number_of};
use super::{DrainageRule, FloodError};
use crate::diagnostic::Advice;
use crate::exec::{Cancelled, Exec};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU32, Ordering};

/// Set in an entry that holds the number of a basin, not the next cell.
const NUMBERED: u32 = 1 << 31;
/// No lower neighbour, and no way found yet.
pub(super) const FLAT: u32 = NUMBERED - 1;
/// No contact.
pub(super) const OUTSIDE: u32 = NUMBERED - 2;
/// Grids must have fewer cells than this.
pub(super) const LABEL_LIMIT: u32 = OUTSIDE;

/// Every cell's basin.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Basins {
    /// The number of every cell's basin.
    pub(super) labels: Vec<u32>,
    /// The lowest cell of every basin, the first in memory among equals; ascending.
    pub(super) minima: Vec<u32>,
    /// How many cells every basin has.
    pub(super) cells: Vec<usize>,
    /// The basin of the cells without contact.
    pub(super) outside: Option<u32>,
}

/// Number of cells between two checks of the cancel flag.
const CELLS_PER_CHECK: usize = 1 << 16;
/// The same for flat cells, all of whose neighbours are visited.
const FLATS_PER_CHECK: usize = 1 << 12;

/// Drains every cell of a grid of this shape.
pub(super) fn drain(
    shape: &[usize],
    heights: &[f32],
    rule: DrainageRule,
    metric: &Metric,
    exec: &Exec,
) -> Result<Basins, FloodError> {
    let slabs = Slabs::new(shape);
    slabs.ensure_fit(exec)?;
    let mut ways: Vec<AtomicU32> = Vec::with_capacity(heights.len());
    ways.resize_with(heights.len(), AtomicU32::default);
    match rule {
        DrainageRule::Lowest => exec.install(|| lowest(&slabs, heights, &mut ways, exec))?,
        DrainageRule::Steepest => exec.install(|| metric.steepest(heights, &mut ways, exec))?,
    }
    let minima = settle(heights, &Neighbourhood::new(shape), &mut ways, exec)?;
    let outside = minima.iter().position(|cell| *ways[*cell as usize].get_mut() == OUTSIDE);
    let outside = outside.map(|number| number as u32);
    for (number, cell) in (0..).zip(&minima) {
        *ways[*cell as usize].get_mut() = NUMBERED | number;
    }
    exec.install(|| follow(&ways, outside, exec))?;
    // The same memory, read as plain numbers.
    let labels: Vec<u32> = ways.into_iter().map(|way| way.into_inner() & !NUMBERED).collect();
    let mut cells = vec![0; minima.len()];
    for piece in labels.chunks(CELLS_PER_CHECK) {
        exec.check()?;
        for label in piece {
            cells[*label as usize] += 1;
        }
    }
    Ok(Basins { labels, minima, cells, outside })
}

/// The lowest cell around every cell, or `FLAT`, or `OUTSIDE`.
fn lowest(slabs: &Slabs, heights: &[f32], ways: &mut [AtomicU32], exec: &Exec) -> Result<(), Cancelled> {
    let mut jobs = Vec::new();
    let mut rest = ways;
    for run in slabs.runs(exec) {
        let (own, others) = rest.split_at_mut(run.len() * slabs.len);
        jobs.push((run, own));
        rest = others;
    }
    jobs.into_par_iter().try_for_each(|(run, ways)| {
        let (mut here, mut next, mut before, mut row) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let load = |k: usize, words: &mut Vec<u64>, row: &mut Vec<u64>| {
            slabs.load(heights, k, |cell| cell as u32, words);
            slabs.least_of_blocks(words, row, exec)
        };
        load(run.start, &mut here, &mut row)?;
        before.resize(slabs.len, u64::MAX);
        if run.start > 0 {
            load(run.start - 1, &mut next, &mut row)?;
            for ((before, last), here) in before.iter_mut().zip(&next).zip(&here) {
                *before = (*last).min(*here);
            }
        }
        for (k, ways) in run.clone().zip(ways.chunks_exact_mut(slabs.len)) {
            if k + 1 < slabs.count {
                load(k + 1, &mut next, &mut row)?;
            } else {
                next.fill(u64::MAX);
                next.resize(slabs.len, u64::MAX);
            }
            let heights = &heights[k * slabs.len..][..slabs.len];
            for ((((way, height), here), next), before) in
                ways.iter_mut().zip(heights).zip(&here).zip(&next).zip(&mut before)
            {
                let pair = (*here).min(*next);
                let least = pair.min(*before);
                *before = pair;
                *way.get_mut() = way_down(*height, least);
            }
            std::mem::swap(&mut here, &mut next);
        }
        Ok(())
    })
}

/// The link of a cell of this height, given the smallest word of its block.
fn way_down(height: f32, least: u64) -> u32 {
    if height == f32::NEG_INFINITY {
        OUTSIDE
    } else if level_of(least) == level(height) {
        FLAT
    } else {
        number_of(least)
    }
}

/// Gives every flat cell its way to the rim of its plateau. Returns the minima in ascending order, the first cell
/// without contact among them.
fn settle(
    heights: &[f32],
    around: &Neighbourhood,
    ways: &mut [AtomicU32],
    exec: &Exec,
) -> Result<Vec<u32>, FloodError> {
    let same = |a: usize, b: usize| level(heights[a]) == level(heights[b]);
    let flat = ways.iter_mut().filter_map(|way| (*way.get_mut() == FLAT).then_some(())).count() as u64;
    exec.ensure_fits("the plateaus of a flooded grid", flat * size_of::<(u32, u32)>() as u64, |_| {
        vec![Advice::CoarserGrid]
    })?;
    // The rim: flat cells next to an equal cell that drains.
    let mut rim: Vec<(u32, u32)> = Vec::new();
    let mut outside = None;
    for cell in 0..ways.len() {
        if cell.is_multiple_of(CELLS_PER_CHECK) {
            exec.check()?;
        }
        match *ways[cell].get_mut() {
            FLAT => {
                let drains = |near: &usize| ways[*near].load(Ordering::Relaxed) != FLAT;
                if let Some(near) = around.of(cell).find(|near| same(cell, *near) && drains(near)) {
                    rim.push((cell as u32, near as u32));
                }
            }
            OUTSIDE if outside.is_none() => outside = Some(cell as u32),
            _ => {}
        }
    }
    for (cell, near) in &rim {
        *ways[*cell as usize].get_mut() = *near;
    }
    let mut rim: Vec<u32> = rim.into_iter().map(|(cell, _)| cell).collect();
    while !rim.is_empty() {
        // In ascending order, so that a cell that two of the rim reach goes to the first of them.
        let mut inner = Vec::new();
        for (done, cell) in rim.into_iter().enumerate() {
            if done.is_multiple_of(FLATS_PER_CHECK) {
                exec.check()?;
            }
            for near in around.of(cell as usize) {
                if *ways[near].get_mut() == FLAT && same(cell as usize, near) {
                    *ways[near].get_mut() = cell;
                    inner.push(near as u32);
                }
            }
        }
        inner.sort_unstable();
        rim = inner;
    }
    // The remaining plateaus have no rim, so they are minima.
    let mut minima = Vec::new();
    let mut plateau = Vec::new();
    for cell in 0..ways.len() {
        if cell.is_multiple_of(CELLS_PER_CHECK) {
            exec.check()?;
        }
        if outside == Some(cell as u32) {
            minima.push(cell as u32);
        }
        if *ways[cell].get_mut() != FLAT {
            continue;
        }
        minima.push(cell as u32);
        plateau.push(cell);
        *ways[cell].get_mut() = cell as u32;
        let mut done = 0usize;
        while let Some(member) = plateau.pop() {
            done += 1;
            if done.is_multiple_of(FLATS_PER_CHECK) {
                exec.check()?;
            }
            for near in around.of(member) {
                if *ways[near].get_mut() == FLAT && same(cell, near) {
                    *ways[near].get_mut() = cell as u32;
                    plateau.push(near);
                }
            }
        }
    }
    Ok(minima)
}

/// Follows every way to its basin and leaves the basin's number along it.
///
/// Threads may meet on a way: all of them write the same number.
fn follow(ways: &[AtomicU32], outside: Option<u32>, exec: &Exec) -> Result<(), Cancelled> {
    let numbered = |way: u32| match (way, outside) {
        (OUTSIDE, Some(number)) => Some(NUMBERED | number),
        _ => (way & NUMBERED != 0).then_some(way),
    };
    let pieces = ways.par_chunks(CELLS_PER_CHECK).enumerate();
    pieces.try_for_each(|(piece, own)| {
        exec.check()?;
        let first = piece * CELLS_PER_CHECK;
        for cell in first..first + own.len() {
            let mut at = cell;
            let number = loop {
                let way = ways[at].load(Ordering::Relaxed);
                match numbered(way) {
                    Some(number) => break number,
                    None => at = way as usize,
                }
            };
            let mut at = cell;
            loop {
                let way = ways[at].load(Ordering::Relaxed);
                ways[at].store(number, Ordering::Relaxed);
                if numbered(way).is_some() {
                    break;
                }
                at = way as usize;
            }
        }
        Ok(())
    })
}
