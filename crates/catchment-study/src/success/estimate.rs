//! The probability of docking, its interval, and its slopes, from a stratified sample of exact motions.
//!
//! ```text
//!   1  N errors drawn, no motions           W_s = N_s/N     their shares of the strata
//!   2  n ≪ N of them followed exactly       p_s             share of stratum s that docks; most motions near the border
//!
//!   P = Σ_s W_s·p_s                                     double sampling for stratification (Cochran, Sampling Techniques, ch. 12)
//!   P − lo = √(Σ_s W_s²(p_s − l_s)² + (P − l)²)         [l_s, u_s]  Wilson's interval of p_s,  [l, u]  that of P from N errors
//!
//!   dP/dσ_k = E[(1_docks − P)·s_k]                      s_k  d log(density)/dσ_k: from the same motions
//! ```
//!
//! The interval of the strata is that of [`catchment_core::method::correction`], which draws batches in the
//! same way: 0 failures of n leave an uncertainty of 3.8/n of the stratum. Undecided motions count as
//! failures; they widen the interval upwards.
//!
//! Slopes have normal intervals; in every stratum the share that docks is shifted towards a half by two poses
//! of either outcome, so that a stratum without failures still has an uncertainty.

use super::samples::DrawnErrors;
use super::source::{SAME, Source};
use super::strata::{STRATA, Strata};
use super::{ErrorStratum, Slope};
use catchment_core::acceptance::Outcome;
use catchment_core::exec::{Cancelled, Exec};
use catchment_core::method::correction::{CombinedShares, Stop, Z95, allot, next};
use catchment_core::method::descent::Follower;
use catchment_core::pose::Dof;
use catchment_core::problem::Problem;
use std::time::Duration;

/// Number of errors drawn for each that is followed: the uncertainty of their shares equals that of as many
/// plain motions.
const DRAWN_PER_MOTION: usize = 256;
const FEWEST_DRAWN: usize = 1 << 16;
const MOST_DRAWN: usize = 1 << 21;
/// Number of errors whose scores are one partial sum.
const BLOCK: usize = 4096;

/// A pose that was followed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FollowedError {
    /// Its number among the errors of the source.
    pub(super) number: u64,
    /// The share of all errors that it stands for.
    pub(crate) weight: f64,
    /// Its outcome.
    pub(crate) outcome: Outcome,
    /// Its stratum.
    pub(super) stratum: usize,
}

/// Result of a sample.
#[derive(Debug, Clone)]
pub(crate) struct Sample {
    /// Probability of docking, in [0, 1], and its 95 % interval.
    pub(crate) probability: f64,
    pub(crate) ci95: [f64; 2],
    /// Motions that were followed.
    pub(crate) motions: usize,
    /// How many of them could not be followed to their end.
    pub(crate) undecided: usize,
    /// Plain motions whose interval would be as wide.
    pub(crate) plain: f64,
    /// The poses that were followed.
    pub(crate) poses: Vec<FollowedError>,
    /// Results of every non-empty stratum.
    pub(crate) strata: Vec<ErrorStratum>,
    /// The stratum of every error that was drawn.
    pub(super) labels: Vec<u8>,
    /// Share that docks, by stratum, and the same drawn towards a half.
    pub(super) docks: [f64; STRATA],
    pub(super) doubted: [f64; STRATA],
    /// Effective sample sizes of the strata.
    pub(super) trials: [f64; STRATA],
}

/// Draws errors, and follows `motions` of them; of rows in their order, all.
pub(super) fn sample(
    problem: &Problem,
    source: &Source<'_>,
    factors: &[f64; 5],
    strata: &Strata,
    motions: usize,
    exec: &Exec,
) -> Result<Sample, Cancelled> {
    sample_by(source, factors, strata, motions, exec, |numbered, part| {
        follow(problem, source, factors, numbered, part)
    })
}

/// The same for any decision of errors: `follow` receives their strata and numbers.
pub(crate) fn sample_by<E: From<Cancelled>>(
    source: &Source<'_>,
    factors: &[f64; 5],
    strata: &Strata,
    motions: usize,
    exec: &Exec,
    mut follow: impl FnMut(&[(usize, u64)], &Exec) -> Result<Vec<Outcome>, E>,
) -> Result<Sample, E> {
    let plain = source.rows().or((!strata.is_some()).then_some(motions));
    let labels = if let Some(count) = plain {
        vec![0; count]
    } else {
        let drawn = (DRAWN_PER_MOTION * motions).clamp(FEWEST_DRAWN, MOST_DRAWN);
        labels(source, factors, strata, drawn, exec)?
    };
    let motions = plain.unwrap_or(motions);
    let mut drawn = DrawnErrors::new(labels, plain.is_some());
    let mut seen = drawn.seen();
    let mut whole = CombinedShares::of(&seen, 0);
    while let Some(batch) = next(Stop::Samples(motions), drawn.total(), seen.len(), Duration::ZERO, &whole)
        .filter(|_| !seen.is_empty())
    {
        let numbered = drawn.batch(&allot(batch.poses, &seen));
        let span = [drawn.total(), drawn.total() + batch.poses].map(|done| done as f64 / motions as f64);
        let part = exec.part(span, "random motions");
        let outcomes = follow(&numbered, &part)?;
        drawn.take(batch.poses, &numbered, &outcomes);
        seen = drawn.seen();
        whole = CombinedShares::of(&seen, drawn.total());
        if batch.last || numbered.is_empty() {
            break;
        }
    }
    Ok(drawn.sample(&whole, source.measurements()))
}

