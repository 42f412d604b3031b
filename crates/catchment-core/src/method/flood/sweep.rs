//! Passes over a whole grid that process one axis after another.
//!
//! ```text
//!    the least of a 3ⁿ block                      the least of a unit cube of 2ⁿ cells
//!    = least of three along axis 0, of those      = least of two along axis 0, of those
//!      the least of three along axis 1, …           the least of two along axis 1, …
//! ```
//!
//! n steps per cell instead of 3ⁿ. The grid is traversed slab by slab along its last axis, so that only three
//! slabs are held at once. A value is a height in the upper half of a word and a distinguishing number in the
//! lower half: the smallest value is that of the lowest cell, and among equals that of the smallest number.

use crate::diagnostic::Advice;
use crate::exec::{Cancelled, Exec, OutOfBudget};
use std::ops::Range;

/// An order-preserving number of a height; −0 and 0 are the same height.
pub(super) fn level(height: f32) -> u32 {
    const SIGN: u32 = 1 << 31;
    let bits = (height + 0.0).to_bits();
    if bits & SIGN == 0 { bits | SIGN } else { !bits }
}

/// The height of a level.
pub(super) fn height(level: u32) -> f32 {
    const SIGN: u32 = 1 << 31;
    f32::from_bits(if level & SIGN == 0 { !level } else { level & !SIGN })
}

/// A word that orders by level first.
pub(super) const fn word(level: u32, number: u32) -> u64 {
    ((level as u64) << 32) | number as u64
}

/// The level of a word.
pub(super) const fn level_of(word: u64) -> u32 {
    (word >> 32) as u32
}

/// The number of a word.
pub(super) const fn number_of(word: u64) -> u32 {
    word as u32
}

/// A grid as slabs along its last axis. Axes of a single cell, which have no neighbours, are removed.
pub(super) struct Slabs {
    /// Cells along every axis of a slab, the first running fastest.
    axes: Vec<usize>,
    /// Cells of a slab.
    pub(super) len: usize,
    /// Number of slabs.
    pub(super) count: usize,
}

/// Slabs that a run holds at once: the current slab, the next, and the remainder of the previous slab.
const HELD: usize = 3;

impl Slabs {
    pub(super) fn new(shape: &[usize]) -> Self {
        let mut axes: Vec<usize> = shape.iter().copied().filter(|cells| *cells != 1).collect();
        let count = axes.pop().unwrap_or(1);
        Self { len: axes.iter().product(), axes, count }
    }

    /// Runs of neighbouring slabs, a run per thread. No result depends on the division.
    pub(super) fn runs(&self, exec: &Exec) -> Vec<Range<usize>> {
        let runs = exec.threads().clamp(1, self.count.max(1));
        (0..runs).map(|k| k * self.count / runs..(k + 1) * self.count / runs).collect()
    }

    /// Checks that the slabs of all runs fit into memory at once.
    pub(super) fn ensure_fit(&self, exec: &Exec) -> Result<(), OutOfBudget> {
        let slabs = (HELD * self.runs(exec).len()) as u64;
        let needed = slabs.saturating_mul((self.len * size_of::<u64>()) as u64);
        exec.ensure_fits("the slabs of a flooded grid", needed, |_| {
            vec![Advice::FewerThreads, Advice::CoarserGrid]
        })
    }

    /// The words of slab `k`, whose cells are numbered by `number`.
    pub(super) fn load(
        &self,
        heights: &[f32],
        k: usize,
        number: impl Fn(usize) -> u32,
        words: &mut Vec<u64>,
    ) {
        let first = k * self.len;
        let cells = heights[first..first + self.len].iter().enumerate();
        words.clear();
        words.extend(cells.map(|(at, h)| word(level(*h), number(first + at))));
    }

    /// The least word of every block of 3ⁿ⁻¹ cells around a cell of a slab.
    pub(super) fn least_of_blocks(
        &self,
        words: &mut [u64],
        before: &mut Vec<u64>,
        exec: &Exec,
    ) -> Result<(), Cancelled> {
        let mut stride = 1;
        for cells in &self.axes {
            exec.check()?;
            before.resize(stride, u64::MAX);
            for block in words.chunks_exact_mut(cells * stride) {
                before.fill(u64::MAX);
                least_of_three(block, before);
            }
            stride *= cells;
        }
        Ok(())
    }

    /// The least word of every cube of 2ⁿ⁻¹ cells of a slab, kept at its first corner. Every two words that are
    /// compared on the way are shown to `meet`.
    pub(super) fn least_of_cubes(
        &self,
        words: &mut [u64],
        mut meet: impl FnMut(u64, u64),
        exec: &Exec,
    ) -> Result<(), Cancelled> {
        let mut stride = 1;
        for cells in &self.axes {
            exec.check()?;
            for block in words.chunks_exact_mut(cells * stride) {
                least_of_two(block, stride, &mut meet);
            }
            stride *= cells;
        }
        Ok(())
    }
}

/// The minimum of every entry and the entries one stride before and after it; `before` has one stride of
/// greatest values.
fn least_of_three(block: &mut [u64], before: &mut [u64]) {
    if let [before] = before {
        for k in 1..block.len() {
            let pair = block[k - 1].min(block[k]);
            block[k - 1] = pair.min(*before);
            *before = pair;
        }
        if let Some(last) = block.last_mut() {
            *last = (*last).min(*before);
        }
        return;
    }
    let stride = before.len();
    let mut rest = block;
    while rest.len() > stride {
        let (row, next) = rest.split_at_mut(stride);
        for ((entry, after), before) in row.iter_mut().zip(&*next).zip(&mut *before) {
            let pair = (*entry).min(*after);
            *entry = pair.min(*before);
            *before = pair;
        }
        rest = next;
    }
    for (entry, before) in rest.iter_mut().zip(before) {
        *entry = (*entry).min(*before);
    }
}

/// The minimum of every entry and the entry a stride after it.
fn least_of_two(block: &mut [u64], stride: usize, meet: &mut impl FnMut(u64, u64)) {
    if stride == 1 {
        for k in 1..block.len() {
            meet(block[k - 1], block[k]);
            block[k - 1] = block[k - 1].min(block[k]);
        }
        return;
    }
    let mut rest = block;
    while rest.len() > stride {
        let (row, next) = rest.split_at_mut(stride);
        for (entry, after) in row.iter_mut().zip(&*next) {
            meet(*entry, *after);
            *entry = (*entry).min(*after);
        }
        rest = next;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_order_like_heights_and_convert_back() {
        let heights = [f32::NEG_INFINITY, -2.5, -1e-40, 0.0, 1e-40, 0.1, 7.0, f32::INFINITY];
        assert!(heights.windows(2).all(|w| level(w[0]) < level(w[1])));
        assert!(heights.iter().all(|h| height(level(*h)).to_bits() == h.to_bits()));
        assert_eq!(level(-0.0), level(0.0));
    }

    #[test]
    fn axes_of_one_cell_do_not_count() {
        let slabs = Slabs::new(&[1, 4, 1, 3, 1]);
        assert_eq!((slabs.axes.as_slice(), slabs.len, slabs.count), (&[4][..], 4, 3));
        let point = Slabs::new(&[]);
        assert_eq!((point.len, point.count), (1, 1));
    }

    #[test]
    fn runs_cover_every_slab_once() {
        for threads in [1, 2, 5, 9] {
            let runs = Slabs::new(&[3, 7]).runs(&Exec::new().with_threads(threads).unwrap());
            assert!(runs.iter().cloned().flatten().eq(0..7));
        }
    }
}
