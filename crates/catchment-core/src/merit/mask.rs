//! Marked cells of a grid, as bits.
//!
//! ```text
//!   axis 0 ─▶  one row is one or more words:   ░░▓▓▓░░░ ░▓▓░░···   (· padding, never marked)
//!   the other axes: rows a fixed number of words apart, so that a step along them is an operation on words
//! ```
//!
//! 64 cells are processed at once, and boxes one axis at a time, so that growing costs O(n · cells / 64) and
//! fitting boxes of any size O(n · log(size) · cells / 64). All axes but the last are processed slab by slab,
//! while the slab is in the cache. Memory: a bit per cell, plus the padding of the last word of each row of
//! the first axis.

use super::MeritError;
use crate::acceptance::Outcome;
use crate::diagnostic::Advice;
use crate::exec::{Cancelled, Exec};
use rayon::prelude::*;

/// Cells in a word.
const WORD: usize = u64::BITS as usize;

/// Words in a piece of work: 128 KiB, small enough to share evenly and to be left within a millisecond.
const PIECE: usize = 1 << 14;

/// Marked cells of a grid.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Mask {
    /// Cells per axis; at least 1 axis.
    shape: Vec<usize>,
    /// Words between neighbours along each axis; for axis 0, which runs inside the words, 0.
    strides: Vec<usize>,
    words: Vec<u64>,
}

impl Mask {
    /// Marks the cells with the wanted outcomes. `shape` is the number of cells per axis, the first axis
    /// fastest.
    ///
    /// # Errors
    /// If it does not fit into memory, or is cancelled.
    pub(super) fn of(
        shape: &[usize],
        outcomes: &[Outcome],
        wanted: impl Fn(Outcome) -> bool + Sync,
        exec: &Exec,
    ) -> Result<Self, MeritError> {
        let shape = if shape.is_empty() { vec![1] } else { shape.to_vec() };
        let (first, row) = (shape[0], shape[0].div_ceil(WORD));
        let mut strides = vec![0];
        let mut words = row;
        for cells in &shape[1..] {
            strides.push(words);
            words *= cells;
        }
        exec.ensure_fits("the figures of merit", (words * size_of::<u64>()) as u64, |_| {
            vec![Advice::CoarserGrid, Advice::MoreMemory]
        })?;
        let mut words = vec![0; words];
        let rows = PIECE.div_ceil(row.max(1));
        exec.install(|| {
            let pieces = words.par_chunks_mut((rows * row).max(1));
            pieces.zip(outcomes.par_chunks((rows * first).max(1))).try_for_each(|(words, outcomes)| {
                exec.check()?;
                for (row, cells) in words.chunks_exact_mut(row).zip(outcomes.chunks_exact(first)) {
                    for (word, cells) in row.iter_mut().zip(cells.chunks(WORD)) {
                        *word = pack(cells, &wanted);
                    }
                }
                Ok::<_, Cancelled>(())
            })
        })?;
        Ok(Self { shape, strides, words })
    }

    /// Whether a cell is marked.
    pub(super) fn holds(&self, index: usize) -> bool {
        let (row, k) = (index / self.shape[0], index % self.shape[0]);
        self.words[row * self.row() + k / WORD] >> (k % WORD) & 1 == 1
    }

    /// How many cells are marked.
    pub(super) fn count(&self, exec: &Exec) -> usize {
        exec.install(|| {
            let ones = |piece: &[u64]| piece.iter().map(|w| w.count_ones() as usize).sum::<usize>();
            self.words.par_chunks(PIECE).map(ones).sum()
        })
    }

    /// Whether no cell is marked.
    pub(super) fn is_empty(&self) -> bool {
        self.words.iter().all(|word| *word == 0)
    }

