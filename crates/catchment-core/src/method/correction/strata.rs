//! Strata: the grid's cells, classified by the reliability of their labels, with their counts, and access to
//! every cell by its rank.
//!
//! ```text
//!   cells      ░░█░▓▓░░ ░▓░░░░░█ █████▓░░ …      ░ █ ▓ strata
//!   before ░   0        5        11       13 …   cells of the stratum before each block
//!   cell 12 of ░:  the last block with before ≤ 12, then cell by cell
//! ```
//!
//! A random cell of a stratum is thus found without a list of cells and without rejection, however rare the
//! stratum.

use super::CorrectionError;
use crate::acceptance::Outcome;
use crate::diagnostic::Advice;
use crate::exec::Exec;

/// A partition of the cells of a grid into a few strata. Any partition keeps the Sum unbiased; a good
/// partition has strata in which nearly all poses have the same outcome.
pub trait Stratify: Sync {
    /// Number of strata, at most [`MOST_STRATA`].
    fn strata(&self) -> usize;
    /// The stratum of a cell, below [`Stratify::strata`].
    fn stratum(&self, cell: usize) -> u8;
    /// Whether the method accepts the cells of a stratum.
    fn accepts(&self, stratum: usize) -> bool;
    /// Description of a stratum, for people.
    fn name(&self, stratum: usize) -> String;
}

/// Most strata of a partition: with more, too few poses fall into each.
pub const MOST_STRATA: usize = 32;

/// Cells per block at least: looking through them takes some microseconds, a small part of a descent.
const LEAST_BLOCK: usize = 64;
/// Cells per block, as a share of the square root of all: the time to look through a block and the memory for the counts
/// grow alike. 30 MB for 24 million cells, 200 MB for a thousand million.
const BLOCK_PER_ROOT: usize = 16;

/// The strata of a grid, counted.
pub(super) struct Strata<'a, S> {
    by: &'a S,
    cells: usize,
    block: usize,
    blocks: usize,
    /// Per stratum and block, the cells of the stratum before the block; per stratum, all of them at the end.
    before: Vec<u64>,
}

impl<'a, S: Stratify> Strata<'a, S> {
    /// Counts the strata of `cells` cells.
    pub(super) fn count(by: &'a S, cells: usize, exec: &Exec) -> Result<Self, CorrectionError> {
        let strata = by.strata().clamp(1, MOST_STRATA);
        let block = (cells.isqrt() / BLOCK_PER_ROOT).max(LEAST_BLOCK);
        let blocks = cells.div_ceil(block);
        let needed = (blocks + 1) * (strata * size_of::<u64>() + size_of::<[u32; MOST_STRATA]>());
        exec.ensure_fits("the strata of the grid", needed as u64, |_| vec![Advice::MoreMemory])?;
        let counted = exec.map(blocks, |b| {
            let mut counts = [0u32; MOST_STRATA];
            for cell in b * block..cells.min((b + 1) * block) {
                counts[place(by, cell, strata)] += 1;
            }
            counts
        })?;
        let mut before = Vec::with_capacity(strata * (blocks + 1));
        for stratum in 0..strata {
            let mut total = 0;
            before.push(total);
            before.extend(counted.iter().map(|counts| {
                total += u64::from(counts[stratum]);
                total
            }));
        }
        Ok(Self { by, cells, block, blocks, before })
    }

    fn before(&self, stratum: usize) -> &[u64] {
        &self.before[stratum * (self.blocks + 1)..][..=self.blocks]
    }

    /// Number of strata, including empty ones.
    pub(super) fn len(&self) -> usize {
        self.before.len() / (self.blocks + 1)
    }

    /// Number of cells of a stratum.
    pub(super) fn cells(&self, stratum: usize) -> u64 {
        self.before(stratum)[self.blocks]
    }

    /// Whether the method accepts the cells of a stratum.
    pub(super) fn accepts(&self, stratum: usize) -> bool {
        self.by.accepts(stratum)
    }

    /// Description of a stratum.
    pub(super) fn name(&self, stratum: usize) -> String {
        self.by.name(stratum)
    }

    /// Cell number `rank` of a stratum, in the order of the grid.
    pub(super) fn cell(&self, stratum: usize, rank: u64) -> usize {
        let before = self.before(stratum);
        let block =
            before.partition_point(|n| *n <= rank).saturating_sub(1).min(self.blocks.saturating_sub(1));
        let mut left = rank - before[block];
        let first = block * self.block;
        let last = self.cells.min(first + self.block).saturating_sub(1);
        for cell in first..last {
            if place(self.by, cell, self.len()) == stratum {
                if left == 0 {
                    return cell;
                }
                left -= 1;
            }
        }
        last
    }
}

