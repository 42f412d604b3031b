//! Certified labels: poses that dock and poses that fail, by bounds that hold for whole boxes of poses.
//!
//! ```text
//!   bodies ──▶ survey of a box ──▶ tree of boxes ──▶ flood   a motion cannot climb          ──▶ yes · no · undecided
//!   (features)  floor ≤ h ≤ roof    halved if         spread  faces that a motion can cross      volumes, retention
//!               all contacts, jumps  undecided        tube    region that motions of a box can reach
//!                                                     home    bounds about the seat, found directly
//! ```
//!
//! Every number is an interval, rounded outwards, that holds for every pose of a box (`interval`, `placed`,
//! `touch`, `arc`, `survey`). Four arguments turn intervals into labels. Three of them hold in any dimension:
//! energy (`flood`: a motion cannot leave the connected set of poses below its height), faces (`spread`:
//! motions leave some boxes only into boxes with the same label, without going back along a `bearing`) and
//! the neighbourhood of the seat (`home`, and its growth `grown`). The fourth, direction, needs at most one
//! free rotation (`tube`: a bundle that contains all motions of a box until it lies in labelled boxes).
//! Sources: capture basins by intervals: Lhommeau, Jaulin, Hardouin 2007; the neighbourhood of the seat
//! without other rests: after Delanoue 2015; escape heights of caged bodies: energy-bounded caging.
//!
//! "Certified" refers to exact frictionless motion of the halves as drawn, up to the rounding of exact
//! heights (10⁻⁹ D). A certificate covers almost every motion in a box: the direction of a half that starts
//! exactly on a ridge is not determined.
//!
//! Not promised: that the undecided share is small. It shrinks with the boxes; it is larger for seats with
//! play, tight fits, halves that meet walls, and more than two free errors. Lengths in D, angles in radians.

mod arc;
mod bearing;
mod body;
pub(super) mod entry;
mod flood;
mod grown;
mod home;
mod interval;
mod placed;
mod rest;
mod spread;
mod survey;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod tests_of_bounds;
mod touch;
mod tree;
mod tube;
mod window;

use crate::acceptance::{Acceptance, Domain, Outcome};
use crate::contact::{Nearby, Pair, SEAT_CORE};
use crate::diagnostic::Warning;
use crate::exec::{Cancelled, Exec, Stopwatch};
use crate::landscape::Grid;
use crate::pose::Dof;
use flood::{EscapeRoute, Seat, flood, retention};
use grown::Growth;
use home::Home;
use interval::Interval;
use placed::{Bodies, PoseBox};
pub(crate) use rest::{applies, depths};
use serde::{Deserialize, Serialize};
use spread::{ahead, spread};
use std::collections::BTreeSet;
use tree::{Cell, Label, Tree};
use tube::Tube;

/// Settings that change the result.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct CertifiedSettings {
    /// Undecided share of the error box at which refinement stops, in [0, 1].
    pub gap: f64,
    /// Largest number of boxes that are examined; the remaining undecided boxes stay undecided.
    pub boxes: usize,
    /// Time limit in seconds; the number of boxes examined in this time depends on the machine.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub budget_s: Option<f64>,
}

impl Default for CertifiedSettings {
    fn default() -> Self {
        Self { gap: 0.02, boxes: 20_000, budget_s: None }
    }
}

/// Why nothing can be certified.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CertifiedError {
    /// No share of a box.
    #[error("an undecided share of {gap} is none: give a number from 0 to 1")]
    Gap {
        /// The given value.
        gap: f64,
    },
    /// Too few boxes to begin with.
    #[error("{boxes} boxes are too few to begin with: give at least {LEAST_BOXES}")]
    Boxes {
        /// The given value.
        boxes: usize,
    },
    /// No time.
    #[error("a budget of {seconds} s is none: give a number of seconds above 0")]
    Budget {
        /// The given value.
        seconds: f64,
    },
    /// So many features that all their meetings cannot be listed.
    #[error(
        "the halves have {meetings} pairs of features that may meet, more than the {MOST_MEETINGS} that are looked at for every box"
    )]
    Large {
        /// How many.
        meetings: usize,
    },
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Boxes at least.
pub const LEAST_BOXES: usize = 64;
/// Largest number of pairs of features: each is examined over the largest boxes.
pub const MOST_MEETINGS: usize = 200_000;

