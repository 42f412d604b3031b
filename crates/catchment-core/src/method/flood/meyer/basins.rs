//! Minima, and Meyer's flooding from them.

use super::neighbourhood::Neighbourhood;
use crate::exec::{Cancelled, Exec};
use serde::{Deserialize, Serialize};
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Not reached.
const UNSEEN: u32 = 0;
/// The basin of every cell without contact, however many pieces it has.
pub(super) const OUTSIDE: u32 = 1;
/// Reached from two basins.
pub(super) const DAM: u32 = u32::MAX;
/// Waiting in the queue.
const QUEUED: u32 = u32::MAX - 1;
/// Equal to a neighbour, and known to be no minimum.
const SLOPE: u32 = u32::MAX - 2;
/// Basin numbers lie below this.
const LABEL_LIMIT: u32 = SLOPE;

/// Whether a label names a basin.
pub(super) const fn is_basin(label: u32) -> bool {
    label != UNSEEN && label < LABEL_LIMIT
}

/// Choices at ambiguous points of the description of flooding. The default follows Meyer's text.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Rules {
    /// Every cell without a lower neighbour is a minimum, even on a plateau that drains elsewhere.
    pub flat_cells_are_minima: bool,
    /// The neighbours of a dam cell are reached through it.
    pub dams_pass_water_on: bool,
}

/// Storage type of heights: `f32` or `f64`.
pub trait Height: Copy + PartialOrd + Into<f64> + Send + Sync + sealed::Sealed {}
impl Height for f32 {}
impl Height for f64 {}

mod sealed {
    /// No other type can be a height.
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
}

/// Labels after flooding: `DAM` or a basin number per cell, `UNSEEN` for a cell walled in by dams.
pub(super) struct Flooded {
    /// The label of each cell.
    pub(super) labels: Vec<u32>,
    /// For every basin number the lowest cell, first in memory among equals; `None` for numbers not in use.
    pub(super) minima: Vec<Option<usize>>,
}

/// Labels the minima and floods the rest. Minima that contain one of the `targets` become a single basin.
pub(super) fn flood<H: Height>(
    heights: &[H],
    around: &Neighbourhood,
    targets: &[usize],
    rules: Rules,
    exec: &Exec,
) -> Result<Flooded, Cancelled> {
    let mut labels: Vec<u32> =
        heights.iter().map(|h| if (*h).into() == f64::NEG_INFINITY { OUTSIDE } else { UNSEEN }).collect();
    let outside = labels.iter().position(|l| *l == OUTSIDE);
    let mut minima = vec![None, outside];
    label_minima(heights, around, rules, &mut labels, &mut minima, exec)?;
    join(&mut labels, &mut minima, heights, targets);
    rise(heights, around, rules, &mut labels, exec)?;
    Ok(Flooded { labels, minima })
}

/// Number of cells between two checks of the cancel flag.
const CELLS_PER_CHECK: usize = 1 << 14;

/// A minimum is a connected set of equal cells without a lower neighbour; by the other rule, a set of equal
/// cells each without a lower neighbour.
fn label_minima<H: Height>(
    heights: &[H],
    around: &Neighbourhood,
    rules: Rules,
    labels: &mut [u32],
    minima: &mut Vec<Option<usize>>,
    exec: &Exec,
) -> Result<(), Cancelled> {
    let mut plateau = Vec::new();
    for start in 0..heights.len() {
        if start.is_multiple_of(CELLS_PER_CHECK) {
            exec.check()?;
        }
        if labels[start] != UNSEEN {
            continue;
        }
        let level = heights[start];
        let mut flat = false;
        let mut lowest = true;
        for near in around.of(start) {
            if heights[near] < level {
                lowest = false;
                break;
            }
            flat |= heights[near] == level;
        }
        if !lowest {
            continue; // stays unseen: if it lies on a plateau, that plateau finds its way here
        }
        let number = minima.len() as u32;
        labels[start] = number;
        if flat {
            plateau.clear();
            plateau.push(start);
            let mut next = 0;
            while let Some(&cell) = plateau.get(next) {
                next += 1;
                for near in around.of(cell) {
                    lowest &= heights[near] >= level;
                    let minimal =
                        |c| !rules.flat_cells_are_minima || around.of(c).all(|n| heights[n] >= level);
                    if heights[near] == level && labels[near] == UNSEEN && minimal(near) {
                        labels[near] = number;
                        plateau.push(near);
                    }
                }
            }
            if !lowest {
                for cell in &plateau {
                    labels[*cell] = SLOPE;
                }
                continue;
            }
        }
        minima.push(Some(start));
    }
    for label in labels {
        if *label == SLOPE {
            *label = UNSEEN;
        }
    }
    Ok(())
}

