//! `catchment run`: the area of acceptance of a design.

mod all;
mod place;
mod sample;
mod study;

pub(super) use sample::SampleArgs;

use crate::advice;
use crate::args::DesignArgs;
use crate::error_args::ErrorArgs;
use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::method_args::{Choice, MethodArgs};
use crate::output::to_stderr;
use crate::result_args::PrintArgs;
use catchment::acceptance::Domain;
use catchment::landscape::Resolution;
use catchment::pose::{Dof, DofSet};
use catchment::problem::Problem;
use catchment::report::{self, Report, UnanswerableError, figure, first_look};
use catchment::run::{Over, Run, RunError, RunPlan, Sample, Upright};
use catchment::terminal::escaped;
use clap::Args;

/// Compute the area of acceptance: which pose errors still dock
///
/// Decides every cell of a grid over the error box by --method. Then follows sampled poses exactly, most of them near the border, and
/// corrects the Sum with them: it is unbiased on any grid and has a 95 % confidence interval. Prints the tolerance window, the single-axis
/// limits, the Sum and the shares of the outcomes.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  catchment run design.toml
  catchment run design.toml -o out
      table, pictures, report.json and result.zarr
  catchment run design.toml --free x,y,yaw --resolution 41,yaw=61
  catchment run design.toml --tolerance 1%
      samples until the Sum is known to ± 1 %
  catchment run design.toml --error-sigma 'x=1 mm,y=1 mm,yaw=2 deg' \\
      --require 'success.probability>=0.99'
      exits with code 1 if the robot docks less often
  catchment run design.toml --window --jams -o out
      also the tolerance window, and the jams
  catchment run design.toml --json | jq .onaa.edge
  catchment run design.toml --method all
      every method, and how well they agree
  catchment run design.toml --free x,yaw --method drop --friction 0.2
  catchment run design.toml --converge -o out
      finer grids until the Sum is stable, with every method
  catchment run design.toml --sensitivity
      slopes against ρ, COR and aspect ratio

The JSON of equal runs is equal byte for byte on any number of threads, but for
`timing`. --converge may end earlier on a slower machine.")]
pub(crate) struct RunArgs {
    #[command(flatten)]
    pub(super) design: DesignArgs,
    #[command(flatten)]
    how: MethodArgs,
    /// Cells per axis of the error grid, such as 30 or x=40,yaw=24 [default: by method and number of axes]
    #[arg(long, value_name = "CELLS", value_parser = resolution)]
    resolution: Option<Resolution>,
    #[command(flatten)]
    sample: sample::SampleArgs,
    #[command(flatten)]
    errors: ErrorArgs,
    #[command(flatten)]
    pub(super) place: place::PlaceArgs,
    #[command(flatten)]
    study: study::StudyArgs,
    /// Also find the tolerance window, as `catchment window` does
    #[arg(long)]
    window: bool,
    /// Also list the most frequent jams, as `catchment rests --jams` does
    #[arg(long)]
    jams: bool,
    #[command(flatten)]
    print: PrintArgs,
    #[command(flatten)]
    exec: ExecArgs,
}

/// Parses a resolution.
pub(super) fn resolution(text: &str) -> Result<Resolution, String> {
    text.parse::<Resolution>().map_err(|error| escaped(&error.to_string()))
}