/// Certified shares of an error box.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct BoxCertificate {
    /// Share of the error box in which every pose docks.
    pub yes: f64,
    /// Share in which no pose docks.
    pub no: f64,
    /// Share that is undecided.
    pub undecided: f64,
    /// Measures of the three, Dᵃ·radᵇ.
    pub measures: [f64; 3],
    /// Certified lower bound on the retention: the height above the mated height that a seated half must
    /// reach before it can leave, in D. Also the energy per unit of the force that holds it.
    pub retention_at_least: f64,
    /// Certified upper bound on the retention; null if no escape path was found.
    pub retention_at_most: Option<f64>,
    /// Certified window: every pose docks in the error box scaled about zero by this factor, in [0, 1].
    pub window: f64,
    /// Number of boxes examined.
    pub boxes: usize,
}

/// All boxes with their labels.
#[derive(Debug, Clone)]
pub(crate) struct Certified {
    tree: Tree,
    pub(crate) certificate: BoxCertificate,
}

/// Number of levels of boxes that are always examined, for one to five free errors.
const FIRST_LEVEL: [u8; 5] = [8, 5, 4, 3, 2];
/// Boxes in the way of the seat's own part are halved down to this size in the ρ-metric, in D: each halving
/// doubles their number or more.
const FINEST: f64 = 3e-4;
/// Part of the budget that is spent finally on the blocking boxes of the seat's part, and its upper limit:
/// doubling it hardly improves the bound.
const AT_LAST: usize = 8;
const MOST_AT_LAST: usize = 4000;
/// Boxes about the mated pose that are halved at once.
const AT_HOME: usize = 64;
/// With more free errors than so many, boxes about the mated pose come before those in the way of its part: there are too many of those.
const MOST_IN_THE_WAY: usize = 3;
/// Largest part of the budget that is spent first on the seat, for one to five free errors: with many errors
/// so few boxes decide little else.
const AT_SEAT: [usize; 5] = [8, 8, 8, 2, 1];
/// Growth factor of the number of boxes after which the motions of a box are followed again in a bundle.
const AGAIN: usize = 2;
/// Boxes that are halved at once, at least, and as a part of all.
const AT_ONCE: usize = 1024;
const PART: usize = 16;

/// Certifies the error box of a pair.
///
/// # Errors
/// See [`CertifiedError`].
pub(crate) fn certify(
    pair: &Pair,
    settings: &CertifiedSettings,
    exec: &Exec,
) -> Result<Certified, CertifiedError> {
    let bodies = Bodies::of(pair);
    if bodies.meetings.len() > MOST_MEETINGS {
        return Err(CertifiedError::Large { meetings: bodies.meetings.len() });
    }
    let alignment = &pair.alignment;
    let watch = Stopwatch::start();
    let is_over = || settings.budget_s.is_some_and(|budget| watch.seconds() > budget);
    let mut tree = begin(pair, &bodies, exec)?;
    let sits = SeatBoxes { pair, rho: alignment.rotation_length };
    let (holds, meets) = (|poses: &PoseBox| sits.holds(poses), |poses: &PoseBox| sits.meets(poses));
    let mated = pair.mated_height();
    let mut home = Home::find(&bodies, &tree.error_box, mated, &mut pair.about(REACH), exec)?;
    let pieces = settings.boxes.saturating_sub(tree.cells.len()) / 2;
    let growth = Growth { pair, bodies: &bodies, errors: tree.error_box, pieces, exec };
    let (mut grown, mut window) = (0, 0.0);
    if let Some(result) = &mut home
        && tree.axes.len() > MOST_IN_THE_WAY
    {
        (*result, grown) = growth.of(*result)?;
        window = growth.window(result)?;
    }
    let boxes = settings.boxes.saturating_sub(grown);
    let seat = Seat { mated, level: mated + alignment.docked.depth, holds: &holds, home, meets: &meets };
    // Refine the seat first: most docking boxes lead there.
    let first = tree.cells.len() + boxes / AT_SEAT[tree.axes.len().clamp(1, 5) - 1];
    while tree.cells.len() < first.min(boxes) && !is_over() {
        let flooded = flood(&mut tree, &seat, exec)?;
        let mut chosen = seat.about(&tree);
        chosen.truncate(AT_HOME.max(tree.cells.len() / PART));
        if tree.axes.len() <= MOST_IN_THE_WAY || chosen.is_empty() {
            chosen.extend(coarse(&tree, &flooded));
        }
        chosen.truncate(((first - tree.cells.len()) >> tree.axes.len()).max(1));
        chosen.sort_unstable();
        chosen.dedup();
        if chosen.is_empty() {
            break;
        }
        halve(&mut tree, &chosen, pair, &bodies, exec)?;
    }
    let at_last = (boxes / AT_LAST).min(MOST_AT_LAST);
    let most = boxes - at_last;
    loop {
        let flooded = flood(&mut tree, &seat, exec)?;
        let in_the_way = coarse(&tree, &flooded);
        spread(&mut tree, &seat, exec)?;
        if alignment.free.rotations() <= 1 {
            bundle(&mut tree, AGAIN, pair, &bodies, exec)?;
            spread(&mut tree, &seat, exec)?;
        }
        exec.report(tree.cells.len() as f64 / boxes as f64, "boxes");
        let chosen = if tree.undecided() <= settings.gap || tree.cells.len() >= most || is_over() {
            Vec::new()
        } else {
            chosen(&tree, &seat, in_the_way, most, exec)?
        };
        if chosen.is_empty() {
            break;
        }
        halve(&mut tree, &chosen, pair, &bodies, exec)?;
    }
    // All that is left, now that there are no more labels to come.
    if alignment.free.rotations() <= 1 && tree.undecided() > settings.gap {
        bundle(&mut tree, 0, pair, &bodies, exec)?;
        spread(&mut tree, &seat, exec)?;
    }
    // The bounds on the retention are tightest once labels are known.
    let last = (tree.cells.len() + at_last).min(boxes);
    loop {
        let route = EscapeRoute::find(&tree, &seat, exec)?;
        let mut in_the_way = coarse(&tree, &route);
        let room = if is_over() { 0 } else { last.saturating_sub(tree.cells.len()) };
        in_the_way.truncate(room >> tree.axes.len());
        if in_the_way.is_empty() {
            let flooded = flood(&mut tree, &seat, exec)?;
            let level = home.map_or(flooded.level, |home| home.level.max(flooded.level));
            let [at_least, at_most] = retention(&tree, &seat, level, exec)?;
            let mut certificate = tree.certificate(window.max(tree.window()));
            certificate.boxes += grown;
            certificate.retention_at_least = at_least;
            certificate.retention_at_most = at_most.is_finite().then_some(at_most);
            return Ok(Certified { tree, certificate });
        }
        in_the_way.sort_unstable();
        halve(&mut tree, &in_the_way, pair, &bodies, exec)?;
    }
}

