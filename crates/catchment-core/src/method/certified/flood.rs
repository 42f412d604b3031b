//! Labels that follow from heights alone: a motion cannot climb.
//!
//! ```text
//!   h │      pass ╲ exit        from the seat, boxes are visited in the order of the lowest path to them by floors:
//!     │ ╲     ╱‾‾‾╲╱            level   the search ends at the first box that may let a motion leave or rest
//!     │  ╲╱╲ ╱                  yes     visited before, roof below the level
//!     │   seat                  no      roof below the lowest path to the seat, or to unknown boxes
//! ```
//!
//! *Yes*: during its descent such a motion stays in boxes taken before. None of these lets it rest outside
//! the terminal boxes, and every rest in a terminal box is in the seat, so it docks. *No*: consider the
//! connected set of poses below the motion's height that contains it; this set contains neither the seat nor
//! a border. Both arguments hold in any dimension, for any metric of the motion.
//!
//! The same two walks bound the **retention** of the seat: by floors from below; from above by roofs, up to a
//! place from which no motion returns.

use super::home::Home;
use super::placed::PoseBox;
use super::tree::{Cell, Label, Tree};
use crate::contact::OVER_A_PATH;
use crate::exec::{Cancelled, Exec};
use std::cmp::Ordering;
use std::collections::{BTreeSet, BinaryHeap};

/// A box that can be reached at a height; ordered by the lowest height, then by the smaller number.
#[derive(PartialEq)]
struct ReachableBox {
    height: f64,
    number: usize,
    /// The box from which it was reached; itself for a source.
    from: usize,
}

impl Eq for ReachableBox {}

impl Ord for ReachableBox {
    fn cmp(&self, other: &Self) -> Ordering {
        other.height.total_cmp(&self.height).then(other.number.cmp(&self.number))
    }
}

impl PartialOrd for ReachableBox {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// Visits boxes in the order of their lowest path from `sources`: `visit` receives each with the height of
/// its path, and returns whether to continue from it, or to end.
fn walk(
    tree: &Tree,
    exec: &Exec,
    sources: impl Iterator<Item = usize>,
    height: impl Fn(&Cell) -> Option<f64>,
    mut visit: impl FnMut(&ReachableBox) -> Expansion,
) -> Result<(), Cancelled> {
    let mut open = BinaryHeap::new();
    let mut taken = 0usize;
    let mut seen = vec![false; tree.cells.len()];
    let mut push = |open: &mut BinaryHeap<ReachableBox>, number: usize, from: usize, way: f64| {
        if !seen[number]
            && let Some(own) = height(&tree.cells[number])
        {
            seen[number] = true;
            open.push(ReachableBox { height: own.max(way), number, from });
        }
    };
    sources.for_each(|number| push(&mut open, number, number, f64::NEG_INFINITY));
    while let Some(reached) = open.pop() {
        let ReachableBox { height, number, .. } = reached;
        taken += 1;
        if taken.is_multiple_of(BETWEEN) {
            exec.check()?;
        }
        match visit(&reached) {
            Expansion::Go => {
                let faces = tree.cells[number].faces.iter();
                faces.for_each(|face| push(&mut open, face.number(), number, height));
            }
            Expansion::End => break,
        }
    }
    Ok(())
}

/// Number of boxes between two checks for cancellation.
const BETWEEN: usize = 1024;

/// Whether to go on from a box.
enum Expansion {
    Go,
    End,
}

/// The seat: the region in which every rest is docked, and the poses that belong to it.
#[derive(Clone, Copy)]
pub(super) struct Seat<'a> {
    /// Deepest that anything rests that is docked, and the level of the seat, in D.
    pub(super) mated: f64,
    pub(super) level: f64,
    /// Whether every rest in a box, at the seat's level or below, is docked.
    pub(super) holds: &'a dyn Fn(&PoseBox) -> bool,
    /// The certified neighbourhood of the mated pose without rests outside the seat.
    pub(super) home: Option<Home>,
    /// Whether a box may contain poses that count as connected with a mated pose.
    pub(super) meets: &'a dyn Fn(&PoseBox) -> bool,
}

