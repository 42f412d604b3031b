//! Random poses beside a grid: an error bar that knows nothing of cells.
//!
//! The poses are drawn uniformly from the error box and followed exactly, so the share of those that align is an
//! unbiased measure of the accepted set, with Wilson's interval. A grid whose Sum lies outside is too coarse, or
//! its method biased; one time in twenty, the sample is at fault.

use super::{Outcomes, Report, WarningReport};
use crate::acceptance::{Acceptance, Warning};
use crate::merit::sum::Sum;
use serde::{Deserialize, Serialize};

/// Random poses followed beside a grid.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SampleReport {
    /// Name of the method that followed them.
    pub method: String,
    /// Its settings.
    pub settings: serde_json::Value,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Poses drawn.
    pub poses: usize,
    /// Measure of the accepted set by their share, in the unit of the grid's.
    pub sum: f64,
    /// How many met each outcome.
    pub outcomes: Outcomes,
}

impl Report {
    /// Adds poses drawn at random by [`Domain::random`](crate::acceptance::Domain::random) from `seed`; `settings`
    /// are those of the method that followed them. A grid's Sum outside their interval becomes a doubt.
    #[must_use]
    pub fn with_sample(mut self, sample: &Acceptance, seed: u64, settings: serde_json::Value) -> Self {
        let found = Sum::of(sample, &self.design.alignment);
        let poses = found.tried;
        if let Some(ci95 @ [lo, hi]) = found.ci95.filter(|_| poses > 0) {
            let sum = self.acceptance.sum;
            if !(lo..=hi).contains(&sum) {
                self.warnings.push(WarningReport::from(Warning::OutsideSample { sum, ci95, poses }));
            }
            self.acceptance.sum_ci95 = Some(ci95);
        }
        self.acceptance.sample = Some(SampleReport {
            method: sample.method.to_owned(),
            settings,
            seed,
            poses,
            sum: found.sum,
            outcomes: Outcomes::new(found.counts),
        });
        self
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{blob, design};
    use super::*;
    use crate::acceptance::{Domain, Outcome};
    use crate::exec::Exec;
    use crate::pose::{Dof, DofSet};

    /// 1000 poses of which `aligned` are.
    fn sample(aligned: usize) -> Acceptance {
        let design = design(DofSet::EMPTY.with(Dof::X).with(Dof::Y));
        let outcome = |k| if k < aligned { Outcome::Aligned } else { Outcome::Jammed };
        Acceptance {
            method: "descent",
            domain: Domain::random(&design.alignment, 1000, 5),
            outcomes: (0..1000).map(outcome).collect(),
            warnings: Vec::new(),
        }
    }

    #[test]
    fn a_sum_outside_the_interval_is_a_doubt_and_one_inside_is_none() {
        let design = design(DofSet::EMPTY.with(Dof::X).with(Dof::Y));
        let grid = blob(&design, 40);
        let share = grid.counts()[0] as f64 / grid.outcomes.len() as f64;
        for (aligned, doubts) in [((1000.0 * share) as usize, 0), ((800.0 * share) as usize, 1)] {
            let report = Report::new(&design, &grid, serde_json::Value::Null, None, &Exec::new()).unwrap();
            let before = report.warnings.len();
            let report = report.with_sample(&sample(aligned), 5, serde_json::Value::Null);
            assert_eq!(report.warnings.len() - before, doubts);
            let [lo, hi] = report.acceptance.sum_ci95.unwrap();
            let found = report.acceptance.sample.unwrap();
            assert!(lo < found.sum && found.sum < hi && (found.sum - aligned as f64 * 4e-3).abs() < 1e-12);
            assert_eq!((found.outcomes.jammed, found.seed), (1000 - aligned, 5));
        }
    }

    #[test]
    fn an_empty_sample_says_nothing() {
        let design = design(DofSet::EMPTY.with(Dof::X));
        let mut none = sample(0);
        (none.domain, none.outcomes) = (Domain::Poses(Vec::new()), Vec::new());
        let report =
            Report::new(&design, &blob(&design, 9), serde_json::Value::Null, None, &Exec::new()).unwrap();
        let report = report.with_sample(&none, 5, serde_json::Value::Null);
        assert_eq!(report.acceptance.sum_ci95, None);
    }
}