/// The boxes that are always examined.
fn begin(pair: &Pair, bodies: &Bodies, exec: &Exec) -> Result<Tree, Cancelled> {
    let mut tree = Tree::over(&pair.alignment, bodies);
    for _ in 0..FIRST_LEVEL[tree.axes.len().clamp(1, 5) - 1] {
        let all: Vec<usize> = tree.leaves().map(|(number, _)| number).collect();
        divide(&mut tree, &all, true, pair, bodies, exec)?;
    }
    Ok(tree)
}

/// The blocking boxes of the seat's part that can still be halved.
fn coarse(tree: &Tree, route: &EscapeRoute) -> Vec<usize> {
    route.in_the_way(|number| tree.width(&tree.cells[number]) > FINEST)
}

/// Which boxes to halve: those in the way of the seat's own part, those about the mated pose, the largest of those that are undecided, and the
/// largest beyond the error box to which these may lead.
fn chosen(
    tree: &Tree,
    seat: &Seat<'_>,
    in_the_way: Vec<usize>,
    boxes: usize,
    exec: &Exec,
) -> Result<Vec<usize>, Cancelled> {
    let most = (tree.cells.len() / PART).max(AT_ONCE);
    let room = boxes.saturating_sub(tree.cells.len()) >> tree.axes.len();
    let by_size = |mut numbers: Vec<usize>| {
        numbers.retain(|number| Tree::is_divisible(&tree.cells[*number]));
        let mut sized: Vec<(f64, usize)> =
            numbers.into_iter().map(|number| (tree.volume(&tree.cells[number]), number)).collect();
        sized.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        sized.into_iter().map(|(_, number)| number)
    };
    let mut chosen = in_the_way;
    chosen.extend(seat.about(tree).into_iter().take(AT_HOME));
    let ahead = ahead(tree, exec)?.into_iter();
    let (inside, beyond) = ahead.partition(|number| tree.is_in_error_box(&tree.cells[*number]));
    chosen.extend(by_size(inside).take(most));
    chosen.extend(by_size(beyond).take(most));
    let mut seen = BTreeSet::new();
    chosen.retain(|number| seen.insert(*number));
    chosen.truncate(room.max(1));
    chosen.sort_unstable();
    Ok(chosen)
}

/// Halves leaves along their widest errors.
fn halve(
    tree: &mut Tree,
    numbers: &[usize],
    pair: &Pair,
    bodies: &Bodies,
    exec: &Exec,
) -> Result<(), Cancelled> {
    divide(tree, numbers, false, pair, bodies, exec)
}

