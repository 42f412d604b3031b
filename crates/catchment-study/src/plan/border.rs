//! Distance of a pose from the border of the accepted set, by exact motions.
//!
//! ```text
//!     docks  ░░░░│                1  towards the nearest known pose with another outcome, along ± every error, along random directions:
//!      ●─────────○ border            the first tested pose with another outcome, then bisection
//!       ╲    ░░░░│                2  directions near the best, each only within the distance of the best
//! ```
//!
//! Distances are in standard deviations per error: √Σ(Δₖ/σₖ)². Errors without a standard deviation are exact
//! and are not varied.
//!
//! Not promised: that no nearer pose has another outcome. The search finds a pose with another outcome, so
//! the distance is an *upper bound*. Poses beyond the error box are not tried.

use crate::success::normals;
use catchment_core::acceptance::{Outcome, Stream};
use catchment_core::method::descent::{DescentSettings, Follower};
use catchment_core::pose::{Dof, PoseError};
use catchment_core::poses::ObservedOutcome;
use catchment_core::problem::Problem;

/// Position of the border, by the motions followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Border {
    /// Upper bound on its distance, in standard deviations.
    pub sigmas: f64,
    /// The same pose, as a share of the half-ranges of the error box: √Σ(Δₖ/rangeₖ)².
    pub box_share: f64,
    /// The distance of the same pose in D, with rotations times the characteristic length.
    pub distance: f64,
    /// The pose beyond the border.
    pub at: PoseError,
}

/// Random directions per error.
const RANDOM: u64 = 4;
/// Number of directions near the best direction, per error.
const BESIDE: u64 = 12;
/// Initial deviation from the best direction, and its reduction after each trial without a nearer pose.
const SPREAD: f64 = 0.5;
const SHRINK: f64 = 0.8;
/// Directions near the best direction are tried at this fraction of its distance.
const NEARER: f64 = 0.98;
/// Number of trials along a direction if a distance is known.
const LOOKS: usize = 4;
/// First trial if no distance is known, in standard deviations; each further trial is twice as far.
const FIRST_LOOK: f64 = 0.25;
/// Width to which a border is bisected, as a share of the distance and at least in units of the accuracy.
const SHARP: f64 = 2e-3;
const SHARPEST: f64 = 1e-3;

/// Follows poses of a problem.
pub struct DockingOracle<'a> {
    follower: Follower<'a>,
    problem: &'a Problem,
    followed: usize,
}

impl<'a> DockingOracle<'a> {
    /// By these motions.
    pub fn new(problem: &'a Problem, motions: &'a DescentSettings) -> Self {
        Self { follower: Follower::new(problem.pair(), motions), problem, followed: 0 }
    }

    /// Whether a pose docks, rotated by a symmetry or not; false for an undecided pose.
    pub fn docks(&mut self, error: &PoseError) -> bool {
        self.followed += 1;
        self.follower.follow(error).outcome == Outcome::Aligned
    }

    /// Outcome of a pose; `None` if undecided.
    pub fn predict(&mut self, error: &PoseError) -> Option<ObservedOutcome> {
        self.followed += 1;
        let end = self.follower.follow(error);
        match end.outcome {
            Outcome::Aligned if self.problem.alignment().symmetry > 1 => {
                self.followed += 1;
                let rest = self.follower.rest(error);
                let turned = self.problem.alignment().nearest_yaw(rest.error.yaw) != 0.0;
                Some(if turned { ObservedOutcome::AlignedElsewhere } else { ObservedOutcome::Aligned })
            }
            Outcome::Aligned => Some(ObservedOutcome::Aligned),
            Outcome::Jammed => Some(ObservedOutcome::Jammed),
            Outcome::Missed => Some(ObservedOutcome::Missed),
            Outcome::Undecided => None,
        }
    }

    /// Motions so far.
    pub const fn followed(&self) -> usize {
        self.followed
    }
}

/// A search for the border about poses, in units of an accuracy.
#[derive(Debug, Clone)]
pub struct Search<'a> {
    problem: &'a Problem,
    /// Accuracy per error, 0 for exact ones.
    accuracy: [f64; 5],
    /// Errors with an accuracy.
    axes: Vec<usize>,
    /// Largest distance that is searched, in standard deviations.
    most: f64,
}

/// The nearest pose known to have another outcome.
#[derive(Debug, Clone, Copy)]
struct Best {
    distance: f64,
    along: [f64; 5],
}

impl<'a> Search<'a> {
    /// In units of this accuracy, no further than `most` of them.
    pub fn new(problem: &'a Problem, accuracy: &PoseError, most: f64) -> Self {
        let free = problem.alignment().free;
        let accuracy = accuracy.to_array();
        let axes = free.iter().map(Dof::index).filter(|k| accuracy[*k] > 0.0).collect();
        Self { problem, accuracy, axes, most }
    }

    /// Distance of two poses, in standard deviations; infinite if an exact error differs.
    pub fn apart(&self, a: &PoseError, b: &PoseError) -> f64 {
        let (a, b) = (a.to_array(), b.to_array());
        let mut sum = 0.0;
        for dof in self.problem.alignment().free.iter() {
            let k = dof.index();
            let off = a[k] - b[k];
            if off != 0.0 {
                sum += (off / self.accuracy[k]).powi(2);
            }
        }
        sum.sqrt()
    }

