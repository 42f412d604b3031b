//! Evaluation of a place as a seat, by exact heights: its position, its width, and the errors that it
//! constrains.
//!
//! ```text
//!   place ──▶ D ──▶ moved to its deepest position, in the middle of its play ──▶ constrained errors ──▶ settled, if necessary
//!                                                                    └ climb: the rise at offsets of 0.1 D and 0.3 D, in all directions
//! ```
//!
//! Errors that the seat leaves free (along a groove, the yaw of a round part) are removed from the free
//! errors: they are locked, except for a yaw with equal depth all around, which is a don't-care rotation. If
//! walls stop an error, but later than the play that a seat may have without a statement in the design
//! ([`Docked::MOST_PLAY`]), the play becomes the docking tolerance.

use super::layout::PartLayout;
use super::sink::Sunk;
use catchment_core::connector::{Connector, Half};
use catchment_core::contact::display_unit::DisplayUnit;
use catchment_core::contact::height_map::{broadest, plan_box};
use catchment_core::contact::mated::{MatedProblem, problems_on, round_half};
use catchment_core::contact::{Pair, face, play, play_on, settle, width};
use catchment_core::design::{Alignment, DrawnFrames, HalfSpec, OwnSpec};
use catchment_core::exec::Exec;
use catchment_core::method::descent;
use catchment_core::pose::{CorPose, Dof, DofSet, Mount, PoseError};
use glam::{DMat3, DVec2};
use std::f64::consts::TAU;
use std::fmt;

/// Steepness of a seat with a score of one half.
pub(super) const STEEP: f64 = 3.5;
/// Largest distance of halves drawn docked, in D.
const MOST_APART: f64 = 0.05;
/// Offsets at which the climb is evaluated, in D, and the largest climb that counts.
const OFF: [f64; 2] = [0.1, 0.3];
const MOST_CLIMB: f64 = 0.3;
/// Factor for a seat that does not hold.
const LOOSE: f64 = 0.1;
/// Factors for a seat that constrains neither x nor y, one of them, both.
const HELD: [f64; 3] = [0.25, 0.75, 1.0];
/// After rotation by a part of a turn the halves count as mated if they are this close, in D.
const ALIKE: f64 = 2e-3;
/// A rest closer than this to the drawn pose, in D and radians, counts as at the drawn pose.
const AT_REST: f64 = 1e-5;
/// Play is put in its middle up to this much, in D.
const MOST_PLAY: f64 = 0.05;

/// Why parts do not dock as they were laid.
#[derive(Debug, Clone)]
pub(super) struct RejectedLayout {
    /// Distance from contact, in the unit of the halves; infinite if it is not defined.
    pub(super) by: f64,
    pub(super) why: String,
    /// How they were laid.
    lie: Option<PartLayout>,
}

impl From<&str> for RejectedLayout {
    fn from(why: &str) -> Self {
        Self::new(f64::INFINITY, why.to_owned())
    }
}

impl fmt::Display for RejectedLayout {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { why, lie, .. } = self;
        lie.map_or(Ok(()), |lie| write!(f, "{lie}: "))?;
        f.write_str(why)
    }
}

impl RejectedLayout {
    const fn new(by: f64, why: String) -> Self {
        Self { by, why, lie: None }
    }

    /// With how they were laid.
    pub(super) fn of(self, lie: PartLayout) -> Self {
        Self { lie: Some(lie), ..self }
    }
}

/// An evaluated candidate. Lengths in the unit of the halves.
#[derive(Debug, Clone)]
pub(super) struct SeatCandidate {
    pub(super) lie: PartLayout,
    pub(super) width: f64,
    /// Whether D exceeds the region that can touch, because a half may be only this much wider than D.
    pub(super) is_widened: bool,
    /// Centre of the region that can touch, in plan view, in the rotated frame of the fixed half.
    pub(super) center: DVec2,
    /// Position of the origin of the rotated moving half.
    pub(super) offset: DVec2,
    /// How much a half climbs that is off, 0 to 1, and the share of the smaller part's broadest side that can touch.
    pub(super) climb: f64,
    pub(super) shared: f64,
    /// How high the origin of the turned moving half is.
    pub(super) lift: f64,
    /// Whether it was searched near the pose in which the parts are drawn.
    pub(super) is_near_drawn: bool,
    /// Its result from a lattice, if any, and the number of its place: places that differ by a rotation about
    /// the approach have the same number.
    pub(super) sunk: Option<Sunk>,
    pub(super) class: usize,
    /// Its seat, or the reason why it is not a seat; `None` before evaluation.
    pub(super) seat: Option<Result<Seat, String>>,
    /// The halves in D, mated.
    connector: Connector,
}