impl Seat<'_> {
    /// The boxes that may be connected with a mated pose.
    fn boxes(&self, tree: &Tree) -> Vec<usize> {
        tree.leaves().filter(|(_, cell)| (self.meets)(&cell.poses)).map(|(number, _)| number).collect()
    }

    /// For every box whether it may be part of the seat: connected with a mated pose at the seat's level or
    /// below.
    ///
    /// # Errors
    /// [`Cancelled`] if a stop is requested.
    pub(super) fn reach(&self, tree: &Tree, exec: &Exec) -> Result<Vec<bool>, Cancelled> {
        let mut in_seat = vec![false; tree.cells.len()];
        walk(tree, exec, self.boxes(tree).into_iter(), floor, |&ReachableBox { number, height, .. }| {
            if height > self.level + OVER_A_PATH {
                return Expansion::End;
            }
            in_seat[number] = true;
            Expansion::Go
        })?;
        Ok(in_seat)
    }

    /// Whether some motion may rest in a box without having docked.
    pub(super) fn lets_rest(&self, cell: &Cell) -> bool {
        let roof = cell.height.map_or(f64::INFINITY, |height| height.up);
        let poses = cell.poses;
        let ends_docked =
            roof <= self.level && (self.holds)(&poses) || self.home.is_some_and(|home| home.holds(&poses));
        !(cell.restless || ends_docked)
    }

    /// The undecided boxes that may hold poses so deep in the neighbourhood of the mated pose that nothing leaves it, the nearest first.
    pub(super) fn about(&self, tree: &Tree) -> Vec<usize> {
        let Some(home) = self.home else { return Vec::new() };
        let off = |cell: &Cell| {
            let poses = cell.poses;
            let parts = poses.iter().zip(&home.poses).filter(|(_, own)| own.up > 0.0);
            parts.map(|(part, own)| part.lo.max(-part.up).max(0.0) / own.up).fold(0.0, f64::max)
        };
        let may = |cell: &Cell| {
            cell.label.is_none()
                && Tree::is_divisible(cell)
                && cell.height.is_some_and(|height| height.lo < home.level)
        };
        let mut result: Vec<(f64, usize)> =
            tree.leaves().filter(|(_, cell)| may(cell)).map(|(number, cell)| (off(cell), number)).collect();
        result.retain(|(off, _)| *off < 1.0);
        result.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        result.into_iter().map(|(_, number)| number).collect()
    }

    /// Whether a box lies so deep in the neighbourhood of the mated pose that nothing leaves it.
    fn keeps(&self, cell: &Cell) -> bool {
        let below = |home: &Home| cell.height.is_some_and(|height| height.up < home.level);
        self.home.is_some_and(|home| below(&home) && home.holds(&cell.poses))
    }
}

/// Whether a motion may leave a box other than by a slope: over an end of h, under a wall, or out of the
/// examined region.
fn leaks(tree: &Tree, cell: &Cell) -> bool {
    cell.sudden || cell.walled || tree.is_at_border(cell)
}

/// The first exit of the seat's part, by floors.
#[derive(Debug, Clone)]
pub(super) struct EscapeRoute {
    /// Below it the seat's part docks, in D.
    pub(super) level: f64,
    /// The boxes that were reached before, each with the height of its path.
    inside: Vec<(usize, f64)>,
    /// Boxes that may contain a rest or an exit below the lowest certain exit: smaller boxes may not.
    blocking: Vec<usize>,
    /// For each box the box from which it was reached.
    came_from: Vec<usize>,
}

/// Number of blocking boxes that are returned at once: the minimum, and the maximum as a part of all.
const LEAST_BLOCKING: usize = 32;
const MOST_BLOCKING: usize = 256;
const PART_BLOCKING: usize = 256;

impl EscapeRoute {
    /// Searches for the exit.
    ///
    /// # Errors
    /// [`Cancelled`] if a stop is requested.
    pub(super) fn find(tree: &Tree, seat: &Seat<'_>, exec: &Exec) -> Result<Self, Cancelled> {
        let (mut level, mut inside, mut blocking) = (None, Vec::new(), Vec::new());
        let mut came_from = vec![usize::MAX; tree.cells.len()];
        let more = tree.cells.len() / PART_BLOCKING;
        walk(tree, exec, seat.boxes(tree).into_iter(), floor, |&ReachableBox { number, height, from }| {
            came_from[number] = from;
            let cell = &tree.cells[number];
            // From a cell known to dock every motion returns to the seat; beyond the border of the error box
            // nothing is known.
            let docks = cell.label == Some(Label::Yes) && !tree.is_at_border(cell);
            if !docks && (seat.lets_rest(cell) || leaks(tree, cell)) {
                level = level.or(Some(height));
                blocking.push(number);
            } else if level.is_none() {
                inside.push((number, height));
            }
            let out = tree.is_at_border(cell) || matches!(cell.label, Some(Label::Jams | Label::Leaves));
            let enough = if out { LEAST_BLOCKING } else { MOST_BLOCKING }.max(more);
            if blocking.len() >= enough { Expansion::End } else { Expansion::Go }
        })?;
        Ok(Self { level: level.unwrap_or(f64::INFINITY), inside, blocking, came_from })
    }

