//! Estimate of the friction that explains a table of trials.
//!
//! ```text
//!   disagreements beyond k accuracies
//!      │╲                       ╱      every trial is followed again with each μ; a trial that disagrees with the observed outcome counts if its
//!      │ ╲___               ___╱       border at that μ is farther than k accuracies
//!      └─────╲_____________╱───▶ μ
//!             [ interval  ]            the coefficients with the fewest disagreements, its ends bisected
//! ```
//!
//! Coefficients are tried from 0 upwards, until one leaves clearly more disagreements than the best before
//! it. A motion that creeps without end counts as a failure.
//!
//! Not promised: that friction is the reason; the result lists only the coefficients as good as the best, and
//! no coefficient beyond the last tried is excluded.

use super::ValidationSettings;
use crate::plan::{DockingOracle, Search, for_each};
use catchment_core::acceptance::Stream;
use catchment_core::exec::{Cancelled, Exec};
use catchment_core::method::descent;
use catchment_core::pose::PoseError;
use catchment_core::problem::Problem;
use serde::Serialize;

/// The friction coefficients that explain the trials best.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FrictionInterval {
    /// Whether a coefficient exists without disagreements beyond the limit.
    pub explains: bool,
    /// The smallest number of disagreements beyond the limit over all coefficients.
    pub fewest: usize,
    /// The smallest coefficient with this number.
    pub low: f64,
    /// The largest coefficient with this number.
    pub high: f64,
    /// Whether the interval continues beyond the largest tried coefficient.
    pub open: bool,
    /// Whether a coefficient inside the interval has more disagreements.
    pub broken: bool,
    /// Every tried coefficient, in ascending order.
    pub tried: Vec<FrictionTried>,
}

/// Disagreements at a friction coefficient.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FrictionTried {
    /// The coefficient.
    pub friction: f64,
    /// Number of disagreements beyond the limit; a lower bound if the coefficient is clearly worse than the
    /// best before it.
    pub beyond: usize,
}

/// Largest coefficient that is tried: rubber.
const MOST: f64 = 1.0;
/// Coefficients between it and 0.
const STEPS: usize = 20;
/// Bisections of an end: to MOST / STEPS / 2⁴ = 0.003.
const HALVINGS: usize = 4;
/// The finest steps that bisections lead to, per coefficient of the ladder.
const FINE: usize = 1 << HALVINGS;
/// So many disagreements more than the fewest are clearly more.
const CLEARLY: usize = 4;
/// Steps after which a motion creeps; others take tens to hundreds.
const CREEPS: usize = 500;

/// Tries coefficients; and how many motions that took.
pub(super) fn estimate(
    problem: &Problem,
    trials: &[(PoseError, bool)],
    settings: &ValidationSettings,
    exec: &Exec,
) -> Result<(FrictionInterval, usize), Cancelled> {
    let mut followed = 0;
    let mut tried: Vec<(f64, usize)> = Vec::new();
    let total = (STEPS + 1 + 2 * HALVINGS) as f64;
    let mut look = |friction: f64, tried: &mut Vec<(f64, usize)>| {
        let done = tried.len() as f64;
        let part = exec.part([done / total, (done + 1.0) / total], "motions");
        let enough = tried.iter().map(|(_, count)| count + CLEARLY).min().unwrap_or(usize::MAX);
        let (count, motions) = beyond(problem, trials, settings, friction, enough, &part)?;
        followed += motions;
        tried.push((friction, count));
        Ok::<_, Cancelled>(count >= enough)
    };
    for k in 0..=STEPS {
        if look(coefficient(k * FINE), &mut tried)? {
            break;
        }
    }
    let last = tried.len() - 1;
    let fewest = tried.iter().map(|(_, count)| *count).min().unwrap_or(0);
    let is_best = |k: &usize| tried[*k].1 == fewest;
    let ends = [(0..=last).find(is_best), (0..=last).rev().find(is_best)].map(Option::unwrap_or_default);
    let broken = !(ends[0]..=ends[1]).all(|k| is_best(&k));
    let open = ends[1] == last;
    let mut interval = ends.map(|k| k * FINE);
    for (k, worse) in [(0, interval[0].checked_sub(FINE)), (1, (!open).then_some(interval[1] + FINE))] {
        let Some(mut worse) = worse else { continue };
        for _ in 0..HALVINGS {
            let middle = usize::midpoint(interval[k], worse);
            look(coefficient(middle), &mut tried)?;
            if tried.last().is_some_and(|(_, count)| *count <= fewest) {
                interval[k] = middle;
            } else {
                worse = middle;
            }
        }
    }
    let fewest = tried.iter().map(|(_, count)| *count).min().unwrap_or(0);
    tried.sort_by(|a, b| a.0.total_cmp(&b.0));
    let [low, high] = interval.map(coefficient);
    let tried = tried.into_iter().map(|(friction, beyond)| FrictionTried { friction, beyond }).collect();
    Ok((FrictionInterval { explains: fewest == 0, fewest, low, high, open, broken, tried }, followed))
}

/// A multiple of the finest step: by a single division, so that 0.3 is the nearest number and is written as
/// 0.3.
fn coefficient(fine: usize) -> f64 {
    MOST * fine as f64 / (STEPS * FINE) as f64
}

/// Number of trials with another outcome than observed and a border farther than the limit; the count stops
/// at `enough`.
fn beyond(
    problem: &Problem,
    trials: &[(PoseError, bool)],
    settings: &ValidationSettings,
    friction: f64,
    enough: usize,
    exec: &Exec,
) -> Result<(usize, usize), Cancelled> {
    /// Number of borders that are searched at once, for any number of threads.
    const AT_ONCE: usize = 8;
    let motions =
        descent::DescentSettings { friction, max_steps: CREEPS, ..descent::DescentSettings::default() };
    let search = Search::new(problem, &settings.accuracy, settings.limit);
    let random = Stream::new(settings.seed).branch(6);
    let judge = || DockingOracle::new(problem, &motions);
    let docks = for_each(trials.len(), exec, judge, |judge, k| judge.docks(&trials[k].0))?;
    let mut followed = trials.len();
    let differing: Vec<usize> = (0..trials.len()).filter(|k| docks[*k] != trials[*k].1).collect();
    let mut count = 0;
    for some in differing.chunks(AT_ONCE) {
        if count >= enough {
            break;
        }
        let result = for_each(some.len(), exec, judge, |judge, n| {
            let k = some[n];
            let error = &trials[k].0;
            let before = judge.followed();
            let near = search.nearest(judge, error, docks[k], None, random.branch(k as u64)).is_some();
            (!near, judge.followed() - before)
        })?;
        count += result.iter().filter(|(beyond, _)| *beyond).count();
        followed += result.iter().map(|(_, count)| count).sum::<usize>();
    }
    Ok((count, followed))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coefficients_are_written_as_they_are_meant() {
        let ladder: Vec<String> = (0..=STEPS).map(|k| coefficient(k * FINE).to_string()).collect();
        assert_eq!([&ladder[3], &ladder[6], &ladder[7], &ladder[12]], ["0.15", "0.3", "0.35", "0.6"]);
        assert!((0..=STEPS * FINE).all(|k| coefficient(k).to_string().len() <= "0.003125".len()));
    }
}
