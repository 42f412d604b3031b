//! Growth of the neighbourhood of the mated pose: larger and larger boxes around it, as long as the shell
//! between successive boxes contains no rest.
//!
//! ```text
//!   ┌─────────────┐   shell    divided into pieces; over each, one direction opens all possible contacts: nothing rests there
//!   │ ┌─────────┐ │   level    the least floor on the outer border: a motion that starts below it never leaves, and docks
//!   │ │  home   │ │   window   the largest box about zero, in the proportions of the error box, with a roof below the level
//!   │ └─────────┘ │
//!   └─────────────┘
//! ```
//!
//! Pieces are halved until they are decided. The pieces of a shell have the same shape at any distance, so
//! that four and five errors need as many of them for a small neighbourhood as for a large one; a tree of
//! boxes would need far more.
//!
//! Not promised: the largest neighbourhood. Poses above the level remain undecided, though most of them may
//! dock.

use super::REACH;
use super::home::Home;
use super::interval::Interval;
use super::placed::{Bodies, PoseBox, middle};
use super::survey::Survey;
use crate::contact::{Nearby, Pair};
use crate::exec::{Cancelled, Exec};
use crate::pose::Dof;

/// Growth factor of a neighbourhood per step.
const GROWTH: f64 = 1.25;
/// Pieces are no smaller than this part of the neighbourhood.
const FINEST: f64 = 1.0 / 128.0;
/// The level is sufficiently accurate if its bounds differ by this part of it.
const NEAR: f64 = 0.1;
/// A window stays this part within a neighbourhood, so that rounding does not lead out of it.
const INSIDE: f64 = 1.0 - 1e-9;
/// Number of bisections of the window between a certified size and an uncertified size.
const HALVINGS: usize = 8;

/// Grows a neighbourhood, by examining pieces of it.
pub(super) struct Growth<'a> {
    pub(super) pair: &'a Pair,
    pub(super) bodies: &'a Bodies,
    /// The error box.
    pub(super) errors: PoseBox,
    /// Largest number of pieces that are examined.
    pub(super) pieces: usize,
    pub(super) exec: &'a Exec,
}

/// A part of a neighbourhood, and all that may carry there.
struct Piece {
    poses: PoseBox,
    among: Box<[u32]>,
}

/// Result of examining a piece.
enum PieceCheck {
    /// The condition holds all over it.
    Holds,
    /// Its halves may decide.
    Open(Box<[u32]>),
    /// It does not hold.
    Fails,
}