fn place(by: &impl Stratify, cell: usize, strata: usize) -> usize {
    usize::from(by.stratum(cell)).min(strata - 1)
}

/// Number of neighbours of a cell along the axes with the opposite label, accepted or not. If several differ,
/// the border of the accepted set cuts the cell.
fn differing(shape: &[usize], cell: usize, accepted: impl Fn(usize) -> bool) -> usize {
    let own = accepted(cell);
    let (mut differ, mut stride, mut rest) = (0, 1, cell);
    for cells in shape {
        let k = rest % cells;
        rest /= cells;
        differ += usize::from(k > 0 && accepted(cell - stride) != own);
        differ += usize::from(k + 1 < *cells && accepted(cell + stride) != own);
        stride *= cells;
    }
    differ
}

/// The partition for a method that gives outcomes alone: whether a cell is accepted, and how many of its neighbours
/// along the axes are not like it.
#[derive(Debug, Clone)]
pub struct ByNeighbours<'a> {
    outcomes: &'a [Outcome],
    shape: Vec<usize>,
}

impl<'a> ByNeighbours<'a> {
    /// For outcomes over a grid of this shape, first axis fastest.
    pub fn new(outcomes: &'a [Outcome], shape: Vec<usize>) -> Self {
        Self { outcomes, shape }
    }

    fn accepted(&self, cell: usize) -> bool {
        self.outcomes.get(cell) == Some(&Outcome::Aligned)
    }

    /// Number of possible counts of differing neighbours, including zero.
    fn levels(&self) -> usize {
        2 * self.shape.len() + 1
    }
}

impl Stratify for ByNeighbours<'_> {
    fn strata(&self) -> usize {
        2 * self.levels()
    }

    fn stratum(&self, cell: usize) -> u8 {
        let differ = differing(&self.shape, cell, |cell| self.accepted(cell));
        let side = if self.accepted(cell) { 0 } else { self.levels() };
        (side + differ) as u8
    }

    fn accepts(&self, stratum: usize) -> bool {
        stratum < self.levels()
    }

    fn name(&self, stratum: usize) -> String {
        let own = if self.accepts(stratum) { "accepted" } else { "rejected" };
        match stratum % self.levels() {
            1 => format!("{own}, 1 neighbour differs"),
            differ => format!("{own}, {differ} neighbours differ"),
        }
    }
}

/// The partition for a method that gives every cell a fraction in [0, 1], accepted above ½, such as the arrival
/// fraction of transport: by bands of the fraction, and how many neighbours along the axes differ in being accepted.
#[derive(Debug, Clone)]
pub struct ByFraction<F> {
    fraction: F,
    shape: Vec<usize>,
}

/// Borders of the bands, including ½. Narrow at the ends, which contain most cells.
const BORDERS: [f64; 11] = [0.0, 0.002, 0.02, 0.1, 0.25, 0.5, 0.75, 0.9, 0.98, 0.998, 1.0];
/// Classes of the number of differing neighbours: 0, 1 or 2, more.
const SIDES: [(usize, &str); 3] = [(0, "0"), (2, "1 or 2"), (usize::MAX, "3 or more")];

impl<F: Fn(usize) -> f64 + Sync> ByFraction<F> {
    /// For the fractions of the cells of a grid of this shape, first axis fastest.
    pub fn new(fraction: F, shape: Vec<usize>) -> Self {
        Self { fraction, shape }
    }
}

impl<F: Fn(usize) -> f64 + Sync> Stratify for ByFraction<F> {
    fn strata(&self) -> usize {
        (BORDERS.len() - 1) * SIDES.len()
    }

    fn stratum(&self, cell: usize) -> u8 {
        let fraction = (self.fraction)(cell);
        let band = BORDERS[1..BORDERS.len() - 1].iter().filter(|border| fraction > **border).count();
        let differ = differing(&self.shape, cell, |cell| (self.fraction)(cell) > 0.5);
        let side = SIDES.iter().position(|(most, _)| differ <= *most).unwrap_or(0);
        (band * SIDES.len() + side) as u8
    }

    fn accepts(&self, stratum: usize) -> bool {
        BORDERS[stratum / SIDES.len()] >= 0.5
    }

    fn name(&self, stratum: usize) -> String {
        let (_, differ) = SIDES[stratum % SIDES.len()];
        let band = (stratum / SIDES.len()).min(BORDERS.len() - 2);
        format!("fraction {} to {}, {differ} neighbours differ", BORDERS[band], BORDERS[band + 1])
    }
}