/// Gives all minima that contain a target cell the same number, the smallest.
fn join<H: Height>(labels: &mut [u32], minima: &mut [Option<usize>], heights: &[H], targets: &[usize]) {
    let mut numbers: Vec<u32> =
        targets.iter().map(|t| labels[*t]).filter(|l| is_basin(*l) && *l != OUTSIDE).collect();
    numbers.sort_unstable();
    numbers.dedup();
    let Some((&kept, others)) = numbers.split_first() else { return };
    if others.is_empty() {
        return;
    }
    for label in labels {
        if others.contains(label) {
            *label = kept;
        }
    }
    for other in others {
        let cell = minima[*other as usize].take();
        if let (Some(a), Some(b)) = (minima[kept as usize], cell)
            && heights[b] < heights[a]
        {
            minima[kept as usize] = cell;
        }
    }
}

/// A cell on the water line.
pub(super) struct Shore<H> {
    height: H,
    order: u32,
    cell: u32,
}

impl<H: Height> Ord for Shore<H> {
    /// The greatest is the lowest cell, and among equals the first to arrive.
    fn cmp(&self, other: &Self) -> Ordering {
        other
            .height
            .partial_cmp(&self.height)
            .unwrap_or(Ordering::Equal)
            .then_with(|| other.order.cmp(&self.order))
    }
}

impl<H: Height> PartialOrd for Shore<H> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<H: Height> PartialEq for Shore<H> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl<H: Height> Eq for Shore<H> {}

/// Meyer's flooding: the lowest cell on the water line joins the single basin that it touches, or becomes a
/// dam.
fn rise<H: Height>(
    heights: &[H],
    around: &Neighbourhood,
    rules: Rules,
    labels: &mut [u32],
    exec: &Exec,
) -> Result<(), Cancelled> {
    const STAGE: &str = "flooding";
    let mut queue = BinaryHeap::new();
    let mut order = 0u32;
    for cell in 0..labels.len() {
        if is_basin(labels[cell]) {
            for near in around.of(cell) {
                if labels[near] == UNSEEN {
                    labels[near] = QUEUED;
                    queue.push(Shore { height: heights[near], order, cell: near as u32 });
                    order += 1;
                }
            }
        }
    }
    let mut unseen = Vec::new();
    let mut done = 0usize;
    while let Some(Shore { cell, .. }) = queue.pop() {
        if done.is_multiple_of(CELLS_PER_CHECK) {
            exec.check()?;
            exec.report(done as f64 / labels.len() as f64, STAGE);
        }
        done += 1;
        let cell = cell as usize;
        unseen.clear();
        let mut basin = UNSEEN;
        for near in around.of(cell) {
            let label = labels[near];
            if label == UNSEEN {
                unseen.push(near);
            } else if is_basin(label) && basin != label {
                basin = if basin == UNSEEN { label } else { DAM };
            }
            if basin == DAM && !rules.dams_pass_water_on {
                unseen.clear();
                break;
            }
        }
        // Reached through dams alone, a cell is a dam itself.
        labels[cell] = if basin == UNSEEN { DAM } else { basin };
        for near in &unseen {
            labels[*near] = QUEUED;
            queue.push(Shore { height: heights[*near], order, cell: *near as u32 });
            order += 1;
        }
    }
    exec.report(1.0, STAGE);
    Ok(())
}
