//! Two parts as they come from CAD, and the design that docks them: how they lie, where they seat, how wide they are.
//!
//! ```text
//!   two files ──▶ drawn docked, in one frame?   6 directions of approach: moved to first contact, how far, does it hold
//!             └─▶ each in its own frame?        6 × 6 facings × 4 turns, all lateral offsets: where one sinks into the other
//!                        └──▶ ranked by what a half climbs that is off, and by how much of the parts can touch ──▶ a design file
//! ```
//!
//! The score of a candidate is climb · shared: how much a half that is 0.1 D and 0.3 D off has to climb, on average all around, 1 standing
//! for 0.3 D or more; and the area that can touch as a share of the broadest side of the smaller part's box. What holds x and y not both
//! counts less, what is no seat a tenth.
//!
//! D is the larger lateral extent of the facets that can touch (`contact::width`). The centre of rotation is put into the face
//! centre, which no geometry says better. The design is read back and checked as any other before it is given.
//!
//! Not promised: that parts dock as a person meant. Parts that dock in several ways, or that are drawn at an angle to their axes, need
//! a word; a proposal whose second best is nearly as good says so.

mod doubt;
mod file;
mod halves;
mod judge;
mod remedy;
mod search;
mod way;

pub use way::{Lie, Way};

use crate::acceptance::Outcome;
use crate::connector::Half;
use crate::contact::relief;
use crate::contact::told::{Told, number};
use crate::design::{LengthUnit, SourceText};
use crate::exec::{Cancelled, Exec};
use crate::pose::{Dof, DofSet, PoseError};
use crate::problem::{Draft, Problem, ProblemError};
use crate::terminal::shown;
use glam::{DMat3, DVec2};
use halves::design_unit;
use judge::{Judged, Refusal, judge};
use std::fmt;
use std::path::{Path, PathBuf};

/// In which frames the parts are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Frames {
    /// Whichever gives a seat: in one frame, docked, where the parts meet as drawn.
    #[default]
    Any,
    /// Both in one, docked.
    Assembled,
    /// Each in its own.
    Facing,
}

/// What is known already.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Settings {
    /// In which frames the parts are drawn.
    pub frames: Frames,
    /// The direction in which the moving half comes, of parts drawn docked.
    pub approach: Option<Way>,
    /// Where the fixed and the moving half face, of parts in frames of their own.
    pub facing: [Option<Way>; 2],
    /// The unit of files that do not say theirs, and of the design; millimetres without it.
    pub unit: Option<LengthUnit>,
    /// Errors that are free; whichever the seat holds without it.
    pub free: Option<DofSet>,
    /// The name of the design.
    pub name: Option<String>,
    /// How far the surface of a file may move so that it is described with fewer triangles, in the unit of the design.
    pub simplify: Option<f64>,
    /// What belongs to the fixed and to the moving half beside its file.
    pub with: [Vec<Beside>; 2],
}

/// What belongs to a half beside its file, in the coordinates of that: what no export has, or has elsewhere.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Beside {
    /// Another file.
    File(PartFile),
    /// A bought ball or pin, as an element of the design's list of parts: `{ sphere = { radius = 6 }, at = [21, 0, 8] }`.
    Part(String),
}

/// A part.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PartFile {
    /// Where it is.
    pub path: PathBuf,
    /// How the design names it: relative to the folder of the design.
    pub written: String,
}

/// One way in which the parts may dock.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// How they lie.
    pub lie: Lie,
    /// 0 to 1; the more, the likelier.
    pub score: f64,
    /// How much a half climbs that is off, 0 to 1.
    pub climb: f64,
    /// The area that can touch as a share of the broadest side of the smaller part's box.
    pub shared: f64,
    /// D, in the unit of the design.
    pub width: f64,
    /// Where the origin of the moving part is across the approach, in the unit of the design and the frame of the fixed half, turned.
    pub offset: [f64; 2],
    /// Whether it is a seat.
    pub seat: Held,
}

/// Whether a candidate is a seat.
#[derive(Debug, Clone, PartialEq)]
pub enum Held {
    /// As drawn.
    Holds,
    /// Where the halves have settled.
    Settles {
        /// By how much the moving half turned, in radians.
        turn: f64,
        /// By how much it shifted across the approach, in the unit of the design.
        shift: f64,
        /// How that is told.
        told: String,
    },
    /// It is none, and why.
    Refused(String),
    /// Others are better, so that it was not asked.
    NotAsked,
}

