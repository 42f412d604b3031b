//! The probability of docking, its interval, and its slopes, from a stratified sample of exact motions.
//!
//! ```text
//!   1  N errors drawn, none followed        W_s = N_s/N     their shares of the strata
//!   2  n ≪ N of them followed exactly       p_s             share of stratum s that docks; most where there is doubt
//!
//!   P = Σ_s W_s·p_s                                     double sampling for stratification (Cochran, Sampling Techniques, ch. 12)
//!   P − lo = √(Σ_s W_s²(p_s − l_s)² + (P − l)²)         [l_s, u_s]  Wilson's interval of p_s,  [l, u]  that of P from N errors
//!
//!   dP/dσ_k = E[(1_docks − P)·s_k]                      s_k  d log(density)/dσ_k: the same motions, no more of them
//! ```
//!
//! The interval of the strata is that of [`crate::method::correction`], which draws batches the same way: 0 of n failures leave the stratum
//! 3.8/n of doubt. Undecided motions count as failures; they widen the interval upwards.
//!
//! Slopes have normal intervals; in every stratum the share that docks is drawn towards a half by two poses of either kind, so that one in which nothing
//! failed still has its doubt.

use super::source::{SAME, Source};
use super::strata::{STRATA, Strata, name};
use super::{Slope, Stratum};
use crate::acceptance::Outcome;
use crate::exec::{Cancelled, Exec};
use crate::method::correction::{Seen, Stop, Whole, Z95, allot, next, wilson95};
use crate::method::descent::{self, Follower};
use crate::pose::Dof;
use crate::problem::Problem;
use rayon::prelude::*;
use std::time::Duration;

/// Errors that are drawn for each that is followed: their share of the doubt is that of as many plain motions.
const DRAWN_PER_MOTION: usize = 256;
const FEWEST_DRAWN: usize = 1 << 16;
const MOST_DRAWN: usize = 1 << 21;
/// Errors drawn between two looks at whether to stop.
const BLOCK: usize = 4096;

/// A pose that was followed.
#[derive(Debug, Clone, Copy)]
pub(super) struct Followed {
    /// Its number among the errors of the source.
    pub(super) number: u64,
    /// The share of all errors that it stands for.
    pub(super) weight: f64,
    /// What became of it.
    pub(super) outcome: Outcome,
    stratum: usize,
}

