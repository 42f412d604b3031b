//! What a person should look at in a proposal, in words: another way that is nearly as good, a seat that is shallow or settles, a size that rather has another unit.

use super::halves::design_unit;
use super::{Candidate, Frames, Held, Lie, NEARLY, Settings, file};
use crate::design::LengthUnit;

/// A half that settles by more than this turn, or by this shift in D, is told of: 2 degrees, as much of an arm of half D.
const MUCH: f64 = 2.0 / 180.0 * std::f64::consts::PI;
/// Docks narrower and wider than this are rather in another unit, in metres.
const LIKELY: [f64; 2] = [5e-4, 5.0];

/// That a dock has a size which it would rather have in another unit.
pub(super) fn of_size(width: f64, unit: LengthUnit) -> Option<String> {
    let is_likely = |unit: &LengthUnit| (LIKELY[0]..=LIKELY[1]).contains(&(width * unit.metres()));
    let rather = [LengthUnit::Mm, LengthUnit::M, LengthUnit::In].into_iter().find(is_likely)?;
    (!is_likely(&unit)).then(|| {
        let [millimetres, would_be] =
            [unit, rather].map(|unit| file::number(width * unit.metres() * 1e3, 1e-3));
        format!(
            "the dock is {millimetres} mm wide: are the files in {}? Then it is {would_be} mm wide",
            rather.symbol()
        )
    })
}

/// What a person should look at.
pub(super) fn of(candidates: &[Candidate], settings: &Settings) -> Vec<String> {
    let [best, others @ ..] = candidates else { return Vec::new() };
    let mut doubts = Vec::new();
    let nearly: Vec<&Candidate> = others.iter().filter(|other| other.score > NEARLY * best.score).collect();
    if let Some(other) = nearly.iter().find(|other| !other.lie.is_turned(best.lie)) {
        doubts.push(format!(
            "in doubt: another way is nearly as good ({}; {:.2} beside {:.2}): look at the picture, and say which it is",
            other.lie, other.score, best.score
        ));
    } else if let Some(other) = nearly.first() {
        let place = if other.lie == best.lie { "at another place" } else { "turned about the approach" };
        doubts.push(format!(
            "the parts dock as well {place} ({}{}): look whether the one that was taken is the one that is meant",
            other.lie,
            other.place_among(candidates, design_unit(settings).symbol())
        ));
    }
    if settings.frames == Frames::Any
        && matches!(best.lie, Lie::Assembled { .. })
        && settings.approach.is_none()
    {
        doubts.push("the parts meet as drawn, and were taken as an assembly that is docked".to_owned());
    }
    if let Held::Settles { turn, shift, told } = &best.seat
        && (*turn > MUCH || *shift > MUCH * best.width)
    {
        doubts.push(format!(
            "as drawn the parts do not hold; let go they come to rest {told} off, which is taken as mated: look at the picture, whether that is how \
             they dock, or lock what turns with --free"
        ));
    }
    if best.climb < 0.1 {
        doubts.push(format!(
            "the seat is shallow: 0.1 D to 0.3 D off, a half climbs {} D on average",
            file::number(best.climb * 0.3, 1e-4)
        ));
    }
    doubts
}
