//! Propagation of labels from box to box by the direction of motion through their faces.
//!
//! ```text
//!      │ ↗ ↗ │            through   a face passes motions in one direction or both, by the pushes of its contacts; bounds hold for the whole face
//!      ├──┄──┤  seat      yes       boxes that motions leave only into other such boxes, and in which no motion rests or ends
//!      │ ↗ ↗ →  boxes     no        boxes without a chain of faces to the seat or to unknown boxes
//! ```
//!
//! The height decreases along a motion. A motion that stays in boxes without rests outside the seat therefore
//! comes to rest in the seat. The set that chains of faces reach is larger than the set that motions reach;
//! but neither argument follows a single motion, and both hold for any number of errors.
//!
//! Faces alone do not limit the distance that a motion travels along them. Each box therefore also stores the
//! bearings ([`super::bearing`]) along which no motion in it goes back, and a chain that would have to go
//! back is excluded.
//!
//! Two boxes that share less than a face need no separate treatment: if a motion passes through a corner, the
//! contact that pushes it there is on a face of a box between.

use super::flood::Seat;
use super::tree::{Cell, Face, Label, Tree};
use crate::exec::{Cancelled, Exec};
use crate::tolerance::COINCIDENT;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Number of boxes between two checks for cancellation.
const BETWEEN: usize = 1024;

/// Labels all boxes that faces decide.
///
/// # Errors
/// [`Cancelled`] if a stop is requested.
pub(super) fn spread(tree: &mut Tree, seat: &Seat<'_>, exec: &Exec) -> Result<(), Cancelled> {
    let in_seat = seat.reach(tree, exec)?;
    let is = |cell: &Cell, yes: bool| cell.label.is_some_and(|label| (label == Label::Yes) == yes);
    let falls_off = |cell: &Cell| cell.height.is_none() || cell.ends;
    let ends_elsewhere = |_, cell: &Cell| {
        is(cell, false)
            || !is(cell, true)
                && (cell.walled || tree.leaves_root(cell) || falls_off(cell) || seat.lets_rest(cell))
    };
    let may_end = back(tree, ends_elsewhere, |cell| !is(cell, true), exec)?;
    let seated = |number: usize, cell: &Cell| {
        is(cell, true) || !is(cell, false) && cell.height.is_some() && (in_seat[number] || tree.loses(cell))
    };
    // A motion ends at a box without contact.
    let may_dock = back(tree, seated, |cell| !is(cell, false) && cell.height.is_some(), exec)?;
    let may_fall = back(tree, |_, cell| falls_off(cell) || tree.leaves_root(cell), |_| true, exec)?;
    for (number, cell) in tree.cells.iter_mut().enumerate() {
        if cell.is_split() || is(cell, true) {
            continue;
        }
        // Heights alone may show that a motion does not dock; faces decide whether it leaves or jams.
        let rejected = if may_fall[number] { Label::Leaves } else { Label::Jams };
        cell.label = match (may_end[number], may_dock[number] && !is(cell, false)) {
            (false, _) => Some(Label::Yes),
            (true, false) => Some(rejected),
            (true, true) => None,
        };
    }
    Ok(())
}

/// The leaves from which a chain of faces may lead to sources, through leaves that let through, without going back along a bearing.
fn back(
    tree: &Tree,
    is_source: impl Fn(usize, &Cell) -> bool,
    through: impl Fn(&Cell) -> bool,
    exec: &Exec,
) -> Result<Vec<bool>, Cancelled> {
    let sources: Vec<usize> =
        tree.leaves().filter(|(number, cell)| is_source(*number, cell)).map(|(number, _)| number).collect();
    let leads_on =
        |to: &Cell, from: &Cell, face: Face| through(from) && goes(from, to, face.axis(), !face.above);
    let mut leads = chained(tree, &sources, leads_on, exec)?;
    let way = SourceChains::of(tree, &sources, &leads);
    let ruled_out = exec.try_map(tree.bearings.len(), |bearing| way.ruled_out(bearing, exec))?;
    for number in ruled_out.into_iter().flatten() {
        leads[number] = false;
    }
    Ok(leads)
}

/// Chains of faces to sources.
struct SourceChains<'a> {
    tree: &'a Tree,
    sources: &'a [usize],
    /// The leaves that such chains lead through.
    leads: &'a [bool],
    /// The faces through which chains lead to each leaf, one leaf after the other.
    faces: Vec<Face>,
    /// Where the faces of each leaf begin, and where those of the last end.
    starts: Vec<usize>,
}

/// A leaf that a source may reach, and the distance reached along a bearing; ordered by the farthest, then by
/// the smaller number.
#[derive(PartialEq)]
struct FarthestLeaf {
    farthest: f64,
    number: usize,
}

impl Eq for FarthestLeaf {}

impl Ord for FarthestLeaf {
    fn cmp(&self, other: &Self) -> Ordering {
        self.farthest.total_cmp(&other.farthest).then(other.number.cmp(&self.number))
    }
}