/// The strata of as many errors.
fn labels(
    source: &Source<'_>,
    factors: &[f64; 5],
    strata: &Strata,
    drawn: usize,
    exec: &Exec,
) -> Result<Vec<u8>, Cancelled> {
    exec.map(drawn, |k| strata.of(&source.pose(&source.standard(k as u64), factors)) as u8)
}

/// Outcomes of errors, by their numbers.
fn follow(
    problem: &Problem,
    source: &Source<'_>,
    factors: &[f64; 5],
    numbered: &[(usize, u64)],
    exec: &Exec,
) -> Result<Vec<Outcome>, Cancelled> {
    let tally = exec.tally(numbered.len(), "random motions");
    let outcome = |follower: &mut Follower<'_>, k: usize| {
        let result = follower.follow(&source.pose(&source.standard(numbered[k].1), factors)).outcome;
        tally.add(1);
        result
    };
    exec.map_with(numbered.len(), || Follower::new(problem.pair(), &source.motions), outcome)
}

impl Sample {
    /// Errors that were drawn, followed or not.
    pub(super) const fn drawn(&self) -> usize {
        self.labels.len()
    }

    /// dP/dσ for every σ that varies, in 1/D or 1/rad, with its interval; empty if the density has no
    /// derivative.
    pub(super) fn slopes(&self, source: &Source<'_>, exec: &Exec) -> Result<Vec<Slope>, Cancelled> {
        if !source.has_scores() || self.labels.is_empty() {
            return Ok(Vec::new());
        }
        let sums = self.score_sums(source, exec)?;
        let drawn = self.labels.len() as f64;
        let is_plain = self.poses.len() == self.labels.len();
        let mut slopes = Vec::new();
        for axis in source.varying() {
            let k = axis.index();
            let (mut mean, mut square) = (0.0, 0.0);
            for (s, sums) in sums.iter().enumerate() {
                let off = self.docks[s] - self.probability;
                mean += off * sums[k][0] / drawn;
                square += off * off * sums[k][1] / drawn;
            }
            let first = if is_plain { 0.0 } else { (square - mean * mean).max(0.0) / drawn };
            let mut rest = 0.0;
            // Of every stratum the mean of the squares of its scores.
            let (mut squares, mut weights) = ([0.0; STRATA], [0.0; STRATA]);
            for pose in &self.poses {
                let score = source.scores(&source.standard(pose.number))[k];
                let docks = f64::from(u8::from(pose.outcome == Outcome::Aligned));
                rest += pose.weight * score * (docks - self.docks[pose.stratum]);
                squares[pose.stratum] += pose.weight * score * score;
                weights[pose.stratum] += pose.weight;
            }
            let second: f64 = (0..STRATA)
                .filter(|s| weights[*s] > 0.0)
                .map(|s| {
                    let p = self.doubted[s];
                    weights[s] * squares[s] * p * (1.0 - p) / self.trials[s]
                })
                .sum();
            let (slope, error) = (mean + rest, Z95 * (first + second).sqrt());
            let sigma = source.scale(axis);
            slopes.push(Slope {
                axis,
                value: slope / sigma,
                ci95: [(slope - error) / sigma, (slope + error) / sigma],
            });
        }
        Ok(slopes)
    }

    /// By stratum and error: sum of the scores of all errors that were drawn, and of their squares. In blocks, in their order, so that
    /// threads change nothing.
    fn score_sums(&self, source: &Source<'_>, exec: &Exec) -> Result<Vec<[[f64; 2]; 5]>, Cancelled> {
        let blocks: Vec<&[u8]> = self.labels.chunks(BLOCK).collect();
        let of_block = |block: usize| {
            let mut sums = vec![[[0.0; 2]; 5]; STRATA];
            for (k, label) in blocks[block].iter().enumerate() {
                let scores = source.scores(&source.standard((block * BLOCK + k) as u64));
                for (sum, score) in sums[usize::from(*label)].iter_mut().zip(scores) {
                    sum[0] += score;
                    sum[1] += score * score;
                }
            }
            sums
        };
        let mut sums = vec![[[0.0; 2]; 5]; STRATA];
        for block in exec.map(blocks.len(), of_block)? {
            for (sum, part) in sums.iter_mut().flatten().flatten().zip(block.iter().flatten().flatten()) {
                *sum += part;
            }
        }
        Ok(sums)
    }
}

/// The probability with no σ changed.
pub(super) fn as_expected(
    problem: &Problem,
    source: &Source<'_>,
    strata: &Strata,
    motions: usize,
    exec: &Exec,
) -> Result<Sample, Cancelled> {
    sample(problem, source, &SAME, strata, motions, exec)
}

/// Factors that change a single σ.
pub(super) fn alone(axis: Dof, factor: f64) -> [f64; 5] {
    let mut factors = SAME;
    factors[axis.index()] = factor;
    factors
}