/// What a sample says.
#[derive(Debug, Clone)]
pub(super) struct Sample {
    /// Probability of docking, in [0, 1], and its 95 % interval.
    pub(super) probability: f64,
    pub(super) ci95: [f64; 2],
    /// Motions that were followed.
    pub(super) motions: usize,
    /// How many of them could not be followed to their end.
    pub(super) undecided: usize,
    /// Plain motions whose interval would be as wide.
    pub(super) plain: f64,
    /// The poses that were followed.
    pub(super) poses: Vec<Followed>,
    /// What was seen of every stratum that has errors.
    pub(super) strata: Vec<Stratum>,
    /// The stratum of every error that was drawn.
    labels: Vec<u8>,
    /// Share that docks, by stratum, and the same drawn towards a half.
    docks: [f64; STRATA],
    doubted: [f64; STRATA],
    /// Poses that would know the share of the stratum as well, if drawn at one go.
    trials: [f64; STRATA],
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
    let plain = source.rows().or((!strata.is_some()).then_some(motions));
    let labels = match plain {
        Some(count) => vec![0; count],
        None => {
            let drawn = (DRAWN_PER_MOTION * motions).clamp(FEWEST_DRAWN, MOST_DRAWN);
            labels(source, factors, strata, drawn, exec)?
        }
    };
    let motions = plain.unwrap_or(motions);
    let drawn = labels.len();
    let mut members: Vec<Vec<u32>> = vec![Vec::new(); STRATA];
    for (number, label) in labels.iter().enumerate() {
        members[usize::from(*label)].push(number as u32);
    }
    let present: Vec<usize> = (0..STRATA).filter(|s| !members[*s].is_empty()).collect();
    let share = |s: usize| members[s].len() as f64 / drawn.max(1) as f64;
    let mut records: Vec<Record> = present.iter().map(|_| Record::default()).collect();
    let mut poses = Vec::new();
    let (mut total, mut sizes) = (0, Vec::new());
    let rebuilt = |records: &[Record], total: usize, sizes: &[usize]| -> Vec<Seen> {
        present
            .iter()
            .zip(records)
            .map(|(s, record)| record.seen(share(*s), members[*s].len(), total, sizes))
            .collect()
    };
    let mut seen = rebuilt(&records, 0, &[]);
    let mut whole = Whole::of(&seen, 0);
    while let Some(batch) =
        next(Stop::Samples(motions), total, present.len(), Duration::ZERO, &whole).filter(|_| drawn > 0)
    {
        let mut numbered: Vec<(usize, u64)> = Vec::new();
        for (k, given) in allot(batch.poses, &seen).into_iter().enumerate() {
            let list = &members[present[k]];
            let from = records[k].followed();
            let numbers = list[from.min(list.len())..(from + given).min(list.len())].iter();
            numbered.extend(numbers.map(|number| (k, u64::from(*number))));
        }
        let part = exec.part(
            [total as f64 / motions as f64, (total + batch.poses) as f64 / motions as f64],
            "random motions",
        );
        let outcomes = follow(problem, source, factors, &numbered, &part)?;
        records.iter_mut().for_each(Record::begin);
        for ((k, number), outcome) in numbered.iter().zip(outcomes) {
            records[*k].push(outcome);
            poses.push((*k, sizes.len(), *number, outcome));
        }
        sizes.push(batch.poses);
        total += batch.poses;
        seen = rebuilt(&records, total, &sizes);
        whole = Whole::of(&seen, total);
        if batch.last || numbered.is_empty() {
            break;
        }
    }
    let (mut docks, mut doubted, mut trials) = ([0.0; STRATA], [0.0; STRATA], [0.0; STRATA]);
    for ((s, record), seen) in present.iter().zip(&records).zip(&seen) {
        docks[*s] = seen.shares(total)[0];
        // Two of either kind (Agresti and Coull 1998).
        doubted[*s] = (record.counts()[0] as f64 + 2.0) / (record.followed() as f64 + 4.0);
        trials[*s] = record.trials(members[*s].len(), total, &sizes);
    }
    let followed: Vec<Followed> = poses
        .iter()
        .map(|(k, batch, number, outcome)| {
            let of_stratum = records[*k].weight(*batch, members[present[*k]].len(), total, &sizes);
            Followed {
                number: *number,
                weight: share(present[*k]) * of_stratum,
                outcome: *outcome,
                stratum: present[*k],
            }
        })
        .collect();
    let probability = whole.fraction;
    let mut ci95 = whole.ci95;
    let known_from = if plain.is_some() { None } else { Some(drawn) };
    for count in known_from.into_iter().chain(source.measurements()) {
        ci95 = widened(probability, ci95, wilson95(probability, count as f64));
    }
    let strata = present.iter().zip(&records).zip(&seen);
    let strata = strata.map(|((s, record), seen)| Stratum {
        name: if plain.is_some() { "all errors".to_owned() } else { name(*s) },
        share: share(*s),
        motions: record.followed(),
        docked: record.counts()[0],
        undecided: record.counts()[1],
        probability: seen.shares(total)[0],
    });
    Ok(Sample {
        probability,
        ci95,
        motions: followed.len(),
        undecided: records.iter().map(|record| record.counts()[1]).sum(),
        plain: plain_motions(probability, ci95),
        strata: strata.collect(),
        poses: followed,
        labels,
        docks,
        doubted,
        trials,
    })
}

/// Both doubts together, as of independent ones.
fn widened(middle: f64, [lo, hi]: [f64; 2], other: [f64; 2]) -> [f64; 2] {
    let down = (middle - lo).hypot(middle - other[0]);
    let up = (hi - middle).hypot(other[1] - middle);
    [(middle - down).max(0.0), (middle + up).min(1.0)]
}

/// Plain motions whose Wilson interval at this probability is as wide as this one.
fn plain_motions(probability: f64, [lo, hi]: [f64; 2]) -> f64 {
    /// Halvings of the exponent: far finer than anybody reads.
    const HALVINGS: usize = 60;
    let (mut few, mut many) = (0.0f64, 40.0f64);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (few + many);
        let [l, u] = wilson95(probability, libm::exp(middle));
        if u - l > hi - lo { few = middle } else { many = middle }
    }
    libm::exp(many)
}

/// What was seen of a stratum, batch by batch.
#[derive(Debug, Clone, Default)]
struct Record {
    /// Followed, docked, undecided.
    batches: Vec<[usize; 3]>,
}

impl Record {
    fn begin(&mut self) {
        self.batches.push([0; 3]);
    }

    fn push(&mut self, outcome: Outcome) {
        if let Some([followed, docked, undecided]) = self.batches.last_mut() {
            *followed += 1;
            *docked += usize::from(outcome == Outcome::Aligned);
            *undecided += usize::from(outcome == Outcome::Undecided);
        }
    }

    fn followed(&self) -> usize {
        self.batches.iter().map(|batch| batch[0]).sum()
    }

    /// Docked, undecided.
    fn counts(&self) -> [usize; 2] {
        [1, 2].map(|k| self.batches.iter().map(|batch| batch[k]).sum())
    }

