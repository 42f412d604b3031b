//! The error box of a proposal: four times the single-axis limits, by exact motions.
//!
//! ```text
//!   tolerance  ├──┤            range = 4 · 2^(−k/2) · R/4 with the least k whose quarter docks on this side,
//!   range      ├──────────┤    R = 1 D or 90 degrees, k = 0 … 20: between 2.8 and 4 times the tolerance
//! ```
//!
//! Not promised: that no pose beyond it docks in combination with other errors.

use super::seat_check::{Seat, SeatCandidate};
use super::{PartFile, ProposalError, ProposalSettings, file};
use catchment_core::acceptance::Outcome;
use catchment_core::contact::Pair;
use catchment_core::design::SourceText;
use catchment_core::exec::{Cancelled, Exec};
use catchment_core::method::descent;
use catchment_core::pose::{Dof, PoseError};
use catchment_core::problem::{Draft, Problem};
use std::f64::consts::FRAC_PI_2;
use std::path::Path;

/// The design of a seat, as text and as a problem that was checked; lengths of the seat times `unit` are in the unit of the design.
pub(super) fn designed(
    parts: &[PartFile; 2],
    settings: &ProposalSettings,
    (best, seat): (&SeatCandidate, &Seat),
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
    let free: Vec<Dof> = free.iter().collect();
    let motions = descent::DescentSettings::default();
    let result = exec.each(free.len(), usize::MAX, "errors", |k, exec| {
        let whole = if free[k].is_rotation() { FRAC_PI_2 } else { 1.0 };
        let mut follower = descent::Follower::new(pair, &motions);
        let mut docks = |sign: f64, share: f64| {
            let mut error = [0.0; 5];
            error[free[k].index()] = 0.25 * sign * share * whole;
            exec.is_cancelled() || follower.follow(&PoseError::from_array(error)).outcome == Outcome::Aligned
        };
        let one = largest(STEPS, |share| docks(-1.0, share));
        // As a rule the other side is no larger.
        let is_larger = one > 0 && docks(1.0, share(one - 1));
        share(if is_larger { largest(one - 1, |share| docks(1.0, share)) } else { one })
    });
    exec.check()?;
    let mut ranges = [1.0; 5];
    for (dof, range) in free.iter().zip(result) {
        ranges[dof.index()] = range;
    }
    Ok(ranges)
}

/// Ranges that are tried: 1, 2^(−1/2), 1/2 … 1/1024, to two digits. The least is that of fits of 1/4000 D.
const STEPS: u32 = 20;

fn share(step: u32) -> f64 {
    let exact = (-0.5 * f64::from(step)).exp2();
    let mut digits = 100.0;
    while digits * exact < 10.0 {
        digits *= 10.0;
    }
    (digits * exact).ceil() / digits
}

/// Whether this is the smallest range that is tried: nothing shows that a quarter of it docks.
pub(super) fn is_least(range: f64) -> bool {
    range <= share(STEPS)
}

/// The first step whose share is accepted, by bisection; the last is not tested.
fn largest(last: u32, mut accepts: impl FnMut(f64) -> bool) -> u32 {
    let (mut few, mut many) = (0, last);
    while few < many {
        let middle = u32::midpoint(few, many);
        if accepts(share(middle)) { many = middle } else { few = middle + 1 }
    }
    many
}

#[cfg(test)]
mod tests {
    use super::{STEPS, largest, share};

    #[test]
    fn a_range_is_three_to_four_times_the_tolerance() {
        for tolerance in [0.3, 0.25, 0.2, 0.1, 0.09, 0.05, 0.03, 0.01, 0.0053, 0.0015, 0.0006] {
            let range = share(largest(STEPS, |share| 0.25 * share <= tolerance));
            assert!(
                range <= 4.0 * tolerance && (range == 1.0 || range > 2.6 * tolerance),
                "{tolerance}: {range}"
            );
        }
        assert_eq!(share(largest(STEPS, |_| false)), 0.00098);
    }
}
