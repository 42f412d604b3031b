//! `catchment rests --jams`: rests that do not dock, and the features in contact. Alias `catchment jams`.

use super::rests::{CauseArgs, SearchArgs};
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::result_args::study;
use catchment::problem::Problem;
use catchment::report::{JamsReport, figure};
use catchment::run::jams::{JamsSettings, run as find, run_for as find_for};
use clap::Args;

/// Find the jams and their causes: old name of `rests --jams`
///
/// Prints the rests that do not dock, with their contacts, stability and escape paths. `catchment help rests` describes them.
#[derive(Debug, Args)]
#[command(after_long_help = "Example:\n  catchment rests design.toml --jams -o jams.png")]
pub(crate) struct JamsArgs {
    #[command(flatten)]
    pub(super) search: SearchArgs,
    #[command(flatten)]
    cause: CauseArgs,
}

pub(crate) fn run(args: &JamsArgs) -> Result<ExitStatus, Failure> {
    of(&args.search, &args.cause)
}

/// Finds, prints and stores the jams.
pub(super) fn of(search: &SearchArgs, cause: &CauseArgs) -> Result<ExitStatus, Failure> {
    let draw = |report: &JamsReport, problem: &Problem| {
        Ok(figure::jams(&report.design, &report.result, problem.connector())?)
    };
    let settings = JamsSettings {
        motions: search.samples(),
        seed: search.seed,
        errors: None,
        examined: search.examined(),
        friction: cause.friction,
        resolution: search.resolution,
        certified: search.certified,
    };
    study(&search.design, &search.result, &search.exec, Some(draw), |problem, exec| {
        match cause.errors.spread(problem.design())? {
            Some(spread) => Ok(find_for(problem, &settings, &spread, exec)?),
            None => Ok(find(problem, &settings, exec)?),
        }
    })
}
