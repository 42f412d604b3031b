//! Assigns dam cells to the basin to which their steepest descent leads.

use super::basins::{Height, is_basin};
use super::neighbourhood::Neighbourhood;

/// Gives every cell without a basin that of the neighbour in the direction of steepest descent (height difference
/// by distance in cells), lowest cells first, so that a neighbour which was a dam itself has its basin already.
///
/// A cell of a plateau may have no descent: it joins the lowest neighbour that has a basin, in rounds from the
/// plateau's rim inwards. Among equals the neighbour first in memory counts.
pub(super) fn assign<H: Height>(heights: &[H], around: &Neighbourhood, labels: &mut [u32]) {
    let mut open: Vec<usize> = (0..labels.len()).filter(|c| !is_basin(labels[*c])).collect();
    open.sort_by(|a, b| heights[*a].into().total_cmp(&heights[*b].into()));
    let mut result = Vec::new();
    for level in open.chunk_by(|a, b| heights[*a] == heights[*b]) {
        let mut flat = Vec::new();
        for &cell in level {
            match steepest(heights, around, cell) {
                Some(near) => labels[cell] = labels[near],
                None => flat.push(cell),
            }
        }
        // No plateau without a lower neighbour is left: those are minima and have their basin. So every round
        // finds a cell at the rim.
        while !flat.is_empty() {
            result.clear();
            flat.retain(|&cell| match lowest_with_basin(heights, around, labels, cell) {
                Some(near) => {
                    result.push((cell, labels[near]));
                    false
                }
                None => true,
            });
            if result.is_empty() {
                break;
            }
            for &(cell, label) in &result {
                labels[cell] = label;
            }
        }
    }
}

/// The neighbour of steepest descent; `None` if no neighbour is lower.
fn steepest<H: Height>(heights: &[H], around: &Neighbourhood, cell: usize) -> Option<usize> {
    let here: f64 = heights[cell].into();
    let mut best = (0.0, None);
    for (near, length) in around.with_length(cell) {
        let slope = (here - heights[near].into()) / length;
        if slope > best.0 {
            best = (slope, Some(near));
        }
    }
    best.1
}

fn lowest_with_basin<H: Height>(
    heights: &[H],
    around: &Neighbourhood,
    labels: &[u32],
    cell: usize,
) -> Option<usize> {
    around
        .of(cell)
        .filter(|near| is_basin(labels[*near]))
        .reduce(|best, near| if heights[near] < heights[best] { near } else { best })
}
