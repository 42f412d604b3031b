//! A tree of boxes of pose errors; a box is halved along its widest errors if it needs refinement.
//!
//! ```text
//!   ┌───────────────┐   root: the error box, or the range that its motions may reach: a whole turn, and as far as the halves
//!   │   ┌───┬─┬─┐   │         reach; the error box then has half of the positions per error, and its border is a border of boxes
//!   │   │   ├─┤ │   │   leaf: a box without parts, with its certain bounds
//!   │   ├───┼─┴─┤   │   positions are integers in units of the smallest box, half open: [corner, corner + size)
//!   │   └───┴───┘   │         all have the same width within the error box, and on either side of it
//!   └───────────────┘
//! ```
//!
//! A root that covers a full turn of a rotation is periodic. The ρ-metric decides along which errors a box is
//! widest: a rotation θ has the width ρθ.

mod faces;

use super::bearing::{Bearings, Rising};
use super::interval::Interval;
use super::placed::{Bodies, PoseBox};
use super::survey::{Flows, Survey};
use crate::contact::Nearby;
use crate::design::Alignment;
use crate::pose::Dof;
use crate::tolerance::ROUNDING;
pub(super) use faces::Face;
use glam::DVec3;
use std::f64::consts::PI;

/// How often the root may be halved along an error.
const DEEPEST: u8 = 20;
/// The root's size in smallest boxes.
pub(super) const WHOLE: u32 = 1 << DEEPEST;

/// Certified facts about all motions that begin in a box, on the height of first contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Label {
    /// They dock.
    Yes,
    /// No motion docks: each comes to rest elsewhere, in a pit that does not contain the seat.
    Jams,
    /// No motion docks: each passes by or slides off, or comes to rest elsewhere before.
    Leaves,
}

/// Numbers of a box per axis, lowest and beyond the highest.
pub(super) type Span = [[u32; 2]; 5];

/// Errors along which a box is wider than this part of its widest are halved with that.
const NEARLY_WIDEST: f64 = 0.6;

/// The parts of a box.
#[derive(Debug, Clone, Copy)]
struct Parts {
    /// Number of the first; the others follow.
    first: u32,
    /// How many.
    count: u32,
}

/// A box.
#[derive(Debug, Clone)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "four facts that hold for a box or not, each without the others"
)]
pub(super) struct Cell {
    pub(super) corner: [u32; 5],
    /// How often the root was halved along each error.
    levels: [u8; 5],
    /// Its pose errors.
    pub(super) poses: PoseBox,
    parts: Option<Parts>,
    /// All that may carry in it.
    pub(super) among: Box<[u32]>,
    /// Heights, in D; `None` without contact.
    pub(super) height: Option<Interval>,
    /// See [`Survey`].
    pub(super) sudden: bool,
    pub(super) walled: bool,
    pub(super) restless: bool,
    /// Whether a motion may reach poses in it at which nothing touches.
    pub(super) ends: bool,
    pub(super) flows: Flows,
    /// The bearings that no motion in it goes back along.
    pub(super) rising: Rising,
    pub(super) label: Option<Label>,
    /// The leaves that a leaf shares faces with.
    pub(super) faces: Box<[Face]>,
    /// How many boxes there were when its motions were last followed in a bundle; 0: not yet.
    pub(super) followed: usize,
}

impl Cell {
    /// Whether it has parts.
    pub(super) const fn is_split(&self) -> bool {
        self.parts.is_some()
    }
}

/// All boxes.
#[derive(Debug, Clone)]
pub(super) struct Tree {
    /// The free errors: those that are halved.
    pub(super) axes: Vec<Dof>,
    /// The root.
    root: PoseBox,
    /// Whether an axis closes on itself.
    closed: [bool; 5],
    /// Whether nothing touches at either end of it: halves pass each other by.
    clear: [bool; 5],
    pub(super) bearings: Bearings,
    /// The error box, and its position in the root.
    pub(super) error_box: PoseBox,
    errors: Span,
    /// Length of a unit of each error in the ρ-metric, in D.
    units: [f64; 5],
    /// Whether motions that meet a wall stay on h: see [`Bodies::upright`].
    pub(super) upright: bool,
    pub(super) cells: Vec<Cell>,
}

