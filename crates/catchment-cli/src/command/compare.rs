//! `catchment compare`: overlap and differences of two acceptances.
//!
//! ```text
//!   A  design ──▶ computed by a method ─┐
//!      folder of `run -o` ──▶ read ─────┼──▶ common cells ──▶ overlap, confusions, distances, picture
//!   B  likewise, or A again ────────────┘
//! ```

use super::run::resolution;
use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::method_args::method_parser;
use crate::output::to_stderr;
use crate::result_args::{Pictures, ResultArgs};
use crate::source::open_design;
use catchment::landscape::Resolution;
use catchment::method::Method;
use catchment::report::compare::{ComparisonResult, ComparisonSource, compare};
use catchment::report::figure::FigureError;
use catchment::report::{ComparisonBody, ReportBody};
use catchment::run::Run;
use clap::Args;
use std::path::PathBuf;

/// Compare two methods, two designs or two results
///
/// Prints the overlap (Jaccard index), Sum and ONAA side by side, the confusion of outcomes, and the distance of the differences from the
/// border of A. Both need the same error box and the same cells, or cells that are finer by an odd factor.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  catchment compare design.toml --methods descent,flood
  catchment compare old.toml new.toml -o out
      two designs, with a picture
  catchment compare out design.toml --methods descent
      a stored result against a fresh one
  catchment compare a.zarr b.zarr --json | jq .comparison.jaccard")]
pub(crate) struct CompareArgs {
    /// Design (- reads stdin), folder written by `run -o`, or its NAME.zarr
    #[arg(value_name = "A", value_hint = clap::ValueHint::AnyPath)]
    first: PathBuf,
    /// The second; without it, --methods names two methods for A
    #[arg(value_name = "B", value_hint = clap::ValueHint::AnyPath)]
    second: Option<PathBuf>,
    /// Method of each design, in order; a single method applies to both [default: confluence]
    #[arg(long, value_name = "METHOD", value_delimiter = ',', value_parser = method_parser())]
    methods: Vec<Method>,
    /// Cells per axis, such as 30 or x=40,yaw=24 [default: those of the stored result, or by number of axes]
    #[arg(long, value_name = "CELLS", value_parser = resolution)]
    resolution: Option<Resolution>,
    #[command(flatten)]
    result: ResultArgs,
    #[command(flatten)]
    exec: ExecArgs,
}

/// Name of the table and the picture in a folder.
const NAME: &str = "difference";

pub(crate) fn run(args: &CompareArgs) -> Result<ExitStatus, Failure> {
    let output = args.result.check_named(ComparisonBody::KIND, NAME)?;
    let sources = sources(args)?;
    let running = args.exec.start()?;
    let exec = &running.exec;
    let ComparisonResult { report, picture } =
        compare(sources, args.resolution, output.wants_picture(), exec)?;
    let pictures = match picture {
        Some(Ok(picture)) => vec![(NAME, picture)],
        Some(Err(FigureError::Empty { what })) => {
            running.beside_bar(|| to_stderr(&[format!("no picture: {what}")]));
            Pictures::new()
        }
        Some(Err(error)) => return Err(error.into()),
        None => Pictures::new(),
    };
    let notes = output.write(&report, || Ok(pictures), |_| Ok(String::new()), exec)?;
    drop(running);
    output.print(&report, &notes)
}

/// The sources A and B, with the method for each design.
fn sources(args: &CompareArgs) -> Result<[ComparisonSource; 2], Failure> {
    let refused =
        |message: &str, help: &str| Err(Failure::with_help(message.to_owned(), Some(help.to_owned())));
    let paths = [&args.first, args.second.as_ref().unwrap_or(&args.first)];
    let stored = paths.map(|path| path.is_dir());
    if args.second.is_none() && (stored[0] || args.methods.len() != 2) {
        let help = "name a second design or result, or the two methods: --methods descent,flood";
        return refused("one thing cannot be compared", help);
    }
    let designs = stored.iter().filter(|stored| !**stored).count();
    if args.methods.len() > designs {
        let help = "a stored result has been decided already: name a method for each design only";
        return refused("--methods names more methods than there are designs", help);
    }
    let mut methods = args.methods.iter().cloned();
    let all = args.methods.first().cloned().unwrap_or_default();
    let mut source = |k: usize| -> Result<ComparisonSource, Failure> {
        let path = paths[k].clone();
        if stored[k] {
            return Ok(ComparisonSource::Stored(path));
        }
        let problem = open_design(&path)?.checked()?;
        let method = methods.next().unwrap_or_else(|| all.clone());
        method.applies_to(problem.design())?;
        let run = Box::new(Run::by(method));
        Ok(ComparisonSource::Fresh { source: path.display().to_string(), problem: Box::new(problem), run })
    };
    Ok([source(0)?, source(1)?])
}
