//! The lowest escape path from a jam among the paths tried.
//!
//! ```text
//!        ╭─╮
//!   ╲   ╱   ╲        climb: the greatest potential energy of the path above that of the rest; beyond it exact motion leads
//!    ╲_╱     ╲       lower, to the mated pose, or off
//!     ↑ rest  ▼
//! ```
//!
//! Paths are straight in position and rotation: along every error, towards the mated pose, at random, and
//! then around the best. Each is evaluated every [`STEP`]; the best is evaluated [`FINER`] times as densely,
//! and again around its point of greatest energy. The climb belongs to an existing path, so it is an upper bound on the
//! escape height.

use super::rests::RestEnd;
use super::stability::{HeightAside, STEEPEST, Space, ground, moved};
use crate::acceptance::{Outcome, Stream};
use crate::contact::{FLUSH, Nearby, Pair};
use crate::method::affordable;
use crate::method::descent::{self, Follower};
use crate::pose::{CorPose, PoseError, angle_between, step_length};
use crate::tolerance;
use glam::DVec2;
use serde::{Deserialize, Serialize};

/// Spacing of the samples of a path, in the metric of the motion, in D.
const STEP: f64 = 0.02;
/// How much more closely the best, and how often: up to 2·10⁻⁶ D about its highest place.
const FINER: usize = 10;
const LOOKS: usize = 4;
/// Largest length of paths, in D: from one side of a connector to the other.
const FARTHEST: f64 = 1.5;
/// Random ways and moves about the best, of simple halves, per free error: of few errors more, so that the lowest way hardly hangs on chance.
const WAYS: f64 = 24.0;
const WAYS_OF_FEW: f64 = 96.0;
const FEW: usize = 3;
const LEAST_WAYS: f64 = 4.0;
/// Rests farther apart than this are different, in the metric of the motion, in D: closer rests are merged.
const ELSEWHERE: f64 = 0.1;
/// Motions keep so far from walls, in D, and heights beside a wall differ by that on its slope.
const OPEN: f64 = tolerance::TOUCHING;
/// Difference in energy that counts as lower, in D: above the accuracy of motions.
const LOWER: f64 = 1e-5;

/// An escape path from a jam.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct EscapePath {
    /// Upper bound on the escape height, in D.
    #[serde(rename = "climb_at_most_d")]
    pub climb: f64,
    /// Outcome at its end: docked, missed, or jammed at a lower rest.
    pub to: Outcome,
    /// The pose error on the path from which the motion to that end starts.
    pub over: PoseError,
}

/// Condition for an escape.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::run) enum EscapeCriterion {
    /// Docked, off, or a lower rest; walls are in the way.
    Jam,
    /// Off, or any other rest; walls may be lifted over.
    Rest {
        /// Whether it may lie anywhere on its supporting features: another rest is then one that is lower, or
        /// rotated.
        is_level: bool,
    },
}

/// A path, up to the escape.
#[derive(Debug, Clone, Copy)]
struct EscapeAttempt {
    along: [f64; 5],
    /// Length at which the half has escaped.
    length: f64,
    out: EscapePath,
    /// End of the motion after the escape.
    end: PoseError,
}

struct Search<'a> {
    pair: &'a Pair,
    space: Space,
    rest: &'a RestEnd,
    nearby: Nearby<'a>,
    follower: Follower<'a>,
    best: Option<EscapeAttempt>,
    leaving: EscapeCriterion,
    /// Whether nothing is above the rest: it may be lifted straight up, and heights are those of a half that comes from above.
    open: bool,
}

/// The lowest escape path found, and the end of the motion after it; `None` if all tried paths continue to
/// climb, or end at walls.
pub(in crate::run) fn escape_path(
    pair: &Pair,
    rest: &RestEnd,
    motions: &descent::DescentSettings,
    leaving: EscapeCriterion,
    seed: u64,
) -> Option<(EscapePath, PoseError)> {
    let space = Space::of(pair);
    let stream = Stream::new(seed).branch(FARTHEST.to_bits());
    let simple = if space.count() <= FEW { WAYS_OF_FEW } else { WAYS };
    let ways = (simple * affordable(pair).sqrt()).max(LEAST_WAYS) as u64 * space.count() as u64;
    let mut search = Search {
        pair,
        rest,
        nearby: pair.about(2.0 * STEP),
        follower: Follower::new(pair, motions),
        best: None,
        leaving,
        open: leaving != EscapeCriterion::Jam && is_open(pair, rest),
        space,
    };
    let home = search.space.towards(rest, &PoseError::default());
    let first: Vec<[f64; 5]> = home.into_iter().chain(search.space.axes()).collect();
    for way in first {
        search.try_way(&way);
    }
    for k in 0..ways {
        if search.is_level() {
            break;
        }
        let way = search.space.random(stream, k);
        search.try_way(&way);
    }
    for k in 0..ways {
        let Some(best) = search.best.filter(|_| !search.is_level()) else { break };
        // Smaller and smaller moves: from half a radian to a hundredth.
        let share = 0.5 * 0.02f64.powf(k as f64 / ways as f64);
        let way = moved(&best.along, &search.space.random(stream, ways + k), share);
        search.try_way(&way);
    }
    search.best.map(|best| (search.finer(&best), best.end))
}

