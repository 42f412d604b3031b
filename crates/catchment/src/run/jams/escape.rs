//! The way out of a jam that climbs least, of those that are tried.
//!
//! ```text
//!        ╭─╮
//!   ╲   ╱   ╲        climb: the highest point of the way above the rest; beyond it exact motion leads lower, to the mated
//!    ╲_╱     ╲       pose, or off
//!     ↑ rest  ▼
//! ```
//!
//! Ways are straight in position and turn: along every error, towards the mated pose, at random, and then about the best. Each is looked at
//! every [`STEP`]; the best is looked at [`FINER`] times as closely. The climb is that of a way that exists, so the lowest way out of all climbs no more.

use super::firmness::{Ground, STEEPEST, Space, ground, moved};
use super::rests::Rested;
use crate::acceptance::{Outcome, Stream};
use crate::contact::{Nearby, Pair};
use crate::method::affordable;
use crate::method::descent::{self, Follower};
use crate::pose::PoseError;

/// How closely a way is looked at, in the metric of the motion, in D.
const STEP: f64 = 0.02;
/// How much more closely the best.
const FINER: usize = 10;
/// How far ways are followed, in D: from one side of a connector to the other.
const FARTHEST: f64 = 1.5;
/// Random ways and moves about the best, of simple halves, per free error.
const WAYS: f64 = 24.0;
const LEAST_WAYS: f64 = 4.0;
/// What counts as lower, in D: above what motions leave.
const LOWER: f64 = 1e-5;

/// A way out of a jam.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WayOut {
    /// How far it climbs above the rest, in D: at most so much is needed to get out.
    pub climb: f64,
    /// What becomes of the half beyond: docked, off, or a rest that is lower.
    pub to: Outcome,
    /// The pose error from which motion leads there.
    pub over: PoseError,
}

/// One way, as far as it leads out.
#[derive(Debug, Clone, Copy)]
struct Way {
    along: [f64; 5],
    /// How far along the half is out.
    length: f64,
    out: WayOut,
}

struct Search<'a> {
    space: Space,
    rest: &'a Rested,
    nearby: Nearby<'a>,
    follower: Follower<'a>,
    best: Option<Way>,
}

/// The lowest way out that is found; none where all that are tried climb on, or end at walls.
pub(super) fn way_out(pair: &Pair, rest: &Rested, seed: u64) -> Option<WayOut> {
    let settings = descent::Settings::default();
    let space = Space::of(pair);
    let stream = Stream::new(seed).branch(FARTHEST.to_bits());
    let ways = (WAYS * affordable(pair).sqrt()).max(LEAST_WAYS) as u64 * space.count() as u64;
    let mut search = Search {
        rest,
        nearby: pair.about(2.0 * STEP),
        follower: Follower::new(pair, &settings),
        best: None,
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
    search.best.map(|best| search.finer(&best))
}

impl Search<'_> {
    /// Whether a way that does not climb is known.
    fn is_level(&self) -> bool {
        self.best.is_some_and(|best| best.out.climb < LOWER)
    }

    /// Looks along a way, no higher than the best so far.
    fn try_way(&mut self, way: &[f64; 5]) {
        let most = self.best.map_or(f64::INFINITY, |best| best.out.climb);
        let (mut top, mut last, mut climbing) = (0.0f64, self.rest.height, false);
        for k in 1..=(FARTHEST / STEP) as usize {
            let length = k as f64 * STEP;
            let pose = self.space.displaced(self.rest, way, length);
            let z = match ground(&mut self.nearby, &pose, last + STEEPEST * STEP) {
                Ground::At(z) => z,
                Ground::Blocked => return,
                Ground::Gone => {
                    return self.found(way, length, top, Outcome::Missed);
                }
            };
            top = top.max(z - self.rest.height);
            if top >= most {
                return;
            }
            let falls = z < last - LOWER * STEP;
            if z < self.rest.height - LOWER || falls && climbing {
                climbing = false;
                if let Some(to) = self.leads_out(way, length) {
                    return self.found(way, length, top, to);
                }
            }
            climbing |= z > last + LOWER * STEP;
            last = z;
        }
    }

    fn found(&mut self, way: &[f64; 5], length: f64, climb: f64, to: Outcome) {
        let over = self.space.error(self.rest, way, length);
        self.best = Some(Way { along: *way, length, out: WayOut { climb, to, over } });
    }

    /// Where motion leads from a place on a way, if that is lower than the rest.
    fn leads_out(&mut self, way: &[f64; 5], length: f64) -> Option<Outcome> {
        let end = self.follower.settle(&self.space.error(self.rest, way, length));
        let is_lower = end.height.is_some_and(|height| height < self.rest.height - LOWER);
        match end.outcome {
            Outcome::Aligned | Outcome::Missed => Some(end.outcome),
            Outcome::Jammed => is_lower.then_some(Outcome::Jammed),
            Outcome::Undecided => None,
        }
    }

    /// The climb of a way, looked at more closely.
    fn finer(&mut self, best: &Way) -> WayOut {
        let steps = (best.length / STEP * FINER as f64).round() as usize;
        let (mut top, mut last) = (best.out.climb, self.rest.height);
        for k in 1..steps {
            let pose = self.space.displaced(self.rest, &best.along, k as f64 * STEP / FINER as f64);
            if let Ground::At(z) = ground(&mut self.nearby, &pose, last + STEEPEST * STEP) {
                top = top.max(z - self.rest.height);
                last = z;
            }
        }
        WayOut { climb: top, ..best.out }
    }
}
