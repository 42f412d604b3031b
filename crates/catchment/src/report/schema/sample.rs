//! The Sum corrected by exact descents: an estimate that owes its truth to no grid.
//!
//! A sample turns the report's Sum from the measure of the accepted cells into the unbiased estimate of
//! [`crate::method::correction`], with its interval. The measure of the cells stays beside it, and becomes a doubt
//! where it lies outside the interval; one time in twenty, the sample is at fault.

use super::{Report, WarningReport};
use crate::acceptance::Warning;
use crate::method::correction::{Corrected, Stratum};
use crate::report::Envelope;
use serde::{Deserialize, Serialize};

/// Random poses, followed exactly, that the Sum and its interval come from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SampleReport {
    /// Name of the method that followed them.
    pub method: String,
    /// Its settings.
    pub settings: serde_json::Value,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Poses followed.
    pub descents: usize,
    /// Where they lay.
    pub strata: Vec<Stratum>,
}

impl Report {
    /// Replaces the Sum by the corrected one. `settings` are those of the descents, `seed` that of their poses.
    #[must_use]
    pub fn with_sample(mut self, corrected: &Corrected, seed: u64, settings: serde_json::Value) -> Self {
        let Envelope { body, warnings, .. } = &mut self;
        let acceptance = &mut body.acceptance;
        let Corrected { sum, ci95, fraction, descents, .. } = *corrected;
        let sum_grid = acceptance.sum_grid;
        if !(ci95[0]..=ci95[1]).contains(&sum_grid) {
            warnings.push(WarningReport::from(Warning::OutsideSample { sum_grid, ci95 }));
        }
        acceptance.sum = sum;
        acceptance.sum_ci95 = Some(ci95);
        acceptance.fraction = fraction;
        acceptance.sample = Some(SampleReport {
            // Drop tests are corrected by drop tests, everything else by descents.
            method: if body.method == "drop" { "drop" } else { "descent" }.to_owned(),
            settings,
            seed,
            descents,
            strata: corrected.strata.clone(),
        });
        self
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{blob, design};
    use super::*;
    use crate::exec::Exec;
    use crate::pose::{Dof, DofSet};

    fn corrected(sum: f64) -> Corrected {
        let stratum = Stratum {
            name: "all".to_owned(),
            share: 1.0,
            descents: 9,
            aligned: 4,
            undecided: 1,
            accepted: 0.4,
        };
        Corrected {
            sum,
            ci95: [sum - 0.1, sum + 0.2],
            fraction: sum / 4.0,
            descents: 9,
            plain_descents: 9.0,
            strata: vec![stratum],
        }
    }

    #[test]
    fn the_sum_is_the_corrected_one_and_cells_outside_its_interval_are_a_doubt() {
        let design = design(DofSet::EMPTY.with(Dof::X).with(Dof::Y));
        let report =
            Report::new(&design, &blob(&design, 40), serde_json::Value::Null, None, &Exec::new()).unwrap();
        let (before, cells) = (report.warnings.len(), report.acceptance.sum);
        for (sum, doubts) in [(cells + 0.05, 0), (cells + 0.15, 1)] {
            let report = report.clone().with_sample(&corrected(sum), 5, serde_json::Value::Null);
            assert_eq!(report.warnings.len() - before, doubts);
            assert_eq!((report.acceptance.sum, report.acceptance.sum_grid), (sum, cells));
            assert_eq!(report.acceptance.fraction, sum / 4.0);
            assert_eq!(report.acceptance.sum_ci95, Some([sum - 0.1, sum + 0.2]));
            let sample = report.body.acceptance.sample.unwrap();
            assert_eq!((sample.seed, sample.descents, sample.strata[0].aligned), (5, 9, 4));
        }
    }
}
