//! The sampled errors, the motions followed for some of them, and the combined estimate.

use super::ErrorStratum;
use super::estimate::{FollowedError, Sample};
use super::strata::{STRATA, name};
use catchment_core::acceptance::Outcome;
use catchment_core::method::correction::{CombinedShares, StratumCounts, wilson95};

/// Sampled errors, by stratum, and the results of those followed in batches.
#[derive(Debug)]
pub(super) struct DrawnErrors {
    /// Whether there are no strata: every error is followed.
    is_plain: bool,
    labels: Vec<u8>,
    /// The numbers of the errors of each stratum.
    members: Vec<Vec<u32>>,
    /// Non-empty strata, and their results.
    present: Vec<usize>,
    records: Vec<Record>,
    /// Sizes of the batches, and their sum.
    sizes: Vec<usize>,
    total: usize,
    poses: Vec<Pose>,
}

/// A pose that was followed: which of the present strata, batch, number, outcome.
#[derive(Debug, Clone, Copy)]
struct Pose {
    place: usize,
    batch: usize,
    number: u64,
    outcome: Outcome,
}

impl DrawnErrors {
    /// Errors by their strata, before any is followed.
    pub(super) fn new(labels: Vec<u8>, is_plain: bool) -> Self {
        let mut members: Vec<Vec<u32>> = vec![Vec::new(); STRATA];
        for (number, label) in labels.iter().enumerate() {
            members[usize::from(*label)].push(number as u32);
        }
        let present: Vec<usize> = (0..STRATA).filter(|s| !members[*s].is_empty()).collect();
        let records = vec![Record::default(); present.len()];
        Self { is_plain, labels, members, present, records, sizes: Vec::new(), total: 0, poses: Vec::new() }
    }

    /// Sum of the sizes of the batches.
    pub(super) const fn total(&self) -> usize {
        self.total
    }

    fn share(&self, place: usize) -> f64 {
        self.of(place).len() as f64 / self.labels.len().max(1) as f64
    }

    fn of(&self, place: usize) -> &[u32] {
        &self.members[self.present[place]]
    }

    /// Results of every stratum.
    pub(super) fn seen(&self) -> Vec<StratumCounts> {
        let seen = |(place, record): (usize, &Record)| {
            record.seen(self.share(place), self.of(place).len(), self.total, &self.sizes)
        };
        self.records.iter().enumerate().map(seen).collect()
    }

    /// So many of each stratum, the next in their order, as far as there are any: their strata and numbers.
    pub(super) fn batch(&self, given: &[usize]) -> Vec<(usize, u64)> {
        let mut numbered = Vec::new();
        for (place, given) in given.iter().enumerate() {
            let list = self.of(place);
            let from = self.records[place].followed().min(list.len());
            let numbers = list[from..(from + given).min(list.len())].iter();
            numbered.extend(numbers.map(|number| (place, u64::from(*number))));
        }
        numbered
    }

    /// Adds the outcomes of a batch.
    pub(super) fn take(&mut self, size: usize, numbered: &[(usize, u64)], outcomes: &[Outcome]) {
        self.records.iter_mut().for_each(Record::begin);
        for ((place, number), outcome) in numbered.iter().zip(outcomes) {
            self.records[*place].push(*outcome);
            let pose = Pose { place: *place, batch: self.sizes.len(), number: *number, outcome: *outcome };
            self.poses.push(pose);
        }
        self.sizes.push(size);
        self.total += size;
    }