    /// Whether batches cannot be weighted by their sizes: all errors of the stratum were followed, each counts alike.
    fn is_exhausted(&self, members: usize) -> bool {
        self.followed() >= members
    }

    fn seen(&self, share: f64, members: usize, total: usize, sizes: &[usize]) -> Seen {
        let mut seen = Seen::new(share);
        if self.followed() == 0 {
            return seen;
        }
        if self.is_exhausted(members) {
            seen.add(total, self.followed(), self.counts());
        } else {
            for ([followed, docked, undecided], size) in self.batches.iter().zip(sizes) {
                seen.add(*size, *followed, [*docked, *undecided]);
            }
        }
        seen
    }

    /// What a pose of a batch counts, of the stratum.
    fn weight(&self, batch: usize, members: usize, total: usize, sizes: &[usize]) -> f64 {
        if self.is_exhausted(members) {
            return 1.0 / self.followed() as f64;
        }
        sizes[batch] as f64 / (self.batches[batch][0] as f64 * total as f64)
    }

    fn trials(&self, members: usize, total: usize, sizes: &[usize]) -> f64 {
        let squares = self.batches.iter().enumerate().map(|(k, batch)| {
            let weight = if batch[0] > 0 { self.weight(k, members, total, sizes) } else { 0.0 };
            batch[0] as f64 * weight * weight
        });
        1.0 / squares.sum::<f64>()
    }
}

/// The strata of as many errors.
fn labels(
    source: &Source<'_>,
    factors: &[f64; 5],
    strata: &Strata,
    drawn: usize,
    exec: &Exec,
) -> Result<Vec<u8>, Cancelled> {
    let mut labels = vec![0u8; drawn];
    exec.install(|| {
        labels.par_chunks_mut(BLOCK).enumerate().try_for_each(|(block, labels)| {
            exec.check()?;
            for (k, label) in labels.iter_mut().enumerate() {
                let z = source.standard((block * BLOCK + k) as u64);
                *label = strata.of(&source.pose(&z, factors)) as u8;
            }
            Ok(())
        })
    })?;
    Ok(labels)
}

/// What becomes of errors, by their numbers.
fn follow(
    problem: &Problem,
    source: &Source<'_>,
    factors: &[f64; 5],
    numbered: &[(usize, u64)],
    exec: &Exec,
) -> Result<Vec<Outcome>, Cancelled> {
    let (pair, settings) = (problem.pair(), descent::Settings::default());
    let done = std::sync::atomic::AtomicUsize::new(0);
    exec.install(|| {
        let outcome = |follower: &mut Follower<'_>, (_, number): &(usize, u64)| {
            exec.check()?;
            let found = follower.follow(&source.pose(&source.standard(*number), factors)).outcome;
            let done = done.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
            exec.report(done as f64 / numbered.len() as f64, "random motions");
            Ok(found)
        };
        numbered.par_iter().map_init(|| Follower::new(pair, &settings), outcome).collect()
    })
}

impl Sample {
    /// Errors that were drawn, followed or not.
    pub(super) const fn drawn(&self) -> usize {
        self.labels.len()
    }

    /// dP/dσ by every σ that varies, in 1/D or 1/rad, with its interval; none where the density has no derivative.
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
                slope: slope / sigma,
                ci95: [(slope - error) / sigma, (slope + error) / sigma],
            });
        }
        Ok(slopes)
    }

    /// By stratum and error: sum of the scores of all errors that were drawn, and of their squares. In blocks, in their order, so that
    /// threads change nothing.
    fn score_sums(&self, source: &Source<'_>, exec: &Exec) -> Result<Vec<[[f64; 2]; 5]>, Cancelled> {
        let of_block = |(block, labels): (usize, &[u8])| {
            exec.check()?;
            let mut sums = vec![[[0.0; 2]; 5]; STRATA];
            for (k, label) in labels.iter().enumerate() {
                let scores = source.scores(&source.standard((block * BLOCK + k) as u64));
                for (sum, score) in sums[usize::from(*label)].iter_mut().zip(scores) {
                    sum[0] += score;
                    sum[1] += score * score;
                }
            }
            Ok(sums)
        };
        let blocks: Vec<Vec<[[f64; 2]; 5]>> = exec.install(|| {
            self.labels.par_chunks(BLOCK).enumerate().map(of_block).collect::<Result<_, Cancelled>>()
        })?;
        let mut sums = vec![[[0.0; 2]; 5]; STRATA];
        for block in blocks {
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

/// Factors that change one σ alone.
pub(super) fn alone(axis: Dof, factor: f64) -> [f64; 5] {
    let mut factors = SAME;
    factors[axis.index()] = factor;
    factors
}