/// Properties of a seat.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seat {
    pub(super) free: DofSet,
    pub(super) dont_care: DofSet,
    /// Pose error of the rest that the halves must first reach, relative to the drawn pose.
    pub(super) settle: Option<PoseError>,
    /// Rotated by this part of a turn they are also mated; 1 without symmetry.
    pub(super) symmetry: u32,
    /// Play that must be stated in the design: D and radians, in the order of [`Dof::ALL`].
    pub(super) play: [Option<f64>; 5],
}

/// The largest play of a seat, in D and radians: beyond it no wall is searched.
const LOOSEST: [f64; 2] = [0.25, 30.0 / 180.0 * std::f64::consts::PI];

impl SeatCandidate {
    pub(super) fn score(&self) -> f64 {
        let held = match &self.seat {
            None => 1.0,
            Some(Err(_)) => LOOSE,
            Some(Ok(seat)) => {
                let lateral = [Dof::X, Dof::Y].into_iter().filter(|dof| seat.free.contains(*dof)).count();
                HELD[lateral]
            }
        };
        let share = match &self.sunk {
            Some(sunk) => sunk.steep / (sunk.steep + STEEP),
            None => self.climb * self.shared,
        };
        (share * held).max(0.0)
    }

    /// Adds the lattice result with which it was found.
    pub(super) fn with_lattice(self, sunk: Sunk, class: usize) -> Self {
        Self { sunk: Some(sunk), class, ..self }
    }

    /// Notes that it was searched near the pose in which the parts are drawn.
    pub(super) fn searched_near_the_drawn_pose(self) -> Self {
        Self { is_near_drawn: true, ..self }
    }

    /// The halves as the design of the seat will have them.
    pub(super) fn pair(&self, seat: &Seat) -> Pair {
        let mut alignment = Alignment::new(seat.free, Mount::X);
        alignment.dont_care = seat.dont_care;
        alignment.docked.limits = seat.play;
        let settled = seat.settle.and_then(|_| settle::settled(self.connector.clone(), &alignment));
        Pair::new(settled.as_ref().unwrap_or(&self.connector), &alignment)
    }

    /// Evaluates its seat, which takes the longest.
    pub(super) fn evaluate_seat(&mut self, free: Option<DofSet>, display: DisplayUnit, exec: &Exec) {
        if self.seat.is_none() {
            let display = DisplayUnit { scale: display.scale * self.width, ..display };
            self.seat = Some(seat(&self.connector, free, display, exec));
        }
    }
}

