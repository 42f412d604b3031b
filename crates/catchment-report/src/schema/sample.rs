//! The Sum corrected by exact motions: an estimate that does not depend on the accuracy of the grid.
//!
//! A sample changes the report's Sum from the measure of the accepted cells to the unbiased estimate of
//! [`catchment_core::method::correction`], with its interval. The measure of the cells is still reported.

use super::Report;
use catchment_core::method::certified::BoxCertificate;
use catchment_core::method::correction::Stratum;
use catchment_core::run::RunCorrection;
use serde::{Deserialize, Serialize};

/// Sampled poses, followed exactly, behind the Sum and its interval.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SampleReport {
    /// Name of the method that followed them.
    pub method: String,
    /// Its settings.
    pub settings: serde_json::Value,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Number of poses followed.
    pub descents: usize,
    /// Share of the error box that the grid misclassifies, accepted or not, in [0, 1]; 1 in reports of older
    /// versions.
    #[serde(default = "unknown", alias = "differing")]
    pub misclassified: f64,
    /// Its 95 % interval.
    #[serde(default = "open", alias = "differing_ci95")]
    pub misclassified_ci95: [f64; 2],
    /// The strata.
    pub strata: Vec<Stratum>,
}

const fn unknown() -> f64 {
    1.0
}

const fn open() -> [f64; 2] {
    [0.0, 1.0]
}

impl Report {
    /// Adds certified bounds: the Sum is at least the certified measure, and at most that plus the undecided
    /// measure.
    #[must_use]
    pub(crate) fn with_certificate(mut self, estimate: BoxCertificate) -> Self {
        let [docks, _, open] = estimate.measures;
        let acceptance = &mut self.body.acceptance;
        acceptance.sum_bracket = Some([docks, docks + open]);
        if acceptance.sample.is_none() {
            (acceptance.sum, acceptance.fraction) = (docks, estimate.yes);
        }
        self.body.certificate = Some(estimate);
        self
    }

    /// Replaces the Sum by the corrected Sum.
    #[must_use]
    pub fn with_sample(mut self, corrected: &RunCorrection) -> Self {
        let acceptance = &mut self.body.acceptance;
        let RunCorrection { estimate, seed, method, settings } = corrected;
        acceptance.sum = estimate.sum;
        acceptance.sum_ci95 = Some(estimate.ci95);
        acceptance.fraction = estimate.fraction;
        acceptance.sample = Some(SampleReport {
            method: (*method).to_owned(),
            settings: settings.clone(),
            seed: *seed,
            descents: estimate.descents,
            misclassified: estimate.misclassified,
            misclassified_ci95: estimate.misclassified_ci95,
            strata: estimate.strata.clone(),
        });
        self
    }
}
