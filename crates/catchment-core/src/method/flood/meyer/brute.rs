//! Flooding by definition, in plain loops: the reference for the fast path. For small grids only, since every
//! step visits every cell.

use super::Rules;
use crate::acceptance::Outcome;
use crate::landscape::Grid;
use crate::method::flood::brute::neighbours;
use std::collections::{BTreeMap, BTreeSet};

/// The basin of every cell after merging: 1 is the outside (height −∞), minima are numbered from 2 in the
/// order of their first cells, and a basin that others have joined keeps its own number. A cell without a
/// basin has 0, which occurs only in landscapes with NaN.
///
/// `shape` has the first axis fastest; minima that contain one of `targets` are merged.
pub fn divide(shape: &[usize], heights: &[f64], targets: &[usize], tolerance: f64, rules: Rules) -> Vec<u32> {
    let near: Vec<Vec<usize>> = (0..heights.len()).map(|c| neighbours(shape, c)).collect();
    let (mut basin, mut bottoms) = minima(heights, &near, rules);
    let joined: BTreeSet<u32> = targets.iter().filter_map(|t| basin[*t]).filter(|b| *b > 1).collect();
    if let Some(&first) = joined.first() {
        for b in basin.iter_mut().flatten().filter(|b| joined.contains(b)) {
            *b = first;
        }
        let lowest = joined.iter().map(|b| bottoms[b]).fold(f64::INFINITY, f64::min);
        bottoms.retain(|b, _| !joined.contains(b));
        bottoms.insert(first, lowest);
    }
    let dams = flood(heights, &near, rules, &mut basin);
    let into = merge(heights, &near, &basin, &dams, bottoms, tolerance);
    drain_dams(shape, heights, &near, &mut basin);
    basin.iter().map(|b| b.map_or(0, |b| into[&b])).collect()
}

/// The outcome of every cell, given the basins of [`divide`] and the cells around the mated pose: the outside
/// and basins with their lowest cell on a border of x or y are missed, the basin of the lowest target is
/// aligned unless it drains deeper below it than the tolerance, the rest is jammed.
pub fn outcomes(
    grid: &Grid,
    heights: &[f64],
    targets: &[usize],
    basins: &[u32],
    tolerance: f64,
) -> Vec<Outcome> {
    let lowest = |cells: &mut dyn Iterator<Item = usize>| {
        cells.reduce(|best, next| if heights[next] < heights[best] { next } else { best })
    };
    let bottom = |basin: u32| lowest(&mut (0..basins.len()).filter(|cell| basins[*cell] == basin));
    let mated = lowest(&mut targets.iter().copied()).filter(|cell| {
        let below = bottom(basins[*cell]).map_or(0.0, |bottom| heights[*cell] - heights[bottom]);
        below == 0.0 || below < tolerance
    });
    let of = |cell: usize| {
        let basin = basins[cell];
        if basin == 1 {
            Outcome::Missed
        } else if mated.is_some_and(|mated| basins[mated] == basin) {
            Outcome::Aligned
        } else {
            let place = bottom(basin).map_or_else(Vec::new, |bottom| grid.cell(bottom));
            let borders = grid.axes.iter().zip(place).filter(|(axis, k)| *k == 0 || k + 1 == axis.cells);
            let slides_off = borders.into_iter().any(|(axis, _)| !axis.dof.is_rotation());
            if slides_off { Outcome::Missed } else { Outcome::Jammed }
        }
    };
    (0..basins.len()).map(of).collect()
}

fn minima(heights: &[f64], near: &[Vec<usize>], rules: Rules) -> (Vec<Option<u32>>, BTreeMap<u32, f64>) {
    let mut basin: Vec<Option<u32>> =
        heights.iter().map(|h| (*h == f64::NEG_INFINITY).then_some(1)).collect();
    let mut bottoms = BTreeMap::from([(1, f64::NEG_INFINITY)]);
    let low = |c: usize| near[c].iter().all(|n| heights[*n] >= heights[c]);
    for start in 0..heights.len() {
        let same = |c: usize| heights[c] == heights[start] && (low(c) || !rules.flat_cells_are_minima);
        let mut plateau = BTreeSet::from([start]);
        while let Some(next) =
            plateau.iter().flat_map(|c| &near[*c]).copied().find(|n| same(*n) && !plateau.contains(n))
        {
            plateau.insert(next);
        }
        let lowest = plateau.iter().all(|c| low(*c));
        if lowest && basin[start].is_none() {
            let number = 1 + bottoms.len() as u32;
            for cell in plateau {
                basin[cell] = Some(number);
            }
            bottoms.insert(number, heights[start]);
        }
    }
    (basin, bottoms)
}

