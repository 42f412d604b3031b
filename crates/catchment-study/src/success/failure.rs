//! Failures: their shares, their dominant error, and the nearest failure.
//!
//! ```text
//!   shares       of the failures, jammed and missed; weighted as the sample is
//!   along        mean |error| in σ of failures over that of successes, by error: the direction of failures
//!   first        the failing error nearest to the mean, in σ: the most likely failure
//!
//!        ·  ·  ✕
//!      ·  μ──✕   ✕       from the nearest failures of the sample bisection towards the mean,
//!        ·  ·  ✕         then moves about the nearest of all; each nearer failure is bisected again
//! ```
//!
//! Without a failure in the sample the search goes farther out, up to 8 σ (3 half-widths): such an error
//! shows the distance of failure, not its probability.
//!
//! Not promised: that no failing error is nearer. Failures in regions too thin for the random errors are
//! found only by luck.

use super::estimate::{FollowedError, Sample};
use super::source::{SAME, Source, normals};
use super::{AlongAxis, Failures, NearestFailure};
use catchment_core::acceptance::Outcome;
use catchment_core::exec::{Cancelled, Exec};
use catchment_core::method::descent::{self, Follower};
use catchment_core::pose::PoseError;
use catchment_core::problem::Problem;

/// Failures of the sample that are bisected.
const NEAREST: usize = 64;
/// Search range if no sample failed, in σ or half-widths.
const FAR: f64 = 8.0;
const FAR_UNIFORM: f64 = 3.0;
/// Relative width to which they are.
const SHARP: f64 = 1e-3;
/// Moves at a time, and how many times at most; a round that finds nothing nearer halves their spread.
const MOVES: usize = 32;
const ROUNDS: u64 = 12;
/// Spread of the first moves, as a share of the distance.
const SPREAD: f64 = 0.3;
/// Moves are tried this much nearer than the nearest failure.
const NEARER: f64 = 0.998;
/// The stream of the moves.
const BRANCH: u64 = 0xfa11;

/// The failures of a sample, and the number of motions in the search for the nearest failure.
pub(super) fn failures(
    problem: &Problem,
    source: &Source<'_>,
    sample: &Sample,
    exec: &Exec,
) -> Result<(Failures, usize), Cancelled> {
    let share = |wanted: Outcome| {
        let of = sample.poses.iter().filter(|pose| pose.outcome == wanted);
        of.map(|pose| pose.weight).sum::<f64>()
    };
    let [jammed, missed, undecided] = [Outcome::Jammed, Outcome::Missed, Outcome::Undecided].map(share);
    let all = jammed + missed + undecided;
    let of_failures = |part: f64| if all > 0.0 { part / all } else { 0.0 };
    let (first, motions) = first(problem, source, sample, exec)?;
    let along = along(source, sample);
    let excess = |along: &AlongAxis| Some((along.axis, along.failed? - along.docked.unwrap_or(0.0)));
    let dominating = along.iter().filter_map(excess).max_by(|a, b| a.1.total_cmp(&b.1));
    let result = Failures {
        share: 1.0 - sample.probability,
        jammed: of_failures(jammed),
        missed: of_failures(missed),
        undecided: of_failures(undecided),
        dominating: dominating.map(|(axis, _)| axis),
        along,
        first,
    };
    Ok((result, motions))
}

/// Statistics of failures, error by error.
fn along(source: &Source<'_>, sample: &Sample) -> Vec<AlongAxis> {
    let mean = |axis: usize, docked: bool| {
        let (mut sum, mut weight) = (0.0, 0.0);
        for pose in sample.poses.iter().filter(|pose| (pose.outcome == Outcome::Aligned) == docked) {
            let y = source.in_sigmas(&source.standard(pose.number));
            sum += pose.weight * y[axis].abs();
            weight += pose.weight;
        }
        if weight > 0.0 { Some(sum / weight) } else { None }
    };
    let of = |axis: catchment_core::pose::Dof| AlongAxis {
        axis,
        failed: mean(axis.index(), false),
        docked: mean(axis.index(), true),
    };
    source.varying().map(of).collect()
}

/// A failing error: its direction, and its distance along it.
#[derive(Debug, Clone, Copy)]
struct Failing {
    z: [f64; 5],
    distance: f64,
    outcome: Outcome,
}

