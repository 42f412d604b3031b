//! From merged basins to the outcome of every cell.

use super::Basin;
use super::tree::{MergeTree, explains};
use crate::acceptance::{Acceptance, Domain, Outcome};
use crate::diagnostic::{Diagnostic, Warning};
use crate::exec::{Cancelled, Exec};
use crate::landscape::{Grid, Landscape};
use rayon::prelude::*;

/// Number of cells between two checks of the cancel flag.
const CELLS_PER_CHECK: usize = 1 << 16;
/// Level ground this far above the seat does not belong to it, in D.
const ABOVE: f32 = 0.01;
/// A share of level ground among accepted cells that is worth a word: below it chance makes neighbours equal.
const LEVEL_SHARE: f64 = 1e-3;

/// Outcomes and basins at a tolerance. `targets` are the cells around the mated pose.
pub(super) fn verdict(
    landscape: &Landscape,
    targets: &[usize],
    docks: &dyn Fn(usize) -> bool,
    labels: &[u32],
    tree: &MergeTree,
    tolerance: f64,
    exec: &Exec,
) -> Result<(Acceptance, Vec<Basin>), Cancelled> {
    let Landscape { grid, heights } = landscape;
    let into = tree.merged(tolerance);
    let target = target_basin(heights, targets, docks, labels, tree, &into, tolerance);
    let outside = tree.outside.map(|basin| into[basin as usize]);
    let mut border_cells = 0;
    let mut result: Vec<Option<Basin>> = vec![None; into.len()];
    let cells = cells(tree, &into);
    let escapes = escapes(tree, &into);
    for (number, minimum) in tree.minima.iter().enumerate() {
        if into[number] as usize != number {
            continue;
        }
        let outcome = if Some(number as u32) == outside {
            Outcome::Missed
        } else if Some(number as u32) == target {
            Outcome::Aligned
        } else {
            let (outcome, on_border) = elsewhere(grid, minimum.cell);
            border_cells += if on_border { cells[number] } else { 0 };
            outcome
        };
        result[number] = Some(Basin {
            minimum: minimum.cell,
            height: minimum.height,
            depth: minimum.depth,
            escape: escapes[number],
            cells: cells[number],
            outcome,
        });
    }
    let outcome = |number: &u32| result[*number as usize].map_or(Outcome::Undecided, |basin| basin.outcome);
    let of_basin: Vec<Outcome> = into.iter().map(outcome).collect();
    let mut outcomes = vec![Outcome::Undecided; labels.len()];
    exec.install(|| {
        let pieces = outcomes.par_chunks_mut(CELLS_PER_CHECK).zip(labels.par_chunks(CELLS_PER_CHECK));
        pieces.try_for_each(|(outcomes, labels)| {
            exec.check()?;
            for (outcome, label) in outcomes.iter_mut().zip(labels) {
                *outcome = of_basin[*label as usize];
            }
            Ok(())
        })
    })?;
    let warnings = warnings(landscape, &outcomes, targets, border_cells, exec)?;
    let mut basins: Vec<Basin> = result.into_iter().flatten().collect();
    basins.sort_by(|a, b| b.cells.cmp(&a.cells).then(a.minimum.cmp(&b.minimum)));
    Ok((Acceptance { method: "flood", domain: Domain::Grid(grid.clone()), outcomes, warnings }, basins))
}

/// The number of the basin that drains to the mated pose: the basin with the lowest cell around it, unless
/// that cell does not dock, or the basin has joined a basin lower than the tolerance can explain.
fn target_basin(
    heights: &[f32],
    targets: &[usize],
    docks: &dyn Fn(usize) -> bool,
    labels: &[u32],
    tree: &MergeTree,
    into: &[u32],
    tolerance: f64,
) -> Option<u32> {
    let lower = |a: usize, b: usize| if heights[b] < heights[a] { b } else { a };
    let cell = targets.iter().copied().reduce(lower).filter(|cell| docks(*cell))?;
    let basin = into[labels[cell] as usize];
    let gathers_at = tree.minima[basin as usize].height;
    explains(tolerance, f64::from(heights[cell]) - gathers_at).then_some(basin)
}

/// Cells of every merged basin.
fn cells(tree: &MergeTree, into: &[u32]) -> Vec<usize> {
    let mut cells = vec![0; into.len()];
    for (minimum, last) in tree.minima.iter().zip(into) {
        cells[*last as usize] += minimum.cells;
    }
    cells
}

/// Height that the water must rise in every merged basin to overflow into another: over the lowest of the
/// tree's passes.
fn escapes(tree: &MergeTree, into: &[u32]) -> Vec<f64> {
    let mut escapes = vec![f64::INFINITY; into.len()];
    for link in &tree.links {
        let [a, b] = link.basins.map(|basin| into[basin as usize] as usize);
        if a != b {
            for basin in [a, b] {
                escapes[basin] = escapes[basin].min(link.height - tree.minima[basin].height);
            }
        }
    }
    escapes
}