impl Tree {
    /// The root of an alignment problem. It extends beyond the error box if at most one rotation is free:
    /// motions can be followed there.
    pub(super) fn over(alignment: &Alignment, bodies: &Bodies) -> Self {
        let axes: Vec<Dof> = alignment.free.iter().collect();
        let wide = alignment.free.rotations() <= 1;
        let [mut root, mut error_box] = [[Interval::ZERO; 5]; 2];
        let [mut closed, mut clear] = [[false; 5]; 2];
        let passing = passing(bodies);
        let mut errors = [[0, WHOLE]; 5];
        for dof in &axes {
            let k = dof.index();
            let half = alignment.half_range(*dof);
            error_box[k] = Interval::new(-half, half);
            let beyond = if dof.is_rotation() { PI } else { (2.0 * half).max(passing) };
            let reach = if wide { half.max(beyond) } else { half };
            root[k] = Interval::new(-reach, reach);
            clear[k] = !dof.is_rotation() && reach >= passing;
            closed[k] = dof.is_rotation() && (reach - PI).abs() <= 4.0 * f64::EPSILON * PI;
            if reach > half {
                errors[k] = [WHOLE / 4, WHOLE / 4 * 3];
            }
        }
        let units = Dof::ALL.map(|dof| if dof.is_rotation() { bodies.rho } else { 1.0 });
        let among = (0..bodies.meetings.len() as u32).collect();
        let whole = Cell {
            corner: [0; 5],
            levels: [0; 5],
            poses: root,
            parts: None,
            among,
            height: Some(Interval::EVERYTHING),
            sudden: true,
            walled: true,
            restless: false,
            ends: true,
            flows: Flows::ALL,
            rising: 0,
            label: None,
            faces: Box::default(),
            followed: 0,
        };
        let bearings = Bearings::of(&axes, &units);
        let (upright, cells) = (bodies.upright, vec![whole]);
        Self { axes, root, closed, clear, bearings, error_box, errors, units, upright, cells }
    }

    /// Size of a box along an axis, in smallest boxes.
    const fn size(cell: &Cell, axis: usize) -> u32 {
        WHOLE >> cell.levels[axis]
    }

    /// Position of a box.
    pub(super) fn span(&self, cell: &Cell) -> Span {
        let mut span = [[0, WHOLE]; 5];
        for dof in &self.axes {
            let k = dof.index();
            span[k] = [cell.corner[k], cell.corner[k] + Self::size(cell, k)];
        }
        span
    }

    /// The stretch of an axis that holds a place: places and errors of both of its ends. Below the error box, in it, or above it.
    fn stretch(&self, axis: usize, above: impl Fn(u32, f64) -> bool) -> ([u32; 2], Interval) {
        let (root, error_box, [from, to]) = (self.root[axis], self.error_box[axis], self.errors[axis]);
        if above(to, error_box.up) {
            ([to, WHOLE], Interval::new(error_box.up, root.up))
        } else if above(from, error_box.lo) {
            ([from, to], error_box)
        } else {
            ([0, from], Interval::new(root.lo, error_box.lo))
        }
    }

    /// The error at a place of an axis.
    fn error(&self, axis: usize, place: u32) -> f64 {
        let ([from, to], errors) = self.stretch(axis, |end, _| place > end);
        // Exact at the ends and in the middle, so that both boxes that share a border have the same number.
        if place == from {
            return errors.lo;
        }
        if place == to {
            return errors.up;
        }
        errors.lo + (errors.up - errors.lo) * (f64::from(place - from) / f64::from(to - from))
    }

    /// The place of an error on its axis, up to rounding.
    fn place(&self, axis: usize, error: f64) -> f64 {
        let ([from, to], errors) = self.stretch(axis, |_, end| error > end);
        let share = if errors.up > errors.lo { (error - errors.lo) / (errors.up - errors.lo) } else { 0.0 };
        f64::from(from) + share * f64::from(to - from)
    }

    /// How wide a box is along each error in the ρ-metric, in D.
    fn widths(&self, cell: &Cell) -> [f64; 5] {
        let poses = cell.poses;
        Dof::ALL.map(|dof| self.units[dof.index()] * poses[dof.index()].width())
    }

