//! Cells that a method leaves in doubt, followed exactly.

use crate::acceptance::{Domain, Outcome};
use crate::contact::Pair;
use crate::exec::{Cancelled, Exec};
use crate::landscape::Grid;
use crate::method::descent;

/// Cells followed between two looks at the memory they need: what is kept of each is small, of all at once is not.
const BATCH: usize = 1 << 16;

/// Follows the centres of `cells` exactly and overwrites their outcomes; cells beyond the grid are left alone.
///
/// # Errors
/// [`Cancelled`] when asked to stop; `outcomes` is then partly overwritten.
pub fn settle(
    pair: &Pair,
    grid: &Grid,
    cells: &[usize],
    outcomes: &mut [Outcome],
    settings: &descent::Settings,
    exec: &Exec,
) -> Result<(), Cancelled> {
    let (mut done, all) = (0.0, cells.len() as f64);
    for batch in cells.chunks(BATCH) {
        let poses = batch.iter().map(|cell| grid.pose(*cell)).collect();
        let span = [done, done + batch.len() as f64].map(|n| n / all);
        let part = exec.part(span, "ambiguous cells");
        let (settled, _) = descent::run(pair, Domain::Poses(poses), settings, &part)?;
        for (cell, outcome) in batch.iter().zip(settled.outcomes) {
            if let Some(place) = outcomes.get_mut(*cell) {
                *place = outcome;
            }
        }
        done += batch.len() as f64;
    }
    Ok(())
}
