//! Remedies for parts that do not dock: the mirror image of a part, or the removal of a narrow feature.
//!
//! ```text
//!   no seat ──▶ the moving part reflected: does it seat?  ──▶ "was one of the two exported mirrored?"
//!          └──▶ features narrower than three cells removed, from one part, then from the other: does it sink in?  ──▶ "in the way: at (…)"
//! ```
//!
//! Not promised: that parts which dock mirrored were meant to be mirrored, or that the reported obstacle is
//! the only one.

use super::{Parts, ProposalSettings, is_seat, rank, search, sunk, ways};
use catchment_core::connector::Half;
use catchment_core::contact::display_unit::{DisplayUnit, number};
use catchment_core::contact::height_map;
use catchment_core::exec::{Cancelled, Exec};
use glam::DVec3;

/// A score below this is weak: the mirror image is tested, too.
pub(super) const WEAK: f64 = 0.3;

/// The remedy in words.
pub(super) fn of(both: &Parts<'_>, exec: &Exec) -> Result<Option<String>, Cancelled> {
    match mirrored(both, exec)? {
        Some((_, words)) => Ok(Some(words)),
        None => obstacle(both.halves, both.settings, both.display, exec),
    }
}

/// Whether the mirror image of the moving part docks, with which score, and that in words.
pub(super) fn mirrored(both: &Parts<'_>, exec: &Exec) -> Result<Option<(f64, String)>, Cancelled> {
    let [fixed, moving] = both.halves;
    let image = moving.reflected(|p| p * DVec3::new(-1.0, 1.0, 1.0));
    let result = sunk(&Parts::new([fixed, &image], both.grain, both.settings, both.display), exec)?;
    let mut judged = result.into_iter().filter_map(Result::ok).collect();
    rank(&mut judged, both.settings.free, both.display, exec)?;
    let best = judged.into_iter().next().filter(is_seat);
    Ok(best.filter(|result| result.score() >= WEAK).map(|result| {
        let score = result.score();
        let words = format!(
            "a mirror image of the moving part would dock ({}; {score:.2}): was one of the two exported mirrored?",
            result.lie
        );
        (score, words)
    }))
}

/// Whether the parts would dock without something narrow that is in the way, in words.
fn obstacle(
    pair: [&Half; 2],
    settings: &ProposalSettings,
    display: DisplayUnit,
    exec: &Exec,
) -> Result<Option<String>, Cancelled> {
    let facing = settings.facing.map(ways);
    let result = search::obstacle(pair, [&facing[0], &facing[1]], exec)?;
    Ok(result.map(|(lie, result)| {
        let turns = lie.turns();
        let at = [0, 1].map(|k| {
            let [x, y, z] = (display.scale * (turns[k].transpose() * result.at[k])).to_array().map(number);
            format!("({x}, {y}, {z}) {}", display.unit)
        });
        format!("{} ({lie})", height_map::in_words(&result, &at, display))
    }))
}
