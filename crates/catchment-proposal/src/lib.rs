//! A proposal: from two parts in CAD files to the design that docks them, with their orientation, seat and
//! width.
//!
//! ```text
//!   two files ──▶ drawn docked, in one frame?   6 approaches on a lattice near the drawn pose ──▶ exact contact of those that hold
//!             └─▶ each in its own frame?        6 × 24 views, all lateral offsets on a lattice ──▶ exact contact of the steepest places
//!                        └──▶ ranked by the steepness of the seat ──▶ a design file
//! ```
//!
//! steep = climb / (e + play): how high the moving half climbs before it leaves the seat, relative to its
//! play to each side at half of that height; e is half a millimetre for parts of a few centimetres. The score
//! of a candidate is steep / (steep + 3.5). A candidate that does not constrain both x and y counts less; one
//! without a seat counts a tenth. A candidate that no lattice found (a shallow groove) scores climb · shared
//! from exact contact: the climb of a half at offsets of 0.1 D and 0.3 D, and the area that can touch as a
//! share of the broadest side of the smaller part's box.
//!
//! Parts that are drawn in a common frame, close to each other and without overlap, are an assembly: they
//! dock as drawn or are rejected with the cause.
//!
//! D is the larger lateral extent of the facets that can touch (`contact::width`). The centre of rotation is
//! placed at the face centre, because no geometry determines it better. The design is read back and checked
//! like any other before it is returned.
//!
//! Not promised: that parts dock as their designer intended. Parts that dock in several ways, or that are
//! drawn at an angle to their axes other than 45 degrees, need additional input. A proposal with a weak
//! score, or a runner-up with 0.4 of its steepness, is marked as "in doubt".

mod assembled;
mod candidate;
mod diagnosis;
mod error_box;
mod file;
mod halves;
mod layout;
mod remedy;
mod search;
mod seat_check;
mod sink;
mod warnings;

pub use candidate::{Candidate, SeatCheck, shown_length};
pub use layout::{AxisDirection, PartLayout};

use assembled::{docked, let_down};
use candidate::{candidate, shown_unit};
use catchment_core::connector::Half;
use catchment_core::contact::display_unit::DisplayUnit;
use catchment_core::contact::height_map;
use catchment_core::design::LengthUnit;
use catchment_core::diagnostic::{Advice, Diagnostic};
use catchment_core::exec::{Cancelled, Exec};
use catchment_core::pose::DofSet;
use catchment_core::problem::{Problem, ProblemError};
use catchment_core::terminal::shown;
use glam::{DMat3, DVec2};
use halves::design_unit;
use seat_check::{RejectedLayout, SeatCandidate, judge};
use std::collections::HashSet;
use std::path::{Path, PathBuf};

/// In which frames the parts are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PartFrames {
    /// Either, whichever gives a seat: in a common frame, docked, if the parts meet as drawn.
    #[default]
    Any,
    /// Both docked, in a common frame.
    Assembled,
    /// Each in its own.
    Facing,
}

/// Known facts about the parts.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ProposalSettings {
    /// In which frames the parts are drawn.
    pub frames: PartFrames,
    /// The direction in which the moving half comes, of parts drawn docked.
    pub approach: Option<AxisDirection>,
    /// Facing directions of the fixed and the moving half, for parts in their own frames.
    pub facing: [Option<AxisDirection>; 2],
    /// The unit of files that do not state it; default: millimetres. The design has the same unit, but
    /// millimetres for files in metres.
    pub unit: Option<LengthUnit>,
    /// Errors that are free; whichever the seat holds without it.
    pub free: Option<DofSet>,
    /// The name of the design.
    pub name: Option<String>,
    /// Largest displacement of a file's surface by simplification to fewer triangles, in `unit`.
    pub simplify: Option<f64>,
    /// Additions to the fixed and to the moving half besides its file.
    pub with: [Vec<PartDetail>; 2],
}

