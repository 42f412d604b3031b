//! `catchment classify`: a design among the published connectors.

use crate::args::DesignArgs;
use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::result_args::{ResultArgs, no_picture};
use catchment::document::Subject;
use catchment_systems::catalog::report::ClassifyBody;
use catchment_systems::catalog::{Catalog, classify as classified};
use clap::Args;

/// Classify a design among published connectors
///
/// Prints the self-aligning degree by the published rule, from the zero-rotation area of acceptance of the design; its gendering; and its
/// area and largest inscribed square beside the published values.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  catchment classify design.toml
  catchment classify design.toml --json | jq .degree
  catchment catalog --append design.toml
      as a row of the catalogue")]
pub(crate) struct ClassifyArgs {
    #[command(flatten)]
    pub(super) design: DesignArgs,
    #[command(flatten)]
    result: ResultArgs,
    #[command(flatten)]
    exec: ExecArgs,
}

pub(crate) fn run(args: &ClassifyArgs) -> Result<ExitStatus, Failure> {
    let output = args.result.check(ClassifyBody::KIND, false)?;
    let catalog = Catalog::published()?;
    let problem = args.design.halves()?;
    let running = args.exec.start()?;
    let results = classified(&problem, &running.exec)?;
    drop(running);
    let report = ClassifyBody::report(problem.design(), &results, &catalog);
    output.finish(&report, || Err(no_picture()))
}
