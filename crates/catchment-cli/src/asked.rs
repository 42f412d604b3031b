//! What is asked of a report on the command line: that requirements hold of it, and how it is told.

use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::output::{to_stderr, to_stdout};
use catchment::report::{Body, Envelope};
use catchment::run::Requirement;
use catchment::terminal::escaped;
use clap::Args;
use serde::Serialize;

/// How a report is told, and what must hold of it.
#[derive(Debug, Args)]
pub(crate) struct AskedArgs {
    /// Print JSON, in D and radians
    #[arg(long)]
    json: bool,
    /// End with exit code 1 unless this holds of the JSON report; may be repeated
    #[arg(long, value_name = "PATH OP NUMBER", value_parser = requirement)]
    require: Vec<Requirement>,
}

/// Reads a requirement.
pub(crate) fn requirement(text: &str) -> Result<Requirement, String> {
    text.parse::<Requirement>().map_err(|error| escaped(&error.to_string()))
}

impl AskedArgs {
    /// Refuses requirements that a report of this form cannot answer, before anything is computed.
    pub(crate) fn check<B: Body + Serialize>(&self, form: &Envelope<B>) -> Result<(), Failure> {
        for requirement in &self.require {
            let tried = form.verdicts(std::slice::from_ref(requirement));
            tried.map_err(|error| Failure::with_help(format!("--require '{requirement}': {error}"), None))?;
        }
        Ok(())
    }

    /// Prints a report, as JSON or as its table, and says what does not hold of it.
    pub(crate) fn tell<B: Body + Serialize>(
        &self,
        report: &Envelope<B>,
        table: impl FnOnce(&Envelope<B>) -> String,
    ) -> Result<ExitStatus, Failure> {
        to_stdout(&if self.json { report.to_json()? } else { table(report) })?;
        let verdicts = report.verdicts(&self.require)?;
        let unmet: Vec<String> =
            verdicts.iter().filter(|verdict| !verdict.met).map(ToString::to_string).collect();
        to_stderr(&unmet);
        Ok(if unmet.is_empty() { ExitStatus::Done } else { ExitStatus::RequirementNotMet })
    }
}
