//! Search for the nearest failure: the failing pose nearest to zero.
//!
//! A probe is a direction u in [−1, 1]ⁿ; at scale s it is the pose with the given errors uᵢ·wᵢ and the others
//! s·uᵢ·pᵢ. The largest of the latter uᵢ is 1 or −1, so that at scale s the pose lies on the surface of the
//! box, with the given errors anywhere.
//!
//! All motions of a batch use the scale that was known before it, for any number of threads.

use super::Reach;
use super::space::{Direction, Space};
use crate::acceptance::{Outcome, Stream};
use crate::exec::{Cancelled, Exec};
use crate::method::descent::{self, Follower};
use crate::method::{affordable, motions_in};
use crate::pose::{Dof, DofSet, PoseError};
use crate::problem::Problem;

/// Relative width to which the scale of a failing pose is bisected.
const SHARP: f64 = 2e-4;
/// Variations are tried at this fraction of the distance of the nearest failure: a new failure then reduces
/// the box by at least as much.
const INSIDE: f64 = 0.998;
/// Number of scales at which every direction is tried, between zero and the error box.
const LOOKS: usize = 8;
/// The same along a single error, at small cost, and beyond a window in which all poses are known to dock.
const LOOKS_ALONE: usize = 64;
/// No fewer of halves whose motions take long.
const LEAST_LOOKS_ALONE: usize = 16;
const LOOKS_BESIDE: usize = 4;
/// Variations per batch, fewer for halves with slow motions: the result of a batch reduces the work of the
/// next; and the number of consecutive batches without a new failure that ends the search.
const BATCH: usize = 64;
const LEAST_BATCH: f64 = 8.0;
const QUIET: usize = 512;
/// The same of halves whose motions take long.
const LEAST_QUIET: usize = 128;
/// Largest core-seconds of variations, and of trials along the directions of a single error beside the
/// others: for very slow motions fewer are tried.
const LONGEST: f64 = 10.0;
/// The window is smaller by this share than the nearest pose that was seen to fail, at least and at most: beyond
/// the accuracy of the bisection.
const MARGIN: f64 = 1e-3;
const MOST_MARGIN: f64 = 0.1;
/// Windows that are tried before it is given up.
pub(super) const WINDOWS: usize = 50;
/// How many times as large as in the window an error is to see whether it limits it.
const SLIGHTLY: f64 = 1.01;
/// Below this scale, as a share of the largest, there is no window.
const NONE: f64 = 1e-4;
/// Samples between two checks whether one failed.
const CERTIFIED_AT_ONCE: usize = 4096;
const CERTIFIED_WHERE_SPENT: usize = 64;
/// Largest number of batches of variations; the certificate decides after that.
const MOST_BATCHES: u64 = 200;

/// A direction, and the least scale at which its pose was seen to fail.
#[derive(Debug, Clone, Copy)]
struct Failing {
    scale: f64,
    along: Direction,
}

/// A window without a failed sample.
pub(super) struct Shrunk {
    pub(super) scale: f64,
    /// Number of earlier windows with a failed sample.
    pub(super) redrawn: usize,
}

/// The search, and its state.
pub(super) struct Search<'a> {
    problem: &'a Problem,
    settings: descent::DescentSettings,
    space: Space,
    nearest: Option<Failing>,
    /// Windows below this scale are not needed.
    least: f64,
    /// Largest number of motions; then the current result is used.
    most: usize,
    random: Stream,
    batches: u64,
    followed: usize,
}

impl<'a> Search<'a> {
    pub(super) fn new(
        problem: &'a Problem,
        space: Space,
        seed: u64,
        settings: &descent::DescentSettings,
    ) -> Self {
        Self {
            problem,
            settings: settings.clone(),
            space,
            nearest: None,
            least: 0.0,
            most: usize::MAX,
            random: Stream::new(seed),
            batches: 0,
            followed: 0,
        }
    }

    /// Ends it after so many motions, more or less.
    #[must_use]
    pub(super) const fn within(mut self, most: usize) -> Self {
        self.most = most;
        self
    }

    /// Ends the search at results not above this scale.
    #[must_use]
    pub(super) const fn above(mut self, least: f64) -> Self {
        self.least = least;
        self
    }

    pub(super) const fn space(&self) -> &Space {
        &self.space
    }