impl PartialOrd for FarthestLeaf {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<'a> SourceChains<'a> {
    fn of(tree: &'a Tree, sources: &'a [usize], leads: &'a [bool]) -> Self {
        let (mut faces, mut starts) = (Vec::new(), vec![0]);
        for (to, is_on_chain) in tree.cells.iter().zip(leads) {
            let leads_here = |face: &&Face| {
                let next = face.number();
                leads[next] && goes(&tree.cells[next], to, face.axis(), !face.above)
            };
            if *is_on_chain {
                faces.extend(to.faces.iter().filter(leads_here));
            }
            starts.push(faces.len());
        }
        Self { tree, sources, leads, faces, starts }
    }

    /// The leaves all of whose chains would have to go back along a bearing: the farthest reach along it of
    /// all leaves that may lead on stays behind the whole leaf.
    ///
    /// The reach of a leaf in which no motion goes back is that of its outgoing faces, limited by the reach
    /// of the leaves behind them.
    fn ruled_out(&self, bearing: usize, exec: &Exec) -> Result<Vec<usize>, Cancelled> {
        let Self { tree, sources, leads, faces, starts } = self;
        let rises = |cell: &Cell| cell.rising >> bearing & 1 == 1;
        let range = |(cell, is_on_chain): (&Cell, &bool)| {
            if *is_on_chain { tree.bearings.range(bearing, &cell.poses) } else { [0.0; 2] }
        };
        let ranges: Vec<[f64; 2]> = tree.cells.iter().zip(*leads).map(range).collect();
        let mut farthest = vec![f64::NEG_INFINITY; tree.cells.len()];
        for number in *sources {
            farthest[*number] = ranges[*number][1];
        }
        let far = |number: usize, farthest: f64| FarthestLeaf { farthest, number };
        let mut open: BinaryHeap<FarthestLeaf> = sources.iter().map(|k| far(*k, farthest[*k])).collect();
        let mut taken = 0usize;
        while let Some(FarthestLeaf { number, farthest: then }) = open.pop() {
            if then < farthest[number] {
                continue;
            }
            taken += 1;
            if taken.is_multiple_of(BETWEEN) {
                exec.check()?;
            }
            let to = &tree.cells[number];
            for face in &faces[starts[number]..starts[number + 1]] {
                let next = face.number();
                if farthest[next] >= ranges[next][1] {
                    continue;
                }
                let from = &tree.cells[next];
                let shared = tree.shared(to, from, *face);
                let [first, last] = tree.bearings.range(bearing, &shared);
                if farthest[number] < first - COINCIDENT {
                    continue;
                }
                // If an axis is periodic, positions on the two sides of the face differ.
                let reach = if !rises(from) || tree.closes(to, *face) {
                    ranges[next][1]
                } else {
                    farthest[number].min(last)
                };
                if reach > farthest[next] {
                    farthest[next] = reach;
                    open.push(far(next, reach));
                }
            }
        }
        let all = tree.leaves().filter(|(number, cell)| leads[*number] && rises(cell));
        Ok(all.map(|(k, _)| k).filter(|k| farthest[*k] < ranges[*k][0] - COINCIDENT).collect())
    }
}

/// The undecided leaves to which a chain of undecided leaves may lead from the error box, itself included:
/// smaller boxes may decide them.
///
/// # Errors
/// [`Cancelled`] if a stop is requested.
pub(super) fn ahead(tree: &Tree, exec: &Exec) -> Result<Vec<usize>, Cancelled> {
    let requested = tree.leaves().filter(|(_, cell)| cell.label.is_none() && tree.is_in_error_box(cell));
    let sources: Vec<usize> = requested.map(|(number, _)| number).collect();
    let leads_on =
        |from: &Cell, to: &Cell, face: Face| to.label.is_none() && goes(from, to, face.axis(), face.above);
    let seen = chained(tree, &sources, leads_on, exec)?;
    Ok((0..seen.len()).filter(|number| seen[*number]).collect())
}

/// For every box whether it is in `sources` or a chain of faces leads to it from them; `leads_on` decides
/// whether a face leads from a box to the next.
fn chained(
    tree: &Tree,
    sources: &[usize],
    leads_on: impl Fn(&Cell, &Cell, Face) -> bool,
    exec: &Exec,
) -> Result<Vec<bool>, Cancelled> {
    let mut chained = vec![false; tree.cells.len()];
    for number in sources {
        chained[*number] = true;
    }
    let (mut open, mut taken) = (sources.to_vec(), 0usize);
    while let Some(number) = open.pop() {
        taken += 1;
        if taken.is_multiple_of(BETWEEN) {
            exec.check()?;
        }
        let here = &tree.cells[number];
        for face in &here.faces {
            let next = face.number();
            if !chained[next] && leads_on(here, &tree.cells[next], *face) {
                chained[next] = true;
                open.push(next);
            }
        }
    }
    Ok(chained)
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