    /// Indices of the marked cells, in memory order.
    pub(super) fn marked(&self) -> impl ParallelIterator<Item = usize> + '_ {
        let (first, row) = (self.shape[0], self.row());
        let words = self.words.par_iter().enumerate().with_min_len(PIECE);
        words.filter(|(_, word)| **word != 0).flat_map_iter(move |(k, word)| {
            let start = k / row * first + k % row * WORD;
            bits(*word).map(move |bit| start + bit)
        })
    }

    /// The rows along the first axis, in memory order, as words of which cell 0 is the lowest bit.
    pub(super) fn rows(&self) -> std::slice::ChunksExact<'_, u64> {
        self.words.chunks_exact(self.row().max(1))
    }

    /// Inverts all marks.
    pub(super) fn invert(&mut self) {
        let (row, valid) = (self.row(), self.valid());
        for words in self.words.chunks_exact_mut(row.max(1)) {
            for word in &mut *words {
                *word = !*word;
            }
            words[row - 1] &= valid;
        }
    }

    /// Marks every cell with a marked cell among its 3ⁿ − 1 neighbours.
    pub(super) fn grow(&mut self, exec: &Exec) -> Result<(), Cancelled> {
        let (strides, valid) = (self.strides.clone(), self.valid());
        self.sweep(exec, |axis, block| {
            let stride = strides[axis];
            if axis == 0 {
                grow_row(block, valid);
                return Ok(());
            }
            // Each row takes the union with the next row; then, backwards, with the previous row, both as
            // they were at first.
            let rows = block.len() / stride;
            for k in 1..rows {
                let (here, next) = block[(k - 1) * stride..(k + 1) * stride].split_at_mut(stride);
                combine(here, next, exec, |a, b| a | b)?;
            }
            for k in (1..rows).rev() {
                let (before, here) = block[(k - 1) * stride..(k + 1) * stride].split_at_mut(stride);
                combine(here, before, exec, |a, b| a | b)?;
            }
            Ok(())
        })
    }

    /// If every marked cell was the *first* corner of a box of `from[axis]` cells, keeps those that are the
    /// first corner of a box of `to[axis]` cells. `from` must not be 0 anywhere, and `to` not smaller.
    pub(super) fn widen_boxes(&mut self, from: &[usize], to: &[usize], exec: &Exec) -> Result<(), Cancelled> {
        let (strides, shape) = (self.strides.clone(), self.shape.clone());
        self.sweep(exec, |axis, block| {
            let (Some(&from), Some(&to)) = (from.get(axis), to.get(axis)) else { return Ok(()) };
            let mut reach = from;
            while reach < to {
                // Two boxes that touch or overlap form a longer box.
                let step = reach.min(to - reach);
                if axis == 0 {
                    keep_if_ahead(block, step);
                } else {
                    let (stride, rows) = (strides[axis], shape[axis]);
                    for k in 0..rows.saturating_sub(step) {
                        let (here, ahead) = block[k * stride..].split_at_mut(step * stride);
                        combine(&mut here[..stride], &ahead[..stride], exec, |a, b| a & b)?;
                    }
                    block[rows.saturating_sub(step) * stride..].fill(0);
                }
                reach += step;
            }
            Ok(())
        })
    }

    /// Words of a row along the first axis.
    fn row(&self) -> usize {
        self.shape[0].div_ceil(WORD)
    }

    /// The bits of a row's last word that are cells.
    fn valid(&self) -> u64 {
        match self.shape[0] % WORD {
            0 => u64::MAX,
            cells => (1 << cells) - 1,
        }
    }

    /// Runs `work(axis, block)` for every axis, in order, on blocks that hold whole lines along it: for axis
    /// 0 the block is a row.
    fn sweep(
        &mut self,
        exec: &Exec,
        work: impl Fn(usize, &mut [u64]) -> Result<(), Cancelled> + Sync,
    ) -> Result<(), Cancelled> {
        if self.words.is_empty() {
            return Ok(());
        }
        let last = self.shape.len() - 1;
        let (strides, words) = (&self.strides, &mut self.words);
        exec.install(|| {
            if last > 0 {
                words.par_chunks_exact_mut(strides[last]).try_for_each(|slab| {
                    exec.check()?;
                    for axis in 0..last {
                        slab.chunks_exact_mut(strides[axis + 1]).try_for_each(|block| work(axis, block))?;
                    }
                    Ok(())
                })?;
            }
            work(last, words)
        })
    }
}

/// A bit for each cell, the first lowest.
fn pack(cells: &[Outcome], wanted: impl Fn(Outcome) -> bool) -> u64 {
    // Moves the lowest bits of eight bytes into the highest byte: byte k meets the factor's bit 56 − 7k.
    const GATHER: u64 = 0x0102_0408_1020_4080;
    let (eights, rest) = cells.as_chunks::<8>();
    let mut word = 0;
    for (k, eight) in eights.iter().enumerate() {
        let flags = u64::from_le_bytes(eight.map(|outcome| u8::from(wanted(outcome))));
        word |= (flags.wrapping_mul(GATHER) >> 56) << (8 * k);
    }
    for (k, outcome) in rest.iter().enumerate() {
        word |= u64::from(wanted(*outcome)) << (8 * eights.len() + k);
    }
    word
}

/// Places of the set bits of a word, the lowest first.
pub(super) fn bits(mut word: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let bit = word.trailing_zeros();
        word &= word.wrapping_sub(1);
        (bit < u64::BITS).then_some(bit as usize)
    })
}

/// Combines two rows word by word, in parallel if they are long.
fn combine(
    into: &mut [u64],
    from: &[u64],
    exec: &Exec,
    with: impl Fn(u64, u64) -> u64 + Sync,
) -> Result<(), Cancelled> {
    let piece = |(into, from): (&mut [u64], &[u64])| {
        for (a, b) in into.iter_mut().zip(from) {
            *a = with(*a, *b);
        }
    };
    if into.len() <= PIECE {
        piece((into, from));
        return Ok(());
    }
    exec.check()?;
    into.par_chunks_mut(PIECE).zip(from.par_chunks(PIECE)).for_each(piece);
    Ok(())
}

