//! Parts that are drawn docked, in a common frame: the approaches along which they hold, near the pose in
//! which they are drawn.
//!
//! ```text
//!   6 approaches, and common diagonals ──▶ a lattice near the drawn pose ──▶ exact contact of those that hold
//!                                                                       └─▶ drawn apart: lowered to first contact
//! ```

use super::layout::{AxisDirection, PartLayout};
use super::seat_check::{RejectedLayout, SeatCandidate, judge};
use super::{PartFrames, Parts, SeatSearch, is_seat, rank, sink, ways};
use catchment_core::diagnostic::Diagnostic;
use catchment_core::exec::{Cancelled, Exec};
use glam::DVec2;

/// Parts that are drawn docked: the results of a lattice for each approach; for those that hold, or that are
/// requested, the results of exact contact.
pub(super) fn docked(
    both: &Parts<'_>,
    looked: &mut SeatSearch,
    exec: &Exec,
) -> Result<Vec<(AxisDirection, sink::ApproachResult)>, Cancelled> {
    let ways = ways(both.settings.approach);
    let look = |ways: &[AxisDirection]| {
        exec.each(ways.len(), usize::MAX, "approaches", |k, _| {
            (ways[k], sink::drawn(both.lattices(), ways[k], false, both.grain))
        })
    };
    let mut looks = look(&ways);
    if both.settings.approach.is_none() {
        // A diagonal counts only if it holds; a failure along it is not reported.
        let [fixed, moving] = &both.diagonals;
        let common: Vec<AxisDirection> = fixed.iter().copied().filter(|way| moving.contains(way)).collect();
        looks.extend(
            look(&common).into_iter().filter(|(_, drawn)| matches!(drawn, sink::ApproachResult::Holds(_))),
        );
    }
    exec.check()?;
    let holds = looks.iter().filter_map(|(way, drawn)| match drawn {
        sink::ApproachResult::Holds(sunk) => Some((*way, *sunk)),
        _ => None,
    });
    let holds: Vec<(AxisDirection, sink::Sunk)> = holds.collect();
    let found =
        exec.each(holds.len(), usize::MAX, "seats", |k, exec| let_in(both, holds[k].0, holds[k].1, exec));
    looked.add(found);
    rank(&mut looked.judged, both.settings.free, both.display, exec)?;
    if !looked.has_seat() {
        // A groove holds in a single direction, which the lattice search does not recognise as a seat.
        let rests = |drawn: &sink::ApproachResult| matches!(drawn, sink::ApproachResult::Flat { .. });
        let is_assembled = both.settings.frames == PartFrames::Assembled || both.settings.approach.is_some();
        let flat: Vec<AxisDirection> =
            looks.iter().filter(|(_, drawn)| is_assembled || rests(drawn)).map(|(way, _)| *way).collect();
        let found = exec.each(flat.len(), usize::MAX, "approaches", |k, _| {
            let lie = PartLayout::Assembled { approach: flat[k] };
            judge(both.halves, lie, DVec2::ZERO, &[], None, both.display).map_err(|refusal| refusal.of(lie))
        });
        looked.add(found);
        rank(&mut looked.judged, both.settings.free, both.display, exec)?;
    }
    Ok(looks)
}

/// A place near the drawn pose: as drawn if exact contact holds there, else the deepest place nearby.
fn let_in(
    both: &Parts<'_>,
    way: AxisDirection,
    sunk: sink::Sunk,
    exec: &Exec,
) -> Result<SeatCandidate, RejectedLayout> {
    let lie = PartLayout::Assembled { approach: way };
    let drawn =
        judge(both.halves, lie, DVec2::ZERO, &[], None, both.display).map_err(|refusal| refusal.of(lie));
    let near = |found: &SeatCandidate| {
        let lift = sunk.height + 0.5 * sunk.climb;
        found.lift <= lift
    };
    if let Ok(found) = drawn
        && near(&found)
    {
        let mut found = found.with_lattice(sunk, 0);
        found.evaluate_seat(both.settings.free, both.display, exec);
        if matches!(found.seat, Some(Ok(_))) {
            return Ok(found);
        }
    }
    judge(both.halves, sunk.lie, sunk.offset, &[DVec2::ZERO], Some(&sunk), both.display)
        .map(|found| found.with_lattice(sunk, 0).searched_near_the_drawn_pose())
        .map_err(|refusal| refusal.of(lie))
}

/// Parts that are drawn apart: lowered along the approach until they hold, from any distance; with a note
/// about it.
pub(super) fn let_down(
    both: &Parts<'_>,
    looks: &[(AxisDirection, sink::ApproachResult)],
    looked: &mut SeatSearch,
    exec: &Exec,
) -> Result<Option<Diagnostic>, Cancelled> {
    let apart: Vec<AxisDirection> = looks
        .iter()
        .filter(|(_, drawn)| matches!(drawn, sink::ApproachResult::Apart(_)))
        .map(|(way, _)| *way)
        .collect();
    let found = exec.each(apart.len(), usize::MAX, "approaches", |k, exec| {
        let sink::ApproachResult::Holds(sunk) = sink::drawn(both.lattices(), apart[k], true, both.grain)
        else {
            return None;
        };
        Some(let_in(both, apart[k], sunk, exec))
    });
    looked.add(found.into_iter().flatten().collect());
    rank(&mut looked.judged, both.settings.free, both.display, exec)?;
    let best = looked.judged.first().filter(|best| is_seat(best)).and_then(|best| best.sunk);
    Ok(best.map(|sunk| {
        let text = format!(
            "in doubt: as drawn the parts are {} apart; the moving part slides so far along the approach to first contact",
            both.display.length(sunk.height.abs())
        );
        Diagnostic::note("drawn-apart", text)
    }))
}