impl Growth<'_> {
    /// The largest neighbourhood found, and the number of pieces examined.
    ///
    /// # Errors
    /// [`Cancelled`] if a stop is requested.
    pub(super) fn of(&self, home: Home) -> Result<(Home, usize), Cancelled> {
        let (mut result, mut spent) = (home, 0);
        let mut poses = home.poses;
        while spent < self.pieces {
            let outer = self.scaled(&poses, GROWTH);
            if outer == poses {
                break;
            }
            let (rests, taken) =
                self.all(shell(&poses, &outer, self.bodies), &outer, self.pieces - spent, |survey, _| {
                    !survey.walled && !survey.ends && survey.downhill.is_some()
                })?;
            spent += taken;
            if !rests {
                break;
            }
            poses = outer;
            let (level, taken) = self.level(&poses)?;
            spent += taken;
            if level > result.level {
                result = Home { poses, level };
            }
        }
        Ok((result, spent))
    }

    /// A neighbourhood, larger by a factor, within the error box.
    fn scaled(&self, poses: &PoseBox, by: f64) -> PoseBox {
        std::array::from_fn(|k| {
            let up = (poses[k].up * by).min(self.errors[k].up);
            if up > 0.0 { Interval::new(-up, up) } else { Interval::ZERO }
        })
    }

    /// The scale of the largest box about zero, in the proportions of the error box, that certainly lies in a
    /// neighbourhood and below its level.
    ///
    /// # Errors
    /// [`Cancelled`] if a stop is requested.
    pub(super) fn window(&self, home: &Home) -> Result<f64, Cancelled> {
        let mut free = self.bodies.free.iter();
        let Some(most) = free.next().map(|dof| home.poses[dof.index()].up / self.errors[dof.index()].up)
        else {
            return Ok(0.0);
        };
        let below = |scale: f64| {
            let poses =
                self.errors.map(|errors| if errors.up > 0.0 { errors * scale } else { Interval::ZERO });
            let whole = vec![Piece { poses, among: self.everything() }];
            let (holds, _) = self.all(whole, &poses, self.pieces, |survey, _| {
                survey.height.is_some_and(|height| height.up < home.level)
            })?;
            Ok(holds)
        };
        let (mut yes, mut no) = (0.0, most * INSIDE);
        for _ in 0..HALVINGS {
            let scale = if yes == 0.0 { 0.5 * no } else { f64::midpoint(yes, no) };
            if below(scale)? { yes = scale } else { no = scale }
        }
        Ok(yes)
    }

    /// Below it nothing leaves a neighbourhood, and how many pieces that took.
    fn level(&self, poses: &PoseBox) -> Result<(f64, usize), Cancelled> {
        let mut open = border(poses, self.bodies, &self.everything());
        let (mut least, mut most, mut spent) = (f64::INFINITY, f64::INFINITY, 0);
        while !open.is_empty() {
            spent += open.len();
            let seen: Vec<(Piece, Option<f64>, f64)> = self.look(&open, |piece, nearby| {
                let survey = Survey::of(self.bodies, &piece.poses, &piece.among, nearby);
                let floor = survey.height.map(|height| height.lo);
                let there = nearby.height(&middle(&piece.poses)).unwrap_or(f64::NEG_INFINITY);
                (Piece { poses: piece.poses, among: survey.numbers() }, floor, there)
            })?;
            most = seen.iter().map(|(_, _, there)| *there).fold(most, f64::min);
            let enough = most - NEAR * (most - self.pair.mated_height()).max(0.0);
            open = Vec::new();
            for (piece, floor, _) in seen {
                let floor = floor.unwrap_or(f64::NEG_INFINITY);
                if floor >= enough || spent > self.pieces || !is_divisible(&piece.poses, poses) {
                    least = least.min(floor);
                } else {
                    open.extend(halves(&piece.poses, poses, &piece.among));
                }
            }
        }
        Ok((least, spent))
    }

    /// Whether a condition holds over all pieces of a neighbourhood, or their halves, and the number of
    /// pieces examined.
    fn all(
        &self,
        mut open: Vec<Piece>,
        whole: &PoseBox,
        most: usize,
        holds: impl Fn(&Survey, &PoseBox) -> bool + Sync,
    ) -> Result<(bool, usize), Cancelled> {
        let mut spent = 0;
        while !open.is_empty() {
            spent += open.len();
            if spent > most {
                return Ok((false, spent));
            }
            let seen = self.look(&open, |piece, nearby| {
                let survey = Survey::of(self.bodies, &piece.poses, &piece.among, nearby);
                if holds(&survey, &piece.poses) {
                    PieceCheck::Holds
                } else if is_divisible(&piece.poses, whole) {
                    PieceCheck::Open(survey.numbers())
                } else {
                    PieceCheck::Fails
                }
            })?;
            let mut next = Vec::new();
            for (piece, look) in open.iter().zip(seen) {
                match look {
                    PieceCheck::Holds => {}
                    PieceCheck::Open(among) => next.extend(halves(&piece.poses, whole, &among)),
                    PieceCheck::Fails => return Ok((false, spent)),
                }
            }
            open = next;
        }
        Ok((true, spent))
    }

    /// Examines pieces, in their order.
    fn look<T: Send>(
        &self,
        pieces: &[Piece],
        look: impl Fn(&Piece, &mut Nearby<'_>) -> T + Sync,
    ) -> Result<Vec<T>, Cancelled> {
        self.exec.map_with(pieces.len(), || self.pair.about(REACH), |nearby, k| look(&pieces[k], nearby))
    }

    fn everything(&self) -> Box<[u32]> {
        (0..self.bodies.meetings.len() as u32).collect()
    }
}

/// The region between a box and a larger box: two slabs per free error.
fn shell(inner: &PoseBox, outer: &PoseBox, bodies: &Bodies) -> Vec<Piece> {
    let among: Box<[u32]> = (0..bodies.meetings.len() as u32).collect();
    let mut slab = *outer;
    let mut pieces = Vec::new();
    for k in bodies.free.iter().map(Dof::index) {
        let sides = [Interval::new(outer[k].lo, inner[k].lo), Interval::new(inner[k].up, outer[k].up)];
        for side in sides.into_iter().filter(|side| side.width() > 0.0) {
            let mut poses = slab;
            poses[k] = side;
            pieces.push(Piece { poses, among: among.clone() });
        }
        slab[k] = inner[k];
    }
    pieces
}

/// The faces of a box.
fn border(poses: &PoseBox, bodies: &Bodies, among: &[u32]) -> Vec<Piece> {
    let face = |k: usize, end: f64| {
        let mut face = *poses;
        face[k] = Interval::thin(end);
        Piece { poses: face, among: among.into() }
    };
    bodies.free.iter().map(Dof::index).flat_map(|k| [face(k, poses[k].lo), face(k, poses[k].up)]).collect()
}

/// The error along which a piece is the largest part of the whole, and that part.
fn widest(piece: &PoseBox, whole: &PoseBox) -> (usize, f64) {
    let part = |k: usize| if whole[k].width() > 0.0 { piece[k].width() / whole[k].width() } else { 0.0 };
    (0..5).map(|k| (k, part(k))).fold((0, 0.0), |best, own| if own.1 > best.1 { own } else { best })
}

fn is_divisible(piece: &PoseBox, whole: &PoseBox) -> bool {
    widest(piece, whole).1 > FINEST
}

/// A piece halved along its widest error.
fn halves(piece: &PoseBox, whole: &PoseBox, among: &[u32]) -> [Piece; 2] {
    let (k, _) = widest(piece, whole);
    let Interval { lo, up } = piece[k];
    let middle = piece[k].middle();
    [Interval::new(lo, middle), Interval::new(middle, up)].map(|half| {
        let mut poses = *piece;
        poses[k] = half;
        Piece { poses, among: among.into() }
    })
}
