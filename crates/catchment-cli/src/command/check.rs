//! `catchment check`: everything that is wrong with a design, with its place in the file.

use crate::args::DesignArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::output::to_stdout;
use catchment::problem::{Draft, Problem, ProblemError};
use catchment::report::CheckReport;
use clap::Args;

/// Check a design file: all problems at once, with their places
#[derive(Debug, Args)]
#[command(after_long_help = "Examples:\n  \
    catchment check design.toml\n  \
    catchment check design.toml --json | jq .problems")]
pub(crate) struct CheckArgs {
    #[command(flatten)]
    design: DesignArgs,
    /// Print problems, or the design as understood, as JSON
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(args: &CheckArgs) -> Result<ExitStatus, Failure> {
    let checked = args.design.draft().and_then(Draft::build).and_then(Problem::checked);
    if !args.json {
        to_stdout(&CheckReport::good(&checked?).table())?;
        return Ok(ExitStatus::Done);
    }
    let (report, status) = match checked {
        Ok(problem) => (CheckReport::good(&problem), ExitStatus::Done),
        Err(ProblemError::Findings(findings)) => (CheckReport::bad(&findings), ExitStatus::Failed),
        Err(error @ ProblemError::Load(_)) => return Err(error.into()),
    };
    to_stdout(&report.to_json()?)?;
    Ok(status)
}