pub(crate) fn run(args: &RunArgs) -> Result<ExitStatus, Failure> {
    if let Some(studied) = study::run(args) {
        return studied;
    }
    let Choice::One(method) = &args.how.method else { return all::run(args) };
    if args.study.time_limit.is_some() {
        let message = "--time-limit is for --converge and --method all".to_owned();
        return Err(Failure::with_help(
            message,
            Some("--budget limits the time of the random poses".to_owned()),
        ));
    }
    let method = args.how.settings.of(method)?;
    let targets = args.place.targets()?;
    let problem = args.design.problem()?;
    let run = Run {
        method,
        over: Over::Grid(args.resolution.unwrap_or_default()),
        sample: args.sample.sample(),
        seed: args.sample.seed,
        errors: args.errors.distribution(problem.design())?,
        requirements: args.print.require.clone(),
        heights: targets.want_heights(),
        jams: args.jams,
        window: args.window,
    };
    report::check_requirements(&run, &problem).map_err(|error| match error {
        UnanswerableError::Run(error) => refused(&problem, error),
        UnanswerableError::Requirement { requirement, error } => {
            Failure::with_help(format!("--require '{requirement}': {error}"), None)
        }
    })?;
    let running = args.exec.start()?;
    let plan = run.plan(&problem).map_err(|error| refused(&problem, error))?;
    if targets.need_grid() && matches!(plan.domain, Domain::Poses(_)) {
        let message =
            "a grid that can be afforded resolves nothing here, and random poses have no cells to write"
                .to_owned();
        let help =
            "--resolution 8 computes a grid, however long it takes; -o DIR or -o FILE.csv writes the poses"
                .to_owned();
        return Err(Failure::with_help(message, Some(help)).ends(ExitStatus::NotComputed));
    }
    // An explicit resolution needs no notes about run time.
    let stated = match args.resolution {
        None => notes_before(&run, &plan, &problem, running.exec.threads()),
        Some(_) => Vec::new(),
    };
    to_stderr(&stated);
    if targets.draw() {
        plan.ensure_fits(&running.exec)?;
        figure::ensure_run_fits(&plan, &running.exec)?;
    }
    let first = |upright: &Upright| {
        if !stated.is_empty() {
            to_stderr(&first_look(problem.design(), upright));
        }
    };
    let answer = run.on_with(&problem, &running.exec, first).map_err(|error| refused(&problem, error))?;
    let report = Report::of_answer(&answer);
    let notes = targets.write(&answer, &report, &running.exec)?;
    drop(running);
    let status = args.print.print(&report, &report.described_with(advice::flags));
    to_stderr(&notes);
    status
}

/// Runs with a longer estimate print notes beforehand, in seconds.
pub(super) const LONG: f64 = 20.0;

/// The estimated run time, and faster alternatives.
fn notes_before(run: &Run, plan: &RunPlan, problem: &Problem, threads: usize) -> Vec<String> {
    let wall = |plan: &RunPlan, problem: &Problem| plan.seconds(problem) / threads as f64;
    let seconds = wall(plan, problem);
    if seconds < LONG {
        return Vec::new();
    }
    let count =
        |free: DofSet| if free.len() == 1 { "1 error".to_owned() } else { format!("{} errors", free.len()) };
    let free = problem.alignment().free;
    let how = match &plan.domain {
        Domain::Grid(grid) => format!("{} cells", grid.len()),
        Domain::Poses(poses) => format!("{} random poses, as a grid would be too coarse", poses.len()),
    };
    let mut stated = format!("{} on these halves: about {} ({how})", count(free), time(seconds));
    let mut design = problem.design().clone();
    design.alignment.free =
        [Dof::X, Dof::Y, Dof::Yaw].into_iter().filter(|dof| free.contains(*dof)).collect();
    if design.alignment.free != free
        && !design.alignment.free.is_empty()
        && let Ok(fewer) = problem.with(design)
        && let Ok(plan) = run.plan(&fewer)
    {
        let names: Vec<&str> = fewer.alignment().free.iter().map(Dof::name).collect();
        let named = names.join(", ");
        let fewer = time(wall(&plan, &fewer));
        stated = format!("{stated}; {named} alone: about {fewer} (--free {})", names.join(","));
    }
    let fewer = "--budget 30s takes fewer poses, --samples N that many".to_owned();
    // Omit the alternatives for options that the user has set.
    std::iter::once(stated).chain((run.sample == Sample::ByMethod).then_some(fewer)).collect()
}

/// A readable duration.
pub(super) fn time(seconds: f64) -> String {
    if seconds < 90.0 { format!("{seconds:.0} s") } else { format!("{:.0} min", seconds / 60.0) }
}

/// The error of a run, at the responsible design key or option.
pub(super) fn refused(problem: &Problem, error: RunError) -> Failure {
    match error {
        RunError::NotHeld(diagnostics) => diagnostics.into(),
        RunError::NotApplicable(refusal) => {
            problem.refused("connector.family", format!("--method {refusal}"), None).into()
        }
        RunError::Resolution(error) => Failure::with_help(format!("--resolution: {error}"), None),
        error => error.into(),
    }
}
