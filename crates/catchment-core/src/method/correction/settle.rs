//! Exact motions of cells that a method leaves undecided.

use crate::acceptance::Outcome;
use crate::exec::{Cancelled, Exec};
use crate::landscape::Grid;
use crate::pose::PoseError;

/// Number of cells between two checks for cancellation.
const BLOCK: usize = 1 << 16;

/// Number of ambiguous cells among `cells` cells, and their list, in ascending order; no list if they are
/// more than `most`.
///
/// # Errors
/// [`Cancelled`] if a stop is requested.
pub fn ambiguous(
    cells: usize,
    is_ambiguous: impl Fn(usize) -> bool + Sync,
    most: usize,
    exec: &Exec,
) -> Result<(usize, Vec<usize>), Cancelled> {
    let blocks = cells.div_ceil(BLOCK);
    let within = |block: usize| block * BLOCK..cells.min((block + 1) * BLOCK);
    let found = |block| within(block).filter(|cell| is_ambiguous(*cell));
    let count = exec.map(blocks, |block| found(block).count())?.into_iter().sum();
    if count > most {
        return Ok((count, Vec::new()));
    }
    let lists = exec.map(blocks, |block| found(block).collect::<Vec<_>>())?;
    Ok((count, lists.concat()))
}

/// Follows the centres of `cells` by `follow`, which returns an outcome for each pose, and overwrites their
/// outcomes; cells beyond the grid are not changed.
///
/// # Errors
/// Those of `follow`; `outcomes` is then partly overwritten.
pub fn settle<E>(
    grid: &Grid,
    cells: &[usize],
    outcomes: &mut [Outcome],
    exec: &Exec,
    mut follow: impl FnMut(Vec<PoseError>, &Exec) -> Result<Vec<Outcome>, E>,
) -> Result<(), E> {
    let (mut done, all) = (0.0, cells.len() as f64);
    // In blocks, so that the ends of few poses are kept at a time.
    for block in cells.chunks(BLOCK) {
        let poses = block.iter().map(|cell| grid.pose(*cell)).collect();
        let next = done + block.len() as f64;
        let part = exec.part([done / all, next / all], "ambiguous cells");
        for (cell, outcome) in block.iter().zip(follow(poses, &part)?) {
            if let Some(place) = outcomes.get_mut(*cell) {
                *place = outcome;
            }
        }
        done = next;
    }
    Ok(())
}