/// Evaluates halves in the relative orientation `lie`, the moving half at `offset`; further offsets may be
/// given, which are used if the half lies as deep there. Returns the reason if the halves do not meet or are
/// not docked as drawn, with lengths in the unit `display`.
pub(super) fn judge(
    halves: [&Half; 2],
    lie: PartLayout,
    offset: DVec2,
    others: &[DVec2],
    sunk: Option<&Sunk>,
    display: DisplayUnit,
) -> Result<SeatCandidate, RejectedLayout> {
    const APART: &str = "they pass each other by";
    let turns = lie.turns();
    let [fixed, moving] = [0, 1].map(|k| halves[k].mapped(|p| turns[k] * p));
    let drawn = match lie {
        PartLayout::Assembled { approach } => {
            DrawnFrames::Assembled { approach: approach.vector().to_array(), face_center: None }
        }
        PartLayout::Facing { .. } => DrawnFrames::Facing,
    };
    let pair = Pair::new(&Connector::from_halves(fixed.clone(), moving.clone()), &nothing_free());
    let height = |pair: &Pair, lateral: DVec2| pair.height(&CorPose { lateral, rotation: DMat3::IDENTITY });
    let mut lift = height(&pair, offset).ok_or(APART)?;
    let mut offset = offset;
    if let Some(sunk) = sunk {
        // The lattice is accurate to a cell: a half that stands on the rim of its hole may belong beside it.
        let on_the_rim = |lift: f64| lift > sunk.height + 0.5 * sunk.climb;
        let near = others.iter().copied().filter(|other| other.distance(sunk.offset) < 2.0 * sunk.cell);
        let mut around = near.chain(rings(sunk.cell).map(|by| sunk.offset + by));
        while on_the_rim(lift)
            && let Some(other) = around.next()
        {
            if let Some(z) = height(&pair, other).filter(|z| *z < lift) {
                (offset, lift) = (other, z);
            }
        }
        if on_the_rim(lift) {
            let (deep, cell) = (display.length(sunk.climb), display.length(sunk.cell));
            let why = format!(
                "no play: one would sink {deep} into the other if it were {cell} narrower on each side; give it some play"
            );
            return Err(RejectedLayout::new(0.0, why));
        }
    }
    let at = |offset: DVec2| moving.mapped(move |p| p + offset.extend(0.0));
    let wide = width::width(&fixed, &at(offset), lift).ok_or(APART)?;
    if let PartLayout::Facing { .. } = lie {
        for other in others {
            // Prefer round numbers at which the half lies as deep.
            if let Some(z) =
                height(&pair, *other).filter(|z| *z <= lift + 1e-4 * wide && other.distance(offset) < wide)
            {
                (offset, lift) = (*other, z);
            }
        }
        offset += deepest(&fixed, &at(offset), wide);
        lift = height(&pair, offset).ok_or(APART)?;
    } else {
        if lift > MOST_APART * wide {
            let why = format!("blocked: {} above where they are drawn", display.length(lift));
            return Err(RejectedLayout::new(lift, why));
        }
        if lift < -MOST_APART * wide {
            return Err(RejectedLayout::new(-lift, format!("drawn {} apart", display.length(-lift))));
        }
    }
    let placed = at(offset);
    let [low, high] = width::touching(&fixed, &placed, lift).ok_or(APART)?;
    let width = (high - low).max_element();
    if width <= 0.0 {
        return Err(APART.into());
    }
    let widest = halves.map(|half| {
        let (low, high) = plan_box(half, &DMat3::IDENTITY);
        (high - low).max_element() / width::MOST_WIDE
    });
    let least = widest.into_iter().fold(0.0, f64::max);
    let (width, is_widened) = (width.max(least), width < least);
    let center = low.midpoint(high);
    let smaller = halves.map(broadest).into_iter().fold(f64::INFINITY, f64::min);
    let shared = ((high - low).element_product() / smaller).clamp(0.0, 1.0);
    let scaled = |half: &Half| half.mapped(|p| p - center.extend(0.0)).scaled(1.0 / width);
    let nothing = || HalfSpec::Pieces(Vec::new());
    let own = OwnSpec { drawn, face_height: None, ..OwnSpec::new(0.0, nothing(), nothing()) };
    let connector = face::with_derived_face(Connector::from_halves(scaled(&fixed), scaled(&placed)), &own);
    let climb = climb(&Pair::new(&connector, &nothing_free()));
    Ok(SeatCandidate {
        lie,
        width,
        is_widened,
        center,
        offset,
        climb,
        shared,
        lift,
        is_near_drawn: false,
        sunk: None,
        class: 0,
        seat: None,
        connector,
    })
}

const fn nothing_free() -> Alignment {
    Alignment::new(DofSet::EMPTY, Mount::X)
}

/// Offsets around zero, up to a cell and a half.
fn rings(cell: f64) -> impl Iterator<Item = DVec2> {
    let steps = [-3i32, -2, -1, 0, 1, 2, 3];
    let mut all: Vec<DVec2> = steps
        .iter()
        .flat_map(|i| steps.iter().map(move |j| 0.5 * cell * DVec2::new(f64::from(*i), f64::from(*j))))
        .collect();
    all.sort_by(|a, b| a.length().total_cmp(&b.length()));
    all.into_iter().skip(1)
}

