//! Notes about a proposal: another candidate of similar score, a shallow or settling seat, a
//! size that suggests another unit.

use super::halves::design_unit;
use super::{Candidate, NEARLY, PartFrames, PartLayout, ProposalSettings, SeatCheck, file};
use catchment_core::design::LengthUnit;
use catchment_core::diagnostic::{Advice, Diagnostic};

/// A half that settles by more than this rotation, or by this offset in D, is reported: 2 degrees, as much
/// for an arm of half D.
const MUCH: f64 = 2.0 / 180.0 * std::f64::consts::PI;
/// Another place with this share of the steepness of the best may be the intended seat.
const RIVAL: f64 = 0.4;
/// A place that scores less than this is weak.
const WEAK: f64 = 0.4;
/// Docks narrower and wider than this are rather in another unit, in metres.
const LIKELY: [f64; 2] = [5e-4, 5.0];

/// That a dock has a size which it would rather have in another unit.
pub(super) fn of_size(width: f64, unit: LengthUnit) -> Option<Diagnostic> {
    let is_likely = |unit: &LengthUnit| (LIKELY[0]..=LIKELY[1]).contains(&(width * unit.metres()));
    let rather = [LengthUnit::Mm, LengthUnit::M, LengthUnit::In].into_iter().find(is_likely)?;
    (!is_likely(&unit)).then(|| {
        let [millimetres, would_be] =
            [unit, rather].map(|unit| file::number(width * unit.metres() * 1e3, 1e-3));
        let text = format!(
            "the dock is {millimetres} mm wide: are the files in {}? Then it is {would_be} mm wide",
            rather.symbol()
        );
        Diagnostic::note("unit", text)
    })
}

/// Whether two orientations differ only in the end of a part that is up.
fn is_twin(one: &Candidate, other: &Candidate) -> bool {
    let (PartLayout::Facing { fixed, moving, .. }, PartLayout::Facing { fixed: f, moving: m, .. }) =
        (one.lie, other.lie)
    else {
        return false;
    };
    (fixed == f || fixed.opposite() == f)
        && (moving == m || moving.opposite() == m)
        && (fixed, moving) != (f, m)
}

/// The notes for the user.
pub(super) fn of(candidates: &[Candidate], settings: &ProposalSettings) -> Vec<Diagnostic> {
    let [best, others @ ..] = candidates else { return Vec::new() };
    let mut notes = Vec::new();
    let look = |code, text: String| Diagnostic::note(code, text).with(Advice::StateLayout);
    let rivals = |other: &&Candidate| {
        let is_refused = matches!(other.seat, SeatCheck::Refused(_));
        if best.steep > 0.0 && other.steep > 0.0 && other.class != best.class {
            // A candidate that is as steep but does not hold may be wrong by a lattice cell.
            other.steep >= if is_refused { NEARLY } else { RIVAL } * best.steep
        } else {
            !is_refused && other.score > NEARLY * best.score
        }
    };
    let nearly: Vec<&Candidate> = others.iter().filter(rivals).collect();
    let elsewhere =
        |other: &&&Candidate| !other.lie.is_turned(best.lie) || best.steep > 0.0 && other.class != best.class;
    if let Some(other) = nearly.iter().find(elsewhere) {
        notes.push(look("rival-seat", format!(
            "in doubt: {} ({}{}; score {:.2} beside {:.2}): look at the picture; to choose the other, state how the parts face",
            if is_twin(best, other) {
                "the moving part docks turned end for end, too"
            } else {
                "another way to dock scores nearly as high"
            },
            other.lie_in_words(design_unit(settings)),
            other.place_among(candidates, design_unit(settings)),
            other.score,
            best.score
        )));
    } else if let Some(other) = nearly.first() {
        let place = if other.lie == best.lie { "at another place" } else { "turned about the approach" };
        notes.push(look("rival-place", format!(
            "the parts dock as well {place} ({}{}): look at the picture to see if the right one was chosen",
            other.lie_in_words(design_unit(settings)),
            other.place_among(candidates, design_unit(settings))
        )));
    }
    if settings.frames == PartFrames::Any
        && matches!(best.lie, PartLayout::Assembled { .. })
        && settings.approach.is_none()
    {
        let text = "the parts meet as drawn, and were taken as an assembly that is docked";
        notes.push(Diagnostic::note("assembly", text));
    }
    if let SeatCheck::Settles { turn, shift, off_by } = &best.seat
        && (*turn > MUCH || *shift > MUCH * best.width)
    {
        notes.push(look("settles", format!(
            "the drawn pose is not a rest: released, the moving part settles {off_by} off, and that pose counts as mated: look at the picture; \
             errors that your mount locks need not be free"
        )));
    }
    if matches!(best.lie, PartLayout::Facing { .. }) && best.score < WEAK {
        notes.push(look("weak-seat", format!(
            "in doubt: the score {:.2} is low (below {WEAK}): look at the picture; if the parts dock differently, state how they face",
            best.score
        )));
    }
    if best.is_loose {
        let text = "in doubt: the moving part lies loose, as in a tray: look at the picture; if the parts dock differently, state how they face";
        notes.push(look("loose-seat", text.to_owned()));
    }
    if best.sunk.is_none() && best.climb < 0.1 {
        notes.push(Diagnostic::note(
            "shallow-seat",
            format!(
                "the seat is shallow: 0.1 D to 0.3 D off, a half climbs {} D on average",
                file::number(best.climb * 0.3, 1e-4)
            ),
        ));
    }
    notes
}