/// Marks the neighbours inside a row; `valid` are the bits of its last word that are cells.
fn grow_row(row: &mut [u64], valid: u64) {
    let mut before = 0;
    for k in 0..row.len() {
        let (here, after) = (row[k], row.get(k + 1).copied().unwrap_or(0));
        row[k] = here | here << 1 | before >> (WORD - 1) | here >> 1 | after << (WORD - 1);
        before = here;
    }
    if let Some(last) = row.last_mut() {
        *last &= valid;
    }
}

/// Keeps the cells of a row whose `step`-th next cell is marked.
fn keep_if_ahead(row: &mut [u64], step: usize) {
    let (words, bits) = (step / WORD, step % WORD);
    for k in 0..row.len() {
        let word = |k: usize| row.get(k).copied().unwrap_or(0);
        let above = if bits == 0 { 0 } else { word(k + words + 1) << (WORD - bits) };
        row[k] &= word(k + words) >> bits | above;
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::grid;
    use super::*;
    use proptest::prelude::*;

    /// Short rows, rows of several words, and up to four axes.
    fn masks() -> impl Strategy<Value = (Vec<usize>, Vec<Outcome>)> {
        let shapes = prop_oneof![
            proptest::collection::vec(1usize..6, 1..5),
            (60usize..140, 1usize..4).prop_map(|(row, n)| vec![row, n]),
        ];
        shapes.prop_flat_map(|shape| {
            let cells = shape.iter().product::<usize>();
            let outcome =
                prop::bool::weighted(0.8).prop_map(|b| if b { Outcome::Aligned } else { Outcome::Missed });
            (Just(shape), proptest::collection::vec(outcome, cells))
        })
    }

    fn accepted(shape: &[usize], outcomes: &[Outcome], exec: &Exec) -> Mask {
        Mask::of(shape, outcomes, |o| o == Outcome::Aligned, exec).unwrap()
    }

    proptest! {
        #[test]
        fn bits_match_the_accepted_cells((shape, outcomes) in masks()) {
            let exec = Exec::new();
            let mut mask = accepted(&shape, &outcomes, &exec);
            let aligned: Vec<usize> = (0..outcomes.len()).filter(|i| outcomes[*i] == Outcome::Aligned).collect();
            prop_assert_eq!(&mask.marked().collect::<Vec<_>>(), &aligned);
            prop_assert_eq!((mask.count(&exec), mask.is_empty()), (aligned.len(), aligned.is_empty()));
            prop_assert!((0..outcomes.len()).all(|i| mask.holds(i) == (outcomes[i] == Outcome::Aligned)));
            mask.invert();
            prop_assert_eq!(mask, Mask::of(&shape, &outcomes, |o| o != Outcome::Aligned, &exec).unwrap());
        }

        #[test]
        fn growing_and_fitting_are_as_defined((shape, outcomes) in masks(), sizes in proptest::array::uniform4(0.0..1.0f64)) {
            let exec = Exec::new();
            let g = grid(&shape, &vec![1.0; shape.len()]);
            let mask = accepted(&shape, &outcomes, &exec);
            let mut grown = mask.clone();
            grown.grow(&exec).unwrap();
            let size = |scale: f64| -> Vec<usize> {
                shape.iter().zip(sizes).map(|(n, s)| 1 + (scale * s * (*n as f64 - 1.0)) as usize).collect()
            };
            let (ones, half, full) = (vec![1; shape.len()], size(0.5), size(1.0));
            let mut fitted = mask.clone();
            fitted.widen_boxes(&ones, &half, &exec).unwrap();
            fitted.widen_boxes(&half, &full, &exec).unwrap();
            for i in 0..outcomes.len() {
                let here = g.cell(i);
                let near = mask.marked().any(|j| here.iter().zip(g.cell(j)).all(|(a, b)| a.abs_diff(b) <= 1));
                prop_assert_eq!(grown.holds(i), near);
                let room = here.iter().zip(&full).zip(&shape).all(|((k, w), n)| k + w <= *n);
                let inside = |j: &usize| g.cell(*j).iter().zip(&here).zip(&full).all(|((c, k), w)| (*k..k + w).contains(c));
                prop_assert_eq!(fitted.holds(i), room && (0..outcomes.len()).filter(inside).all(|j| mask.holds(j)));
            }
        }
    }

    #[test]
    fn an_oversized_mask_is_refused_and_a_cancelled_one_stops() {
        let outcomes = vec![Outcome::Aligned; 4096];
        let small = Exec::new().with_memory_budget(511);
        let wanted = |o| o == Outcome::Aligned;
        assert!(matches!(Mask::of(&[64, 64], &outcomes, wanted, &small), Err(MeritError::OutOfBudget(_))));
        let cancelled = Exec::new();
        cancelled.cancel_flag().store(true, std::sync::atomic::Ordering::Relaxed);
        assert!(matches!(Mask::of(&[64, 64], &outcomes, wanted, &cancelled), Err(MeritError::Cancelled(_))));
    }
}