/// Offset to the deepest position of the half nearby, in the middle of its play.
fn deepest(fixed: &Half, moving: &Half, width: f64) -> DVec2 {
    let lateral = DofSet::EMPTY.with(Dof::X).with(Dof::Y);
    let alignment = Alignment::new(lateral, Mount::X);
    let moved = |by: DVec2| {
        let moving = moving.mapped(move |p| p + by.extend(0.0)).scaled(1.0 / width);
        Pair::new(&Connector::from_halves(fixed.scaled(1.0 / width), moving), &alignment)
    };
    let mut by = DVec2::ZERO;
    let pair = moved(by);
    let pair = match settle::rest(&pair) {
        Some(error) if DVec2::new(error.x, error.y).length() > AT_REST => {
            by = DVec2::new(error.x, error.y) * width;
            moved(by)
        }
        Some(_) => pair,
        None => return by,
    };
    for play in play(&pair) {
        let middle = 0.5 * (play.plus - play.minus);
        if play.most() <= MOST_PLAY && middle.abs() > AT_REST {
            by[play.axis.index()] += middle * width;
        }
    }
    by
}

/// Climb of a half at an offset, as a share of the largest climb that counts.
fn climb(pair: &Pair) -> f64 {
    const WAYS: u32 = 8;
    let mut sum = 0.0;
    for off in OFF {
        for way in 0..WAYS {
            let lateral = DVec2::from_angle(TAU * f64::from(way) / f64::from(WAYS)) * off;
            let height = pair.height(&CorPose { lateral, rotation: DMat3::IDENTITY });
            let climb = height.map_or(-MOST_CLIMB, |height| height - pair.mated_height());
            sum += climb.clamp(-MOST_CLIMB, MOST_CLIMB) / MOST_CLIMB;
        }
    }
    sum / (OFF.len() as f64 * f64::from(WAYS))
}

/// The largest part of a turn after which the halves are mated as well.
fn symmetry(pair: &Pair) -> u32 {
    const FOLDS: [u32; 6] = [8, 6, 5, 4, 3, 2];
    let mated = |fold: &u32| {
        let rotation = DMat3::from_rotation_z(TAU / f64::from(*fold));
        let height = pair.height(&CorPose { lateral: DVec2::ZERO, rotation });
        height.is_some_and(|height| (height - pair.mated_height()).abs() < ALIKE)
    };
    FOLDS.into_iter().find(mated).unwrap_or(1)
}

/// Errors that the seat constrains, among those that may be free.
fn seat(
    connector: &Connector,
    wanted: Option<DofSet>,
    display: DisplayUnit,
    exec: &Exec,
) -> Result<Seat, String> {
    // A seat that does not hold with all errors free may hold without tilts, or with offsets only.
    let level = DofSet::EMPTY.with(Dof::X).with(Dof::Y);
    let sets = wanted.map_or_else(|| vec![DofSet::ALL, level.with(Dof::Yaw), level], |set| vec![set]);
    let mut first = None;
    for set in sets {
        match held(connector, set, wanted.is_some(), display, exec) {
            Ok(seat) => return Ok(seat),
            Err(reason) => first = first.or(Some(reason)),
        }
    }
    Err(first.unwrap_or_default())
}

