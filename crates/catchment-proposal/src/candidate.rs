//! A candidate: a relative orientation in which two parts may dock, in terms for the user.

use super::layout::PartLayout;
use super::seat_check::{Seat, SeatCandidate};
use catchment_core::contact::display_unit::{DisplayUnit, number};
use catchment_core::design::LengthUnit;
use catchment_core::pose::PoseError;
use std::fmt;

/// A distance from the drawn pose below this is not printed, in D.
const HARDLY: f64 = 1e-3;

/// A relative pose in which the parts may dock.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// How they lie.
    pub lie: PartLayout,
    /// 0 to 1; the more, the likelier.
    pub score: f64,
    /// Climb of the moving half until it leaves, and its play to each side at half of that, in the unit of
    /// the design; if a lattice found it.
    pub sunk: Option<[f64; 2]>,
    /// climb / (e + play); 0 if no lattice found it.
    pub steep: f64,
    /// Whether it hardly rises within the range of a lattice: a part in a tray, and not in a seat.
    pub is_loose: bool,
    /// Number of its place: candidates of the same place differ by a rotation about the approach.
    pub class: usize,
    /// How much a half climbs that is off, 0 to 1.
    pub climb: f64,
    /// The area that can touch as a share of the broadest side of the smaller part's box.
    pub shared: f64,
    /// D, in the unit of the design.
    pub width: f64,
    /// Position of the origin of the moving part across the approach, in the unit of the design and the
    /// rotated frame of the fixed half.
    pub offset: [f64; 2],
    /// How far it is from the pose in which the parts are drawn, across the approach and along it, in the unit
    /// of the design; if it was searched there, because the drawn pose itself is not a seat.
    pub off_drawn: Option<[f64; 2]>,
    /// Whether it is a seat.
    pub seat: SeatCheck,
}

/// Whether a candidate is a seat.
#[derive(Debug, Clone, PartialEq)]
pub enum SeatCheck {
    /// As drawn.
    Holds,
    /// The rest that the halves reach.
    Settles {
        /// By how much the moving half turned, in radians.
        turn: f64,
        /// By how much it shifted across the approach, in the unit of the design.
        shift: f64,
        /// Its description.
        off_by: String,
    },
    /// It is not a seat, for this reason.
    Refused(String),
    /// It was not evaluated, because others are better.
    NotAsked,
}

impl fmt::Display for SeatCheck {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Holds => f.write_str("at rest when mated"),
            Self::Settles { off_by, .. } => write!(f, "settles {off_by} off the drawn pose"),
            Self::Refused(reason) => f.write_str(reason),
            Self::NotAsked => f.write_str("not examined further"),
        }
    }
}

/// The unit for lengths of parts in texts: millimetres if a file is in metres.
pub(super) const fn shown_unit(unit: LengthUnit) -> LengthUnit {
    match unit {
        LengthUnit::M => LengthUnit::Mm,
        other => other,
    }
}

/// A length in the unit of the design, as text: in millimetres if the file is in metres.
pub fn shown_length(value: f64, unit: LengthUnit) -> String {
    let shown = shown_unit(unit);
    format!("{} {}", number(value * unit.metres() / shown.metres()), shown.symbol())
}

/// A candidate in the user's terms: lengths times `unit` are in the unit of the design.
pub(super) fn candidate(judged: &SeatCandidate, unit: f64, display: DisplayUnit) -> Candidate {
    let SeatCandidate { lie, width, climb, shared, seat, offset, lift, sunk, class, .. } = judged;
    Candidate {
        lie: *lie,
        score: judged.score(),
        sunk: sunk.map(|sunk| [sunk.climb * unit, sunk.play * unit]),
        steep: sunk.map_or(0.0, |sunk| sunk.steep),
        is_loose: sunk.is_some_and(|sunk| sunk.is_loose),
        class: *class,
        climb: climb.max(0.0),
        shared: *shared,
        width: width * unit,
        offset: (*offset * unit).to_array(),
        off_drawn: judged.is_near_drawn.then(|| [offset.length() * unit, lift.abs() * unit]),
        seat: match seat {
            None => SeatCheck::NotAsked,
            Some(Ok(Seat { settle: Some(off), .. })) => settles(off, width * display.scale, display.unit),
            Some(Ok(_)) => SeatCheck::Holds,
            Some(Err(reason)) => SeatCheck::Refused(reason.clone()),
        },
    }
}

/// The rest that the halves reach.
fn settles(off: &PoseError, width: f64, unit: &str) -> SeatCheck {
    let turn = off.roll.hypot(off.pitch).hypot(off.yaw);
    let shift = off.x.hypot(off.y) * width;
    // Smaller deviations are within the accuracy of the rest.
    let shown = [(turn.to_degrees(), "deg", 0.05), (shift, unit, 1e-4 * width)];
    let parts: Vec<String> = shown
        .into_iter()
        .filter(|(value, _, least)| value >= least)
        .map(|(value, unit, _)| match unit {
            "deg" => format!("{value:.1} deg"),
            _ => format!("{} {unit}", number(value)),
        })
        .collect();
    let off_by = if parts.is_empty() { "hardly".to_owned() } else { parts.join(" and ") };
    SeatCheck::Settles { turn, shift, off_by }
}

impl Candidate {
    /// Position of the moving part, in words to append to its orientation, if others have the same
    /// orientation; else empty.
    pub fn place_among(&self, all: &[Self], unit: LengthUnit) -> String {
        if all.iter().filter(|other| other.lie == self.lie).count() < 2 {
            return String::new();
        }
        let shown = shown_unit(unit);
        let [x, y] = self.offset.map(|side| number(side * unit.metres() / shown.metres()));
        format!(", its origin at ({x}, {y}) {}", shown.symbol())
    }

    /// How the parts lie, in words, with lengths in this unit.
    pub(super) fn lie_in_words(&self, unit: LengthUnit) -> String {
        let (PartLayout::Facing { moving, .. }, Some([across, along])) = (self.lie, self.off_drawn) else {
            return self.lie.to_string();
        };
        let drawn = PartLayout::Assembled { approach: moving };
        let off: Vec<String> = [(across, "across"), (along, "along")]
            .into_iter()
            .filter(|(length, _)| *length > HARDLY * self.width)
            .map(|(length, way)| format!("{} {way} it", shown_length(length, unit)))
            .collect();
        if off.is_empty() { drawn.to_string() } else { format!("{drawn}, but for {}", off.join(" and ")) }
    }

    /// The candidate in words, beside all of them, with lengths in this unit.
    pub fn in_words(&self, all: &[Self], unit: LengthUnit) -> String {
        let Self { score, climb, shared, seat, .. } = self;
        let lie = self.lie_in_words(unit);
        if let Some([deep, play]) = self.sunk {
            return format!(
                "{score:.2} (0: no seat, 1: steep seat without play): {lie}{}; sits {} deep along the approach, ±{} of sideways play at half of that depth; {seat}",
                self.place_among(all, unit),
                shown_length(deep, unit),
                shown_length(play, unit)
            );
        }
        format!(
            "{score:.2} (0: no seat, 1: steep seat without play): {lie}{}; seat slope {:.0} %, {:.0} % of the smaller part's broad side can touch; {seat}",
            self.place_among(all, unit),
            climb * 100.0,
            shared * 100.0
        )
    }
}
