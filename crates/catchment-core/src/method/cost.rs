//! Estimates of time and memory before a computation.

use super::descent::{DescentSettings, End, Follower};
use crate::acceptance::{Domain, Outcome};
use crate::contact::Pair;
use crate::diagnostic::Advice;
use crate::exec::{Exec, OutOfBudget};
use crate::landscape::Resolution;
use crate::pose::PoseError;

/// Seconds of a motion between simple halves, on one core: the unit of cost estimates.
pub(super) const DESCENT_SECONDS: f64 = 1e-4;

/// Bytes per pose while poses are decided singly: the end and the outcome of each, and the ends once more
/// while the parts of the threads are merged.
pub(super) const POSE_BYTES: u64 = (2 * size_of::<End>() + size_of::<Outcome>()) as u64;

/// Affordable number of motions, as a share of that for simple halves: the time of a motion grows with about
/// the cube of the number of facets; for halves with trees it is measured on a few motions.
pub fn affordable(pair: &Pair) -> f64 {
    const SIMPLE: f64 = 64.0;
    if pair.has_trees() {
        return (DESCENT_SECONDS / *pair.motion_cache.seconds.get_or_init(|| counted(pair))).min(1.0);
    }
    let facets = |half: &crate::connector::Half| half.surfaces.iter().map(|s| s.facets.len()).sum::<usize>();
    let facets = (facets(&pair.fixed) + facets(&pair.moving)) as f64;
    (SIMPLE / facets.max(SIMPLE)).powi(3)
}

/// Estimated seconds for a motion, on one core.
pub fn seconds_per_motion(pair: &Pair) -> f64 {
    DESCENT_SECONDS / affordable(pair)
}

/// Number of motions in this time on one core, at least ten.
pub fn motions_in(seconds: f64, pair: &Pair) -> usize {
    const FEWEST: f64 = 10.0;
    (seconds / seconds_per_motion(pair)).max(FEWEST) as usize
}

/// Affordable cells per axis, from the number for simple halves with as many free errors, each a motion; in
/// total at least `poses`, if those for simple halves are as many.
pub(super) fn affordable_cells(pair: &Pair, simple: [usize; 5], poses: usize) -> [usize; 5] {
    let (share, poses) = (affordable(pair), poses as f64);
    let mut axes = 0.0;
    simple.map(|cells| {
        axes += 1.0;
        let cells = cells as f64;
        (cells * share.powf(1.0 / axes)).max(poses.powf(1.0 / axes).min(cells)) as usize
    })
}

/// Seconds of a motion between halves with trees: the cost is counted for a few sampled poses of the error
/// box, and for docking poses in the same directions, each at a quarter of the pose before. The larger mean
/// counts; the same on every machine.
fn counted(pair: &Pair) -> f64 {
    const POSES: usize = 3;
    const SMALLER: [f64; 5] = [1.0, 0.25, 0.0625, 0.016, 0.004];
    const SEED: u64 = 0xc057;
    /// After this many seconds the measurement ends.
    const ENOUGH: f64 = 2.0;
    let Domain::Poses(poses) = Domain::random(&pair.alignment, POSES, SEED) else { return DESCENT_SECONDS };
    let settings = DescentSettings::default();
    let mut follower = Follower::new(pair, &settings);
    let (mut random, mut docking, mut followed) = (0.0, 0.0, 0.0);
    for pose in &poses {
        followed += 1.0;
        for (k, share) in SMALLER.into_iter().enumerate() {
            let before = follower.took();
            let scaled = PoseError::from_array(pose.to_array().map(|value| share * value));
            let docks = follower.follow(&scaled).outcome == Outcome::Aligned;
            let seconds = 1e-9 * (follower.took() - before) as f64;
            random += if k == 0 { seconds } else { 0.0 };
            if docks {
                docking += seconds;
                break;
            }
        }
        if 1e-9 * follower.took() as f64 > ENOUGH {
            break;
        }
    }
    (f64::max(random, docking) / followed).max(DESCENT_SECONDS)
}

/// Rejects results that do not fit into memory, with a resolution that would.
pub fn ensure_fits(
    what: &'static str,
    needed: u64,
    per_cell: u64,
    axes: usize,
    exec: &Exec,
) -> Result<(), OutOfBudget> {
    exec.ensure_fits(what, needed, |budget| {
        let fits = Resolution::largest_that_fits(budget, per_cell, axes);
        vec![Advice::AtMostResolution(fits), Advice::MoreMemory]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::connector::Connector;
    use crate::design::family::Cone;
    use crate::design::{Alignment, FamilySpec};
    use crate::pose::{DofSet, Mount};

    #[test]
    fn the_cost_of_many_facets_stays_below_their_cube() {
        let share = |chord_error: f64| {
            let spec = FamilySpec::Cone(Cone { chord_error, ..Cone::default() });
            let connector = Connector::of_family(&spec, Mount::X).unwrap();
            affordable(&Pair::new(&connector, &Alignment::new(DofSet::ALL, Mount::X)))
        };
        // Of a thousand facets from all the error box 42 ms were measured: by the cube of their number it would be 300 ms and more.
        let (coarse, fine) = (share(1e-2), share(1e-5));
        assert!(coarse > fine, "{coarse} {fine}");
        let milliseconds = |share: f64| 1e3 * DESCENT_SECONDS / share;
        assert!((20.0..80.0).contains(&milliseconds(fine)), "{}", milliseconds(fine));
    }

    #[test]
    fn the_cost_of_a_motion_is_counted_and_reproducible() {
        let spec = FamilySpec::Cone(Cone { chord_error: 1e-5, ..Cone::default() });
        let connector = Connector::of_family(&spec, Mount::X).unwrap();
        let pair = || Pair::new(&connector, &Alignment::new(DofSet::ALL, Mount::X));
        let (one, other) = (counted(&pair()), counted(&pair()));
        assert!(pair().has_trees() && one > DESCENT_SECONDS);
        assert_eq!(one.to_bits(), other.to_bits());
    }

    #[test]
    fn a_time_budget_yields_its_motions_and_at_least_ten() {
        let connector = Connector::of_family(&FamilySpec::Cone(Cone::default()), Mount::X).unwrap();
        let pair = Pair::new(&connector, &Alignment::new(DofSet::ALL, Mount::X));
        assert_eq!(motions_in(100.5 * seconds_per_motion(&pair), &pair), 100);
        assert_eq!(motions_in(0.0, &pair), 10);
    }
}
