//! Transport: the share of each cell that arrives at the mated pose, over a grid in any number of dimensions.
//!
//! ```text
//!   u = 1  ·  1  ·  .9 ·  .4 ·  0        every cell takes the mean of the cells that its *exact* direction of
//!          ╲     ╲     ╲     │           steepest descent (ρ-metric, contact of the cell's centre) points at;
//!   u = 1  ·  1  ·  1  ·  .7 ·  0        if the grid has no direction left, exact descent decides
//!              mated       border        accepted: u > ½
//! ```
//!
//! The arrival fraction obeys `q̇·∇u = 0`, discretised upwind on Freudenthal's simplices (`links.rs`):
//! monotone, first order, and, unlike flooding and steepest-neighbour descent, *convergent*, because the
//! direction is exact and not limited to the grid's. Every link leads downwards: valleys that a coarse
//! direction would cross back and forth are solved when the links are made, so a single pass over the cells
//! is sufficient (`solve.rs`).
//!
//! *Ends* are cells without a downhill neighbour: the mated pose, jams, and the hollows into which a grid
//! divides a narrow ravine. Exact descent from their centres distinguishes them, so that nothing must be
//! merged and no tolerance must be chosen. If motion leaves the error box, exact descent also decides if the
//! grid's surface has at most [`TransportSettings::followed_out`] cells; on larger grids it counts as missed at a
//! border of x or y, as jammed at a border of an angle, and a warning reports it.
//!
//! **Not guaranteed:** u strictly between 0 and 1 is numerical diffusion, not a probability of docking. At 30
//! cells per axis in five dimensions a tenth of the box is ambiguous (0.02 < u < 0.98) and contains most of
//! the misclassified cells; [`ArrivalFractions::is_ambiguous`] identifies them, so that exact descent can decide them
//! or a sample can correct their Sum.
//!
//! Memory: 10 bytes per cell, 2.5 to 5 for symmetric pairs ([`GradientField`]). Sources: upwind membership,
//! Gyulassy, Bremer and Pascucci 2012; D-infinity, Tarboton 1997; simplices, Freudenthal 1942. Lengths in D,
//! angles in radians.

pub mod brute;
pub(super) mod entry;
mod links;
mod solve;
#[cfg(test)]
mod tests;

use super::descent;
use crate::acceptance::{Acceptance, Domain, Outcome};
use crate::contact::Pair;
use crate::diagnostic::{Advice, Warning};
use crate::exec::{Cancelled, Exec, OutOfBudget};
use crate::landscape::{Fold, Gradient, GradientField, Grid, LandscapeError, Resolution};
use crate::method::metric::Metric;
use crate::pose::{Dof, PoseError};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use solve::Shares;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// Settings that may change the result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct TransportSettings {
    /// Motions that leave the error box are followed exactly if the grid has at most this many cells at its
    /// surface.
    pub followed_out: usize,
    /// Settings of the exact motions that decide ends.
    pub descent: descent::DescentSettings,
}

impl Default for TransportSettings {
    fn default() -> Self {
        Self { followed_out: 50_000, descent: descent::DescentSettings::default() }
    }
}