    pub(super) const fn followed(&self) -> usize {
        self.followed
    }

    /// The scale up to which nothing was seen to fail.
    fn scale(&self) -> f64 {
        self.nearest.map_or(self.space.border(), |failing| failing.scale)
    }

    /// The same, reduced by a margin if a pose failed.
    fn window(&self, margin: f64) -> f64 {
        self.nearest.map_or(self.space.border(), |failing| failing.scale * (1.0 - margin))
    }

    /// Whether anything is left of the window.
    pub(super) fn has_room(&self) -> bool {
        self.window(MARGIN) > self.least.max(NONE * self.space.border())
    }

    /// In which direction it lies.
    pub(super) fn worst_way(&self) -> Option<[f64; 5]> {
        self.nearest.map(|failing| failing.along)
    }

    /// The nearest pose that fails.
    pub(super) fn worst(&self) -> Option<PoseError> {
        self.nearest.map(|failing| self.space.pose(&failing.along, failing.scale))
    }

    /// The errors that limit a window about zero of this scale: with one of them slightly larger and the others inside the window
    /// a pose fails. Tried is the nearest failing pose, with all errors but one put back into the window. Empty if nothing failed.
    pub(super) fn limiting(&self, scale: f64) -> DofSet {
        let Some(worst) = self.worst() else { return DofSet::EMPTY };
        let (worst, half_widths) = (worst.to_array(), self.space.half_widths(scale));
        let fails = |axis: &Dof| {
            let inside = |k: usize| worst[k].clamp(-half_widths[k], half_widths[k]);
            let (k, mut error) = (axis.index(), std::array::from_fn(inside));
            error[k] = worst[k].signum() * worst[k].abs().max(SLIGHTLY * half_widths[k]);
            let end = descent::outcome(self.problem.pair(), &PoseError::from_array(error), &self.settings);
            end.outcome != Outcome::Aligned
        };
        let is_outside = |axis: &Dof| worst[axis.index()].abs() > half_widths[axis.index()];
        Dof::ALL.into_iter().filter(is_outside).filter(fails).collect()
    }

    /// Searches for failures, and reduces the window until no sampled pose of it fails. `None` if poses fail
    /// however small it is, or lie all over ([`Self::worst`] is one of them), and if it is no larger than
    /// required. After the motion limit, only samples search for failures, and the window shrinks by larger
    /// steps.
    pub(super) fn shrink(&mut self, motions: usize, exec: &Exec) -> Result<Option<Shrunk>, Cancelled> {
        self.directions(exec)?;
        let mut margin = MARGIN;
        for redrawn in 0..WINDOWS {
            let is_spent = self.followed > self.most;
            if is_spent {
                margin = (2.0 * margin).min(MOST_MARGIN);
            } else {
                self.moves(exec)?;
            }
            if !self.has_room() {
                return Ok(None);
            }
            let scale = self.window(margin);
            let at_once = if is_spent { CERTIFIED_WHERE_SPENT } else { CERTIFIED_AT_ONCE };
            if !self.certify([0.0, scale], (motions, at_once), redrawn, exec)? {
                return Ok(Some(Shrunk { scale, redrawn }));
            }
        }
        Ok(None)
    }

    /// Looks along every direction of {−1, 0, 1}ⁿ.
    fn directions(&mut self, exec: &Exec) -> Result<(), Cancelled> {
        let all = self.space.all();
        self.try_batches(&all, 0.0, LOOKS, exec)
    }