    /// The nearest pose found with another outcome than `from`, which `docks` or fails; `other` is a pose
    /// known to have another outcome.
    pub(crate) fn nearest(
        &self,
        judge: &mut DockingOracle<'_>,
        from: &PoseError,
        docks: bool,
        other: Option<&PoseError>,
        random: Stream,
    ) -> Option<Border> {
        let mut best = None;
        if let Some(other) = other {
            let distance = self.apart(from, other);
            if distance > 0.0 && distance.is_finite() && distance <= self.most {
                let along = std::array::from_fn(|k| {
                    let off = other.to_array()[k] - from.to_array()[k];
                    if self.axes.contains(&k) { off / self.accuracy[k] / distance } else { 0.0 }
                });
                best = Some(Best { distance, along });
                self.ray(judge, from, docks, along, &mut best);
            }
        }
        for k in &self.axes {
            for sign in [-1.0, 1.0] {
                let mut along = [0.0; 5];
                along[*k] = sign;
                self.ray(judge, from, docks, along, &mut best);
            }
        }
        let several = self.axes.len() as u64;
        if several > 1 {
            for number in 0..RANDOM * several {
                if let Some(along) = self.unit(random_direction(random, number)) {
                    self.ray(judge, from, docks, along, &mut best);
                }
            }
            self.beside(judge, from, docks, random.branch(1), &mut best);
        }
        best.map(|best| self.border(from, &best))
    }

    /// Tries directions near the best direction.
    fn beside(
        &self,
        judge: &mut DockingOracle<'_>,
        from: &PoseError,
        docks: bool,
        random: Stream,
        best: &mut Option<Best>,
    ) {
        let mut spread = SPREAD;
        for number in 0..BESIDE * self.axes.len() as u64 {
            let Some(known) = *best else { return };
            let step = random_direction(random, number);
            let Some(along) = self.unit(std::array::from_fn(|k| known.along[k] + spread * step[k])) else {
                continue;
            };
            let nearer = known.distance * NEARER;
            if nearer > self.reach(from, &along) || judge.docks(&self.pose(from, &along, nearer)) == docks {
                spread *= SHRINK;
            } else {
                *best =
                    Some(Best { distance: self.bisect(judge, from, docks, &along, [0.0, nearer]), along });
            }
        }
    }

    /// Looks along a direction, as far as is worth it.
    fn ray(
        &self,
        judge: &mut DockingOracle<'_>,
        from: &PoseError,
        docks: bool,
        along: [f64; 5],
        best: &mut Option<Best>,
    ) {
        let reach = self.reach(from, &along).min(self.most);
        let end = best.map_or(reach, |best| best.distance.min(reach));
        let looks: Vec<f64> = if best.is_some() {
            (1..=LOOKS).map(|k| end * k as f64 / LOOKS as f64).collect()
        } else {
            let far = std::iter::successors(Some(FIRST_LOOK), |t| Some(2.0 * t)).take_while(|t| *t < end);
            far.chain([end]).collect()
        };
        let mut same = 0.0;
        for t in looks.into_iter().filter(|t| *t > 0.0) {
            if judge.docks(&self.pose(from, &along, t)) == docks {
                same = t;
                continue;
            }
            let distance = self.bisect(judge, from, docks, &along, [same, t]);
            if best.is_none_or(|best| distance < best.distance) {
                *best = Some(Best { distance, along });
            }
            return;
        }
    }

    /// The change of the outcome between a pose with the same and a pose with another outcome.
    fn bisect(
        &self,
        judge: &mut DockingOracle<'_>,
        from: &PoseError,
        docks: bool,
        along: &[f64; 5],
        [mut same, mut other]: [f64; 2],
    ) -> f64 {
        while other - same > (SHARP * other).max(SHARPEST) {
            let middle = f64::midpoint(same, other);
            if judge.docks(&self.pose(from, along, middle)) == docks {
                same = middle;
            } else {
                other = middle;
            }
        }
        other
    }

    /// Distance in a direction up to the border of the error box.
    fn reach(&self, from: &PoseError, along: &[f64; 5]) -> f64 {
        let alignment = self.problem.alignment();
        let until = |k: usize| {
            let speed = along[k] * self.accuracy[k];
            let end = alignment.half_range(Dof::ALL[k]).copysign(speed);
            if speed == 0.0 { f64::INFINITY } else { ((end - from.to_array()[k]) / speed).max(0.0) }
        };
        self.axes.iter().map(|k| until(*k)).fold(f64::INFINITY, f64::min)
    }

    fn pose(&self, from: &PoseError, along: &[f64; 5], t: f64) -> PoseError {
        let from = from.to_array();
        PoseError::from_array(std::array::from_fn(|k| from[k] + t * along[k] * self.accuracy[k]))
    }

    /// The same direction with length 1, exact errors left out.
    fn unit(&self, along: [f64; 5]) -> Option<[f64; 5]> {
        let length = self.axes.iter().map(|k| along[*k] * along[*k]).sum::<f64>().sqrt();
        (length > 0.0)
            .then(|| std::array::from_fn(|k| if self.axes.contains(&k) { along[k] / length } else { 0.0 }))
    }

    fn border(&self, from: &PoseError, best: &Best) -> Border {
        let alignment = self.problem.alignment();
        let at = self.pose(from, &best.along, best.distance);
        let off = |k: usize| at.to_array()[k] - from.to_array()[k];
        let sum = |unit: &dyn Fn(usize) -> f64| {
            self.axes.iter().map(|k| (off(*k) * unit(*k)).powi(2)).sum::<f64>().sqrt()
        };
        let in_d = |k: usize| if Dof::ALL[k].is_rotation() { alignment.rotation_length } else { 1.0 };
        Border {
            sigmas: best.distance,
            box_share: sum(&|k| alignment.half_ranges[k].recip()),
            distance: sum(&in_d),
            at,
        }
    }
}

/// Number of uniform random numbers for five normal ones.
const DRAWS: u64 = 6;

pub(super) fn random_direction(random: Stream, number: u64) -> [f64; 5] {
    normals(|k| random.uniform(DRAWS * number + k))
}