    /// Width of a box along its widest error, in D.
    pub(super) fn width(&self, cell: &Cell) -> f64 {
        self.widths(cell).into_iter().fold(0.0, f64::max)
    }

    /// Volume of a box in the ρ-metric.
    pub(super) fn volume(&self, cell: &Cell) -> f64 {
        let widths = self.widths(cell);
        self.axes.iter().map(|dof| widths[dof.index()]).product()
    }

    /// Whether a box may be halved.
    pub(super) fn is_divisible(cell: &Cell) -> bool {
        cell.levels.iter().all(|level| *level < DEEPEST)
    }

    /// The pose errors between places.
    fn between(&self, span: &Span) -> PoseBox {
        let mut poses = [Interval::ZERO; 5];
        for dof in &self.axes {
            let k = dof.index();
            poses[k] = Interval::new(self.error(k, span[k][0]), self.error(k, span[k][1]));
        }
        poses
    }

    /// The positions that contain all of these pose errors, each within the root; `None` if some lie outside.
    pub(super) fn places(&self, poses: &PoseBox) -> Option<Span> {
        let mut span = [[0, WHOLE]; 5];
        for dof in &self.axes {
            let k = dof.index();
            let Interval { lo, up } = self.root[k];
            if poses[k].lo < lo || poses[k].up > up {
                return None;
            }
            // Widen by one position on both sides against rounding.
            let first = (self.place(k, poses[k].lo).floor() - 1.0).max(0.0) as u32;
            let last = ((self.place(k, poses[k].up).ceil() + 1.0) as u32).min(WHOLE);
            span[k] = [first, last];
        }
        Some(span)
    }

    /// The positions strictly within these pose errors, except for rounding: boxes that only touch them do
    /// not count.
    pub(super) fn inner_places(&self, poses: &PoseBox) -> Option<Span> {
        let within = self.axes.iter().all(|dof| {
            let (own, root) = (poses[dof.index()], self.root[dof.index()]);
            root.lo - ROUNDING <= own.lo && own.up <= root.up + ROUNDING
        });
        within.then(|| {
            let mut span = [[0, WHOLE]; 5];
            for dof in &self.axes {
                let k = dof.index();
                let first = (self.place(k, poses[k].lo) + 1e-3).floor().max(0.0) as u32;
                let last = (self.place(k, poses[k].up) - 1e-3).ceil() as u32;
                span[k] = [first.min(WHOLE - 1), last.min(WHOLE)];
            }
            span
        })
    }

    /// Whether a box lies in the error box.
    pub(super) fn is_in_error_box(&self, cell: &Cell) -> bool {
        let span = self.span(cell);
        self.axes.iter().all(|dof| {
            let ([a, b], [c, d]) = (span[dof.index()], self.errors[dof.index()]);
            c <= a && b <= d
        })
    }

    /// Share of the error box that a box in it takes.
    pub(super) fn share(&self, cell: &Cell) -> f64 {
        let part = |dof: &Dof| {
            let [a, b] = self.errors[dof.index()];
            f64::from(Self::size(cell, dof.index())) / f64::from(b - a)
        };
        self.axes.iter().map(part).product()
    }

    /// Whether a motion may leave the root along an axis.
    const fn is_open(&self, axis: usize) -> bool {
        !self.closed[axis] && !self.clear[axis]
    }

    /// Whether a motion may leave the root from a box.
    pub(super) fn is_at_border(&self, cell: &Cell) -> bool {
        let span = self.span(cell);
        self.axes.iter().any(|dof| {
            let [a, b] = span[dof.index()];
            self.is_open(dof.index()) && (a == 0 || b == WHOLE)
        })
    }

    /// Whether a motion may go from a box to places that heights and faces do not describe: under something,
    /// or out of the root.
    pub(super) fn loses(&self, cell: &Cell) -> bool {
        cell.walled && !self.upright || self.leaves_root(cell)
    }

    /// Every leaf, in order.
    pub(super) fn leaves(&self) -> impl Iterator<Item = (usize, &Cell)> {
        self.cells.iter().enumerate().filter(|(_, cell)| cell.parts.is_none())
    }

    /// Visits every leaf that shares more than a border with a span, until `go_on` returns false; returns
    /// whether it never did.
    pub(super) fn visit(&self, span: &Span, mut go_on: impl FnMut(usize, &Cell) -> bool) -> bool {
        self.visit_in(0, span, &mut go_on)
    }

