//! Labels the kept cells of a gradient field in order of rising potential energy.
//!
//! ```text
//!   order   ▁▁▂▂▂▃▃▄▄▅▅▆▆▇▇     cells by energy; a batch reads the results of earlier batches only
//!           ├──┼──┼──┼──┼──┤
//!   then    thin jams mended, some inherited cells followed to their end
//! ```

use super::label::Label;
use super::neighbours::Neighbours;
use super::{ConfluenceSettings, InheritedLabels, STAGE};
use crate::acceptance::{Outcome, Stream};
use crate::contact::Pair;
use crate::exec::{Cancelled, Exec, Stopwatch};
use crate::landscape::DescentDirections;
use crate::method::affordable;
use crate::method::correction::wilson95;
use crate::method::descent::Follower;
use rayon::prelude::*;

/// Labels the stored cells.
pub(super) struct Labeller<'a> {
    pub(super) pair: &'a Pair,
    /// Its gradients are velocities.
    pub(super) falls: &'a DescentDirections,
    pub(super) settings: &'a ConfluenceSettings,
    /// Its start, for the time limit.
    pub(super) started: Stopwatch,
}

/// Largest number of cells per batch, and smallest number of batches if each has enough cells for the
/// threads.
const BATCH: usize = 4096;
const BATCHES: usize = 256;
const LEAST_BATCH: usize = 32;

/// Share of the cells below which jams are rare: the cells that touch them are few compared with the motions
/// before. The jams of the 3-D X-Face are 0.1 to 0.3 % of the cells, those of the pyramid 10 %.
const RARE: f64 = 0.01;

/// Cells of the box of simple halves that are drawn to be tried, and of any halves; and their seed.
const TRIED: f64 = 1000.0;
const LEAST_TRIED: f64 = 200.0;
const SEED: u64 = 0xc0f1;

