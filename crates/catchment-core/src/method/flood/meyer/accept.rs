//! The dissertation's flooding with dams on an ordinary error grid: the outcome of every cell.
//!
//! ```text
//!   divide ──▶ dams to steepest descent ──▶ basin of the mated pose   aligned
//!                                           outside                   missed
//!                                           minimum on a border       missed (x, y) or jammed (angles)
//!                                           any other minimum         jammed
//! ```

use super::basins::Shore;
use super::{Division, Rules, divide};
use crate::acceptance::{Acceptance, Domain, Outcome};
use crate::design::{Alignment, ConnectorSpec, Design};
use crate::diagnostic::Advice;
use crate::exec::Exec;
use crate::landscape::{Landscape, Resolution};
use crate::method::flood::steepest::Metric;
use crate::method::flood::tolerance::{self, Choice, ToleranceReason};
use crate::method::flood::tree::explains;
use crate::method::flood::{self, DrainageRule, FloodError, Watersheds, outcomes, target};
use serde::{Deserialize, Serialize};

/// Settings that change the result.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct MeyerSettings {
    /// Basins shallower than this are merged, in D; 0 keeps every minimum. The default lies in the widest gap
    /// between the depths, as in [`flood`](super::super::flood).
    pub depth_tolerance: Option<f64>,
    /// Choices at ambiguous points of the text.
    #[serde(default)]
    pub rules: Rules,
}

impl MeyerSettings {
    /// Depth tolerance of the text, as a share of the height H of the face.
    pub const DEPTH_PER_FACE_HEIGHT: f64 = 0.1;

    /// The settings of the text for a design: a tolerance of 0.1·H, in D, if the connector is of a family,
    /// whose H is known. Pieces and meshes have no H, because their face is not defined; the widest gap
    /// decides instead, which on the families accepts the same cells wherever the two were compared.
    pub fn of(design: &Design) -> Self {
        let depth_tolerance = match &design.connector {
            ConnectorSpec::Family(spec) => Some(Self::DEPTH_PER_FACE_HEIGHT * spec.aspect_ratio()),
            ConnectorSpec::Own(_) => None,
        };
        Self { depth_tolerance, ..Self::default() }
    }

    /// Merges basins shallower than `depth`, in D.
    pub fn with_tolerance(depth: f64) -> Self {
        Self { depth_tolerance: Some(depth), ..Self::default() }
    }
}

/// The result of flooding.
#[derive(Debug, Clone, PartialEq)]
pub struct MeyerFlooding {
    /// Outcome of every cell.
    pub acceptance: Acceptance,
    /// The tolerance that was used, and why.
    pub tolerance: Choice,
    /// The label of every cell, before merging and after; dams are given to no watershed yet.
    pub watersheds: Watersheds,
}

/// Bytes per cell beside the heights: its basin before and after dams are given, its place on the water line (the queue doubles as it
/// grows), its place in the list of dams, and its outcome.
const BYTES_PER_CELL: u64 =
    (2 * size_of::<u32>() + 2 * size_of::<Shore<f32>>() + size_of::<usize>() + size_of::<Outcome>()) as u64;

/// Bytes needed to flood `cells` cells, including heights; the passes between basins need additional memory.
pub const fn bytes(cells: u64) -> u64 {
    cells.saturating_mul(BYTES_PER_CELL + Landscape::bytes(1))
}