impl Search<'_> {
    /// Whether a way that does not climb is known.
    fn is_level(&self) -> bool {
        self.best.is_some_and(|best| best.out.climb < LOWER)
    }

    /// Looks along a way, no higher than the best so far.
    fn try_way(&mut self, way: &[f64; 5]) {
        let most = self.best.map_or(f64::INFINITY, |best| best.out.climb);
        let (mut top, mut climbing, mut requested) = (0.0f64, false, 0.0);
        let (mut height, mut last) = (self.rest.height, self.rest.energy);
        for k in 1..=(FARTHEST / STEP) as usize {
            let length = k as f64 * STEP;
            let pose = self.space.displaced(self.rest, way, length);
            height = match self.look(&pose, height + STEEPEST * STEP) {
                HeightAside::At(z) => z,
                HeightAside::Blocked => return,
                HeightAside::Gone => {
                    let over = self.space.error(self.rest, way, length);
                    return self.record_best(way, length, top, (Outcome::Missed, over));
                }
            };
            let energy = self.pair.energy(&pose, height);
            top = top.max(energy - self.rest.energy);
            if top >= most {
                return;
            }
            let falls = energy < last - LOWER * STEP;
            // Level ground beyond is another rest as soon as it is far enough.
            let is_level = self.leaving != EscapeCriterion::Jam
                && top > LOWER
                && energy <= last + LOWER * STEP
                && (climbing || length - requested > ELSEWHERE);
            if energy < self.rest.energy - LOWER || falls && climbing || is_level {
                (climbing, requested) = (false, length);
                if let Some(to) = self.leads_out(way, length) {
                    return self.record_best(way, length, top, to);
                }
            }
            climbing |= energy > last + LOWER * STEP;
            last = energy;
        }
    }

    /// The height at a pose.
    fn look(&mut self, pose: &CorPose, ceiling: f64) -> HeightAside {
        if !self.open {
            return ground(&mut self.nearby, pose, ceiling);
        }
        self.nearby.turn(&pose.rotation, pose.lateral, FLUSH, 0.0);
        self.nearby.height_below(pose.lateral, f64::INFINITY).0.map_or(HeightAside::Gone, HeightAside::At)
    }

    fn record_best(&mut self, way: &[f64; 5], length: f64, climb: f64, (to, end): (Outcome, PoseError)) {
        let over = self.space.error(self.rest, way, length);
        self.best = Some(EscapeAttempt { along: *way, length, out: EscapePath { climb, to, over }, end });
    }

    /// Outcome of the motion from a point of a path, if that is an escape.
    fn leads_out(&mut self, way: &[f64; 5], length: f64) -> Option<(Outcome, PoseError)> {
        let from = self.space.error(self.rest, way, length);
        let end = match self.leaving {
            EscapeCriterion::Jam => self.follower.settle(&from),
            EscapeCriterion::Rest { .. } => self.follower.come_to_rest(&from),
        };
        let is_lower = end
            .height
            .is_some_and(|height| self.pair.energy_at(&end.error, height) < self.rest.energy - LOWER);
        let is_out = match (end.outcome, self.leaving) {
            (Outcome::Missed, _) | (Outcome::Aligned, EscapeCriterion::Jam) => true,
            (Outcome::Undecided, _) => false,
            (Outcome::Jammed, EscapeCriterion::Jam) => is_lower,
            (_, EscapeCriterion::Rest { is_level }) => is_lower || self.is_elsewhere(&end.error, is_level),
        };
        is_out.then_some((end.outcome, end.error))
    }

    /// Whether a rest is a different one.
    fn is_elsewhere(&self, end: &PoseError, is_level: bool) -> bool {
        let pose = self.space.pose(end);
        let turned = angle_between(&pose.rotation, &self.rest.pose.rotation);
        let lateral = if is_level { DVec2::ZERO } else { pose.lateral - self.rest.pose.lateral };
        step_length(lateral, turned, self.space.rho()) > ELSEWHERE
    }

    /// The climb of a path, sampled more and more densely around its point of greatest energy.
    fn finer(&mut self, best: &EscapeAttempt) -> EscapePath {
        let mut top = best.out.climb;
        let (mut from, mut to, mut last) = (0.0, best.length, self.rest.height);
        let mut step = STEP;
        for _ in 0..LOOKS {
            step /= FINER as f64;
            let (begun, start) = (last, self.space.displaced(self.rest, &best.along, from));
            let mut highest = (from, last, self.pair.energy(&start, last));
            for k in 1..((to - from) / step).round() as usize {
                let length = from + k as f64 * step;
                let pose = self.space.displaced(self.rest, &best.along, length);
                if let HeightAside::At(z) = self.look(&pose, last + STEEPEST * STEP) {
                    let energy = self.pair.energy(&pose, z);
                    if energy > highest.2 {
                        highest = (length, z, energy);
                    }
                    last = z;
                }
            }
            top = top.max(highest.2 - self.rest.energy);
            // Start a step before the point of greatest energy; the height there is at least the height at the start of
            // this search.
            last = begun.max(highest.1 - STEEPEST * step);
            (from, to) = ((highest.0 - step).max(0.0), (highest.0 + step).min(best.length));
        }
        EscapePath { climb: top, ..best.out }
    }
}

/// Whether a half lowered from far above reaches the rest: nothing is above it.
fn is_open(pair: &Pair, rest: &RestEnd) -> bool {
    pair.height(&rest.pose).is_some_and(|height| height <= rest.height + OPEN)
}
