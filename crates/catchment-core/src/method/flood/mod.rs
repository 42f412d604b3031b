//! The discrete method: basins of the height landscape over the error grid (the dissertation's chapter 5),
//! and the tree of their merging.
//!
//! ```text
//!    ╲               ╱      every cell drains to its lowest neighbour; a basin is the set that drains to one minimum.
//!     ╲    ╱╲       ╱       Basins shallower than a tolerance are merged across their lowest pass; the area
//!      ╲__╱  ╲_____╱        of acceptance is the basin of the mated pose.
//!      jam    mated
//! ```
//!
//! 1. Every cell drains to the lowest of its 3ⁿ − 1 neighbours ([`DrainageRule::Lowest`]), or to the steepest
//!    ([`DrainageRule::Steepest`]). Cells without contact form a separate basin, the outside.
//! 2. The merge tree ([`MergeTree`]) holds the depth of every minimum and the pass across which it merges, so
//!    that the result is known for every tolerance at once.
//! 3. Basins shallower than [`FloodSettings::depth_tolerance`] are merged. Its default lies in the widest gap
//!    between the depths (see [`Choice`]).
//!
//! The mated pose is lower than all poses around it. If it falls between cell centres (an even number of
//! cells), the minima among the cells around it count as a single minimum; if no such cell is a minimum, the
//! target is the basin of the lowest of them. If that basin, after merging, drains to a minimum deeper below
//! the mated pose than the tolerance, the mated pose is not a rest and no cell is accepted.
//!
//! **Compared with Meyer's flooding** ([`meyer`]), which the dissertation uses: the minima are the same and
//! merging follows the same rule, but the borders differ. There, a cell that two basins reach is a *dam* and
//! is not flooded through, so that the cells above it are reached from the sides; here it drains to its
//! lowest neighbour. [`meyer::accept`] decides by that rule. At 100 × 100 cells on five planar designs the
//! two decide 3.9, 8.8, 1.6, 2.5 and 0 % of the cells differently.
//!
//! **Not guaranteed:** motion on a grid can only follow the grid's directions, so the border of a basin does
//! not converge to the true border as the grid is refined ([`Warning::FloodingBias`]). Bias of the Sum at 100
//! × 100 cells compared with exact descent, in percent, for the X-Face (AR 1, COR ½; AR ½, COR −½; AR 2, COR
//! 1) and the V-Face (AR 1, COR 0; AR ½, COR −½):
//!
//! | | X 1, ½ | X ½, −½ | X 2, 1 | V 1, 0 | V ½, −½ |
//! |---|---|---|---|---|---|
//! | lowest neighbour | +5.8 | −5.7 | +1.6 | +0.4 | −13 |
//! | steepest neighbour | +4.5 | −20 | +1.3 | +0.8 | −7.4 |
//! | Meyer's queue | +2.3 | −24 | +1.6 | +0.5 | −3.5 |
//!
//! Motion beyond the error box is unknown: a basin whose minimum lies on a border of x or y counts as missed
//! (the halves slide off), on a border of a rotation as jammed.
//!
//! [`Warning::FloodingBias`]: crate::diagnostic::Warning::FloodingBias

pub mod brute;
mod drain;
pub(super) mod entry;
pub mod meyer;
mod outcomes;
mod passes;
mod steepest;
mod sweep;
mod target;
#[cfg(test)]
mod tests;
mod tolerance;
mod tree;
mod watersheds;

use crate::acceptance::{Acceptance, Outcome};
use crate::contact::Pair;
use crate::design::Alignment;
use crate::diagnostic::Advice;
use crate::exec::{Cancelled, Exec, OutOfBudget};
use crate::landscape::{Grid, Landscape, LandscapeError, Resolution};
use crate::method::descent;
use drain::LABEL_LIMIT;
use serde::{Deserialize, Serialize};
use steepest::Metric;
pub use tolerance::{Choice, ToleranceReason};
pub use tree::{Link, MergeTree, Minimum, ToleranceStep};
pub use watersheds::{DAM, WatershedCounts, Watersheds};

/// Rule that selects the cell to which a cell drains.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum DrainageRule {
    /// The lowest of its 3ⁿ − 1 neighbours, the first in memory if several are equal. Distance has no effect.
    #[default]
    Lowest,
    /// The neighbour with the greatest fall per distance, the first in memory if several are equal. The
    /// distance is that of exact motion: lateral steps of the COR and ρ times the angle between rotations.
    Steepest,
}