/// An addition to a half besides its file, in the coordinates of the file: features that an export lacks, or
/// has elsewhere.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum PartDetail {
    /// Another file.
    File(PartFile),
    /// A bought ball or pin, as an element of the design's list of parts: `{ sphere = { radius = 6 }, at = [21, 0, 8] }`.
    Part(String),
}

/// A part.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PartFile {
    /// The file.
    pub path: PathBuf,
    /// How the design names it: relative to the folder of the design.
    pub written: String,
    /// Number of its body, the largest first, if it holds several; all of them without a number.
    pub body: Option<u16>,
}

/// A design that docks two parts.
#[derive(Debug, Clone)]
pub struct Proposal {
    /// The design file.
    pub text: String,
    /// The problem of the design, checked.
    pub problem: Problem,
    /// All evaluated candidates, the best first.
    pub candidates: Vec<Candidate>,
    /// Notes for the user.
    pub notes: Vec<Diagnostic>,
}

/// Why there is no proposal.
#[derive(Debug, thiserror::Error)]
pub enum ProposalError {
    /// A part cannot be read, or the design that was found is refused.
    #[error(transparent)]
    Problem(#[from] ProblemError),
    /// A file does not state its unit, and the settings do not either.
    #[error("{} does not say its unit: the part is {} in its file", shown(path), size_in_words(*size))]
    NoUnit {
        /// The file.
        path: PathBuf,
        /// Its extent along x, y and z, in its own coordinates.
        size: [f64; 3],
        /// The probable unit.
        guess: LengthUnit,
    },
    /// The parts do not dock.
    #[error("no docking direction along the axes was found{}", listed(tried))]
    NoSeat {
        /// The candidates tried, the best first, with the reasons.
        tried: Vec<String>,
        /// A remedy: a mirror image, or the removal of a narrow feature.
        remedy: Option<String>,
        /// Further advice.
        advice: Vec<Advice>,
    },
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Largest number of candidates in an error.
const MOST_TOLD: usize = 4;

fn listed(tried: &[String]) -> String {
    let directions: Vec<&str> = tried.iter().take(MOST_TOLD).map(String::as_str).collect();
    if directions.is_empty() { String::new() } else { format!(": {}", directions.join("; ")) }
}

fn size_in_words(size: [f64; 3]) -> String {
    size.map(|side| file::number(side, 1e-3 * size.into_iter().fold(0.0, f64::max))).join(" × ")
}

/// A score below this is no seat: flat faces that slide.
const LEAST: f64 = 0.02;
/// A second best with this share of the score is nearly as good.
const NEARLY: f64 = 0.8;
/// Parts whose boxes are closer than this, in the smaller part's middle extent, may be drawn docked.
const NEAR: f64 = 0.05;
/// Number of places for exact contact, and the smallest steepness as a share of the largest.
const JUDGED: usize = 5;
const JUDGED_STEEP: f64 = 0.3;

/// Both halves, for exact contact and for lattices. Lengths in the smaller half's middle extent.
struct Parts<'a> {
    halves: [&'a Half; 2],
    triangles: [sink::Triangles; 2],
    /// Directions half way between two axes along which each may enter or be entered.
    diagonals: [Vec<AxisDirection>; 2],
    grain: sink::Grain,
    settings: &'a ProposalSettings,
    /// Unit of lengths in texts.
    display: DisplayUnit,
}

impl<'a> Parts<'a> {
    fn new(
        halves: [&'a Half; 2],
        grain: sink::Grain,
        settings: &'a ProposalSettings,
        display: DisplayUnit,
    ) -> Self {
        let triangles = halves.map(sink::triangles);
        let diagonals = triangles.each_ref().map(sink::diagonals);
        Self { halves, triangles, diagonals, grain, settings, display }
    }

    fn lattices(&self) -> [&sink::Triangles; 2] {
        self.triangles.each_ref()
    }
}

/// The evaluated and the rejected candidates.
#[derive(Default)]
struct SeatSearch {
    judged: Vec<SeatCandidate>,
    refused: Vec<RejectedLayout>,
}

impl SeatSearch {
    fn add(&mut self, found: Vec<Result<SeatCandidate, RejectedLayout>>) {
        for one in found {
            match one {
                Ok(one) => self.judged.push(one),
                Err(refusal) => self.refused.push(refusal),
            }
        }
    }

    fn has_seat(&self) -> bool {
        self.judged.first().is_some_and(is_seat)
    }
}

/// Proposes a design for two parts, to be stored at `place`; paths of the parts are relative to its folder.
///
/// # Errors
/// An invalid part, a part without a unit, parts that do not dock.
pub fn propose(
    parts: &[PartFile; 2],
    settings: &ProposalSettings,
    place: &Path,
    exec: &Exec,
) -> Result<Proposal, ProposalError> {
    let halves = halves::read(parts, settings, place, exec)?;
    exec.check()?;
    let unit = halves.each_ref().map(Half::middle_extent).into_iter().fold(f64::INFINITY, f64::min);
    let [fixed, moving] = halves.map(|half| half.scaled(1.0 / unit));
    let shown = shown_unit(design_unit(settings));
    let display =
        DisplayUnit { scale: unit * design_unit(settings).metres() / shown.metres(), unit: shown.symbol() };
    let millimetre = 1e-3 / (unit * design_unit(settings).metres());
    let both = Parts::new([&fixed, &moving], sink::Grain::new(millimetre), settings, display);
    let pinned = settings.facing.iter().any(Option::is_some);
    let may_be = |frames: PartFrames| match settings.frames {
        PartFrames::Any => {
            frames == if settings.approach.is_some() { PartFrames::Assembled } else { frames }
                && !(pinned && frames == PartFrames::Assembled)
        }
        known => known == frames,
    };
    let mut looked = SeatSearch::default();
    let (mut notes, mut why, mut frame) = (Vec::new(), None, diagnosis::Frame::Own);
    // The cause for parts that lie flat on each other as drawn; reported only if there is no other seat.
    let mut flat = None;
    let meet = settings.frames != PartFrames::Any || settings.approach.is_some() || are_near(both.halves);
    if may_be(PartFrames::Assembled) && meet {
        let looks = docked(&both, &mut looked, exec)?;
        if settings.frames == PartFrames::Any && settings.approach.is_none() {
            frame = diagnosis::frame(both.lattices(), both.grain);
        }
        let may_be_assembly = frame != diagnosis::Frame::Own;
        if !looked.has_seat() {
            if may_be_assembly && let Some(note) = let_down(&both, &looks, &mut looked, exec)? {
                notes.push(note);
            }
            // Parts in frames of their own say nothing about an assembly, so no cause is given.
            why = (may_be_assembly || !may_be(PartFrames::Facing))
                .then(|| diagnosis::of(both.lattices(), &looks, both.grain, display));
            let are_flat = looks.iter().any(|(_, drawn)| matches!(drawn, sink::ApproachResult::Flat { .. }));
            flat = are_flat.then(|| diagnosis::of(both.lattices(), &looks, both.grain, display));
        }
    }
    let is_assembly = frame == diagnosis::Frame::Assembly;
    let faces = may_be(PartFrames::Facing) && !is_assembly;
    if faces && !looked.has_seat() {
        anywhere(&both, &mut looked, exec)?;
        if frame == diagnosis::Frame::Perhaps {
            notes.push(Diagnostic::note("drawn-elsewhere", diagnosis::ELSEWHERE));
        }
    }
    let SeatSearch { judged, mut refused } = looked;
    let candidates: Vec<Candidate> = judged.iter().map(|found| candidate(found, unit, display)).collect();
    let best = judged.first().filter(|best| is_seat(best));
    let Some((best, Some(Ok(seat)))) = best.map(|best| (best, &best.seat)) else {
        let slack = |one: &Candidate| {
            let flat = "flat: a half that is off does not climb";
            let why = if let SeatCheck::Refused(why) = &one.seat { why } else { flat };
            format!("{}{}: {why}", one.lie, one.place_among(&candidates, design_unit(settings)))
        };
        // List the refusals nearest to docking first: those that lack only play come before flat ones.
        refused.sort_by(|a, b| a.by.total_cmp(&b.by));
        let (mut tight, refused): (Vec<RejectedLayout>, Vec<RejectedLayout>) =
            refused.into_iter().partition(|refusal| refusal.by <= 0.0);
        // Of a cube every facing has no play: once is enough.
        let mut known = HashSet::new();
        tight.retain(|refusal| known.insert(refusal.why.clone()));
        let [tight, refused] =
            [tight, refused].map(|list| list.into_iter().map(|refusal| refusal.to_string()));
        let nowhere =
            faces.then_some("facing each other: nowhere along the axes does one sink into the other");
        let nowhere = nowhere.filter(|_| candidates.is_empty()).map(ToOwned::to_owned);
        let (why, advice) = why.or(flat).unzip();
        let taken = is_assembly.then_some(Advice::OwnFrames);
        let advice = advice.flatten().into_iter().chain(taken).collect();
        let slack = candidates.iter().map(slack);
        let tried = tight.chain(why).chain(slack).chain(nowhere).chain(refused).collect();
        let remedy = match diagnosis::of_files(parts, both.halves, settings, unit) {
            Some(mistake) => Some(mistake),
            None if faces => remedy::of(&both, exec)?,
            None => None,
        };
        return Err(ProposalError::NoSeat { tried, remedy, advice });
    };
    notes.extend(warnings::of(&candidates, settings));
    if best.score() < remedy::WEAK
        && faces
        && let Some((score, note)) = remedy::mirrored(&both, exec)?
        && score * NEARLY > best.score()
    {
        notes.push(Diagnostic::note("mirror-image", note));
    }
    if halves::are_more_than_two(parts, settings, exec) {
        let text = "in doubt: the file holds more than two separate bodies; the two largest were taken";
        notes.push(Diagnostic::note("several-bodies", text));
    }
    let (text, problem) = error_box::designed(parts, settings, (best, seat), unit, place, exec)?;
    let by_width = problem.design().unit.and_then(|unit| warnings::of_size(problem.design().width, unit));
    let by_length =
        || diagnosis::unit(both.halves, settings, unit).map(|text| Diagnostic::note("unit", text));
    notes.extend(by_width.or_else(by_length));
    Ok(Proposal { text, problem, candidates, notes })
}

/// Parts in their own frames: the places at which one sinks into the other, or the shallow places if there
/// are none.
fn anywhere(both: &Parts<'_>, looked: &mut SeatSearch, exec: &Exec) -> Result<(), Cancelled> {
    looked.add(sunk(both, exec)?);
    rank(&mut looked.judged, both.settings.free, both.display, exec)?;
    if !looked.has_seat() {
        looked.add(facing(both.halves, both.settings, both.display, exec)?);
        rank(&mut looked.judged, both.settings.free, both.display, exec)?;
    }
    Ok(())
}

/// The steepest places, evaluated by exact contact.
fn sunk(both: &Parts<'_>, exec: &Exec) -> Result<Vec<Result<SeatCandidate, RejectedLayout>>, Cancelled> {
    let facing = both.settings.facing.map(ways);
    let mut found = sink::sinks(both.lattices(), [&facing[0], &facing[1]], both.grain, exec)?;
    if both.settings.facing == [None; 2] {
        let [fixed, moving] = &both.diagonals;
        if !fixed.is_empty() && !moving.is_empty() {
            found.extend(sink::sinks(both.lattices(), [fixed, moving], both.grain, exec)?);
            found.sort_by(|a, b| b.steep.total_cmp(&a.steep));
        }
    }
    let classes = sink::classes(both.lattices()[1], &found, both.grain);
    let most = classes.first().map_or(0.0, |class| class.best.steep);
    let places: Vec<(usize, sink::Sunk)> = classes
        .iter()
        .take(JUDGED)
        .enumerate()
        .filter(|(_, class)| class.best.steep >= JUDGED_STEEP * most)
        .flat_map(|(k, class)| {
            let turned = class.turned.filter(|turned| k == 0 && turned.steep >= NEARLY * most);
            std::iter::once(class.best).chain(turned).map(move |sunk| (k, sunk))
        })
        .collect();
    Ok(exec.each(places.len(), usize::MAX, "seats", |k, _| {
        let (class, sunk) = places[k];
        judge(
            both.halves,
            sunk.lie,
            sunk.offset,
            &round_numbers(both.halves, sunk.lie),
            Some(&sunk),
            both.display,
        )
        .map(|found| found.with_lattice(sunk, class))
        .map_err(|refusal| refusal.of(sunk.lie))
    }))
}

/// Parts in their own frames, evaluated at every place at which one may sink into the other.
fn facing(
    pair: [&Half; 2],
    settings: &ProposalSettings,
    display: DisplayUnit,
    exec: &Exec,
) -> Result<Vec<Result<SeatCandidate, RejectedLayout>>, Cancelled> {
    let facing = settings.facing.map(ways);
    let places = search::places(pair, [&facing[0], &facing[1]], exec)?;
    Ok(exec.each(places.len(), usize::MAX, "seats", |k, _| {
        let search::SeatPlace { lie, offset, .. } = places[k];
        judge(pair, lie, offset, &round_numbers(pair, lie), None, display).map_err(|refusal| refusal.of(lie))
    }))
}

fn is_seat(judged: &SeatCandidate) -> bool {
    matches!(judged.seat, Some(Ok(_))) && judged.score() > LEAST
}

/// Ranks the candidates, and evaluates the seats of the best and those of similar score.
fn rank(
    judged: &mut Vec<SeatCandidate>,
    free: Option<DofSet>,
    display: DisplayUnit,
    exec: &Exec,
) -> Result<(), Cancelled> {
    let sort = |judged: &mut Vec<SeatCandidate>| judged.sort_by(|a, b| b.score().total_cmp(&a.score()));
    sort(judged);
    // Places that came to the same seat.
    let mut kept: Vec<SeatCandidate> = Vec::new();
    for one in judged.drain(..) {
        if !kept
            .iter()
            .any(|other| other.lie == one.lie && other.offset.distance(one.offset) < NEAR * one.width)
        {
            kept.push(one);
        }
    }
    *judged = kept;
    // If the seat of the best candidate is refused, its score drops and the next candidate is tried.
    loop {
        exec.check()?;
        let level = judged.first().map_or(0.0, |best| (NEARLY * best.score()).max(LEAST));
        let Some(next) = judged.iter_mut().find(|one| one.seat.is_none() && one.score() > level) else {
            return Ok(());
        };
        next.evaluate_seat(free, display, exec);
        sort(judged);
    }
}

fn ways(known: Option<AxisDirection>) -> Vec<AxisDirection> {
    known.map_or_else(|| AxisDirection::ALL.to_vec(), |way| vec![way])
}

/// Whether the boxes of the parts overlap or nearly touch.
fn are_near([fixed, moving]: [&Half; 2]) -> bool {
    let ((a, b), (c, d)) = (fixed.bounds(), moving.bounds());
    (c - b).max(a - d).max_element() < NEAR
}

/// Natural offsets: the centres of the parts' boxes coincide, or the origins of their files coincide.
fn round_numbers([fixed, moving]: [&Half; 2], lie: PartLayout) -> [DVec2; 2] {
    let turns = lie.turns();
    let middle = |half: &Half, turn: &DMat3| {
        let (low, high) = height_map::plan_box(half, turn);
        low.midpoint(high)
    };
    [middle(fixed, &turns[0]) - middle(moving, &turns[1]), DVec2::ZERO]
}
