//! The arrival fractions of all cells: one value per cell, a pure function of the values of lower cells.
//!
//! ```text
//!   u(c) = Σ w u(link)      solved depth first: a cell with unsolved links waits for them;
//!                           links lead downwards, so no cell waits for itself
//! ```
//!
//! No sorting is needed, and the order has no effect: every cell's value is the same whichever thread
//! computes it. Threads work on different rotations and reuse each other's values; if two of them compute the
//! same cell, that costs time and never a bit.

use super::ExactOracle;
use super::links::{CellFlow, Link, Links, Scratch};
use crate::exec::{Cancelled, Exec};
use crate::landscape::GradientField;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

/// Shares of a cell's motion: aligned and jammed; the rest loses contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Shares(u32);

/// Stored value of a share of 1: 16 bits, errors of 10⁻⁵ per cell.
const ONE: f32 = 65_534.0;

impl Shares {
    /// Not known yet: more than any two shares of 1 make.
    const UNKNOWN: Self = Self(u32::MAX);

    pub(super) fn new(aligned: f32, jammed: f32) -> Self {
        let store = |share: f32| (share.clamp(0.0, 1.0) * ONE + 0.5) as u32;
        Self(store(aligned) << 16 | store(jammed))
    }

    pub(super) fn aligned(self) -> f32 {
        (self.0 >> 16) as f32 / ONE
    }

    pub(super) fn jammed(self) -> f32 {
        (self.0 & 0xffff) as f32 / ONE
    }
}

/// A cell that waits for its links.
struct Waiting {
    cell: u32,
    /// Start of its links; they end at the start of those of the next cell.
    links: usize,
    /// The first that may be unknown.
    cursor: usize,
}

/// Solves all kept cells.
pub(super) fn solve(
    field: &GradientField,
    judge: &ExactOracle,
    exec: &Exec,
) -> Result<Vec<Shares>, Cancelled> {
    let shares: Vec<AtomicU32> = field
        .carriers
        .iter()
        .map(|c| {
            AtomicU32::new(
                if *c == GradientField::NOTHING { Shares::new(0.0, 0.0) } else { Shares::UNKNOWN }.0,
            )
        })
        .collect();
    let links = Links::new(field);
    let slab = field.fold.slab();
    let slabs = field.fold.representatives();
    let tally = exec.tally(slabs, "arrivals");
    exec.install(|| {
        (0..slabs).into_par_iter().try_for_each_init(
            || Solver {
                links: &links,
                shares: &shares,
                judge: judge.start(),
                scratch: Scratch::default(),
                waiting: Vec::new(),
                found: Vec::new(),
            },
            |solver, number| {
                for cell in number * slab..(number + 1) * slab {
                    solver.solve(cell as u32, exec)?;
                }
                tally.add(1);
                Ok(())
            },
        )
    })?;
    Ok(shares.into_iter().map(|s| Shares(s.into_inner())).collect())
}

struct Solver<'a> {
    links: &'a Links<'a>,
    shares: &'a [AtomicU32],
    judge: super::Ends<'a>,
    scratch: Scratch,
    waiting: Vec<Waiting>,
    found: Vec<Link>,
}

impl Solver<'_> {
    fn known(&self, cell: u32) -> Option<Shares> {
        let shares = Shares(self.shares[cell as usize].load(Relaxed));
        (shares != Shares::UNKNOWN).then_some(shares)
    }

    fn solve(&mut self, cell: u32, exec: &Exec) -> Result<(), Cancelled> {
        self.visit(cell, exec)?;
        while let Some(top) = self.waiting.last_mut() {
            let mut cursor = top.cursor;
            while cursor < self.found.len()
                && self.shares[self.found[cursor].to as usize].load(Relaxed) != Shares::UNKNOWN.0
            {
                cursor += 1;
            }
            top.cursor = cursor;
            if let Some(link) = self.found.get(cursor) {
                let to = link.to;
                self.visit(to, exec)?;
                continue;
            }
            let (cell, links) = (top.cell, top.links);
            let (mut aligned, mut jammed) = (0.0, 0.0);
            for link in &self.found[links..] {
                let to = Shares(self.shares[link.to as usize].load(Relaxed));
                aligned += link.weight * to.aligned();
                jammed += link.weight * to.jammed();
            }
            self.shares[cell as usize].store(Shares::new(aligned, jammed).0, Relaxed);
            self.found.truncate(links);
            self.waiting.pop();
        }
        Ok(())
    }

    /// Decides a cell, or lets it wait for its links.
    fn visit(&mut self, cell: u32, exec: &Exec) -> Result<(), Cancelled> {
        if self.known(cell).is_some() {
            return Ok(());
        }
        let links = self.found.len();
        let leaves = match self.links.of(cell, &mut self.scratch, &mut self.found) {
            CellFlow::Down => {
                self.waiting.push(Waiting { cell, links, cursor: links });
                return Ok(());
            }
            CellFlow::Leaves(axis) => Some(axis),
            CellFlow::End => None,
        };
        exec.check()?;
        let shares = self.judge.decide(cell, leaves);
        self.shares[cell as usize].store(shares.0, Relaxed);
        Ok(())
    }
}