/// The outcome of a basin that is neither the mated basin nor the outside, by the position of its minimum,
/// and whether that is on a border: missed at a border of a translation, jammed at a border of a rotation and
/// anywhere else.
pub(super) fn elsewhere(grid: &Grid, minimum: usize) -> (Outcome, bool) {
    let (translation, rotation) = on_border(grid, minimum);
    (if translation { Outcome::Missed } else { Outcome::Jammed }, translation || rotation)
}

/// Whether a cell lies on a border of a translation, and of a rotation.
fn on_border(grid: &Grid, index: usize) -> (bool, bool) {
    let cell = grid.cell(index);
    let at = |rotation: bool| {
        grid.axes
            .iter()
            .zip(&cell)
            .any(|(a, k)| a.dof.is_rotation() == rotation && (*k == 0 || k + 1 == a.cells))
    };
    (at(false), at(true))
}

/// The warnings; `border_cells` drain to a minimum on the border.
pub(super) fn warnings(
    landscape: &Landscape,
    outcomes: &[Outcome],
    targets: &[usize],
    border_cells: usize,
    exec: &Exec,
) -> Result<Vec<Diagnostic>, Cancelled> {
    let grid = &landscape.grid;
    let mut warnings = vec![Warning::FloodingBias.into()];
    if targets.is_empty() || targets.iter().all(|t| outcomes[*t] != Outcome::Aligned) {
        warnings.push(Warning::MatedPoseNotAccepted.into());
    }
    let [cells, of] = level_ground(landscape, outcomes, targets, exec)?;
    if cells as f64 > LEVEL_SHARE * of as f64 {
        warnings.push(Warning::LevelGround { cells, of }.into());
    }
    let axes = touched_axes(grid, outcomes);
    if !axes.is_empty() {
        warnings.push(Warning::TouchesBorder { axes }.into());
    }
    if border_cells > 0 {
        let share = 100.0 * border_cells as f64 / outcomes.len() as f64;
        let text = format!(
            "{share:.1} % of the poses drain to the border of the error box, beyond which nothing was sampled; \
             they count as missed at a border of x or y, as jammed at one of an angle"
        );
        warnings.push(Diagnostic::warning("drains-to-border", text));
    }
    Ok(warnings)
}

/// Cells that are level with their neighbours along every axis, above the seat and accepted; and how many are accepted.
fn level_ground(
    Landscape { grid, heights }: &Landscape,
    outcomes: &[Outcome],
    targets: &[usize],
    exec: &Exec,
) -> Result<[usize; 2], Cancelled> {
    let seat = targets.iter().map(|t| heights[*t]).fold(f32::INFINITY, f32::min);
    let strides: Vec<(usize, usize)> = grid
        .axes
        .iter()
        .scan(1, |stride, axis| {
            let own = *stride;
            *stride *= axis.cells;
            Some((own, axis.cells))
        })
        .collect();
    let level = |cell: usize| {
        heights[cell] > seat + ABOVE
            && strides.iter().all(|&(stride, cells)| {
                let k = cell / stride % cells;
                (k == 0 || heights[cell - stride] == heights[cell])
                    && (k + 1 == cells || heights[cell + stride] == heights[cell])
            })
    };
    exec.install(|| {
        let pieces = outcomes.par_chunks(CELLS_PER_CHECK).enumerate();
        let count = |(piece, outcomes): (usize, &[Outcome])| {
            exec.check()?;
            let first = piece * CELLS_PER_CHECK;
            let accepted = (first..).zip(outcomes).filter(|(_, outcome)| **outcome == Outcome::Aligned);
            Ok(accepted.fold([0, 0], |[flat, all], (cell, _)| [flat + usize::from(level(cell)), all + 1]))
        };
        pieces.map(count).try_reduce(|| [0, 0], |a, b| Ok([a[0] + b[0], a[1] + b[1]]))
    })
}

/// Names of the axes at whose border a cell is accepted.
fn touched_axes(grid: &Grid, outcomes: &[Outcome]) -> Vec<String> {
    let mut names = Vec::new();
    let mut stride = 1;
    for axis in &grid.axes {
        // The cells at either border form runs of `stride` cells, a run per `block`.
        let block = stride * axis.cells;
        let aligned = |run: &[Outcome]| run.contains(&Outcome::Aligned);
        let touches = outcomes
            .chunks_exact(block)
            .any(|block| aligned(&block[..stride]) || aligned(&block[block.len() - stride..]));
        if touches {
            names.push(axis.dof.name().to_owned());
        }
        stride = block;
    }
    names
}