impl DrainageRule {
    /// The name of the method that floods by this rule.
    pub const fn method(self) -> &'static str {
        match self {
            Self::Lowest => "flood",
            Self::Steepest => "steepest",
        }
    }
}

/// Settings that change the result.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct FloodSettings {
    /// Basins shallower than this are merged, in D; 0 keeps every minimum. By default it is chosen from the
    /// depths.
    pub depth_tolerance: Option<f64>,
    /// Rule that selects the cell to which a cell drains.
    pub rule: DrainageRule,
}

impl FloodSettings {
    /// Merges basins shallower than `depth`, in D.
    pub fn with_tolerance(depth: f64) -> Self {
        Self { depth_tolerance: Some(depth), ..Self::default() }
    }
}

/// Why nothing was flooded.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FloodError {
    /// The tolerance is no depth.
    #[error("a depth tolerance of {depth} is no depth; give a length of at least 0")]
    Tolerance {
        /// The given value, in D.
        depth: f64,
    },
    /// More cells than a basin number can distinguish.
    #[error("{cells} cells are more than flooding can number ({LABEL_LIMIT}); lower the resolution")]
    TooManyCells {
        /// How many.
        cells: usize,
    },
    /// The heights are not those of a grid of this shape, or it has too many axes.
    #[error("{heights} heights are none of a grid of {shape:?} cells with at most {most_axes} axes")]
    Shape {
        /// Cells per axis.
        shape: Vec<usize>,
        /// How many heights there are.
        heights: usize,
        /// Most axes of a grid.
        most_axes: usize,
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

/// A basin after merging.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Basin {
    /// The lowest cell.
    pub minimum: usize,
    /// Its height, in D; −∞ for the basin of all cells without contact.
    pub height: f64,
    /// Height that the water must rise above the minimum to reach a lower minimum, in D; infinite if no
    /// minimum is lower.
    pub depth: f64,
    /// Height that the water must rise above the minimum to overflow into any other basin, in D: a measure of
    /// the stability of this equilibrium. Infinite for a single basin.
    pub escape: f64,
    /// Number of cells that drain to it.
    pub cells: usize,
    /// Outcome of these cells.
    pub outcome: Outcome,
}

/// The result of flooding.
#[derive(Debug, Clone, PartialEq)]
pub struct Flooding {
    /// Outcome of every cell.
    pub acceptance: Acceptance,
    /// The basins behind it.
    pub hierarchy: Hierarchy,
    /// The label of every cell, before merging and after.
    pub watersheds: Watersheds,
}

/// The basins of a landscape, at a given tolerance and at all tolerances.
#[derive(Debug, Clone, PartialEq)]
pub struct Hierarchy {
    /// The basins after merging, those with the most cells first.
    pub basins: Vec<Basin>,
    /// How they merge, at every tolerance.
    pub tree: MergeTree,
    /// The tolerance that was used, and why.
    pub tolerance: Choice,
    /// Accepted cells over the tolerance; empty if no cell holds the mated pose.
    pub staircase: Vec<ToleranceStep>,
}

/// Heights of `pair` over `grid`, flooded.
///
/// # Errors
/// When the grid does not suit the pair, does not fit into memory, or the computation is cancelled.
pub fn accept(
    pair: &Pair,
    grid: &Grid,
    settings: &FloodSettings,
    exec: &Exec,
) -> Result<Acceptance, FloodError> {
    let cells = grid.checked_len().unwrap_or(usize::MAX) as u64;
    ensure_fits(cells, Landscape::bytes(1), grid.axes.len(), exec)?;
    let landscape = Landscape::compute(pair, grid, exec)?;
    Ok(flood(&landscape, &pair.alignment, &docks(pair, grid), settings, exec)?.acceptance)
}

/// Whether a half let down at the centre of a cell docks, by exact motion. A grid may have no cell in a narrow hole: those around the
/// mated pose lie on its rim then, and their basin is not that of the mated pose.
pub fn docks<'a>(pair: &'a Pair, grid: &'a Grid) -> impl Fn(usize) -> bool + 'a {
    |cell| {
        let end = descent::outcome(pair, &grid.pose(cell), &descent::DescentSettings::default());
        end.outcome == Outcome::Aligned
    }
}