impl Labeller<'_> {
    /// Labels all kept cells.
    pub(super) fn run(&self, exec: &Exec) -> Result<(Vec<Label>, InheritedLabels), Cancelled> {
        let DescentDirections { grid, fold, energies, below } = self.falls;
        let touches = |cell: &u32| below[*cell as usize] != DescentDirections::NOTHING;
        let mut order: Vec<u32> = (0..below.len() as u32).filter(touches).collect();
        exec.install(|| {
            order.par_sort_unstable_by(|a, b| {
                energies[*a as usize].total_cmp(&energies[*b as usize]).then(a.cmp(b))
            });
        });
        let mut labels = vec![Label::own(Outcome::Missed); below.len()];
        for cell in &order {
            labels[*cell as usize] = Label::UNKNOWN;
        }
        let around = Neighbours::new(grid, fold, self.settings.known);
        // If a free error is not an axis of the grid, motions leave the grid, so cells cannot inherit
        // outcomes.
        let joins = self.pair.alignment.free.iter().all(|dof| grid.axis(dof).is_some());
        let mut counts = InheritedLabels { cells: order.len(), ..InheritedLabels::default() };
        let size = order.len().div_ceil(BATCHES).clamp(LEAST_BATCH, BATCH);
        for (number, batch) in order.chunks(size).enumerate() {
            if self.is_late() || self.settings.motions.is_some_and(|most| counts.motions >= most) {
                break;
            }
            exec.report((number * size) as f64 / order.len() as f64, STAGE);
            let result = self.each(batch, exec, |follower, cell| {
                if self.is_late() {
                    (Label::UNKNOWN, false)
                } else if joins {
                    self.label(cell, follower, &around, &labels)
                } else {
                    (self.follow(cell, follower), true)
                }
            })?;
            for (cell, (label, is_followed)) in batch.iter().zip(result) {
                labels[*cell as usize] = label;
                counts.motions += usize::from(is_followed);
            }
        }
        drop(order);
        counts.motions += self.mend(&mut labels, exec)?;
        counts.inherited = labels.iter().filter(|label| label.has_inherited()).count();
        self.judge(&labels, &mut counts, exec)?;
        Ok((labels, counts))
    }

    /// Does something with every cell of a list, in its order, in parallel; every thread has a follower of its own.
    fn each<T: Send>(
        &self,
        cells: &[u32],
        exec: &Exec,
        work: impl Fn(&mut Follower<'_>, u32) -> T + Sync,
    ) -> Result<Vec<T>, Cancelled> {
        let start = || Follower::new(self.pair, &self.settings.descent);
        exec.map_with(cells.len(), start, |follower, k| work(follower, cells[k]))
    }

    /// Whether the time is over: then only the motions that measure the error rate of the labels are
    /// followed.
    fn is_late(&self) -> bool {
        self.settings.budget_s.is_some_and(|most| self.started.seconds() >= most)
    }

    /// Number of a kept cell in the whole grid.
    fn whole(&self, cell: u32) -> usize {
        let fold = &self.falls.fold;
        let (representative, lateral) = (cell as usize / fold.slab(), cell as usize % fold.slab());
        fold.rotation(representative) * fold.slab() + lateral
    }

    /// A cell by its own motion, to the end.
    fn follow(&self, cell: u32, follower: &mut Follower<'_>) -> Label {
        Label::own(follower.follow(&self.falls.grid.pose(self.whole(cell))).outcome)
    }

    /// A cell by those ahead of it, else by its own motion until it joins others; and whether it was followed.
    fn label(
        &self,
        cell: u32,
        follower: &mut Follower<'_>,
        around: &Neighbours<'_>,
        labels: &[Label],
    ) -> (Label, bool) {
        let centre = self.falls.grid.pose(self.whole(cell));
        // Friction bends the way, and may end it.
        if !self.settings.descent.may_hold() {
            let ahead = around.ahead(&centre, self.falls.below[cell as usize]);
            if let Some(label) = around.agreed(&ahead, labels, 1) {
                return (label, false);
            }
        }
        // At its start a motion is among the neighbours of its cell anyway; inheritance begins when it moves
        // on.
        let mut base = around.base(&centre);
        let mut inherited = None;
        let outcome = follower.follow_until(&centre, |error| {
            let now = around.base(error);
            if now != base {
                base = now;
                inherited = around.agreed(&base, labels, 0);
            }
            inherited.map(Label::outcome)
        });
        (inherited.unwrap_or(Label::own(outcome)), true)
    }

    /// Follows the neighbours of thin jams to their end, if their labels were inherited, until no further
    /// cell jams; returns the number of motions. A jam is thin if it has no jammed neighbour on either side
    /// along some axis: it may be thinner than a cell elsewhere. Rare jams are threads, which touch by
    /// corners alone: all cells that touch them are followed. Beyond the border of the box, with fewer
    /// decided centres, neighbours of neighbours are followed too.
    fn mend(&self, labels: &mut [Label], exec: &Exec) -> Result<usize, Cancelled> {
        let mut jammed: Vec<u32> =
            (0..labels.len() as u32).filter(|cell| labels[*cell as usize].jams()).collect();
        let are_rare = jammed.len() as f64 <= RARE * labels.len() as f64;
        let mut motions = 0;
        while !jammed.is_empty() {
            let label = |cell: &u32| labels[*cell as usize];
            let is_thin = |cell: &u32| {
                self.sides(*cell).any(|sides| !sides.into_iter().flatten().any(|side| label(&side).jams()))
            };
            let is_open = |cell: &u32| label(cell).has_inherited() && !label(cell).jams();
            let faces = |cell: &u32| self.sides(*cell).flatten().flatten().collect::<Vec<u32>>();
            let beside = |cell: &u32| if are_rare { self.near(*cell) } else { faces(cell) };
            let near = |cell: &u32| if is_thin(cell) { beside(cell) } else { Vec::new() };
            let mut around: Vec<u32> =
                exec.install(|| jammed.par_iter().flat_map_iter(near).filter(is_open).collect());
            let further = around.iter().filter(|cell| label(cell).has_joined_beyond()).flat_map(beside);
            around.extend(further.filter(is_open).collect::<Vec<u32>>());
            around.sort_unstable();
            around.dedup();
            let result = self.each(&around, exec, |follower, cell| {
                if self.is_late() { label(&cell) } else { self.follow(cell, follower) }
            })?;
            motions += around.len();
            for (cell, label) in around.iter().zip(result) {
                labels[*cell as usize] = label;
            }
            jammed = around;
            jammed.retain(|cell| labels[*cell as usize].jams());
        }
        Ok(motions)
    }

    /// The stored cells on both sides of a cell, along every axis.
    fn sides(&self, cell: u32) -> impl Iterator<Item = [Option<u32>; 2]> {
        let DescentDirections { grid, fold, .. } = self.falls;
        let whole = self.whole(cell);
        let mut stride = 1;
        grid.axes.iter().map(move |axis| {
            let number = whole / stride % axis.cells;
            let below = (number > 0).then(|| whole - stride);
            let above = (number + 1 < axis.cells).then(|| whole + stride);
            stride *= axis.cells;
            [below, above].map(|cell| cell.map(|cell| fold.kept_cell(cell) as u32))
        })
    }

    /// The stored cells that touch a cell, including by a corner, and itself.
    fn near(&self, cell: u32) -> Vec<u32> {
        let DescentDirections { grid, fold, .. } = self.falls;
        let mut near = vec![self.whole(cell)];
        let mut stride = 1;
        for axis in &grid.axes {
            let beside = |cell: usize| {
                let number = cell / stride % axis.cells;
                let below = (number > 0).then(|| cell - stride);
                [Some(cell), below, (number + 1 < axis.cells).then(|| cell + stride)].into_iter().flatten()
            };
            near = near.into_iter().flat_map(beside).collect();
            stride *= axis.cells;
        }
        near.into_iter().map(|cell| fold.kept_cell(cell) as u32).collect()
    }

    /// Follows some of the cells with inherited labels to their end: a random sample, or all if they are few.
    fn judge(&self, labels: &[Label], counts: &mut InheritedLabels, exec: &Exec) -> Result<(), Cancelled> {
        let DescentDirections { grid, fold, .. } = self.falls;
        let draws = (TRIED * affordable(self.pair)).max(LEAST_TRIED) as u64;
        let stream = Stream::new(SEED);
        let draw = |k| fold.kept_cell((stream.uniform(k) * grid.len() as f64) as usize) as u32;
        let mut cells: Vec<u32> = if labels.len() as u64 <= draws {
            (0..labels.len() as u32).collect()
        } else {
            (0..draws).map(draw).collect()
        };
        cells.retain(|cell| labels[*cell as usize].has_inherited());
        let ends = self.each(&cells, exec, |follower, cell| self.follow(cell, follower).outcome())?;
        let differs = |(cell, end): &(&u32, Outcome)| labels[**cell as usize].outcome() != *end;
        counts.tried = cells.len();
        counts.wrong = cells.iter().zip(ends).filter(differs).count();
        if counts.tried > 0 {
            counts.wrong_ci95 = wilson95(counts.wrong as f64 / counts.tried as f64, counts.tried as f64);
        }
        Ok(())
    }
}
