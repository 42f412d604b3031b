//! The report of an answer, and whether it meets the requirements of its run.

use super::envelope::{Body, Envelope};
use super::schema::{PartitionReport, SuccessReport, Timing, UprightReport, WarningReport, WatershedsReport};
use super::{JamsFound, Report, WindowSection};
use catchment_core::acceptance::{Acceptance, Domain, Outcome, Warning};
use catchment_core::exec::Exec;
use catchment_core::landscape::{Grid, Landscape, Resolution};
use catchment_core::merit::Merits;
use catchment_core::method::certified::Certificate;
use catchment_core::method::confluence::Joined;
use catchment_core::method::correction::{self, ByNeighbours, Stop};
use catchment_core::method::flood;
use catchment_core::pose::DofSet;
use catchment_core::problem::Problem;
use catchment_core::run::jams::Jams;
use catchment_core::run::window::Window;
use catchment_core::run::{
    Answer, Corrected, Over, Requirement, RequirementError, Run, RunError, Seating, Verdict,
};
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
            Some(found) => report.with_certificate(found),
            None => report,
        };
        report.joined = answer.by_products.joined;
        if let (Some(distribution), Some(success)) = (&answer.run.errors, &answer.success) {
            report.success = Some(SuccessReport::new(distribution.clone(), success));
        }
        report.upright = answer.upright.as_ref().map(UprightReport::from);
        report.jams = answer.jams.as_ref().map(|found| JamsFound::new(answer.problem.design(), found));
        report.window = answer.window.as_ref().and_then(|found| found.as_ref().ok()).map(WindowSection::from);
        report.seat = Some(answer.seating.clone());
        report.warnings = answer.warnings().into_iter().map(WarningReport::from).collect();
        report
    }
}

impl<T: Body + Serialize> Envelope<T> {
    /// Every requirement, judged by this report.
    ///
    /// # Errors
    /// The report has no such place, or no number there.
    pub fn verdicts(&self, requirements: &[Requirement]) -> Result<Vec<Verdict>, RequirementError> {
        let value = serde_json::to_value(self).unwrap_or(Value::Null);
        requirements.iter().map(|requirement| requirement.judge(&value)).collect()
    }
}

/// Why a requirement of a run cannot be judged.
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

/// Refuses a requirement that no report of this run on a problem can answer, before anything is computed: they are tried on a
/// report of the same form, over the smallest grid.
///
/// # Errors
/// The first requirement without an answer.
pub fn check_requirements(run: &Run, problem: &Problem) -> Result<(), UnanswerableError> {
    if run.requirements.is_empty() {
        return Ok(());
    }
    let report = serde_json::to_value(form_of_report(run, problem)?).unwrap_or(Value::Null);
    for requirement in &run.requirements {
        requirement.judge(&report).map_err(|error| UnanswerableError::Requirement {
            requirement: requirement.to_string(),
            error,
        })?;
    }
    Ok(())
}

/// A report with every place that one of this run will have, and numbers that mean nothing.
fn form_of_report(run: &Run, problem: &Problem) -> Result<Report, RunError> {
    let plan = run.plan(problem)?;
    let exec = Exec::new();
    let domain = match plan.domain {
        // Whatever answers in the place of a grid tells the same of it.
        _ if matches!(run.over, Over::Grid(_)) => {
            Domain::Grid(Grid::over(problem.alignment(), |_| Resolution::LEAST))
        }
        Domain::Grid(grid) => Domain::Grid(grid),
        Domain::Poses(poses) => Domain::Poses(poses.into_iter().take(1).collect()),
    };
    let outcomes = vec![Outcome::Aligned; domain.len()];
    let method = run.method.name();
    let acceptance = Acceptance { method, domain, outcomes, warnings: Vec::<Warning>::new() };
    let merits = Merits::of(&acceptance, problem.alignment(), &exec)?;
    let settings = run.method.settings_for(problem);
    let timing = Some(Timing { total_s: 0.0, threads: 1 });
    let mut report = Report::from_merits(problem.design(), &acceptance, &merits, settings, timing);
    if let (Some(sample), Some(grid)) = (plan.sample, acceptance.grid()) {
        let by = ByNeighbours::new(&acceptance.outcomes, grid.shape());
        let one = correction::Settings { stop: Stop::Samples(1), ..sample };
        let aligned = |poses: Vec<_>, _: &_| Ok(vec![Outcome::Aligned; poses.len()]);
        let found = correction::estimate(grid, &by, &one, &exec, aligned)?;
        let settings = Value::Null;
        report = report.with_sample(&Corrected { found, seed: sample.seed, method, settings });
    }
    if problem.alignment().free == DofSet::ALL {
        let tolerances = report.tolerances.clone();
        report.upright = report.centered.clone().map(|window| UprightReport { window, tolerances });
    }
    report.seat = Some(Seating::form(problem));
    if run.window {
        report.window = Some(WindowSection::from(&Window::form(problem)));
    }
    if run.jams {
        report.jams = Some(JamsFound::new(problem.design(), &Jams::form(&run.jams_settings())));
    }
    let by_products = run.method.by_products();
    if let (true, Some(grid)) = (by_products.contains(&"basins"), acceptance.grid()) {
        // So few cells are flooded in no time.
        let landscape = Landscape::compute(problem.pair(), grid, &exec)?;
        let flooding =
            flood::flood(&landscape, problem.alignment(), &|_| true, &flood::Settings::default(), &exec);
        if let Ok(flooding) = flooding {
            report = report.with_basins(&acceptance, &flooding.hierarchy);
        }
    }
    if by_products.contains(&"watersheds") {
        report.watersheds = Some(WatershedsReport::default());
    }
    if by_products.contains(&"joined") {
        report.joined = Some(Joined::default());
    }
    if by_products.contains(&"partition") {
        report.partition = Some(PartitionReport::default());
    }
    if by_products.contains(&"certificate") {
        // Of every place a number, so that all can be asked for.
        report.certificate = Some(Certificate { retention_at_most: Some(0.0), ..Certificate::default() });
    }
    if let Some(distribution) = &run.errors {
        report = report.with_success(&acceptance, distribution.clone(), &exec)?;
    }
    Ok(report)
}
