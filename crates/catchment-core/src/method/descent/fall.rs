//! Test by exact motion whether a half slightly off the mated pose stays in its seat.
//! [`crate::contact::mated`] tests only the first order, and a half in unstable balance is level to first
//! order.
//!
//! ```text
//!     ╲   ___●___   ╱    released: without error; 0.01 D or 1° off, each free error both ways, and all of them together
//!      ╲_╱ ↙   ↘ ╲_╱     one comes to rest below the seat, or runs off  →  the mated pose is not stable
//! ```
//!
//! For halves of many facets the same motions, followed to their ends, also show whether all poses slightly
//! off reach the mated pose itself, as in a tapered seat.
//!
//! Run once per pair, with about ten motions; for tight fits and halves of many facets with five. Code that
//! ends motions before they come to rest must run this test first: in a seat that fails it, an arriving half
//! does not stay.
//!
//! Not promised: a fall that needs a larger error, or that starts in a direction outside the tested ones, is
//! missed.

use super::motion::{Motion, Until};
use super::rest::TOUCHING;
use super::{DescentSettings, End};
use crate::acceptance::Outcome;
use crate::contact::mated::{CONTACT_TOLERANCE, LossOfSeat, ReleaseResult};
use crate::contact::{Pair, Seat};
use crate::pose::{Dof, PoseError};
use std::f64::consts::PI;

/// Pose errors at which halves are released: D, and radians.
const OFF: [f64; 2] = [0.01, PI / 180.0];
/// A half this close to the mated pose, in the ρ-metric, stays: on paths along which it would fall it is
/// never closer than a third of its initial distance.
const HOME: f64 = 1e-3;
/// Halves of many facets this close to the mated pose, and within this share of the distance of the tested
/// motions that ended there, are moved to it.
const TAKEN: f64 = 2e-3;
const SHARE: f64 = 0.2;
/// Of so few free errors all combinations of signs are tried.
const FEW: usize = 2;

/// Rest below the seat of a pair that a half slightly off reaches, or its running off; `None` if the mated
/// pose is stable. Always with the default settings: the result is stored with the pair.
pub fn fall(pair: &Pair) -> Option<LossOfSeat> {
    about(pair).fall
}

/// Distance from the mated pose, in the ρ-metric, within which all halves of many facets reach it: every
/// tested half that is released slightly off, from farther away, does so. 0 if one does not.
pub(super) fn home(pair: &Pair) -> f64 {
    about(pair).home
}

fn about(pair: &Pair) -> ReleaseResult {
    *pair.motion_cache.about_mated.get_or_init(|| {
        let settings = DescentSettings::default();
        let mut motion = Motion::new(pair, &settings).trusting();
        let mut seat = Seat::new(pair);
        // If all facets nearly touch, the last part of a motion near the mated pose takes longest; motions
        // stop early if all starts nearby reach it.
        let mut within = if pair.has_trees() && !pair.is_tight() { TAKEN } else { 0.0 };
        let mut falls = |from: PoseError| {
            // A motion near the mated pose stops early, unless its end is needed: the last part takes
            // longest.
            let (mut is_home, ends) = (false, within > 0.0);
            let mut home = |at: &PoseError| {
                is_home = !ends && from != PoseError::default() && pair.alignment.length(at) <= HOME;
                is_home.then_some(Outcome::Aligned)
            };
            let End { outcome, error: rest, height } = motion.follow(&from, Until::AtRest, &mut home);
            if pair.alignment.length(&rest) > TOUCHING {
                within = 0.0;
            } else if from != PoseError::default() {
                within = within.min(SHARE * pair.alignment.length(&from));
            }
            if is_home || outcome == Outcome::Undecided {
                return None;
            }
            let height = height.unwrap_or(f64::NEG_INFINITY);
            let energy = pair.energy_at(&rest, height);
            let sinks = pair.mated_energy() - energy;
            let is_seated = energy >= seat.floor() && seat.holds(&rest, height);
            (sinks > CONTACT_TOLERANCE && !is_seated).then_some(LossOfSeat { from, rest, sinks })
        };
        let fall = starts(pair).into_iter().find_map(&mut falls);
        ReleaseResult { fall, home: if fall.is_none() { within } else { 0.0 } }
    })
}

/// Whether every half in the seat is docked, so that a motion may end before it comes to rest: the design has
/// no limits, the mated pose is stable, and the seat does not leak.
pub(in crate::method) fn all_count(pair: &Pair) -> bool {
    let mut seat = Seat::new(pair);
    !seat.is_limited() && fall(pair).is_none() && !seat.leaks()
}

/// The pose errors at which halves are released.
fn starts(pair: &Pair) -> Vec<PoseError> {
    let alignment = &pair.alignment;
    let free: Vec<Dof> = alignment.free.iter().filter(|dof| !alignment.dont_care.contains(*dof)).collect();
    let with = |sign: &dyn Fn(usize) -> f64| {
        let mut error = [0.0; Dof::ALL.len()];
        for (k, dof) in free.iter().enumerate() {
            error[dof.index()] = sign(k) * OFF[usize::from(dof.is_rotation())];
        }
        PoseError::from_array(error)
    };
    let alternate = |k: usize| if k.is_multiple_of(2) { 1.0 } else { -1.0 };
    // Motions of these halves are slow: about a tenth of a second each.
    let is_slow = pair.has_trees() || pair.is_tight();
    let mut starts = vec![PoseError::default()];
    if !is_slow {
        starts.extend(
            (0..free.len()).flat_map(|one| [1.0, -1.0].map(|s| with(&|k| if k == one { s } else { 0.0 }))),
        );
    }
    if free.len() > 1 || is_slow {
        starts.extend([with(&|_| 1.0), with(&|_| -1.0)]);
        if free.len() <= FEW || is_slow {
            starts.extend([with(&alternate), with(&|k| -alternate(k))]);
        }
    }
    starts
}