    /// The same for a box and its parts.
    fn visit_in(&self, number: usize, span: &Span, go_on: &mut impl FnMut(usize, &Cell) -> bool) -> bool {
        let cell = &self.cells[number];
        let is_apart = |dof: &Dof| {
            let k = dof.index();
            let [a, b] = [cell.corner[k], cell.corner[k] + Self::size(cell, k)];
            b <= span[k][0] || span[k][1] <= a
        };
        if self.axes.iter().any(is_apart) {
            return true;
        }
        match cell.parts {
            Some(parts) => {
                (parts.first..parts.first + parts.count).all(|part| self.visit_in(part as usize, span, go_on))
            }
            None => go_on(number, cell),
        }
    }

    /// The label that all leaves have that share more than a border with a span; of two ways not to dock that of the first.
    pub(super) fn common_label(&self, span: &Span) -> Option<Label> {
        let mut label: Option<Label> = None;
        let docks = |label: Label| label == Label::Yes;
        let all = self.visit(span, |_, cell| {
            let agrees = cell.label.is_some_and(|own| label.is_none_or(|label| docks(label) == docks(own)));
            label = label.or(cell.label);
            agrees
        });
        label.filter(|_| all)
    }

    /// Whether a motion may leave the root from a leaf.
    pub(super) fn leaves_root(&self, cell: &Cell) -> bool {
        let span = self.span(cell);
        self.axes.iter().any(|dof| {
            let k = dof.index();
            let ([a, b], [lower, upper]) = (span[k], cell.flows.0[k]);
            self.is_open(k) && (a == 0 && lower.down || b == WHOLE && upper.up)
        })
    }

    /// The parts of a leaf, halved along all errors or along its widest, each examined: nothing is changed.
    pub(super) fn parts(
        &self,
        number: usize,
        all: bool,
        bodies: &Bodies,
        nearby: &mut Nearby<'_>,
    ) -> Vec<Cell> {
        let whole = &self.cells[number];
        let (widths, widest) = (self.widths(whole), self.width(whole));
        let axes = self.axes.iter().map(|dof| dof.index());
        let halved: Vec<usize> = axes.filter(|k| all || widths[*k] > NEARLY_WIDEST * widest).collect();
        let part = |which: usize| {
            let mut part = whole.clone();
            for (bit, k) in halved.iter().enumerate() {
                part.levels[*k] += 1;
                part.corner[*k] += Self::size(&part, *k) * (which >> bit & 1) as u32;
            }
            part.poses = self.between(&self.span(&part));
            let survey = Survey::of(bodies, &part.poses, &whole.among, nearby);
            part.among = survey.numbers();
            // Bounds for the whole box hold for its parts.
            let both = |own: Interval| whole.height.and_then(|height| own.and(height)).unwrap_or(own);
            part.height = survey.height.map(both);
            part.sudden = survey.sudden && whole.sudden;
            part.walled = survey.walled && whole.walled;
            part.restless = survey.downhill.is_some() || whole.restless;
            part.ends = part.height.is_none() || survey.ends && whole.ends;
            part.flows = survey.flows(bodies, &part.poses, nearby);
            part.rising = whole.rising | survey.rising(&self.bearings);
            part.parts = None;
            part.faces = Box::default();
            part.followed = 0;
            part
        };
        (0..1usize << halved.len()).map(part).collect()
    }

    /// Gives a leaf its parts.
    pub(super) fn split(&mut self, number: usize, parts: Vec<Cell>) {
        self.cells[number].parts = Some(Parts { first: self.cells.len() as u32, count: parts.len() as u32 });
        self.cells[number].among = Box::default();
        self.cells.extend(parts);
    }
}

/// Smallest distance of the face centres at which halves certainly pass each other by, at any rotation, in D.
pub(super) fn passing(bodies: &Bodies) -> f64 {
    let face = DVec3::Z * bodies.cor;
    let fixed = bodies.fixed.vertices.iter().map(|v| v.truncate().length()).fold(0.0, f64::max);
    fixed + bodies.moving.vertices.iter().map(|v| v.distance(face)).fold(0.0, f64::max)
}