/// Why nothing was transported.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TransportError {
    /// A free error has no axis in the grid.
    #[error("transport needs every free error as an axis of the grid, and {} is not; descent needs none, for slices", dof.name())]
    NotSampled {
        /// Which.
        dof: Dof,
    },
    /// More cells than can be numbered.
    #[error("{cells} cells are more than transport can number ({}); lower the resolution", u32::MAX)]
    TooManyCells {
        /// How many.
        cells: usize,
    },
    /// No heights.
    #[error(transparent)]
    Landscape(#[from] LandscapeError),
    /// It does not fit into memory.
    #[error(transparent)]
    OutOfBudget(#[from] OutOfBudget),
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Arrival fractions over a grid.
#[derive(Debug, Clone)]
pub struct ArrivalFractions {
    grid: Grid,
    fold: Fold,
    shares: Vec<Shares>,
    /// Motion that left the box was not followed.
    cut_off: bool,
}

impl ArrivalFractions {
    /// Arrivals between these are ambiguous: nearly all errors of the grid lie there.
    pub const AMBIGUOUS: [f64; 2] = [0.02, 0.98];

    /// The grid.
    pub const fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Share of a cell's motion that arrives at the mated pose, in [0, 1].
    pub fn fraction(&self, cell: usize) -> f64 {
        f64::from(self.shares[self.fold.kept_cell(cell)].aligned())
    }

    /// Whether the grid cannot decide the outcome of a cell.
    pub fn is_ambiguous(&self, cell: usize) -> bool {
        let [low, high] = Self::AMBIGUOUS;
        (low..high).contains(&self.fraction(cell))
    }

    /// Mean fraction over the grid: transport's own estimate of the share of the error box that is accepted. More accurate
    /// than counting cells, because a cell at the border counts in part.
    pub fn mean(&self) -> f64 {
        let slab = self.fold.slab();
        let per_slab: Vec<f64> = self
            .shares
            .chunks_exact(slab)
            .map(|slab| slab.iter().map(|s| f64::from(s.aligned())).sum())
            .collect();
        let total: f64 =
            (0..self.fold.rotations()).map(|r| per_slab[self.fold.image(r).representative]).sum();
        total / self.grid.len() as f64
    }

    /// Outcome of every cell: aligned above ½, else the larger of the shares that jam and that lose contact.
    pub fn acceptance(&self, exec: &Exec) -> Result<Acceptance, OutOfBudget> {
        exec.ensure_fits("the outcome of every cell", self.grid.len() as u64, |budget| {
            vec![Advice::AtMostResolution(Resolution::largest_that_fits(budget, 1, self.grid.axes.len()))]
        })?;
        let slab = self.fold.slab();
        let mut outcomes = vec![Outcome::Missed; self.grid.len()];
        exec.install(|| {
            outcomes.par_chunks_exact_mut(slab).enumerate().for_each(|(rotation, outcomes)| {
                for (lateral, outcome) in outcomes.iter_mut().enumerate() {
                    let shares = self.shares[self.fold.kept_cell(rotation * slab + lateral)];
                    let (aligned, jammed) = (shares.aligned(), shares.jammed());
                    if aligned > 0.5 {
                        *outcome = Outcome::Aligned;
                    } else if jammed > 1.0 - aligned - jammed {
                        *outcome = Outcome::Jammed;
                    }
                }
            });
        });
        let mut warnings = Vec::new();
        if self.cut_off {
            warnings.push(Warning::CutOff.into());
        }
        Ok(Acceptance { method: "transport", domain: Domain::Grid(self.grid.clone()), outcomes, warnings })
    }
}

/// Bytes per cell at the peak, without symmetry: heights, patches' numbers, arrivals; and the outcomes after
/// them.
const BYTES_PER_CELL: u64 =
    GradientField::BYTES_PER_CELL + size_of::<Shares>() as u64 + size_of::<Outcome>() as u64;

/// Bytes that transport over a grid needs at most, for a pair.
pub fn bytes(pair: &Pair, grid: &Grid) -> u64 {
    let cells = grid.checked_len().map_or(u64::MAX, |cells| cells as u64);
    // Symmetric rotations that are their own image are stored completely, so this is the least saving of
    // folding.
    let folded = BYTES_PER_CELL - size_of::<Outcome>() as u64;
    let kept = Fold::new(grid, pair.mirrors()).map_or(cells, |fold| fold.kept_cells() as u64);
    kept.saturating_mul(folded).saturating_add(cells)
}

/// Arrival fractions of `pair` over `grid`, which samples every free error.
///
/// # Errors
/// When the grid does not suit the pair, does not fit into memory, or the computation is cancelled.
pub fn run(
    pair: &Pair,
    grid: &Grid,
    settings: &TransportSettings,
    exec: &Exec,
) -> Result<ArrivalFractions, TransportError> {
    if let Some(dof) = pair.alignment.free.iter().find(|dof| grid.axis(*dof).is_none()) {
        return Err(TransportError::NotSampled { dof });
    }
    let cells = grid.checked_len().unwrap_or(usize::MAX);
    if cells >= u32::MAX as usize {
        return Err(TransportError::TooManyCells { cells });
    }
    let needed = bytes(pair, grid);
    exec.ensure_fits("transport", needed, |budget| {
        let per_cell = (needed / (cells as u64).max(1)).max(1) + 1;
        let largest = Resolution::largest_that_fits(budget, per_cell, grid.axes.len());
        vec![Advice::AtMostResolution(largest)]
    })?;
    let field = GradientField::compute(pair, grid, exec, |error: &PoseError| {
        let metric = Metric::new(pair, grid, error);
        move |gradient: &Gradient| metric.velocity(gradient)
    })?;
    let follow_out = surface(grid) <= settings.followed_out;
    let judge = ExactOracle { pair, field: &field, settings, follow_out, cut_off: AtomicBool::new(false) };
    let shares = solve::solve(&field, &judge, exec)?;
    let cut_off = judge.cut_off.into_inner();
    let GradientField { grid, fold, .. } = field;
    Ok(ArrivalFractions { grid, fold, shares, cut_off })
}

/// Number of cells at the surface of a grid.
fn surface(grid: &Grid) -> usize {
    grid.len() - grid.axes.iter().map(|a| a.cells.saturating_sub(2)).product::<usize>()
}

/// Decides ends by exact descent.
struct ExactOracle<'a> {
    pair: &'a Pair,
    field: &'a GradientField,
    settings: &'a TransportSettings,
    /// Whether motion that leaves the box is followed.
    follow_out: bool,
    /// Whether some motion left that was not.
    cut_off: AtomicBool,
}

impl ExactOracle<'_> {
    /// Buffers of a thread that decides ends.
    fn start(&self) -> Ends<'_> {
        Ends { judge: self, follower: descent::Follower::new(self.pair, &self.settings.descent) }
    }
}

struct Ends<'a> {
    judge: &'a ExactOracle<'a>,
    follower: descent::Follower<'a>,
}

impl Ends<'_> {
    /// Outcome of an end; `leaves` is the number of the axis along which its motion leaves the box, if it
    /// does.
    fn decide(&mut self, kept: u32, leaves: Option<usize>) -> Shares {
        let GradientField { grid, fold, .. } = self.judge.field;
        if let (Some(axis), false) = (leaves, self.judge.follow_out) {
            self.judge.cut_off.store(true, Relaxed);
            let jams = grid.axes[axis].dof.is_rotation();
            return Shares::new(0.0, if jams { 1.0 } else { 0.0 });
        }
        let (representative, lateral) = (kept as usize / fold.slab(), kept as usize % fold.slab());
        let cell = fold.rotation(representative) * fold.slab() + lateral;
        match self.follower.follow(&grid.pose(cell)).outcome {
            Outcome::Aligned => Shares::new(1.0, 0.0),
            Outcome::Jammed => Shares::new(0.0, 1.0),
            Outcome::Missed => Shares::new(0.0, 0.0),
            // Everything that comes here is ambiguous then.
            Outcome::Undecided => Shares::new(0.5, 0.5),
        }
    }
}