/// Halves leaves along their widest errors or along all, in parallel; their parts are in the order of the leaves.
fn divide(
    tree: &mut Tree,
    numbers: &[usize],
    all: bool,
    pair: &Pair,
    bodies: &Bodies,
    exec: &Exec,
) -> Result<(), Cancelled> {
    let look = |nearby: &mut Nearby<'_>, k: usize| tree.parts(numbers[k], all, bodies, nearby);
    let parts: Vec<Vec<Cell>> = exec.map_with(numbers.len(), || pair.about(REACH), look)?;
    for (number, parts) in numbers.iter().zip(parts) {
        tree.split(*number, parts);
    }
    tree.join(numbers, exec)
}

/// Labels the boxes all of whose motions lead to labelled boxes.
fn bundle(tree: &mut Tree, again: usize, pair: &Pair, bodies: &Bodies, exec: &Exec) -> Result<(), Cancelled> {
    // Retry a box once the number of boxes has grown enough for many new labels.
    let boxes = tree.cells.len();
    let is_open = |cell: &Cell| {
        cell.label.is_none() && !cell.sudden && tree.is_in_error_box(cell) && boxes >= again * cell.followed
    };
    let open: Vec<usize> =
        tree.leaves().filter(|(_, cell)| is_open(cell)).map(|(number, _)| number).collect();
    let tube = Tube { bodies, tree };
    let follow = |nearby: &mut Nearby<'_>, k: usize| tube.follow(&tree.cells[open[k]], nearby);
    let result: Vec<Option<Label>> = exec.map_with(open.len(), || pair.about(REACH), follow)?;
    for (number, label) in open.into_iter().zip(result) {
        tree.cells[number].label = label;
        tree.cells[number].followed = boxes;
    }
    Ok(())
}

/// Approximate distance of the poses of a box: range of the lists of possible contacts.
const REACH: f64 = 0.02;

/// Which boxes belong to the seat.
struct SeatBoxes<'a> {
    pair: &'a Pair,
    rho: f64,
}

impl SeatBoxes<'_> {
    /// Errors against the mated pose that is nearest to the middle of a box.
    fn off(&self, poses: &PoseBox) -> PoseBox {
        let mut off = *poses;
        let yaw = off[Dof::Yaw.index()];
        let nearest = self.pair.alignment.nearest_yaw(yaw.middle());
        off[Dof::Yaw.index()] = (yaw - Interval::thin(nearest)).widened(4.0 * f64::EPSILON * nearest.abs());
        off.each_mut().iter_mut().skip(2).for_each(|angle| **angle = **angle * self.rho);
        off
    }

    /// Whether all poses of a box are so close to a mated pose that they count as connected with it.
    fn holds(&self, poses: &PoseBox) -> bool {
        let square = |part: Interval| part.lo.abs().max(part.up.abs()).powi(2);
        self.off(poses).into_iter().map(square).sum::<f64>() <= (SEAT_CORE * (1.0 - 1e-9)).powi(2)
    }

    /// Whether some may be.
    fn meets(&self, poses: &PoseBox) -> bool {
        self.off(poses).into_iter().all(|part| part.meets(Interval::new(-SEAT_CORE, SEAT_CORE)))
    }
}

impl Certified {
    /// The certain outcome of every cell of a grid: of all of its poses.
    pub(crate) fn acceptance(&self, grid: &Grid, exec: &Exec) -> Result<Acceptance, Cancelled> {
        let outcomes = exec.map(grid.len(), |index| self.outcome(grid, index))?;
        let undecided = outcomes.iter().filter(|o| **o == Outcome::Undecided).count();
        let note = format!(
            "{undecided} of {} cells hold poses that are not certain; docking is certain in the others that count as aligned",
            outcomes.len()
        );
        let warnings = if undecided > 0 { vec![Warning::Open { text: note }.into()] } else { Vec::new() };
        Ok(Acceptance { method: entry::INFO.name, domain: Domain::Grid(grid.clone()), outcomes, warnings })
    }

    fn outcome(&self, grid: &Grid, index: usize) -> Outcome {
        let mut poses = [Interval::ZERO; 5];
        for (axis, k) in grid.axes.iter().zip(grid.cell(index)) {
            let at = |k: usize| axis.lo + axis.step() * k as f64;
            poses[axis.dof.index()] = Interval::new(at(k), at(k + 1));
        }
        if self.tree.is_within(&poses, self.certificate.window) {
            return Outcome::Aligned;
        }
        match self.tree.label_over(&poses) {
            Some(Label::Yes) => Outcome::Aligned,
            Some(Label::Jams) => Outcome::Jammed,
            Some(Label::Leaves) => Outcome::Missed,
            None => Outcome::Undecided,
        }
    }
}