    /// The blocking boxes that may be halved: each blocking box or, if it may not, the last box that may on
    /// the path to it, whose floor may be too low.
    pub(super) fn in_the_way(&self, may: impl Fn(usize) -> bool) -> Vec<usize> {
        let mut result = Vec::new();
        let mut seen = BTreeSet::new();
        for blocking in &self.blocking {
            let mut at = *blocking;
            while !may(at) && self.came_from[at] != at {
                at = self.came_from[at];
            }
            if may(at) && seen.insert(at) {
                result.push(at);
            }
        }
        result
    }
}

/// The floor of a box, if it contains contacts.
fn floor(cell: &Cell) -> Option<f64> {
    cell.height.map(|height| height.lo)
}

/// Labels the boxes that heights decide, and returns the blocking boxes.
///
/// # Errors
/// [`Cancelled`] if a stop is requested.
pub(super) fn flood(tree: &mut Tree, seat: &Seat<'_>, exec: &Exec) -> Result<EscapeRoute, Cancelled> {
    let route = EscapeRoute::find(tree, seat, exec)?;
    let level = route.level;
    // Beyond the pass, at the level itself, cells of any depth may lead elsewhere.
    for (number, _) in route.inside.iter().filter(|(_, way)| *way < level) {
        let cell = &mut tree.cells[*number];
        if cell.height.is_some_and(|height| height.up < level) {
            cell.label = Some(Label::Yes);
        }
    }
    let kept: Vec<usize> = tree.leaves().filter(|(_, cell)| seat.keeps(cell)).map(|(k, _)| k).collect();
    for number in kept {
        tree.cells[number].label = Some(Label::Yes);
    }
    // The other way round: from the seat and from all that is not known, which may lead to it.
    let unknown = tree
        .leaves()
        .filter(|(_, cell)| cell.walled && !tree.upright || tree.is_at_border(cell))
        .map(|(k, _)| k);
    let sources: Vec<usize> = seat.boxes(tree).into_iter().chain(unknown).collect();
    let mut way = vec![f64::INFINITY; tree.cells.len()];
    walk(tree, exec, sources.into_iter(), floor, |&ReachableBox { number, height, .. }| {
        way[number] = height;
        Expansion::Go
    })?;
    let lone = |cell: &Cell, way: f64| {
        cell.height.is_none_or(|height| height.up < way && way > seat.level + OVER_A_PATH)
    };
    for (cell, way) in tree.cells.iter_mut().zip(way) {
        if cell.label.is_none() && !cell.is_split() && lone(cell, way) {
            // Heights do not decide whether the motion comes to rest or leaves: see `spread`.
            cell.label = Some(Label::Leaves);
        }
    }
    Ok(route)
}

/// Lower and upper bound on the retention: the height above the mated height that a half in the seat must
/// reach before it can leave, in D.
///
/// # Errors
/// [`Cancelled`] if a stop is requested.
pub(super) fn retention(
    tree: &Tree,
    seat: &Seat<'_>,
    level: f64,
    exec: &Exec,
) -> Result<[f64; 2], Cancelled> {
    let mut out = f64::INFINITY;
    let roof = |cell: &Cell| Some(cell.height.map_or(f64::NEG_INFINITY, |height| height.up));
    walk(tree, exec, seat.boxes(tree).into_iter(), roof, |reached| match tree.cells[reached.number].label {
        Some(Label::Jams | Label::Leaves) => {
            out = reached.height;
            Expansion::End
        }
        _ => Expansion::Go,
    })?;
    Ok([(level - seat.mated).max(0.0), out - seat.mated])
}
