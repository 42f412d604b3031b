//! The Sum corrected by exact descents: an estimate that owes its truth to no grid.
//!
//! A sample turns the report's Sum from the measure of the accepted cells into the unbiased estimate of
//! [`crate::method::correction`], with its interval. The measure of the cells stays beside it.

use super::Report;
use crate::method::correction::Stratum;
use crate::run::Corrected;
use serde::{Deserialize, Serialize};

/// Random poses, followed exactly, that the Sum and its interval come from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
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
    /// Replaces the Sum by the corrected one.
    #[must_use]
    pub fn with_sample(mut self, corrected: &Corrected) -> Self {
        let acceptance = &mut self.acceptance;
        let Corrected { found, seed, method, settings } = corrected;
        acceptance.sum = found.sum;
        acceptance.sum_ci95 = Some(found.ci95);
        acceptance.fraction = found.fraction;
        acceptance.sample = Some(SampleReport {
            method: (*method).to_owned(),
            settings: settings.clone(),
            seed: *seed,
            descents: found.descents,
            strata: found.strata.clone(),
        });
        self
    }
}
