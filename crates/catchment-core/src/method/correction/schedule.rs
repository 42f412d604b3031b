//! Schedule of the samples: sizes of the batches, and their distribution over the strata.
//!
//! ```text
//!   batch   1        2     3       4            …   the last
//!   poses   8 per    half of all before,            cut to the requested number
//!           stratum  at most 8192
//! ```
//!
//! The sizes depend only on the number of strata, so that the first n poses are the same for every stopping
//! rule: a run with a time limit and a run with the same number of poses give the same bytes.

use super::interval::{CombinedShares, StratumCounts};
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// Stopping rule of a sampling.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Stop {
    /// After this many poses; every stratum receives at least one.
    Samples(usize),
    /// When the half-width of the interval is this share of the Sum, or of [`FAINT`] of the box if the Sum is
    /// smaller. Checked after every batch.
    Tolerance(f64),
    /// After this time, with at least the first batch. The number of poses depends on the machine; the
    /// results for a given number do not.
    Budget(Duration),
}

/// Share of the box below which a relative tolerance becomes absolute: 1 % of zero cannot be reached.
pub const FAINT: f64 = 1e-3;

/// Poses of the first batch, per stratum and in all.
const FIRST_PER_STRATUM: usize = 8;
const FIRST: usize = 64;
/// A batch is this part of all before it, so that the early batches, drawn with little knowledge, have little
/// weight.
const GROWTH: usize = 2;
/// Largest number of poses in a batch: memory limit.
const MOST: usize = 8192;

/// The next batch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Batch {
    /// How many poses it draws.
    pub poses: usize,
    /// Nothing follows.
    pub last: bool,
}

/// The batch after `total` poses in `strata` strata that took `elapsed` and gave `whole`; `None` if the
/// stopping rule applies.
pub fn next(
    stop: Stop,
    total: usize,
    strata: usize,
    elapsed: Duration,
    whole: &CombinedShares,
) -> Option<Batch> {
    let scheduled = if total == 0 {
        FIRST.max(FIRST_PER_STRATUM * strata)
    } else {
        (total / GROWTH).clamp(FIRST.max(strata), MOST)
    };
    let go_on = Some(Batch { poses: scheduled, last: false });
    match stop {
        Stop::Samples(wanted) => {
            let left = wanted.max(strata).saturating_sub(total);
            // A rest too small for a pose in every stratum is drawn with the batch before it.
            match left {
                0 => None,
                _ if left < scheduled + strata => Some(Batch { poses: left, last: true }),
                _ => go_on,
            }
        }
        Stop::Tolerance(share) => {
            let enough = total > 0 && whole.half_width() <= share * whole.fraction.max(FAINT);
            if enough { None } else { go_on }
        }
        Stop::Budget(_) if total == 0 => go_on,
        Stop::Budget(budget) => {
            let each = elapsed.as_secs_f64() / total as f64;
            let left = budget.saturating_sub(elapsed).as_secs_f64();
            let affordable = (left / each.max(f64::MIN_POSITIVE)) as usize;
            match affordable {
                few if few < strata => None,
                some if some < scheduled => Some(Batch { poses: some, last: true }),
                _ => go_on,
            }
        }
    }
}

/// Progress of the sampling, in [0, 1], after `total` poses.
pub(crate) fn progress(stop: Stop, total: usize, elapsed: Duration, whole: &CombinedShares) -> f64 {
    if total == 0 {
        return 0.0;
    }
    match stop {
        Stop::Samples(wanted) => total as f64 / wanted as f64,
        Stop::Tolerance(share) => (share * whole.fraction.max(FAINT) / whole.half_width()).powi(2),
        Stop::Budget(budget) => elapsed.as_secs_f64() / budget.as_secs_f64(),
    }
}

/// Distributes a batch over the strata: at least a pose for each, the others in proportion to the uncertainty
/// (Neyman, J. R. Stat. Soc. 97 (1934) 558).
pub fn allot(poses: usize, seen: &[StratumCounts]) -> Vec<usize> {
    let spare = poses.saturating_sub(seen.len());
    let doubt: f64 = seen.iter().map(StratumCounts::doubt).sum();
    let ideal: Vec<f64> = seen.iter().map(|s| spare as f64 * (s.doubt() / doubt)).collect();
    let mut given: Vec<usize> = ideal.iter().map(|x| 1 + *x as usize).collect();
    let rest = poses.saturating_sub(given.iter().sum());
    let mut order: Vec<usize> = (0..seen.len()).collect();
    order.sort_by(|a, b| ideal[*b].fract().total_cmp(&ideal[*a].fract()).then(a.cmp(b)));
    for stratum in order.iter().cycle().take(rest) {
        given[*stratum] += 1;
    }
    given
}

#[cfg(test)]
mod tests {
    use super::*;

    const WHOLE: CombinedShares = CombinedShares { fraction: 0.3, ci95: [0.29, 0.31], plain: 0.0 };

    /// The sizes of all batches.
    fn batches(stop: Stop, strata: usize, each: Duration) -> Vec<usize> {
        let (mut sizes, mut total) = (Vec::new(), 0);
        while let Some(batch) = next(stop, total, strata, each * total as u32, &WHOLE) {
            sizes.push(batch.poses);
            total += batch.poses;
            if batch.last {
                break;
            }
        }
        sizes
    }

    #[test]
    fn a_time_budget_gives_the_batches_of_its_sample_count() {
        for strata in [1, 4, 22, 32] {
            for millis in (1..60).chain([100, 500, 2500, 20_000]) {
                let budget = Stop::Budget(Duration::from_millis(millis));
                let timed = batches(budget, strata, Duration::from_micros(100));
                let counted = batches(Stop::Samples(timed.iter().sum()), strata, Duration::ZERO);
                assert_eq!(timed, counted, "{strata} strata, {millis} ms");
                let made: usize = timed.iter().sum();
                let wanted = millis as usize * 10;
                assert!(
                    made + strata >= wanted && (made <= wanted || timed.len() == 1),
                    "{made} of {wanted}"
                );
            }
        }
    }

    #[test]
    fn batches_add_up_to_the_sample_count_and_cover_every_stratum() {
        for strata in [1, 4, 22, 32] {
            for wanted in (0..700).chain([4000, 100_000]) {
                let sizes = batches(Stop::Samples(wanted), strata, Duration::ZERO);
                assert_eq!(sizes.iter().sum::<usize>(), wanted.max(strata));
                assert!(sizes.iter().all(|n| *n >= strata), "{sizes:?}");
            }
        }
    }

    #[test]
    fn a_batch_is_fully_allotted_and_favours_uncertain_strata() {
        let mut seen = [StratumCounts::new(0.5), StratumCounts::new(0.3), StratumCounts::new(0.2)];
        assert_eq!(allot(3, &seen), [1, 1, 1]);
        assert_eq!(allot(103, &seen), [51, 31, 21]);
        seen[0].add(100, 100, [100, 0]);
        seen[1].add(100, 100, [50, 0]);
        seen[2].add(100, 100, [1, 0]);
        let given = allot(1000, &seen);
        assert_eq!(given.iter().sum::<usize>(), 1000);
        assert!(given[1] > given[0] && given[0] > given[2] && given[2] > 100, "{given:?}");
    }
}
