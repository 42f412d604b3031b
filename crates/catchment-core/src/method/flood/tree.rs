//! The merge tree: the order in which the basins of a rising water merge, and the depth of each.
//!
//! ```text
//!   ╲        ╱╲      ╱          a minimum is as deep as the water must rise in it to reach a lower one:
//!    ╲  ╱╲  ╱  ╲    ╱           B by its pass to A, A by its pass to C, C never (depth ∞). Basins shallower
//!     ╲╱  ╲╱ A  ╲  ╱            than a tolerance are merged across that pass; a higher tolerance merges more,
//!      B         ╲╱ C           and the tree contains all merges.
//! ```
//!
//! The tree is exact: it is that of the sets of cells below every height, connected in the full
//! neighbourhood. Source: the "elder rule" of persistent homology (Edelsbrunner, Letscher, Zomorodian 2002);
//! merging by depth is the watershed hierarchy "by dynamics" (Grimaud 1992). If a pass leads into several
//! basins at once, the basin with the smallest number counts.

use super::drain::Basins;
use super::passes::Pass;
use super::sweep::height;
use crate::disjoint::DisjointSets;

/// A minimum and the cells that drain to it, before any merging.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Minimum {
    /// The lowest cell, the first in memory among equals.
    pub cell: usize,
    /// Its height, in D; −∞ for the basin of all cells without contact.
    pub height: f64,
    /// Height that the water must rise to reach a lower minimum (among equally low minima, the first in
    /// memory), in D; infinite if no minimum is lower.
    pub depth: f64,
    /// How many cells drain to it.
    pub cells: usize,
}

/// A pass over which two basins run together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Link {
    /// The basins on both sides.
    pub basins: [u32; 2],
    /// Height of the pass, in D.
    pub height: f64,
    /// Depth of the shallower of the two bodies of water that meet here, in D.
    pub depth: f64,
}

/// All minima of a landscape and how they merge.
#[derive(Debug, Clone, PartialEq)]
pub struct MergeTree {
    /// The minima, in the order of their cells; the number of a basin is its place here.
    pub minima: Vec<Minimum>,
    /// The passes, the shallowest first: those below a tolerance join basins, those above keep them apart.
    pub links: Vec<Link>,
    /// Basins around the mated pose that are merged.
    pub(super) joined: Vec<u32>,
    /// The basin of the cells without contact.
    pub outside: Option<u32>,
}

impl MergeTree {
    /// The tree of `basins`, whose passes are sorted; those in `joined` are merged from the start.
    pub(super) fn new(basins: &Basins, heights: &[f32], passes: &[Pass], joined: Vec<u32>) -> Self {
        let minimum = |(cell, cells): (&u32, &usize)| Minimum {
            cell: *cell as usize,
            // −0 and 0 are the same height.
            height: f64::from(heights[*cell as usize] + 0.0),
            depth: f64::INFINITY,
            cells: *cells,
        };
        let mut minima: Vec<Minimum> = basins.minima.iter().zip(&basins.cells).map(minimum).collect();
        let mut sets = joined_sets(&minima, &joined);
        for other in &joined {
            if sets.find(*other) != *other {
                minima[*other as usize].depth = 0.0;
            }
        }
        let mut links = Vec::with_capacity(passes.len());
        for pass in passes {
            let (a, b) = (sets.find(pass.a), sets.find(pass.b));
            if a == b {
                continue;
            }
            let (elder, younger) = if is_elder(&minima, a, b) { (a, b) } else { (b, a) };
            sets.put_under(younger, elder);
            let height = f64::from(height(pass.level));
            let depth = height - minima[younger as usize].height;
            minima[younger as usize].depth = depth;
            links.push(Link { basins: [pass.a, pass.b], height, depth });
        }
        links.sort_by(|p, q| p.depth.total_cmp(&q.depth));
        Self { minima, links, joined, outside: basins.outside }
    }

    /// For every basin the basin with the lowest minimum among all with which it is merged at a tolerance.
    pub fn merged(&self, tolerance: f64) -> Vec<u32> {
        let mut sets = joined_sets(&self.minima, &self.joined);
        for link in self.links.iter().take_while(|link| link.depth < tolerance) {
            self.join(&mut sets, link);
        }
        (0..self.minima.len() as u32).map(|basin| sets.find(basin)).collect()
    }

    /// Unites the two sides of a link under the lower minimum; who stays and who goes.
    fn join(&self, sets: &mut DisjointSets, link: &Link) -> (u32, u32) {
        let [a, b] = link.basins.map(|basin| sets.find(basin));
        let (stays, goes) = if is_elder(&self.minima, a, b) { (a, b) } else { (b, a) };
        sets.put_under(goes, stays);
        (stays, goes)
    }

    /// Number of accepted cells at every tolerance, if `target` is the basin of the mated pose, whose height
    /// is `mated`: steps, each valid for tolerances above its own up to that of the next step, the first from
    /// 0 on.
    ///
    /// The mated basin grows from step to step until it merges with a basin that is lower by more than the
    /// tolerance explains: then no cell is accepted.
    pub fn staircase(&self, target: u32, mated: f64) -> Vec<ToleranceStep> {
        let mut sets = joined_sets(&self.minima, &self.joined);
        let mut cells: Vec<usize> = self.minima.iter().map(|m| m.cells).collect();
        for basin in &self.joined {
            let leader = sets.find(*basin) as usize;
            if leader != *basin as usize {
                cells[leader] += std::mem::take(&mut cells[*basin as usize]);
            }
        }
        let mut steps: Vec<ToleranceStep> = Vec::new();
        let mut push = |step: ToleranceStep| {
            while steps.last().is_some_and(|last| last.above >= step.above) {
                steps.pop();
            }
            if steps.last().is_none_or(|last| last.cells != step.cells) {
                steps.push(step);
            }
        };
        // The mated basin is `basin` at tolerances above `above`.
        let mut at = |above: f64, basin: u32, cells: usize| {
            let below = mated - self.minima[basin as usize].height;
            if !explains(above, below) {
                push(ToleranceStep { above, cells: 0 });
            }
            if below.is_finite() {
                push(ToleranceStep { above: above.max(below), cells });
            }
        };
        let first = sets.find(target);
        at(0.0, first, cells[first as usize]);
        for link in &self.links {
            let (stays, goes) = self.join(&mut sets, link);
            cells[stays as usize] += std::mem::take(&mut cells[goes as usize]);
            if sets.find(target) == stays {
                at(link.depth, stays, cells[stays as usize]);
            }
        }
        steps
    }
}

/// A step of the staircase of accepted cells over the tolerance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToleranceStep {
    /// Tolerances above this, in D, …
    pub above: f64,
    /// … accept so many cells.
    pub cells: usize,
}

/// Whether a tolerance explains that the mated basin gathers so far below the mated pose.
pub(super) fn explains(tolerance: f64, below: f64) -> bool {
    below <= 0.0 || below < tolerance
}

fn is_elder(minima: &[Minimum], a: u32, b: u32) -> bool {
    let (m, n) = (&minima[a as usize], &minima[b as usize]);
    m.height.total_cmp(&n.height).then(m.cell.cmp(&n.cell)).is_lt()
}

/// Sets in which the joined basins are merged, under the lowest of them.
fn joined_sets(minima: &[Minimum], joined: &[u32]) -> DisjointSets {
    let mut sets = DisjointSets::new(minima.len());
    let elder = |a: u32, b: u32| if is_elder(minima, b, a) { b } else { a };
    if let Some(lowest) = joined.iter().copied().reduce(elder) {
        for basin in joined {
            sets.put_under(*basin, lowest);
        }
    }
    sets
}
