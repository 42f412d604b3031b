//! Memory needs of pictures, known before they are drawn.
//!
//! ```text
//!   fonts, pixels of a page, its encoder    PAGE_BYTES; the pages of a run RUN_BYTES
//!   maps                                    MAP_BYTES per cell: colours, their PNG, and that once more as text in the SVG
//! ```
//!
//! Measured; `tests/memory.py` repeats the measurement.

use catchment_core::acceptance::Domain;
use catchment_core::diagnostic::Advice;
use catchment_core::exec::{Exec, OutOfBudget};
use catchment_core::landscape::Grid;
use catchment_core::merit::slice;
use catchment_core::run::RunPlan;

/// Bytes of a picture, and of the pictures of a run, without their maps.
const PAGE_BYTES: u64 = 32 << 20;
const RUN_BYTES: u64 = 96 << 20;
/// Bytes per cell that a map shows.
const MAP_BYTES: u64 = 14;

/// Refuses a picture whose maps show so many cells, if it does not fit into memory.
///
/// # Errors
/// It does not.
pub fn ensure_fits(cells: u64, exec: &Exec) -> Result<(), OutOfBudget> {
    ensure(PAGE_BYTES, cells, exec)
}

/// The same of a picture of every two axes of a grid.
///
/// # Errors
/// It does not fit.
pub fn ensure_grid_fits(grid: &Grid, exec: &Exec) -> Result<(), OutOfBudget> {
    ensure_fits(shown(grid), exec)
}

/// The same of the pictures of a run that is planned.
///
/// # Errors
/// They do not fit.
pub fn ensure_run_fits(plan: &RunPlan, exec: &Exec) -> Result<(), OutOfBudget> {
    ensure_domain_fits(&plan.domain, exec)
}

/// The same of the pictures of a run over these poses.
pub(super) fn ensure_domain_fits(domain: &Domain, exec: &Exec) -> Result<(), OutOfBudget> {
    let cells = match domain {
        Domain::Grid(grid) => shown(grid),
        Domain::Poses(_) => 0,
    };
    ensure(RUN_BYTES, cells, exec)
}

/// Cells of the maps of every two axes.
fn shown(grid: &Grid) -> u64 {
    let cells = |dof| grid.axes.iter().find(|axis| axis.dof == dof).map_or(1, |axis| axis.cells as u64);
    let planes = slice::pairs(grid).into_iter().map(|[a, b]| cells(a).saturating_mul(cells(b)));
    planes.fold(0, u64::saturating_add)
}

fn ensure(fixed: u64, cells: u64, exec: &Exec) -> Result<(), OutOfBudget> {
    let needed = fixed.saturating_add(cells.saturating_mul(MAP_BYTES));
    exec.ensure_fits("drawing the pictures", needed, |budget| {
        let coarser = (budget > fixed).then_some(Advice::CoarserGrid);
        coarser.into_iter().chain([Advice::MoreMemory]).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_beyond_the_budget_are_refused_with_advice() {
        let exec = Exec::new().with_memory_budget(PAGE_BYTES + 100 * MAP_BYTES);
        assert!(ensure_fits(100, &exec).is_ok());
        let refused = ensure_fits(101, &exec).unwrap_err();
        assert_eq!(refused.advice.0, [Advice::CoarserGrid, Advice::MoreMemory]);
        let refused = ensure_fits(0, &exec.with_memory_budget(PAGE_BYTES - 1)).unwrap_err();
        assert_eq!(refused.advice.0, [Advice::MoreMemory]);
    }
}
