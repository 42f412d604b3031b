//! What becomes of the poses of a plan, and how far each is from the border.

use super::border::{Border, Judge, Search};
use catchment_core::acceptance::Stream;
use catchment_core::exec::{Cancelled, Exec};
use catchment_core::method::descent;
use catchment_core::pose::PoseError;
use catchment_core::poses::Observed;
use catchment_core::problem::Problem;
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

/// What exact motions say of a pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Foretold {
    /// What becomes of it; nothing where that is undecided.
    pub predicted: Option<Observed>,
    /// The nearest pose found that fares otherwise; none within the error box where there is nothing.
    pub border: Option<Border>,
}

impl Foretold {
    /// Whether it docks, turned or not.
    pub const fn docks(&self) -> bool {
        matches!(self.predicted, Some(Observed::Aligned | Observed::AlignedElsewhere))
    }

    /// How far it is from the border, in units of the accuracy; infinitely where no border was found, 0 where it is undecided what becomes of it.
    pub fn margin(&self) -> f64 {
        match (self.predicted, &self.border) {
            (None, _) => 0.0,
            (_, Some(border)) => border.sigmas,
            (_, None) => f64::INFINITY,
        }
    }

    /// Whether the robot's accuracy lets it go either way.
    pub fn is_either(&self) -> bool {
        self.margin() < 1.0
    }
}

/// Work on every number below `count`, each thread with a tool of its own; in the order of the numbers.
pub(crate) fn for_each<T: Send, A>(
    count: usize,
    exec: &Exec,
    tool: impl Fn() -> A + Sync + Send,
    work: impl Fn(&mut A, usize) -> T + Sync + Send,
) -> Result<Vec<T>, Cancelled> {
    let done = AtomicUsize::new(0);
    exec.install(|| {
        (0..count)
            .into_par_iter()
            .map_init(tool, |tool, k| {
                exec.check()?;
                let found = work(tool, k);
                let done = done.fetch_add(1, Ordering::Relaxed) + 1;
                exec.report(done as f64 / count as f64, "motions");
                Ok(found)
            })
            .collect()
    })
}

/// Follows poses and looks for the border about each; and how many motions that took.
pub(crate) fn foretell(
    problem: &Problem,
    accuracy: &PoseError,
    motions: &descent::Settings,
    poses: &[PoseError],
    seed: u64,
    exec: &Exec,
) -> Result<(Vec<Foretold>, usize), Cancelled> {
    /// Part of the time that the poses themselves take.
    const FIRST: f64 = 0.05;
    let judge = || Judge::new(problem, motions);
    let first = exec.part([0.0, FIRST], "motions");
    let predicted = for_each(poses.len(), &first, judge, |judge, k| {
        let before = judge.followed();
        (judge.predict(&poses[k]), judge.followed() - before)
    })?;
    let mut followed: usize = predicted.iter().map(|(_, count)| count).sum();
    let search = Search::new(problem, accuracy, f64::INFINITY);
    let mut foretold: Vec<Foretold> =
        predicted.into_iter().map(|(predicted, _)| Foretold { predicted, border: None }).collect();
    let random = Stream::new(seed).branch(4);
    let rest = exec.part([FIRST, 1.0], "motions");
    let borders = for_each(poses.len(), &rest, judge, |judge, k| {
        let before = judge.followed();
        let docks = foretold[k].docks();
        let others =
            (0..poses.len()).filter(|other| foretold[*other].docks() != docks).map(|other| &poses[other]);
        let nearest = others.min_by(|a, b| search.apart(&poses[k], a).total_cmp(&search.apart(&poses[k], b)));
        let border = search.nearest(judge, &poses[k], docks, nearest, random.branch(k as u64));
        (border, judge.followed() - before)
    })?;
    for (told, (border, count)) in foretold.iter_mut().zip(borders) {
        told.border = border;
        followed += count;
    }
    Ok((foretold, followed))
}
