//! `catchment check`: everything that is wrong with a design, with its place in the file.

use crate::args::DesignArgs;
use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::output::{FileArgs, image, to_stdout};
use catchment::problem::ProblemError;
use catchment::report::{CheckReport, figure};
use clap::Args;

/// Check a design file: all problems at once, with their places
///
/// Where nothing is wrong it says how the design was understood: of halves from files also where the face centre and the centre of rotation
/// are in the coordinates of each file. With -o it draws the two halves, apart and mated.
#[derive(Debug, Args)]
#[command(after_long_help = "Examples:\n  \
    catchment check design.toml\n  \
    catchment check design.toml -o pair.svg       with a picture of the halves (.svg, .png)\n  \
    catchment check design.toml --json | jq .problems")]
pub(crate) struct CheckArgs {
    #[command(flatten)]
    pub(super) design: DesignArgs,
    /// Print problems, or the design as understood, as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    file: FileArgs,
    #[command(flatten)]
    exec: ExecArgs,
}

pub(crate) fn run(args: &CheckArgs) -> Result<ExitStatus, Failure> {
    let kind = args.file.kind(&["svg", "png"])?;
    let running = args.exec.start()?;
    if kind.is_some() {
        figure::ensure_fits(0, &running.exec)?;
    }
    running.may_be_left();
    let judged = args.design.draft_on(&running.exec).and_then(|draft| draft.judged_on(&running.exec));
    // Also of halves that are refused for their mated pose: a picture shows why.
    let picture = match (kind, &judged) {
        (Some(kind), Ok((problem, _))) => Some(image(&figure::pair(problem)?, kind)?),
        _ => None,
    };
    let checked = judged.and_then(|(problem, refusal)| match refusal {
        None => problem.checked(),
        Some(findings) => Err(findings.into()),
    });
    running.exec.check()?;
    drop(running);
    if let Some(bytes) = picture {
        args.file.write(&bytes)?;
    }
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
