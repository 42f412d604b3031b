//! Which friction explains a table of trials.
//!
//! ```text
//!   disagreements beyond k accuracies
//!      │╲                       ╱      every trial is followed again with each μ; of those that fare otherwise than was seen, those count whose
//!      │ ╲___               ___╱       border at that μ is farther than k accuracies
//!      └─────╲_____________╱───▶ μ
//!             [ interval  ]            the coefficients with the fewest, its ends bisected
//! ```
//!
//! Not promised: that friction is the reason; only which coefficients are as good as the best.

use super::Settings;
use crate::acceptance::Stream;
use crate::exec::{Cancelled, Exec};
use crate::method::descent;
use crate::poses::Tried;
use crate::problem::Problem;
use crate::study::plan::{Judge, Search, for_each};

/// What friction explains.
#[derive(Debug, Clone, PartialEq)]
pub struct FrictionFound {
    /// The fewest disagreements beyond the limit; 0 where some friction explains all.
    pub fewest: usize,
    /// The coefficients that leave so few.
    pub interval: [f64; 2],
    /// The interval goes on beyond the largest coefficient that was tried.
    pub open: bool,
    /// Some coefficient within the interval leaves more.
    pub broken: bool,
    /// Every coefficient that was tried, in ascending order, with its disagreements.
    pub tried: Vec<(f64, usize)>,
}

/// Largest coefficient that is tried: rubber.
const MOST: f64 = 1.0;
/// Coefficients between it and 0.
const STEPS: usize = 20;
/// Bisections of an end: to MOST / STEPS / 2⁴ = 0.003.
const HALVINGS: usize = 4;

/// Tries coefficients; and how many motions that took.
pub(super) fn estimate(
    problem: &Problem,
    trials: &[(Tried, bool)],
    settings: &Settings,
    exec: &Exec,
) -> Result<(FrictionFound, usize), Cancelled> {
    let mut followed = 0;
    let mut tried: Vec<(f64, usize)> = Vec::new();
    let total = (STEPS + 1 + 2 * HALVINGS) as f64;
    let mut look = |friction: f64, tried: &mut Vec<(f64, usize)>| {
        let done = tried.len() as f64;
        let part = exec.part([done / total, (done + 1.0) / total], "motions");
        let (count, motions) = beyond(problem, trials, settings, friction, &part)?;
        followed += motions;
        tried.push((friction, count));
        Ok::<_, Cancelled>(count)
    };
    let step = MOST / STEPS as f64;
    for k in 0..=STEPS {
        look(k as f64 * step, &mut tried)?;
    }
    let fewest = tried.iter().map(|(_, count)| *count).min().unwrap_or(0);
    let is_best = |k: &usize| tried[*k].1 == fewest;
    let ends = [(0..=STEPS).find(is_best), (0..=STEPS).rev().find(is_best)].map(Option::unwrap_or_default);
    let broken = !(ends[0]..=ends[1]).all(|k| is_best(&k));
    let mut interval = ends.map(|k| k as f64 * step);
    for (k, away) in [(0, -1.0), (1, 1.0)] {
        let mut worse = interval[k] + away * step;
        if !(0.0..=MOST + 0.5 * step).contains(&worse) {
            continue;
        }
        for _ in 0..HALVINGS {
            let middle = f64::midpoint(interval[k], worse);
            if look(middle, &mut tried)? <= fewest {
                interval[k] = middle;
            } else {
                worse = middle;
            }
        }
    }
    let fewest = tried.iter().map(|(_, count)| *count).min().unwrap_or(0);
    tried.sort_by(|a, b| a.0.total_cmp(&b.0));
    Ok((FrictionFound { fewest, interval, open: ends[1] == STEPS, broken, tried }, followed))
}

/// Trials that fare otherwise than was seen, and whose border is farther than the limit.
fn beyond(
    problem: &Problem,
    trials: &[(Tried, bool)],
    settings: &Settings,
    friction: f64,
    exec: &Exec,
) -> Result<(usize, usize), Cancelled> {
    let motions = descent::Settings { friction, ..descent::Settings::default() };
    let search = Search::new(problem, &settings.accuracy, settings.limit);
    let random = Stream::new(settings.seed).branch(6);
    let found = for_each(
        trials.len(),
        exec,
        || Judge::new(problem, &motions),
        |judge, k| {
            let (tried, seen) = &trials[k];
            let before = judge.followed();
            let docks = judge.docks(&tried.error);
            let near = docks == *seen
                || search.nearest(judge, &tried.error, docks, None, random.branch(k as u64)).is_some();
            (!near, judge.followed() - before)
        },
    )?;
    Ok((found.iter().filter(|(beyond, _)| *beyond).count(), found.iter().map(|(_, count)| count).sum()))
}