/// Floods a landscape by Meyer's queue; `docks` as for [`flood`](super::super::flood).
///
/// The mated pose is treated as in [`flood`](super::super::flood): the minima among the cells around it are
/// merged, and if no such cell is a minimum, the target is the basin of the lowest. If that basin drains
/// deeper below the mated pose than the tolerance explains, no cell is accepted.
///
/// # Errors
/// If the tolerance is not a depth, the landscape is too large, or the computation is cancelled.
pub fn accept(
    landscape: &Landscape,
    alignment: &Alignment,
    docks: &dyn Fn(usize) -> bool,
    settings: &MeyerSettings,
    exec: &Exec,
) -> Result<MeyerFlooding, FloodError> {
    let Landscape { grid, heights } = landscape;
    if let Some(depth) = settings.depth_tolerance
        && !(depth >= 0.0 && depth.is_finite())
    {
        return Err(FloodError::Tolerance { depth });
    }
    exec.ensure_fits("flooding", (heights.len() as u64).saturating_mul(BYTES_PER_CELL), |budget| {
        let largest = Resolution::largest_that_fits(budget, BYTES_PER_CELL, grid.axes.len());
        vec![Advice::AtMostResolution(largest)]
    })?;
    let (shape, targets) = (grid.shape(), target::cells(grid, alignment));
    let tolerance = match settings.depth_tolerance {
        Some(depth) => Choice { depth, reason: ToleranceReason::Given },
        None => widest_gap(landscape, alignment, &targets, exec)?,
    };
    let mut division = divide(&shape, heights, &targets, tolerance.depth, settings.rules, exec)?;
    let watersheds = division.watersheds();
    division.give_dams(heights);
    let count = division.merged.into.len();
    let mated = mated_basin(&division, heights, &targets, docks, tolerance.depth);
    // The lowest cell of every basin, the first in memory among equals, and how many cells it has.
    let mut basins: Vec<Option<(usize, usize)>> = vec![None; count];
    for cell in 0..heights.len() {
        let Some(basin) = division.basin(cell) else { continue };
        let (lowest, cells) = basins[basin as usize].get_or_insert((cell, 0));
        *cells += 1;
        if heights[cell] < heights[*lowest] {
            *lowest = cell;
        }
    }
    let mut border_cells = 0;
    let mut of_basin = vec![Outcome::Undecided; count];
    for (basin, result) in (0..).zip(&basins) {
        let Some((lowest, cells)) = *result else { continue };
        of_basin[basin as usize] = if Division::is_outside(basin) {
            Outcome::Missed
        } else if Some(basin) == mated {
            Outcome::Aligned
        } else {
            let (outcome, on_border) = outcomes::elsewhere(grid, lowest);
            border_cells += if on_border { cells } else { 0 };
            outcome
        };
    }
    // Each cell has a basin once dams are assigned: a landscape without NaN leaves no cell undecided.
    let outcome = |cell| division.basin(cell).map_or(Outcome::Undecided, |basin| of_basin[basin as usize]);
    let outcomes: Vec<Outcome> = (0..heights.len()).map(outcome).collect();
    let warnings = outcomes::warnings(landscape, &outcomes, &targets, border_cells, exec)?;
    let acceptance = Acceptance { method: "meyer", domain: Domain::Grid(grid.clone()), outcomes, warnings };
    Ok(MeyerFlooding { acceptance, tolerance, watersheds })
}

/// The basin that gathers at the mated pose.
fn mated_basin(
    division: &Division,
    heights: &[f32],
    targets: &[usize],
    docks: &dyn Fn(usize) -> bool,
    tolerance: f64,
) -> Option<u32> {
    let lower = |a: usize, b: usize| if heights[b] < heights[a] { b } else { a };
    let cell = targets.iter().copied().reduce(lower).filter(|cell| docks(*cell))?;
    let basin = division.basin(cell)?;
    explains(tolerance, f64::from(heights[cell]) - division.bottom(basin)).then_some(basin)
}

/// The tolerance in the widest gap between the depths of the exact merge tree, whose minima are the same.
fn widest_gap(
    landscape: &Landscape,
    alignment: &Alignment,
    targets: &[usize],
    exec: &Exec,
) -> Result<Choice, FloodError> {
    let Landscape { grid, heights } = landscape;
    let shape = grid.shape();
    let metric = Metric { grid, alignment };
    let (labels, tree) = flood::divide(&shape, heights, targets, DrainageRule::Lowest, &metric, exec)?;
    let lower = |a: usize, b: usize| if heights[b] < heights[a] { b } else { a };
    let mated = targets.iter().copied().reduce(lower);
    let staircase = mated.map_or_else(Vec::new, |cell| tree.staircase(labels[cell], heights[cell].into()));
    Ok(tolerance::choose(&tree, &staircase, tolerance::height_step(&shape, heights)))
}
