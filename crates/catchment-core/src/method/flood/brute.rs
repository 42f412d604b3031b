//! Basins and their tree by definition, in plain loops: the reference for the fast path. For small grids
//! only, since most steps visit every cell.

/// Minimum cell, its height and its depth, in the order of the cells: cell after cell from the lowest on,
/// united with the neighbours that are already present. If two bodies of water meet, the body with the higher
/// minimum (the later in memory among equals) ends; if that minimum was no higher than the water, it was not
/// a minimum. Cells of height −∞ form a single body.
pub fn tree(shape: &[usize], heights: &[f32]) -> Vec<(usize, f64, f64)> {
    let mut order: Vec<usize> = (0..heights.len()).collect();
    // The order of memory stays among equals; −0 and 0 are the same height.
    order.sort_by(|a, b| (heights[*a] + 0.0).total_cmp(&(heights[*b] + 0.0)));
    // The lowest cell of every cell's body of water, once it is under water.
    let mut body: Vec<Option<usize>> = vec![None; heights.len()];
    let mut result: Vec<(usize, f64, f64)> = Vec::new();
    for (place, &cell) in order.iter().enumerate() {
        body[cell] = Some(cell);
        let outside = |other: &usize| heights[*other] == f32::NEG_INFINITY;
        let met: Vec<usize> = if outside(&cell) {
            order[..place].to_vec()
        } else {
            neighbours(shape, cell).into_iter().filter(|near| body[*near].is_some()).collect()
        };
        for near in met {
            let (Some(a), Some(b)) = (body[cell], body[near]) else { continue };
            if a == b {
                continue;
            }
            let rank = |c: usize| order.iter().position(|o| *o == c);
            let (elder, younger) = if rank(a) < rank(b) { (a, b) } else { (b, a) };
            for owner in body.iter_mut().filter(|owner| **owner == Some(younger)) {
                *owner = Some(elder);
            }
            let depth = f64::from(heights[cell]) - f64::from(heights[younger]);
            if depth > 0.0 {
                result.push((younger, heights[younger].into(), depth));
            }
        }
    }
    result.extend(order.first().map(|first| (*first, heights[*first].into(), f64::INFINITY)));
    result.sort_by_key(|minimum| minimum.0);
    result
}

/// The minimum to which every cell drains, by its lowest neighbours. Cells without a lower neighbour lead to
/// the nearest equal cell that drains, the first in memory among several; a plateau without such a cell is a
/// minimum and represented by its first cell, cells of height −∞ by the first of them.
pub fn basins(shape: &[usize], heights: &[f32]) -> Vec<usize> {
    let near: Vec<Vec<usize>> = (0..heights.len()).map(|cell| neighbours(shape, cell)).collect();
    let outside = |cell: &usize| heights[*cell] == f32::NEG_INFINITY;
    let first_outside = (0..heights.len()).find(|cell| outside(cell));
    let mut way: Vec<Option<usize>> = (0..heights.len())
        .map(|cell| {
            if outside(&cell) {
                return first_outside;
            }
            let lowest =
                near[cell].iter().copied().reduce(|a, b| if heights[b] < heights[a] { b } else { a });
            lowest.filter(|lowest| heights[*lowest] < heights[cell])
        })
        .collect();
    loop {
        let drained = |cell: usize, way: &[Option<usize>]| {
            near[cell].iter().copied().find(|n| heights[*n] == heights[cell] && way[*n].is_some())
        };
        let result: Vec<(usize, usize)> = (0..heights.len())
            .filter(|cell| way[*cell].is_none())
            .filter_map(|cell| Some((cell, drained(cell, &way)?)))
            .collect();
        if result.is_empty() {
            break;
        }
        for (cell, to) in result {
            way[cell] = Some(to);
        }
    }
    // Plateaus without a rim: the first cell's number spreads over each.
    let mut first: Vec<usize> = (0..heights.len()).collect();
    for _ in 0..heights.len() {
        for cell in (0..heights.len()).filter(|cell| way[*cell].is_none()) {
            for &n in near[cell].iter().filter(|n| way[**n].is_none() && heights[**n] == heights[cell]) {
                first[cell] = first[cell].min(first[n]);
            }
        }
    }
    let end = |mut cell: usize| {
        while let Some(to) = way[cell].filter(|to| *to != cell) {
            cell = to;
        }
        first[cell]
    };
    (0..heights.len()).map(end).collect()
}

/// Cells at most one step away along every axis, in order of memory.
pub(super) fn neighbours(shape: &[usize], cell: usize) -> Vec<usize> {
    let place = |mut index: usize| -> Vec<usize> {
        shape
            .iter()
            .map(|n| {
                let k = index % n;
                index /= n;
                k
            })
            .collect()
    };
    let here = place(cell);
    (0..shape.iter().product())
        .filter(|other| *other != cell && place(*other).iter().zip(&here).all(|(a, b)| a.abs_diff(*b) <= 1))
        .collect()
}