impl fmt::Display for Held {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Holds => f.write_str("holds"),
            Self::Settles { told, .. } => write!(f, "settles, {told} off"),
            Self::Refused(reason) => f.write_str(reason),
            Self::NotAsked => f.write_str("not looked at any closer"),
        }
    }
}

/// A design that docks two parts.
#[derive(Debug, Clone)]
pub struct Proposal {
    /// The design file.
    pub text: String,
    /// What it says, checked.
    pub problem: Problem,
    /// All ways that were judged, the best first.
    pub candidates: Vec<Candidate>,
    /// What a person should look at, as sentences.
    pub doubts: Vec<String>,
}

/// Why there is no proposal.
#[derive(Debug, thiserror::Error)]
pub enum ProposalError {
    /// A part cannot be read, or the design that was found is refused.
    #[error(transparent)]
    Problem(#[from] ProblemError),
    /// A file does not say its unit, and nobody else does.
    #[error("{} does not say its unit: the part is {} in its file", shown(path), told(*size))]
    NoUnit {
        /// The file.
        path: PathBuf,
        /// Its extent along x, y and z, in its own coordinates.
        size: [f64; 3],
        /// What it may be.
        guess: LengthUnit,
    },
    /// The parts do not dock.
    #[error("the parts dock in no direction along an axis{}", listed(tried))]
    NoSeat {
        /// What was tried, the best first, and why not.
        tried: Vec<String>,
        /// What would let them: a mirror image, or something narrow left out.
        remedy: Option<String>,
    },
    /// The computation was asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Candidates that a refusal tells.
const MOST_TOLD: usize = 6;

fn listed(tried: &[String]) -> String {
    tried.iter().take(MOST_TOLD).fold(String::new(), |told, line| told + "\n  " + line)
}

fn told(size: [f64; 3]) -> String {
    size.map(|side| file::number(side, 1e-3 * size.into_iter().fold(0.0, f64::max))).join(" × ")
}

/// A score below this is no seat: flat faces that slide.
const LEAST: f64 = 0.02;
/// A second best with this share of the score is nearly as good.
const NEARLY: f64 = 0.8;
/// Parts whose boxes are nearer than this, in the smaller one's middle extent, may be drawn docked.
const NEAR: f64 = 0.05;

/// Proposes a design for two parts; it will lie at `place`, to whose folder the parts are written relative.
///
/// # Errors
/// A part that is none or whose unit nobody says, parts that do not dock.
pub fn propose(
    parts: &[PartFile; 2],
    settings: &Settings,
    place: &Path,
    exec: &Exec,
) -> Result<Proposal, ProposalError> {
    let halves = halves::read(parts, settings, place, exec)?;
    exec.check()?;
    let unit = halves.each_ref().map(Half::middle_extent).into_iter().fold(f64::INFINITY, f64::min);
    let [fixed, moving] = halves.map(|half| half.scaled(1.0 / unit));
    let pair = [&fixed, &moving];
    let told = Told { scale: unit, unit: design_unit(settings).symbol() };
    let pinned = settings.facing.iter().any(Option::is_some);
    let may_be = |frames: Frames| match settings.frames {
        Frames::Any => {
            frames == if settings.approach.is_some() { Frames::Assembled } else { frames }
                && !(pinned && frames == Frames::Assembled)
        }
        known => known == frames,
    };
    let (mut judged, mut refused, mut nowhere) = (Vec::new(), Vec::new(), None);
    let meet = settings.frames != Frames::Any || settings.approach.is_some() || are_near(pair);
    if may_be(Frames::Assembled) && meet {
        let ways = ways(settings.approach);
        let found = exec.each(ways.len(), usize::MAX, "approaches", |k, _| {
            let lie = Lie::Assembled { approach: ways[k] };
            judge(pair, lie, DVec2::ZERO, &[], told).map_err(|refusal| refusal.of(lie))
        });
        sort(found, &mut judged, &mut refused);
        rank(&mut judged, settings.free, told, exec)?;
    }
    let docked = judged.first().is_some_and(is_seat);
    if may_be(Frames::Facing) && !docked {
        let found = facing(pair, settings, told, exec)?;
        if found.is_empty() {
            nowhere =
                Some("facing each other: nowhere along the axes does one sink into the other".to_owned());
        }
        sort(found, &mut judged, &mut refused);
        rank(&mut judged, settings.free, told, exec)?;
    }
    let candidates: Vec<Candidate> = judged.iter().map(|found| candidate(found, told)).collect();
    let best = judged.first().filter(|best| is_seat(best));
    let Some((best, Some(Ok(seat)))) = best.map(|best| (best, &best.seat)) else {
        let slack = |one: &Candidate| {
            let flat = "a half that is off does not climb";
            let why = if let Held::Refused(why) = &one.seat { why } else { flat };
            format!("{}{}: {why}", one.lie, one.place_among(&candidates, told.unit))
        };
        // What is nearest to docking first.
        refused.sort_by(|a, b| a.by.total_cmp(&b.by));
        let refused = refused.into_iter().map(|refusal| refusal.why);
        let tried = candidates.iter().map(slack).chain(nowhere).chain(refused).collect();
        let faces = may_be(Frames::Facing);
        let remedy = if faces { remedy::of(pair, settings, told, exec)? } else { None };
        return Err(ProposalError::NoSeat { tried, remedy });
    };
    let mut doubts = doubt::of(&candidates, settings);
    if best.score() < remedy::WEAK
        && may_be(Frames::Facing)
        && let Some((score, told)) = remedy::mirrored(pair, settings, told, exec)?
        && score * NEARLY > best.score()
    {
        doubts.push(told);
    }
    let text = |ranges: &[f64; 5]| file::text(parts, settings, best, *seat, unit, ranges);
    let problem = |text: &str| -> Result<Problem, ProblemError> {
        Draft::read(SourceText::new(place, text))?.build_on(exec)?.checked()
    };
    let whole = text(&[1.0; 5]);
    let wide = problem(&whole)?;
    let ranges = ranges(&wide, exec)?;
    let (text, problem) = if ranges == [1.0; 5] {
        (whole, wide)
    } else {
        let text = text(&ranges);
        let problem = problem(&text)?;
        (text, problem)
    };
    doubts.extend(problem.design().unit.and_then(|unit| doubt::of_size(problem.design().width, unit)));
    Ok(Proposal { text, problem, candidates, doubts })
}

/// Up to where errors are worth looking at, as shares of what they are looked at in first: four times as far as each alone is corrected.
fn ranges(problem: &Problem, exec: &Exec) -> Result<[f64; 5], Cancelled> {
    const LOOKS: i32 = 5;
    let alignment = problem.alignment();
    let sides: Vec<(Dof, f64)> = alignment.free.iter().flat_map(|dof| [(dof, -1.0), (dof, 1.0)]).collect();
    let found = exec.each(sides.len(), usize::MAX, "errors", |k, exec| {
        let (dof, sign) = sides[k];
        let docks = |share: &f64| {
            let mut error = [0.0; 5];
            error[dof.index()] = 0.25 * sign * share * alignment.half_range(dof);
            exec.is_cancelled() || problem.follow(&PoseError::from_array(error)).outcome == Outcome::Aligned
        };
        let mut shares = (0..LOOKS).map(|k| f64::from(-k).exp2());
        let least = f64::from(1 - LOOKS).exp2();
        shares.find(docks).unwrap_or(least)
    });
    exec.check()?;
    let mut ranges = [1.0; 5];
    for dof in alignment.free.iter() {
        let of = sides.iter().zip(&found).filter(|((side, _), _)| *side == dof).map(|(_, share)| *share);
        ranges[dof.index()] = of.fold(0.0, f64::max);
    }
    Ok(ranges)
}

/// Parts in frames of their own, judged wherever one may sink into the other.
fn facing(
    pair: [&Half; 2],
    settings: &Settings,
    told: Told,
    exec: &Exec,
) -> Result<Vec<Result<Judged, Refusal>>, Cancelled> {
    let facing = settings.facing.map(ways);
    let places = search::places(pair, [&facing[0], &facing[1]], exec)?;
    Ok(exec.each(places.len(), usize::MAX, "seats", |k, _| {
        let search::Place { lie, offset, .. } = places[k];
        judge(pair, lie, offset, &round_numbers(pair, lie), told).map_err(|refusal| refusal.of(lie))
    }))
}

fn is_seat(judged: &Judged) -> bool {
    matches!(judged.seat, Some(Ok(_))) && judged.score() > LEAST
}

/// The best first, and what the best and those nearly as good hold.
fn rank(judged: &mut Vec<Judged>, free: Option<DofSet>, told: Told, exec: &Exec) -> Result<(), Cancelled> {
    let sort = |judged: &mut Vec<Judged>| judged.sort_by(|a, b| b.score().total_cmp(&a.score()));
    sort(judged);
    // Places that came to the same seat.
    let mut kept: Vec<Judged> = Vec::new();
    for one in judged.drain(..) {
        if !kept
            .iter()
            .any(|other| other.lie == one.lie && other.offset.distance(one.offset) < NEAR * one.width)
        {
            kept.push(one);
        }
    }
    *judged = kept;
    // Whoever is asked and refused falls back.
    loop {
        exec.check()?;
        let level = judged.first().map_or(0.0, |best| (NEARLY * best.score()).max(LEAST));
        let Some(next) = judged.iter_mut().find(|one| one.seat.is_none() && one.score() > level) else {
            return Ok(());
        };
        next.ask(free, told, exec);
        sort(judged);
    }
}

fn ways(known: Option<Way>) -> Vec<Way> {
    known.map_or_else(|| Way::ALL.to_vec(), |way| vec![way])
}

fn sort(found: Vec<Result<Judged, Refusal>>, judged: &mut Vec<Judged>, refused: &mut Vec<Refusal>) {
    for one in found {
        match one {
            Ok(one) => judged.push(one),
            Err(refusal) => refused.push(refusal),
        }
    }
}

/// Whether the boxes of the parts overlap or nearly touch.
fn are_near([fixed, moving]: [&Half; 2]) -> bool {
    let ((a, b), (c, d)) = (fixed.bounds(), moving.bounds());
    (c - b).max(a - d).max_element() < NEAR
}

/// Offsets that a person would choose: the middles of the parts' boxes together, the origins of their files together.
fn round_numbers([fixed, moving]: [&Half; 2], lie: Lie) -> [DVec2; 2] {
    let turns = lie.turns();
    let middle = |half: &Half, turn: &DMat3| {
        let (low, high) = relief::plan_box(half, turn);
        low.midpoint(high)
    };
    [middle(fixed, &turns[0]) - middle(moving, &turns[1]), DVec2::ZERO]
}

fn candidate(judged: &Judged, told: Told) -> Candidate {
    let Judged { lie, width, climb, shared, seat, offset, .. } = judged;
    let unit = told.scale;
    Candidate {
        lie: *lie,
        score: judged.score(),
        climb: climb.max(0.0),
        shared: *shared,
        width: width * unit,
        offset: (*offset * unit).to_array(),
        seat: match seat {
            None => Held::NotAsked,
            Some(Ok(judge::Seat { settle: Some(off), .. })) => settles(off, width * unit, told.unit),
            Some(Ok(_)) => Held::Holds,
            Some(Err(reason)) => Held::Refused(reason.clone()),
        },
    }
}

/// Where halves have settled.
fn settles(off: &PoseError, width: f64, unit: &str) -> Held {
    let turn = off.roll.hypot(off.pitch).hypot(off.yaw);
    let shift = off.x.hypot(off.y) * width;
    // What is less is how well the rest is known.
    let shown = [(turn.to_degrees(), "deg", 0.05), (shift, unit, 1e-4 * width)];
    let parts: Vec<String> = shown
        .into_iter()
        .filter(|(value, _, least)| value >= least)
        .map(|(value, unit, _)| match unit {
            "deg" => format!("{value:.1} deg"),
            _ => format!("{} {unit}", number(value)),
        })
        .collect();
    let told = if parts.is_empty() { "hardly".to_owned() } else { parts.join(" and ") };
    Held::Settles { turn, shift, told }
}

impl Candidate {
    /// Where the moving part is, in words to put behind how it lies, where others lie the same way; nothing otherwise.
    pub fn place_among(&self, all: &[Self], unit: &str) -> String {
        if all.iter().filter(|other| other.lie == self.lie).count() < 2 {
            return String::new();
        }
        let [x, y] = self.offset.map(number);
        format!(", its origin at ({x}, {y}) {unit}")
    }

    /// The candidate in words, beside all of them, with lengths in this unit.
    pub fn told(&self, all: &[Self], unit: &str) -> String {
        let Self { lie, score, climb, shared, seat, .. } = self;
        format!(
            "{score:.2}  {lie}{}: climbs {:.0} %, {:.0} % of the smaller part's broad side can touch, {seat}",
            self.place_among(all, unit),
            climb * 100.0,
            shared * 100.0
        )
    }
}
