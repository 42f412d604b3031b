//! `catchment check`: every defect of a design, with its place in the file.

use crate::args::DesignArgs;
use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::result_args::{ResultArgs, no_picture};
use catchment::problem::ProblemError;
use catchment::report::{CheckBody, CheckReport, ReportBody, figure};
use clap::Args;

/// Check a design file and report every problem with its place
///
/// Prints how the design was read. For halves from files it also prints the face centre and the centre of rotation in the coordinates of
/// each file. -o draws the two halves, apart and mated.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  catchment check design.toml
  catchment check design.toml -o pair.svg
      with a picture of the halves (.svg, .png)
  catchment check design.toml --json | jq .problems")]
pub(crate) struct CheckArgs {
    #[command(flatten)]
    pub(super) design: DesignArgs,
    #[command(flatten)]
    result: ResultArgs,
    #[command(flatten)]
    exec: ExecArgs,
}

pub(crate) fn run(args: &CheckArgs) -> Result<ExitStatus, Failure> {
    let output = args.result.check(CheckBody::KIND, true)?;
    let running = args.exec.start()?;
    if output.wants_picture() {
        figure::ensure_fits(0, &running.exec)?;
    }
    running.may_be_left();
    let (checked, problem) =
        match args.design.draft_on(&running.exec).and_then(|draft| draft.judged_on(&running.exec)) {
            Ok((problem, None)) => (problem.clone().checked(), Some(problem)),
            // Also for halves whose mated pose is rejected: the picture shows why.
            Ok((problem, Some(diagnostics))) => (Err(diagnostics.into()), Some(problem)),
            Err(error) => (Err(error), None),
        };
    running.exec.check()?;
    drop(running);
    let picture = || match &problem {
        Some(problem) => Ok(figure::pair(problem)?),
        None => Err(no_picture()),
    };
    match checked {
        Ok(problem) => output.finish(&CheckReport::good(&problem), picture),
        Err(ProblemError::Diagnostics(diagnostics)) if args.result.is_json() => {
            let output = if problem.is_some() { output } else { output.without_picture() };
            output.finish(&CheckReport::bad(&diagnostics), picture)?;
            Ok(ExitStatus::BadInput)
        }
        Err(error) => {
            if problem.is_some() {
                output.draw(picture)?;
            }
            Err(error.into())
        }
    }
}
