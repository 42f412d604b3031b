//! The error box of a proposal: four times what each error alone tolerates, by exact motions.
//!
//! ```text
//!   tolerance  ├──┤            range = 4 · 2^(−k/2) · R/4 with the least k whose quarter docks on this side,
//!   range      ├──────────┤    R = 1 D or 90 degrees, k = 0 … 8: between 2.8 and 4 times the tolerance
//! ```
//!
//! Not promised: that nothing docks beyond, together with other errors.

use super::judge::{Judged, Seat};
use super::{PartFile, ProposalError, Settings, file};
use crate::acceptance::Outcome;
use crate::contact::Pair;
use crate::design::SourceText;
use crate::exec::{Cancelled, Exec};
use crate::method::descent;
use crate::pose::{Dof, PoseError};
use crate::problem::{Draft, Problem};
use std::f64::consts::FRAC_PI_2;
use std::path::Path;

/// The design of a seat, as text and as a problem that was checked; lengths of the seat times `unit` are in the unit of the design.
pub(super) fn designed(
    parts: &[PartFile; 2],
    settings: &Settings,
    (best, seat): (&Judged, &Seat),
    unit: f64,
    place: &Path,
    exec: &Exec,
) -> Result<(String, Problem), ProposalError> {
    let ranges = ranges(&best.pair(seat), exec)?;
    let text = file::text(parts, settings, best, *seat, unit, &ranges);
    let problem = Draft::read(SourceText::new(place, &text))?.build_on(exec)?.checked()?;
    Ok((text, problem))
}

/// Ranges as shares of 1 D and 90 degrees.
fn ranges(pair: &Pair, exec: &Exec) -> Result<[f64; 5], Cancelled> {
    let free = pair.alignment.free;
    let sides: Vec<(Dof, f64)> = free.iter().flat_map(|dof| [(dof, -1.0), (dof, 1.0)]).collect();
    let motions = descent::Settings::default();
    let found = exec.each(sides.len(), usize::MAX, "errors", |k, exec| {
        let (dof, sign) = sides[k];
        let whole = if dof.is_rotation() { FRAC_PI_2 } else { 1.0 };
        largest(|share| {
            let mut error = [0.0; 5];
            error[dof.index()] = 0.25 * sign * share * whole;
            exec.is_cancelled()
                || descent::outcome(pair, &PoseError::from_array(error), &motions).outcome == Outcome::Aligned
        })
    });
    exec.check()?;
    let mut ranges = [1.0; 5];
    for dof in free.iter() {
        let of = sides.iter().zip(&found).filter(|((side, _), _)| *side == dof).map(|(_, share)| *share);
        ranges[dof.index()] = of.fold(0.0, f64::max);
    }
    Ok(ranges)
}

/// The largest of 1, 2^(−1/2), 1/2 … 1/16 that is accepted, by bisection, to two digits; the last is not asked.
fn largest(accepts: impl Fn(f64) -> bool) -> f64 {
    const STEPS: u32 = 8;
    let share = |k: u32| (100.0 * (-0.5 * f64::from(k)).exp2()).ceil() / 100.0;
    let (mut few, mut many) = (0, STEPS);
    while few < many {
        let middle = u32::midpoint(few, many);
        if accepts(share(middle)) { many = middle } else { few = middle + 1 }
    }
    share(many)
}

#[cfg(test)]
mod tests {
    use super::largest;

    #[test]
    fn a_range_is_three_to_four_times_the_tolerance() {
        for tolerance in [0.3, 0.25, 0.2, 0.1, 0.09, 0.05, 0.03] {
            let range = largest(|share| 0.25 * share <= tolerance);
            assert!(
                range <= 4.0 * tolerance && (range == 1.0 || range > 2.6 * tolerance),
                "{tolerance}: {range}"
            );
        }
        assert_eq!(largest(|_| false), 0.07);
    }
}
