//! Exact distance from every cell of a grid to the nearest marked cell.
//!
//! ```text
//!   d²(p) = min over marked q of Σ (wₖ (pₖ − qₖ))²     axis by axis: along a line, the lower envelope of
//!                                                     the parabolas based on the values of the previous axes
//! ```
//!
//! O(cells · axes), after Felzenszwalb and Huttenlocher (Theory of Computing 8, 2012). Distances are between
//! centres, in units of `spacing`; single precision, relative error 1e-7. [`super::brute::squared_distances`]
//! is the definition.

use super::MeritError;
use crate::diagnostic::Advice;
use crate::exec::{Cancelled, Exec};
use rayon::prelude::*;

/// A parabola of the lower envelope of a line, in units of the line's spacing.
struct Parabola {
    at: f64,
    height: f64,
    /// Start of the interval on which it is the lowest.
    from: f64,
}

/// Squared distances to the cells that `marked` lists; infinite if there are none. `shape` is the number of
/// cells per axis, the first axis fastest.
///
/// # Errors
/// If it does not fit into memory, or is cancelled.
pub(super) fn squared_distances(
    shape: &[usize],
    spacing: &[f64],
    marked: impl Fn(usize) -> bool + Sync,
    exec: &Exec,
) -> Result<Vec<f32>, MeritError> {
    let cells: usize = shape.iter().product();
    exec.ensure_fits("distances to a border", (cells * size_of::<f32>()) as u64, |_| {
        vec![Advice::CoarserGrid, Advice::MoreMemory]
    })?;
    exec.install(|| {
        let at = |cell| if marked(cell) { 0.0 } else { f32::INFINITY };
        let mut squares: Vec<f32> = (0..cells).into_par_iter().map(at).collect();
        let mut stride = 1;
        for (count, spacing) in shape.iter().zip(spacing) {
            // Lines along an axis lie interleaved in blocks of `stride · count` cells.
            squares.par_chunks_mut((stride * count).max(1)).try_for_each(|block| {
                let (mut line, mut hull) = (Vec::with_capacity(*count), Vec::new());
                for first in 0..stride {
                    exec.check()?;
                    line.clear();
                    line.extend(block[first..].iter().step_by(stride));
                    lower(&mut line, spacing * spacing, &mut hull);
                    for (to, from) in block[first..].iter_mut().step_by(stride).zip(&line) {
                        *to = *from;
                    }
                }
                Ok::<_, Cancelled>(())
            })?;
            stride *= count;
        }
        Ok(squares)
    })
}

/// Replaces the heights along a line by the lower envelope of the parabolas that stand on them.
fn lower(line: &mut [f32], unit: f64, hull: &mut Vec<Parabola>) {
    hull.clear();
    for (at, height) in line.iter().enumerate().filter(|(_, height)| height.is_finite()) {
        let mut next = Parabola { at: at as f64, height: f64::from(*height) / unit, from: f64::NEG_INFINITY };
        while let Some(top) = hull.last() {
            let rise = next.height + next.at * next.at - top.height - top.at * top.at;
            let meet = rise / (2.0 * (next.at - top.at));
            if meet > top.from {
                next.from = meet;
                break;
            }
            hull.pop();
        }
        hull.push(next);
    }
    let mut parts = hull.iter().peekable();
    let Some(mut part) = parts.next() else { return };
    for (at, value) in line.iter_mut().enumerate() {
        let at = at as f64;
        while let Some(next) = parts.next_if(|next| next.from < at) {
            part = next;
        }
        *value = ((part.height + (at - part.at).powi(2)) * unit) as f32;
    }
}

#[cfg(test)]
mod tests {
    use super::super::brute;
    use super::super::testing::grid;
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn distances_are_those_of_the_definition(
            shape in proptest::collection::vec(1usize..7, 1..5),
            marks in proptest::collection::vec(prop::bool::weighted(0.1), 1296),
            spacing in proptest::collection::vec(0.1f64..3.0, 4),
        ) {
            let g = grid(&shape, &vec![1.0; shape.len()]);
            let defined = brute::squared_distances(&g, &spacing, &marks[..g.len()]);
            let result = squared_distances(&shape, &spacing, |cell| marks[cell], &Exec::new()).unwrap();
            for (result, defined) in result.into_iter().zip(defined) {
                let result = f64::from(result);
                // Rounded to single precision once per axis.
                prop_assert!(result == defined || (result / defined - 1.0).abs() < 5e-7, "{result} for {defined}");
            }
        }
    }
}
