//! `catchment check`: everything that is wrong with a design, with its place in the file.

use crate::args::DesignArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::geometry::Built;
use crate::output::to_stdout;
use crate::source::{Finding, InputError, SourceText};
use catchment::report::{CheckReport, Place, ProblemReport};
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
    let checked = checked(&args.design);
    if args.json {
        let (report, status) = match checked {
            Ok(built) => (good(&built), ExitStatus::Done),
            Err(InputError::Findings { source, findings, omitted }) => {
                let problems = findings.into_iter().map(|finding| problem(&source, finding)).collect();
                (CheckReport::bad(source.path(), problems, omitted), ExitStatus::Failed)
            }
            Err(error @ InputError::Load(_)) => return Err(error.into()),
        };
        to_stdout(&report.to_json()?)?;
        return Ok(status);
    }
    to_stdout(&good(&checked?).table())?;
    Ok(ExitStatus::Done)
}

/// Every check of a design, each on what the one before let through: its file, the changes, the geometry of
/// its halves, and the pose in which they mate.
fn checked(args: &DesignArgs) -> Result<Built, InputError> {
    let built = args.build()?;
    let findings = built.mated_findings();
    if findings.is_empty() { Ok(built) } else { Err(built.input.refused(findings)) }
}

fn good(Built { input, connector }: &Built) -> CheckReport {
    let design = &input.design;
    CheckReport::good(input.source.path(), design, connector.ungendered(design.alignment.mount))
}

fn problem(source: &SourceText, Finding { message, help, span }: Finding) -> ProblemReport {
    let place = span.map(|span| {
        let (line, column) = source.line_column(span.start);
        Place { line, column, bytes: [span.start, span.end] }
    });
    ProblemReport { message, help, place }
}