/// The same, starting from a given set; with `exactly` only that set, except for a don't-care yaw.
fn held(
    connector: &Connector,
    free: DofSet,
    exactly: bool,
    display: DisplayUnit,
    exec: &Exec,
) -> Result<Seat, String> {
    let mut alignment = Alignment::new(free, Mount::X);
    let pair = Pair::new(connector, &alignment);
    if round_half(&pair).is_some() {
        alignment.free = free.without(Dof::Yaw);
        alignment.dont_care = DofSet::EMPTY.with(Dof::Yaw);
    }
    let symmetry = if alignment.free.contains(Dof::Yaw) { symmetry(&pair) } else { 1 };
    let spins = alignment.free.contains(Dof::Yaw) && spins(&pair);
    drop(pair);
    // The yaw of a round half does not matter; any other error that the seat does not constrain is locked.
    let may_go = |dof: &Dof| !exactly || *dof == Dof::Yaw && spins;
    let leave_out = |alignment: &mut Alignment, dof: Dof| leave_out(alignment, dof, dof == Dof::Yaw && spins);
    let mut is_without_walls = DofSet::EMPTY;
    // Each step locks an error or sets the play of some errors.
    loop {
        let mut settle = None;
        let mut held = connector.clone();
        let mut found = problems_on(&Pair::new(connector, &alignment), exec);
        if found.iter().any(|problem| matches!(problem, MatedProblem::NotMinimum { .. })) {
            let settled = settle::settled(connector.clone(), &alignment).ok_or("it runs off")?;
            let off = settled.origin.settled.unwrap_or_default();
            settle = off.to_array().iter().any(|off| off.abs() > AT_REST).then_some(off);
            found = problems_on(&Pair::new(&settled, &alignment), exec);
            held = settled;
        }
        // If nothing nearby limits an error, a wall farther off may.
        let unsaid = found.iter().filter_map(|problem| match problem {
            MatedProblem::Free { dof, .. } if !is_without_walls.contains(*dof) => Some(*dof),
            _ => None,
        });
        let unsaid: DofSet = unsaid.collect();
        if !unsaid.is_empty() {
            let without = walls(connector, &mut alignment, unsaid, exec);
            is_without_walls = without.iter().fold(is_without_walls, DofSet::with);
            // A further search would give the same result.
            if let Some(dof) = without.iter().find(may_go) {
                leave_out(&mut alignment, dof)?;
            }
            continue;
        }
        let loose = found.iter().find_map(|problem| match problem {
            MatedProblem::Round { .. } => Some(Dof::Yaw),
            MatedProblem::Free { dof, .. } | MatedProblem::LimitCutsPlay { dof, .. } => Some(*dof),
            _ => None,
        });
        let loose = loose.filter(may_go);
        match (found.first(), loose) {
            (None, _) => {
                if let Some(fall) = descent::fall(&Pair::new(&held, &alignment)) {
                    return Err(fall.in_words(display));
                }
                let Alignment { free, dont_care, docked, .. } = alignment;
                return Ok(Seat { free, dont_care, settle, symmetry, play: docked.limits });
            }
            (Some(_), Some(dof)) => leave_out(&mut alignment, dof)?,
            (Some(MatedProblem::NotMinimum { .. }), None) => return Err("it does not hold".to_owned()),
            (Some(problem), None) => return Err(problem.in_words(display)),
        }
    }
}

/// Whether a half lies equally deep all around, within the docking tolerance: tested every 2.5 degrees.
fn spins(pair: &Pair) -> bool {
    const LOOKS: u32 = 144;
    let depth = pair.alignment.docked.depth;
    (1..LOOKS).all(|k| {
        let rotation = DMat3::from_rotation_z(TAU * f64::from(k) / f64::from(LOOKS));
        let height = pair.height(&CorPose { lateral: DVec2::ZERO, rotation });
        height.is_some_and(|height| (height - pair.mated_height()).abs() <= depth)
    })
}

/// Leaves out an error that the seat does not hold: locked, or of no matter.
fn leave_out(alignment: &mut Alignment, dof: Dof, is_round: bool) -> Result<(), String> {
    alignment.free = alignment.free.without(dof);
    alignment.docked.limits[dof.index()] = None;
    if is_round {
        alignment.dont_care = alignment.dont_care.with(dof);
    }
    if alignment.free.is_empty() { Err("it holds nothing".to_owned()) } else { Ok(()) }
}

/// States the play of some errors, rounded up to two digits, if walls stop them; returns those that nothing
/// stops.
fn walls(connector: &Connector, alignment: &mut Alignment, unsaid: DofSet, exec: &Exec) -> DofSet {
    let loosest = |dof: Dof| LOOSEST[usize::from(dof.is_rotation())];
    for dof in unsaid.iter() {
        alignment.docked.limits[dof.index()] = Some(loosest(dof));
    }
    let mut free = DofSet::EMPTY;
    for found in play_on(&Pair::new(connector, alignment), unsaid, exec) {
        let (dof, most) = (found.axis, found.most());
        if unsaid.contains(dof) {
            let is_stopped = most <= loosest(dof);
            alignment.docked.limits[dof.index()] = is_stopped.then(|| two_digits(dof, most));
            free = if is_stopped { free } else { free.with(dof) };
        }
    }
    free
}

/// A play as it is written: in D or degrees, rounded up.
fn two_digits(dof: Dof, most: f64) -> f64 {
    let up = |value: f64| {
        let step = 10f64.powf(value.log10().floor() - 1.0);
        (value / step).ceil() * step
    };
    if dof.is_rotation() { up(most.to_degrees()).to_radians() } else { up(most) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn a_half_is_scaled() {
        let surface =
            catchment_core::connector::convex_hull(&[DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z]).unwrap();
        let volume = surface.volume();
        let half = Half::of(vec![surface]).scaled(3.0);
        assert!((half.surfaces[0].volume() - 27.0 * volume).abs() < 1e-12);
    }
}
