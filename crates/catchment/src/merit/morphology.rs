//! Growing, shrinking and fitting boxes in masks over an n-dimensional grid (first axis fastest). Each works
//! one axis at a time in memory order, so the cost is O(n · cells) whatever the size of the box.

/// How many lines along the axis lie side by side in memory, and how many cells each has: the grid is a row of
/// blocks of `lines · cells` cells that hold whole lines.
fn blocks(shape: &[usize], axis: usize) -> (usize, usize) {
    let stride: usize = shape[..axis].iter().product();
    (stride, shape[axis])
}

/// Marks, in place, the cells that are the *last* corner of a box of `window[axis]` cells whose cells are all
/// marked.
pub(super) fn fit_boxes(shape: &[usize], window: &[usize], mask: &mut [bool]) {
    for (axis, &wanted) in window.iter().enumerate() {
        let (stride, cells) = blocks(shape, axis);
        for block in mask.chunks_exact_mut(stride * cells) {
            let mut runs = vec![0usize; stride];
            for row in block.chunks_exact_mut(stride) {
                for (marked, run) in row.iter_mut().zip(&mut runs) {
                    *run = if *marked { *run + 1 } else { 0 };
                    *marked = *run >= wanted;
                }
            }
        }
    }
}

/// Keeps, in place, the marked cells all of whose 3ⁿ − 1 neighbours inside the grid are marked.
pub(super) fn shrink(shape: &[usize], mask: &mut [bool]) {
    for axis in 0..shape.len() {
        let (stride, cells) = blocks(shape, axis);
        for block in mask.chunks_exact_mut(stride * cells) {
            let mut before = block[..stride].to_vec();
            for k in 0..cells {
                let (row, after) = block[k * stride..].split_at_mut(stride);
                for (lane, marked) in row.iter_mut().enumerate() {
                    let here = *marked;
                    *marked = here && before[lane] && after.get(lane).is_none_or(|m| *m);
                    before[lane] = here;
                }
            }
        }
    }
}

/// Marks, in place, every cell with a marked cell among its 3ⁿ − 1 neighbours.
pub(super) fn grow(shape: &[usize], mask: &mut [bool]) {
    let invert = |mask: &mut [bool]| mask.iter_mut().for_each(|m| *m = !*m);
    invert(mask);
    shrink(shape, mask);
    invert(mask);
}

#[cfg(test)]
mod tests {
    use super::super::testing::grid;
    use super::*;
    use proptest::prelude::*;

    fn masks() -> impl Strategy<Value = (Vec<usize>, Vec<bool>)> {
        proptest::collection::vec(1usize..5, 1..4).prop_flat_map(|shape| {
            let cells = shape.iter().product::<usize>();
            (Just(shape), proptest::collection::vec(prop::bool::weighted(0.8), cells))
        })
    }

    proptest! {
        #[test]
        fn shrink_and_grow_match_their_definition((shape, mask) in masks()) {
            let g = grid(&shape, &vec![1.0; shape.len()]);
            let near = |a: usize, b: usize| g.cell(a).iter().zip(g.cell(b)).all(|(p, q)| p.abs_diff(q) <= 1);
            let (mut small, mut large) = (mask.clone(), mask.clone());
            shrink(&shape, &mut small);
            grow(&shape, &mut large);
            for i in 0..mask.len() {
                prop_assert_eq!(small[i], (0..mask.len()).filter(|j| near(i, *j)).all(|j| mask[j]));
                prop_assert_eq!(large[i], (0..mask.len()).filter(|j| near(i, *j)).any(|j| mask[j]));
            }
        }
    }
}