    /// The limit of the only growing error, which is known to dock up to `from`: beyond it this many sampled
    /// poses dock, if other errors occur. The directions in `hints` for the others are searched, too.
    pub(super) fn reach(
        &mut self,
        from: f64,
        hints: &[[f64; 5]],
        motions: usize,
        exec: &Exec,
    ) -> Result<Reach, Cancelled> {
        let all = self.space.all();
        if all.len() == 2 {
            let looks = (LOOKS_ALONE as f64 * affordable(self.problem.pair()).sqrt()) as usize;
            self.try_batches(&all, from, looks.max(LEAST_LOOKS_ALONE), exec)?;
        } else {
            let both = hints.iter().flat_map(|u| [1.0, -1.0].map(|sign| self.facing(u, sign)));
            let hinted: Vec<Direction> = both.filter_map(|u| self.space.onto_surface(u)).collect();
            self.try_batches(&hinted, from, LOOKS_BESIDE, exec)?;
            let most = motions_in(LONGEST, self.problem.pair()).div_ceil(LOOKS_BESIDE);
            let some: Vec<Direction> = all.iter().copied().step_by(all.len().div_ceil(most).max(1)).collect();
            self.try_batches(&some, from, LOOKS_BESIDE, exec)?;
            for round in 0..WINDOWS {
                let to = self.window(SHARP);
                if to <= from {
                    break;
                }
                self.moves(exec)?;
                let to = self.window(SHARP).max(from);
                if !self.certify([from, to], (motions, CERTIFIED_AT_ONCE), round, exec)? {
                    break;
                }
            }
        }
        let to = self.window(SHARP).max(from);
        Ok(Reach { to, is_border: self.nearest.is_none() })
    }

    /// A direction with 1 or −1 for the growing error.
    fn facing(&self, along: &Direction, sign: f64) -> Direction {
        std::array::from_fn(|k| if self.space.grows(k) { sign } else { along[k] })
    }

    /// Tries variations of the nearest failure, and other directions, until many in a row find no nearer
    /// failure.
    fn moves(&mut self, exec: &Exec) -> Result<(), Cancelled> {
        let mut quiet = 0;
        let pair = self.problem.pair();
        let least = LEAST_QUIET.min(motions_in(LONGEST, pair));
        let enough = ((QUIET as f64 * affordable(pair).sqrt()) as usize).max(least);
        let batch = BATCH.min(enough);
        let last = self.batches + MOST_BATCHES;
        while quiet < enough && self.batches < last && self.has_room() && self.followed < self.most {
            let random = self.random.branch(self.batches);
            self.batches += 1;
            let all: Vec<Direction> =
                (0..batch as u64).filter_map(|k| self.moved(random.branch(k))).collect();
            let before = self.scale();
            self.try_all(&all, [0.0, INSIDE * before], 1, exec)?;
            exec.report(quiet as f64 / enough as f64, "moves about the worst pose");
            quiet = if self.scale() < before { 0 } else { quiet + batch };
        }
        Ok(())
    }

    /// A direction to try: four of five near the nearest failure, varied in one or two components or in all,
    /// the others anywhere.
    fn moved(&self, random: Stream) -> Option<Direction> {
        const NEAR: f64 = 0.8;
        const SPREAD: f64 = 0.15;
        let number = |k: u64| random.uniform(k);
        let anywhere = |k: usize| 2.0 * number(20 + k as u64) - 1.0;
        let parts: Vec<usize> = (0..5).filter(|k| self.space.occurs(*k)).collect();
        let u = match self.nearest {
            Some(Failing { along: mut u, .. }) if number(0) < NEAR => {
                if number(1) < 0.5 {
                    for turn in 0..=u64::from(number(2) < 0.5) {
                        let k =
                            parts[((number(3 + turn) * parts.len() as f64) as usize).min(parts.len() - 1)];
                        let choice = number(5 + turn);
                        u[k] = if choice < 0.35 {
                            1.0
                        } else if choice < 0.7 {
                            -1.0
                        } else {
                            anywhere(k)
                        };
                    }
                } else {
                    // The sum of three uniform numbers is normal enough.
                    for k in &parts {
                        let sum: f64 = (0..3).map(|j| number(30 + 3 * *k as u64 + j)).sum();
                        u[*k] = (u[*k] + 2.0 * SPREAD * (sum - 1.5)).clamp(-1.0, 1.0);
                    }
                }
                u
            }
            _ => {
                let mut u: Direction = std::array::from_fn(anywhere);
                let grows: Vec<usize> = (0..5).filter(|k| self.space.grows(*k)).collect();
                let face = grows[((number(7) * grows.len() as f64) as usize).min(grows.len() - 1)];
                u[face] = u[face].signum();
                u
            }
        };
        self.space.onto_surface(u)
    }