/// Lowest waiting cell first, in order of arrival among equals; returns the dams.
fn flood(heights: &[f64], near: &[Vec<usize>], rules: Rules, basin: &mut [Option<u32>]) -> BTreeSet<usize> {
    let mut arrived = BTreeSet::new();
    let mut queue: Vec<usize> = Vec::new();
    let mut dams = BTreeSet::new();
    for cell in 0..heights.len() {
        if basin[cell].is_some() {
            queue.extend(near[cell].iter().filter(|n| basin[**n].is_none() && arrived.insert(**n)));
        }
    }
    while !queue.is_empty() {
        let mut first = 0;
        for k in 1..queue.len() {
            if heights[queue[k]] < heights[queue[first]] {
                first = k;
            }
        }
        let cell = queue.remove(first);
        let touched: BTreeSet<u32> = near[cell].iter().filter_map(|n| basin[*n]).collect();
        let is_dam = touched.len() != 1;
        if is_dam {
            dams.insert(cell);
        } else {
            basin[cell] = touched.first().copied();
        }
        if !is_dam || rules.dams_pass_water_on {
            queue.extend(near[cell].iter().filter(|n| basin[**n].is_none() && arrived.insert(**n)));
        }
    }
    dams
}

/// The final basin of every basin after repeatedly merging the shallowest basin below the tolerance into its
/// neighbour.
fn merge(
    heights: &[f64],
    near: &[Vec<usize>],
    basin: &[Option<u32>],
    dams: &BTreeSet<usize>,
    mut bottoms: BTreeMap<u32, f64>,
    tolerance: f64,
) -> BTreeMap<u32, u32> {
    let mut into: BTreeMap<u32, u32> = bottoms.keys().map(|b| (*b, *b)).collect();
    loop {
        // (height of the pass, neighbour) of every basin, the lowest first.
        let mut passes: BTreeMap<u32, Vec<(f64, u32)>> = BTreeMap::new();
        for &dam in dams {
            for &a in &near[dam] {
                for &b in &near[dam] {
                    let (Some(p), Some(q)) = (basin[a], basin[b]) else { continue };
                    if into[&p] != into[&q] {
                        let pass = heights[dam].max(heights[a]).max(heights[b]);
                        passes.entry(into[&p]).or_default().push((pass, into[&q]));
                    }
                }
            }
        }
        let mut shallowest: Option<(f64, u32, u32)> = None;
        for (number, list) in &mut passes {
            list.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
            let (pass, neighbour) = list[0];
            let depth = pass - bottoms[number];
            if depth < tolerance && shallowest.is_none_or(|best| depth < best.0) {
                shallowest = Some((depth, *number, neighbour));
            }
        }
        let Some((_, from, to)) = shallowest else { return into };
        for last in into.values_mut().filter(|last| **last == from) {
            *last = to;
        }
        bottoms.insert(to, bottoms[&to].min(bottoms[&from]));
    }
}

/// Level by level from below: steepest descent, then from the rim of a plateau inwards.
fn drain_dams(shape: &[usize], heights: &[f64], near: &[Vec<usize>], basin: &mut [Option<u32>]) {
    let mut levels: Vec<f64> = heights.to_vec();
    levels.sort_by(f64::total_cmp);
    levels.dedup();
    for level in levels {
        for cell in (0..heights.len()).filter(|c| heights[*c] == level) {
            let mut steepest: Option<(f64, usize)> = None;
            for &n in &near[cell] {
                let slope = (level - heights[n]) / distance(shape, cell, n);
                if slope > steepest.map_or(0.0, |s| s.0) {
                    steepest = Some((slope, n));
                }
            }
            if let (None, Some((_, n))) = (basin[cell], steepest) {
                basin[cell] = basin[n];
            }
        }
        loop {
            let mut result = BTreeMap::new();
            for cell in (0..heights.len()).filter(|c| heights[*c] == level && basin[*c].is_none()) {
                let lowest = near[cell]
                    .iter()
                    .filter(|n| basin[**n].is_some())
                    .min_by(|a, b| heights[**a].total_cmp(&heights[**b]));
                if let Some(n) = lowest {
                    result.insert(cell, basin[*n]);
                }
            }
            if result.is_empty() {
                break;
            }
            for (cell, b) in result {
                basin[cell] = b;
            }
        }
    }
}

/// Distance of two cells, in cells.
fn distance(shape: &[usize], mut a: usize, mut b: usize) -> f64 {
    let mut squares = 0;
    for n in shape {
        squares += (a % n).abs_diff(b % n).pow(2);
        (a, b) = (a / n, b / n);
    }
    (squares as f64).sqrt()
}