/// Floods a landscape; `docks` decides for the lowest cell around the mated pose whether it leads there, see
/// [`docks`].
///
/// # Errors
/// If the tolerance is not a depth, the landscape is too large, or the computation is cancelled.
pub fn flood(
    landscape: &Landscape,
    alignment: &Alignment,
    docks: &dyn Fn(usize) -> bool,
    settings: &FloodSettings,
    exec: &Exec,
) -> Result<Flooding, FloodError> {
    if let Some(depth) = settings.depth_tolerance
        && !(depth >= 0.0 && depth.is_finite())
    {
        return Err(FloodError::Tolerance { depth });
    }
    let Landscape { grid, heights } = landscape;
    let targets = target::cells(grid, alignment);
    let metric = Metric { grid, alignment };
    let (labels, tree) = divide(&grid.shape(), heights, &targets, settings.rule, &metric, exec)?;
    let lower = |a: usize, b: usize| if heights[b] < heights[a] { b } else { a };
    let mated = targets.iter().copied().reduce(lower);
    let staircase = mated.map_or_else(Vec::new, |cell| tree.staircase(labels[cell], heights[cell].into()));
    let tolerance = match settings.depth_tolerance {
        Some(depth) => Choice { depth, reason: ToleranceReason::Given },
        None => tolerance::choose(&tree, &staircase, tolerance::height_step(&grid.shape(), heights)),
    };
    let (mut acceptance, basins) =
        outcomes::verdict(landscape, &targets, docks, &labels, &tree, tolerance.depth, exec)?;
    acceptance.method = settings.rule.method();
    let watersheds = Watersheds { first: labels, into: tree.merged(tolerance.depth), outside: tree.outside };
    Ok(Flooding { acceptance, hierarchy: Hierarchy { basins, tree, tolerance, staircase }, watersheds })
}

/// Every cell's basin before merging, and the tree of the basins. Minima that contain one of the `targets`
/// are merged.
fn divide(
    shape: &[usize],
    heights: &[f32],
    targets: &[usize],
    rule: DrainageRule,
    metric: &Metric,
    exec: &Exec,
) -> Result<(Vec<u32>, MergeTree), FloodError> {
    const STAGE: &str = "flooding";
    if heights.len() >= LABEL_LIMIT as usize {
        return Err(FloodError::TooManyCells { cells: heights.len() });
    }
    ensure_fits(heights.len() as u64, 0, shape.len(), exec)?;
    let drained = drain::drain(shape, heights, rule, metric, exec)?;
    exec.report(0.5, STAGE);
    let count = drained.minima.len() as u64;
    let tree = count.saturating_mul((size_of::<Minimum>() + size_of::<Link>()) as u64);
    let needed = passes::bytes(count).saturating_mul(exec.threads() as u64).saturating_add(tree);
    exec.ensure_fits("the passes between basins", needed, |_| {
        vec![Advice::CoarserGrid, Advice::FewerThreads]
    })?;
    let passes = passes::passes(shape, heights, &drained, exec)?;
    let bottom = |cell: &usize| {
        let basin = drained.labels[*cell];
        let lowest = drained.minima[basin as usize] as usize;
        (heights[*cell] == heights[lowest] && Some(basin) != drained.outside).then_some(basin)
    };
    let mut joined: Vec<u32> = targets.iter().filter_map(bottom).collect();
    joined.sort_unstable();
    joined.dedup();
    let tree = MergeTree::new(&drained, heights, &passes, joined);
    exec.report(1.0, STAGE);
    Ok((drained.labels, tree))
}

/// Bytes per cell that flooding needs besides the heights: the number of its basin and its outcome. The
/// memory per basin is checked once their number is known.
const BYTES_PER_CELL: u64 = (size_of::<u32>() + size_of::<Outcome>()) as u64;

/// Bytes that flooding `cells` cells needs, heights included.
pub const fn bytes(cells: u64) -> u64 {
    cells.saturating_mul(BYTES_PER_CELL + Landscape::bytes(1))
}

fn ensure_fits(cells: u64, heights: u64, axes: usize, exec: &Exec) -> Result<(), OutOfBudget> {
    let per_cell = BYTES_PER_CELL + heights;
    exec.ensure_fits("flooding", cells.saturating_mul(per_cell), |budget| {
        vec![Advice::AtMostResolution(Resolution::largest_that_fits(budget, per_cell, axes))]
    })
}