    /// Looks along directions from a scale on, a batch at a time and no further than to the nearest failing pose before it: as
    /// densely as `looks` times up to the error box.
    fn try_batches(
        &mut self,
        all: &[Direction],
        from: f64,
        looks: usize,
        exec: &Exec,
    ) -> Result<(), Cancelled> {
        let whole = self.space.border() - from;
        let at_once = (BATCH as f64 * affordable(self.problem.pair()).sqrt()).max(LEAST_BATCH) as usize;
        for (number, batch) in all.chunks(at_once).enumerate() {
            exec.report((number * at_once) as f64 / all.len() as f64, "directions");
            if self.followed > self.most {
                break;
            }
            let to = if self.nearest.is_some() { INSIDE * self.scale() } else { self.space.border() };
            if to > from && self.has_room() {
                let share = (looks as f64 * (to - from) / whole).ceil() as usize;
                self.try_all(batch, [from, to], share.max(1), exec)?;
            }
        }
        Ok(())
    }

    /// Looks along directions between two scales, and keeps the nearest failing pose.
    fn try_all(
        &mut self,
        all: &[Direction],
        [from, to]: [f64; 2],
        looks: usize,
        exec: &Exec,
    ) -> Result<(), Cancelled> {
        let (pair, settings, space) = (self.problem.pair(), &self.settings, &self.space);
        let look = |follower: &mut Follower<'_>, k: usize| -> Result<(usize, Option<Failing>), Cancelled> {
            let (along, mut followed) = (&all[k], 0);
            let mut fails = |scale: f64| {
                followed += 1;
                follower.follow(&space.pose(along, scale)).outcome != Outcome::Aligned
            };
            let mut safe = from;
            for k in 1..=looks {
                exec.check()?;
                let scale = from + (to - from) * k as f64 / looks as f64;
                if fails(scale) {
                    let mut failing = scale;
                    while failing - safe > SHARP * failing {
                        exec.check()?;
                        let middle = 0.5 * (safe + failing);
                        if middle <= 1e-6 * space.border() {
                            break;
                        }
                        if fails(middle) { failing = middle } else { safe = middle }
                    }
                    return Ok((followed, Some(Failing { scale: failing, along: *along })));
                }
                safe = scale;
            }
            Ok((followed, None))
        };
        let result = exec.map_with(all.len(), || Follower::new(pair, settings), look)?;
        for (followed, failing) in result.into_iter().collect::<Result<Vec<_>, _>>()? {
            self.followed += followed;
            self.keep(failing);
        }
        Ok(())
    }

    fn keep(&mut self, failing: Option<Failing>) {
        if let Some(failing) = failing.filter(|failing| failing.scale < self.scale()) {
            self.nearest = Some(failing);
        }
    }

    /// Follows samples all over the window of this scale, or of the region beyond another window, a separate
    /// stream for every round; if one of a batch fails, the nearest failure is searched from it on, and true
    /// is returned.
    fn certify(
        &mut self,
        [from, scale]: [f64; 2],
        (motions, at_once): (usize, usize),
        round: usize,
        exec: &Exec,
    ) -> Result<bool, Cancelled> {
        const BRANCH: u64 = 0xce27;
        let random = self.random.branch(BRANCH).branch(round as u64);
        let mut done = 0;
        while done < motions {
            let until = motions.min(done + at_once);
            let (pair, settings, space) = (self.problem.pair(), &self.settings, &self.space);
            let widths = space.half_widths(scale);
            let fails = |follower: &mut Follower<'_>, k: usize| {
                let (k, beyond) = (done + k, from / scale);
                let u: Direction = std::array::from_fn(|j| {
                    let part = 2.0 * random.uniform(5 * k as u64 + j as u64) - 1.0;
                    if space.grows(j) { part + beyond * (part.signum() - part) } else { part }
                });
                let error = space.within(&u, &widths);
                (follower.follow(&error).outcome != Outcome::Aligned).then_some(u)
            };
            let failed: Vec<Option<Direction>> =
                exec.map_with(until - done, || Follower::new(pair, settings), fails)?;
            self.followed += until - done;
            done = until;
            exec.report(done as f64 / motions as f64, "certificate");
            let failed: Vec<Direction> = failed.into_iter().flatten().collect();
            if !failed.is_empty() {
                for u in failed {
                    let there = scale * self.space.largest(&u);
                    if let Some(along) = self.space.onto_surface(u) {
                        self.keep(Some(Failing { scale: there, along }));
                        self.try_all(&[along], [from, there], 1, exec)?;
                    }
                }
                return Ok(true);
            }
        }
        Ok(false)
    }
}