fn first(
    problem: &Problem,
    source: &Source<'_>,
    sample: &Sample,
    exec: &Exec,
) -> Result<(Option<NearestFailure>, usize), Cancelled> {
    let mean = descent::outcome(problem.pair(), &source.mean(), &source.motions).outcome;
    if mean != Outcome::Aligned {
        let failing = Failing { z: [0.0; 5], distance: 0.0, outcome: mean };
        return Ok((Some(nearest_failure(problem, source, failing)), 1));
    }
    let failed = sample.poses.iter().filter(|pose| pose.outcome != Outcome::Aligned);
    let mut candidates: Vec<([f64; 5], f64)> = failed
        .map(|pose: &FollowedError| {
            let z = source.standard(pose.number);
            (z, source.distance(&z))
        })
        .collect();
    candidates.sort_by(|a, b| a.1.total_cmp(&b.1));
    candidates.truncate(NEAREST);
    let mut zs: Vec<[f64; 5]> = candidates.into_iter().map(|(z, _)| z).collect();
    if zs.is_empty() {
        // Nothing failed: further out along the directions of the sample.
        let far = if source.is_uniform() { FAR_UNIFORM } else { FAR };
        let outwards = sample.poses.iter().take(NEAREST).filter_map(|pose| {
            let z = source.standard(pose.number);
            let distance = source.distance(&z);
            (distance > 0.0).then(|| z.map(|part| part * far / distance))
        });
        zs = outwards.collect();
    }
    let (mut best, mut motions) = nearest(problem, source, &zs, exec)?;
    let mut spread = SPREAD;
    for round in 0..ROUNDS {
        let Some(failing) = best else { break };
        let random = source.random().branch(BRANCH).branch(round);
        let moves: Vec<[f64; 5]> = (0..MOVES as u64)
            .filter_map(|k| moved(source, &failing, spread, |j| random.uniform(8 * k + j)))
            .collect();
        let (result, more) = nearest(problem, source, &moves, exec)?;
        motions += more + 1;
        match result.filter(|result| result.distance < failing.distance) {
            Some(nearer) => best = Some(nearer),
            None => spread *= 0.5,
        }
        exec.report(round as f64 / ROUNDS as f64, "what fails first");
    }
    Ok((best.map(|failing| nearest_failure(problem, source, failing)), motions + 1))
}

/// Somewhere about a failing error, a little nearer.
fn moved(
    source: &Source<'_>,
    failing: &Failing,
    spread: f64,
    uniform: impl Fn(u64) -> f64,
) -> Option<[f64; 5]> {
    let off = normals(uniform);
    let mut z = failing.z;
    for axis in source.varying() {
        z[axis.index()] += spread * failing.distance * off[axis.index()];
    }
    let distance = source.distance(&z);
    (distance > 0.0).then(|| z.map(|part| part * NEARER * failing.distance / distance))
}

/// The error, of those given, whose failure is nearest to the mean after bisection; and the number of
/// motions.
fn nearest(
    problem: &Problem,
    source: &Source<'_>,
    zs: &[[f64; 5]],
    exec: &Exec,
) -> Result<(Option<Failing>, usize), Cancelled> {
    let look = |follower: &mut Follower<'_>, k: usize| {
        let (z, mut motions) = (&zs[k], 0);
        let mut outcome = |part: f64| {
            motions += 1;
            follower.follow(&source.pose(&z.map(|v| v * part), &SAME)).outcome
        };
        let mut fails = outcome(1.0);
        if fails == Outcome::Aligned {
            return (None, motions);
        }
        let (mut safe, mut failing) = (0.0, 1.0);
        while failing - safe > SHARP * failing {
            let middle = 0.5 * (safe + failing);
            match outcome(middle) {
                Outcome::Aligned => safe = middle,
                other => (failing, fails) = (middle, other),
            }
            if failing < SHARP {
                break;
            }
        }
        let z = z.map(|v| v * failing);
        (Some(Failing { z, distance: source.distance(&z), outcome: fails }), motions)
    };
    let result: Vec<(Option<Failing>, usize)> =
        exec.map_with(zs.len(), || Follower::new(problem.pair(), &source.motions), look)?;
    let motions = result.iter().map(|(_, motions)| motions).sum();
    let failing = result.into_iter().filter_map(|(failing, _)| failing);
    Ok((failing.min_by(|a, b| a.distance.total_cmp(&b.distance)), motions))
}

fn nearest_failure(problem: &Problem, source: &Source<'_>, failing: Failing) -> NearestFailure {
    let error = source.pose(&failing.z, &SAME);
    let path = descent::trace(problem.pair(), &error, &source.motions);
    let last = path.waypoints.last();
    NearestFailure {
        error,
        sigmas: PoseError::from_array(source.in_sigmas(&failing.z)),
        distance: failing.distance,
        outcome: failing.outcome,
        end: last.map_or(error, |waypoint| waypoint.error),
        touches: last.map_or_else(Vec::new, |waypoint| waypoint.touches.clone()),
    }
}
