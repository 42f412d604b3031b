//! Labels that spread from box to box by the direction of motion through their faces.
//!
//! ```text
//!      │ ↗ ↗ │            through   a face lets motion through one way or both, as what touches on it may push; bounds hold for the whole face
//!      ├──┄──┤  seat      yes       boxes that nothing leaves but into boxes of their own, nothing rests in, and no motion ends in
//!      │ ↗ ↗ →  boxes     no        boxes from which no chain of faces leads to the seat or to what is not known
//! ```
//!
//! The height falls all along a motion, so one that stays among boxes in which nothing rests comes to rest in the seat that is one of them. What a
//! chain of faces leads to is more than what motions come to; but neither argument follows a single motion, and both hold for any number of errors.
//!
//! Two boxes that share less than a face need no word: where a motion goes through a corner, what pushes it there is on a face of a box between.

use super::flood::Seat;
use super::tree::{Cell, Label, Tree};
use crate::exec::{Cancelled, Exec};

/// Boxes that are taken between two looks at whether to stop.
const BETWEEN: usize = 1024;

/// Labels all boxes that faces decide.
///
/// # Errors
/// [`Cancelled`] when asked to stop.
pub(super) fn spread(tree: &mut Tree, seat: &Seat<'_>, exec: &Exec) -> Result<(), Cancelled> {
    let in_seat = seat.reach(tree, exec)?;
    let is = |cell: &Cell, yes: bool| cell.label.is_some_and(|label| (label == Label::Yes) == yes);
    let falls_off = |cell: &Cell| cell.height.is_none() || cell.ends;
    let otherwise = |_, cell: &Cell| {
        is(cell, false)
            || !is(cell, true)
                && (cell.walled || tree.leaves_root(cell) || falls_off(cell) || seat.lets_rest(tree, cell))
    };
    let may_end = back(tree, otherwise, |cell| !is(cell, true), exec)?;
    let seated = |number: usize, cell: &Cell| {
        is(cell, true) || !is(cell, false) && cell.height.is_some() && (in_seat[number] || tree.loses(cell))
    };
    // Where nothing touches, a motion has ended.
    let may_dock = back(tree, seated, |cell| !is(cell, false) && cell.height.is_some(), exec)?;
    let may_fall = back(tree, |_, cell| falls_off(cell), |_| true, exec)?;
    for (number, cell) in tree.cells.iter_mut().enumerate() {
        if cell.is_split() || cell.label.is_some() {
            continue;
        }
        let otherwise = if may_fall[number] { Label::Leaves } else { Label::Jams };
        cell.label = match (may_end[number], may_dock[number]) {
            (false, _) => Some(Label::Yes),
            (true, false) => Some(otherwise),
            (true, true) => None,
        };
    }
    Ok(())
}

/// The leaves from which a chain of faces may lead to sources, through leaves that let through.
fn back(
    tree: &Tree,
    is_source: impl Fn(usize, &Cell) -> bool,
    through: impl Fn(&Cell) -> bool,
    exec: &Exec,
) -> Result<Vec<bool>, Cancelled> {
    let mut leads = vec![false; tree.cells.len()];
    let mut open: Vec<usize> =
        tree.leaves().filter(|(number, cell)| is_source(*number, cell)).map(|(number, _)| number).collect();
    for number in &open {
        leads[*number] = true;
    }
    let mut taken = 0usize;
    while let Some(number) = open.pop() {
        taken += 1;
        if taken.is_multiple_of(BETWEEN) {
            exec.check()?;
        }
        let to = &tree.cells[number];
        tree.beside(to, |next, axis, above| {
            let from = &tree.cells[next];
            if !leads[next] && through(from) && goes(from, to, axis, !above) {
                leads[next] = true;
                open.push(next);
            }
        });
    }
    Ok(leads)
}

/// The undecided leaves to which a chain of such may lead from the error box, itself among them: what they do not tell apart, smaller ones may.
///
/// # Errors
/// [`Cancelled`] when asked to stop.
pub(super) fn ahead(tree: &Tree, exec: &Exec) -> Result<Vec<usize>, Cancelled> {
    let mut seen = vec![false; tree.cells.len()];
    let asked = tree.leaves().filter(|(_, cell)| cell.label.is_none() && tree.is_asked(cell));
    let mut open: Vec<usize> = asked.map(|(number, _)| number).collect();
    for number in &open {
        seen[*number] = true;
    }
    let mut all = open.clone();
    let mut taken = 0usize;
    while let Some(number) = open.pop() {
        taken += 1;
        if taken.is_multiple_of(BETWEEN) {
            exec.check()?;
        }
        let from = &tree.cells[number];
        tree.beside(from, |next, axis, above| {
            let to = &tree.cells[next];
            if !seen[next] && to.label.is_none() && goes(from, to, axis, above) {
                seen[next] = true;
                open.push(next);
                all.push(next);
            }
        });
    }
    Ok(all)
}

/// Whether a motion may go from a leaf to its neighbour, up an axis or down it.
fn goes(from: &Cell, to: &Cell, axis: usize, up: bool) -> bool {
    let side = usize::from(up);
    let through = |cell: &Cell, side: usize| {
        let ways = cell.flows.0[axis][side];
        if up { ways.up } else { ways.down }
    };
    through(from, side) && through(to, 1 - side)
}
