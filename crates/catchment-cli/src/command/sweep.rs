//! `catchment sweep`: every combination of replaced design keys.

use super::run::{SampleArgs, resolution};
use crate::args::DesignArgs;
use crate::error_args::ErrorArgs;
use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::method_args::{Choice, MethodArgs};
use crate::output::kept;
use crate::result_args::ResultArgs;
use crate::signals;
use crate::source::read_design;
use catchment::document::Subject;
use catchment::exec::Exec;
use catchment::landscape::Resolution;
use catchment::report::figure::{sweep_map, sweep_outlines};
use catchment::report::schema::Timing;
use catchment::report::{FinishedDesigns, SweepReport};
use catchment::run::{Over, Run, RunError};
use catchment::study::sweep::{DesignStore, NoStore, Sweep, SweepAxis, SweepError, SweepPlan, SweepSettings};
use catchment::terminal::{escaped, shown};
use clap::Args;
use std::path::Path;
use std::time::Instant;

/// Compute every combination of design parameters
///
/// Each --over names a key of the design file and its values. Every combination is a design of its own, computed as `run` computes it. A
/// combination whose halves do not build or do not meet is reported and skipped.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  catchment sweep design.toml --over aspect_ratio=0.25,0.5,1,2,4 \\
      --over cor=-1..1/5 -o out
  catchment sweep design.toml --over 'errors.yaw=10..30 deg/5' --free x,y,yaw
  catchment sweep design.toml --over family=v-face,s-face,x-face --samples 20000
  catchment sweep design.toml --over connector.moving.mesh=a.stl,b.stl --json \\
      | jq '.designs[].figures.sum'

Write a key as its path (errors.x), or as its last word if that is unique; cor
and rho are short for center_of_rotation and rotation_length. -1..1/5 is five
values from -1 to 1.

A folder also gets outlines.png (and .svg) and sweep.zarr. Until the result is
complete, PATH.parts beside it keeps the finished designs: after Ctrl-C, the
same command continues from there and gives the same result.")]
pub(crate) struct SweepArgs {
    #[command(flatten)]
    pub(super) design: DesignArgs,
    /// Key of the design file and its values, such as cor=-1..1/5 or errors.x=1,2; may be repeated
    #[arg(long, value_name = "KEY=VALUE,…", required = true, allow_hyphen_values = true, value_parser = axis)]
    over: Vec<SweepAxis>,
    #[command(flatten)]
    how: MethodArgs,
    /// Cells per axis of the error grid, such as 30 or x=40,yaw=24 [default: by method and number of axes]
    #[arg(long, value_name = "CELLS", value_parser = resolution)]
    resolution: Option<Resolution>,
    #[command(flatten)]
    sample: SampleArgs,
    #[command(flatten)]
    errors: ErrorArgs,
    #[command(flatten)]
    result: ResultArgs,
    #[command(flatten)]
    exec: ExecArgs,
}

fn axis(text: &str) -> Result<SweepAxis, String> {
    text.parse::<SweepAxis>().map_err(|error| escaped(&error.to_string()))
}

pub(crate) fn run(args: &SweepArgs) -> Result<ExitStatus, Failure> {
    let started = Instant::now();
    let output = args.result.check(Sweep::KIND, true)?;
    let plan = plan(args)?;
    let running = args.exec.start()?;
    let exec = &running.exec;
    let base = plan.base().clone();
    let parts = args.result.output().map(FinishedDesigns::beside);
    let (kept_so_far, designs) = (parts.clone(), plan.len());
    running.may_be_left_after(move || report_finished(kept_so_far.as_ref(), designs));
    let results = compute(plan, parts.as_ref(), exec)?;
    signals::must_stay();
    let timing = Timing { total_s: started.elapsed().as_secs_f64(), threads: exec.threads() };
    let report = SweepReport::new(&base, results, Vec::new(), Some(timing));
    let pictures = || {
        let map = sweep_map(&report).map(|picture| ("sweep", picture));
        let outlines = sweep_outlines(&report)?.map(|picture| ("outlines", picture));
        Ok(map.into_iter().chain(outlines).collect())
    };
    let group = |folder: &Path| {
        report.save_group(folder, exec)?;
        Ok(", sweep.zarr".to_owned())
    };
    let notes = output.write(&report, pictures, group, exec)?;
    if let Some(parts) = parts {
        parts.clear();
    }
    drop(running);
    output.print(&report, &notes)
}

/// Reads the designs and plans the sweep.
fn plan(args: &SweepArgs) -> Result<SweepPlan, Failure> {
    let Choice::One(method) = &args.how.method else {
        let help = Some("name one; `run --method all` compares them on one design".to_owned());
        return Err(Failure::with_help("--method: a sweep is by one method".to_owned(), help));
    };
    if let Some((option, key)) =
        args.design.changed().find(|(_, key)| args.over.iter().any(|axis| axis.key == *key))
    {
        let message = format!("{option} and --over {key} both say what it is");
        return Err(Failure::with_help(message, Some("leave out one of them".to_owned())));
    }
    let source = read_design(&args.design.path)?;
    let base = args.design.change(catchment::problem::Draft::read(source.clone())?)?;
    let run = Run {
        method: args.how.settings.of(method)?,
        over: Over::Grid(args.resolution.unwrap_or_default()),
        sample: args.sample.sample(),
        seed: args.sample.seed,
        errors: args.errors.distribution(base.design())?,
        ..Run::default()
    };
    let settings = SweepSettings { axes: args.over.clone(), run };
    SweepPlan::new(&source, settings, |draft| args.design.change(draft)).map_err(refused)
}

/// Computes the missing designs; reports the stored ones if it stops early.
fn compute(plan: SweepPlan, parts: Option<&FinishedDesigns>, exec: &Exec) -> Result<Sweep, Failure> {
    let Some(parts) = parts else { return plan.run(&NoStore, exec).map_err(refused) };
    let designs = plan.len();
    let keep: &dyn DesignStore = parts;
    plan.run(keep, exec).map_err(|error| {
        report_finished(Some(parts), designs);
        refused(error)
    })
}

/// Reports the number of finished, stored designs.
fn report_finished(parts: Option<&FinishedDesigns>, designs: usize) {
    let Some((parts, finished)) = parts.map(|parts| (parts, parts.count())).filter(|(_, count)| *count > 0)
    else {
        return;
    };
    let place = shown(parts.folder());
    kept(&format!("{finished} of {designs} designs in {place}, from where the same command goes on"));
}

/// The error of the sweep, at the responsible option.
fn refused(error: SweepError) -> Failure {
    match error {
        SweepError::Problem(error) => error.into(),
        SweepError::NotApplicable(error) | SweepError::Run(RunError::NotApplicable(error)) => {
            Failure::with_help(format!("--method {error}"), None)
        }
        SweepError::Run(RunError::Resolution(error)) => {
            Failure::with_help(format!("--resolution: {error}"), None)
        }
        SweepError::Key { .. } | SweepError::TwoAxes { .. } | SweepError::TooMany { .. } => {
            Failure::with_help(format!("--over: {error}"), None)
        }
        error => error.into(),
    }
}