    /// The combined result. `measurements`: the number of rows, if rows were sampled repeatedly.
    pub(super) fn sample(self, whole: &CombinedShares, measurements: Option<usize>) -> Sample {
        /// Poses of either kind by which the share of a stratum is drawn towards a half (Agresti and Coull 1998).
        const PRIOR: f64 = 2.0;
        let (mut docks, mut doubted, mut trials) = ([0.0; STRATA], [0.0; STRATA], [0.0; STRATA]);
        let mut strata = Vec::new();
        for (place, (record, seen)) in self.records.iter().zip(self.seen()).enumerate() {
            let (s, [docked, undecided]) = (self.present[place], record.counts());
            docks[s] = seen.shares(self.total)[0];
            doubted[s] = (docked as f64 + PRIOR) / (record.followed() as f64 + 2.0 * PRIOR);
            trials[s] = record.trials(self.of(place).len(), self.total, &self.sizes);
            strata.push(ErrorStratum {
                name: if self.is_plain { "all errors".to_owned() } else { name(s) },
                share: self.share(place),
                motions: record.followed(),
                docked,
                undecided,
                probability: docks[s],
            });
        }
        let followed = |pose: &Pose| {
            let record = &self.records[pose.place];
            let of_stratum = record.weight(pose.batch, self.of(pose.place).len(), self.total, &self.sizes);
            FollowedError {
                number: pose.number,
                weight: self.share(pose.place) * of_stratum,
                outcome: pose.outcome,
                stratum: self.present[pose.place],
            }
        };
        let poses: Vec<FollowedError> = self.poses.iter().map(followed).collect();
        let probability = whole.fraction;
        let mut ci95 = whole.ci95;
        let drawn = (!self.is_plain).then_some(self.labels.len());
        for count in drawn.into_iter().chain(measurements) {
            ci95 = widened(probability, ci95, wilson95(probability, count as f64));
        }
        Sample {
            probability,
            ci95,
            motions: poses.len(),
            undecided: self.records.iter().map(|record| record.counts()[1]).sum(),
            plain: plain_motions(probability, ci95),
            strata,
            poses,
            labels: self.labels,
            docks,
            doubted,
            trials,
        }
    }
}

/// Both uncertainties combined, as if independent.
fn widened(middle: f64, [lo, hi]: [f64; 2], other: [f64; 2]) -> [f64; 2] {
    let down = (middle - lo).hypot(middle - other[0]);
    let up = (hi - middle).hypot(other[1] - middle);
    [(middle - down).max(0.0), (middle + up).min(1.0)]
}

/// Number of plain motions whose Wilson interval at this probability is as wide as this one.
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

/// Results of a stratum, batch by batch.
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

    fn seen(&self, share: f64, members: usize, total: usize, sizes: &[usize]) -> StratumCounts {
        let mut seen = StratumCounts::new(share);
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

    /// Weight of a pose of a batch, in the stratum.
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Two strata of 900 and 100 errors, of which the second runs out.
    #[test]
    fn weights_are_the_shares_that_poses_represent() {
        let labels = (0..1000).map(|k| u8::from(k % 10 == 0)).collect();
        let mut drawn = DrawnErrors::new(labels, false);
        for given in [[20, 60], [30, 60]] {
            let numbered = drawn.batch(&given);
            let docks = |(place, _): &(usize, u64)| {
                if *place == 0 { Outcome::Aligned } else { Outcome::Jammed }
            };
            let outcomes: Vec<Outcome> = numbered.iter().map(docks).collect();
            drawn.take(given[0] + given[1], &numbered, &outcomes);
        }
        let whole = CombinedShares::of(&drawn.seen(), drawn.total());
        let sample = drawn.sample(&whole, None);
        // All of the 100, and 50 of the 900.
        assert_eq!(sample.motions, 150);
        let weight: f64 = sample.poses.iter().map(|pose| pose.weight).sum();
        assert!((weight - 1.0).abs() < 1e-12 && (sample.probability - 0.9).abs() < 1e-12);
        assert!(sample.ci95[0] < 0.9 && 0.9 < sample.ci95[1]);
        let jammed = sample.poses.iter().filter(|pose| pose.outcome == Outcome::Jammed);
        assert!(
            jammed.clone().count() == 100 && jammed.map(|pose| pose.weight).all(|w| (w - 1e-3).abs() < 1e-15)
        );
    }

    #[test]
    fn plain_motions_invert_the_wilson_interval() {
        for (probability, count) in [(0.5, 1000.0), (0.99, 40_000.0), (1.0, 250.0)] {
            let result = plain_motions(probability, wilson95(probability, count));
            assert!((result / count - 1.0).abs() < 1e-6, "{result} for {count}");
        }
    }
}
