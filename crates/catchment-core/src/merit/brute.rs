//! Figures of merit by their definitions, in plain loops over a flag per cell: the reference for the fast
//! paths, and sufficient for small grids.

use crate::landscape::Grid;

/// Number of accepted cells without a rejected neighbour, and number of cells that are accepted or have an
/// accepted neighbour, among the 3ⁿ − 1 around each that lie in the grid. `accepted` has a flag for each
/// cell.
pub fn inner_and_outer(grid: &Grid, accepted: &[bool]) -> [usize; 2] {
    let shape = grid.shape();
    let around = |index: usize| {
        let mut near = vec![0];
        let mut stride = 1;
        for (k, n) in grid.cell(index).into_iter().zip(&shape) {
            let range = k.saturating_sub(1)..(k + 2).min(*n);
            near = range.flat_map(|k| near.iter().map(move |i| i + k * stride)).collect();
            stride *= n;
        }
        near
    };
    let (mut inner, mut outer) = (0, 0);
    for index in 0..accepted.len() {
        let near = around(index);
        inner += usize::from(near.iter().all(|i| accepted[*i]));
        outer += usize::from(near.iter().any(|i| accepted[*i]));
    }
    [inner, outer]
}

/// Edge, in cells, of the largest cube of accepted cells: dynamic programming in O(2ⁿ · cells) time and two
/// slabs of memory.
///
/// `shape` is the number of cells per axis, `accepted` has a flag for each cell, first axis fastest.
///
/// # Panics
/// If there are more or fewer flags than cells.
pub fn largest_cube(shape: &[usize], accepted: &[bool]) -> usize {
    let Some((&slabs, face)) = shape.split_last() else { return 0 };
    let slab: usize = face.iter().product();
    assert_eq!(slab * slabs, accepted.len());
    if slab == 0 {
        return 0;
    }
    // Offsets, inside a slab, to the preceding corner neighbours: every combination of stepping back or not.
    let mut corners = vec![(0usize, 0usize)];
    let mut stride = 1;
    for (axis, cells) in face.iter().enumerate() {
        let stepped: Vec<_> =
            corners.iter().map(|(offset, axes)| (offset + stride, axes | 1 << axis)).collect();
        corners.extend(stepped);
        stride *= cells;
    }
    let (mut before, mut here) = (vec![0usize; slab], vec![0usize; slab]);
    let mut largest = 0;
    for (number, flags) in accepted.chunks_exact(slab).enumerate() {
        let mut cell = vec![0; face.len()];
        for (index, flag) in flags.iter().enumerate() {
            here[index] = if *flag {
                let first =
                    cell.iter().enumerate().fold(0, |set, (axis, k)| set | usize::from(*k == 0) << axis);
                let mut smallest = if number == 0 { 0 } else { usize::MAX };
                for &(offset, axes) in &corners {
                    if axes & first != 0 {
                        smallest = 0;
                        break;
                    }
                    if axes != 0 {
                        smallest = smallest.min(here[index - offset]);
                    }
                    smallest = smallest.min(before[index - offset]);
                }
                smallest + 1
            } else {
                0
            };
            largest = largest.max(here[index]);
            super::advance(&mut cell, face);
        }
        std::mem::swap(&mut before, &mut here);
    }
    largest
}

/// Squared distance from every cell's centre to that of the nearest marked cell, by comparing all; infinite
/// if no cell is marked. `spacing` is the distance of neighbours along each axis.
pub fn squared_distances(grid: &Grid, spacing: &[f64], marked: &[bool]) -> Vec<f64> {
    let between = |a: usize, b: usize| -> f64 {
        let steps = grid.cell(a).into_iter().zip(grid.cell(b));
        steps.zip(spacing).map(|((i, j), w)| (w * (i as f64 - j as f64)).powi(2)).sum()
    };
    let nearest = |a: usize| {
        (0..marked.len()).filter(|b| marked[*b]).map(|b| between(a, b)).fold(f64::INFINITY, f64::min)
    };
    (0..marked.len()).map(nearest).collect()
}
