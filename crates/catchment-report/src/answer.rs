//! The report of a run's result, and the check of its requirements.

use super::Report;
use super::envelope::{ReportBody, ReportEnvelope};
use super::json_schema;
use super::schema::{PartitionReport, RunBody, Timing, WatershedsReport, WindowSection};
use catchment_core::acceptance::Domain;
use catchment_core::pose::DofSet;
use catchment_core::problem::Problem;
use catchment_core::run::{Answer, Over, Requirement, RequirementCheck, RequirementError, Run, RunError};
use serde::Serialize;
use serde_json::Value;

impl Report {
    /// Everything that a run found.
    pub fn of_answer(answer: &Answer) -> Self {
        let timing = Timing { total_s: answer.seconds, threads: answer.threads };
        let (design, acceptance) = (answer.problem.design(), &answer.acceptance);
        let mut report =
            Report::from_merits(design, acceptance, &answer.merits, answer.settings.clone(), Some(timing));
        if let Some(corrected) = &answer.corrected {
            report = report.with_sample(corrected);
        }
        if let Some(basins) = &answer.by_products.basins {
            report = report.with_basins(acceptance, basins);
        }
        report.watersheds = answer.by_products.watersheds.as_ref().map(WatershedsReport::new);
        if let Some(partition) = &answer.by_products.partition {
            report.partition = Some(PartitionReport::new(partition));
        }
        report = match answer.by_products.certificate {
            Some(result) => report.with_certificate(result),
            None => report,
        };
        report.inherited = answer.by_products.inherited;
        report.success.clone_from(&answer.success);
        report.upright.clone_from(&answer.upright);
        report.jams.clone_from(&answer.jams);
        report.window =
            answer.window.as_ref().and_then(|result| result.as_ref().ok()).map(WindowSection::from);
        report.seat = Some(answer.seating.clone());
        report.warnings = answer.warnings();
        report
    }
}

impl<T: ReportBody + Serialize> ReportEnvelope<T> {
    /// Every requirement, evaluated on this report.
    ///
    /// # Errors
    /// The report has no such place, or no number there.
    pub fn verdicts(&self, requirements: &[Requirement]) -> Result<Vec<RequirementCheck>, RequirementError> {
        let value = serde_json::to_value(self).unwrap_or(Value::Null);
        requirements.iter().map(|requirement| requirement.judge(&value)).collect()
    }
}

/// Reason why a requirement of a run cannot be evaluated.
#[derive(Debug, thiserror::Error)]
pub enum UnanswerableError {
    /// The run itself cannot be made.
    #[error(transparent)]
    Run(#[from] RunError),
    /// No report of the run has such a number.
    #[error("'{requirement}': {error}")]
    Requirement {
        /// Which requirement.
        requirement: String,
        /// Why not.
        error: RequirementError,
    },
}

/// Rejects a requirement that no report of this run on a problem can answer, before anything is computed: the
/// schema of reports defines the possible places, the run the empty ones.
///
/// # Errors
/// The first requirement without an answer.
pub fn check_requirements(run: &Run, problem: &Problem) -> Result<(), UnanswerableError> {
    let Some(schema) = json_schema::of_kind(RunBody::KIND).filter(|_| !run.requirements.is_empty()) else {
        return Ok(());
    };
    let absent = absent(run, problem)?;
    for requirement in &run.requirements {
        requirement.check(&schema, &absent).map_err(|error| UnanswerableError::Requirement {
            requirement: requirement.to_string(),
            error,
        })?;
    }
    Ok(())
}

/// The places that are null in the report of this run.
fn absent(run: &Run, problem: &Problem) -> Result<Vec<&'static str>, RunError> {
    let plan = run.plan(problem)?;
    let by_products = run.method.by_products();
    let is_grid = matches!(run.over, Over::Grid(_)) || matches!(plan.domain, Domain::Grid(_));
    let places = [
        ("onaa", is_grid),
        ("centered", is_grid),
        ("upright", problem.alignment().free == DofSet::ALL),
        ("success", run.errors.is_some()),
        ("jams", run.jams),
        ("window", run.window),
        ("acceptance.sample", plan.sample.is_some()),
    ];
    let places = places.into_iter().filter(|(_, is_there)| !is_there).map(|(place, _)| place);
    let products = ["basins", "watersheds", "inherited", "partition", "certificate"];
    Ok(places.chain(products.into_iter().filter(|name| !by_products.contains(name))).collect())
}
