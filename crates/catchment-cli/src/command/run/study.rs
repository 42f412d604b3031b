//! `catchment run --converge` and `--sensitivity`: studies over several runs.

use super::RunArgs;
use super::sample::duration;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::output::lines;
use crate::result_args::Output;
use catchment::document::Subject;
use catchment::exec::Exec;
use catchment::problem::Problem;
use catchment::report::ReportOf;
use catchment::report::figure::{self, Picture};
use catchment::report::schema::Timing;
use catchment::study::{convergence, sensitivity};
use clap::Args;
use std::time::{Duration, Instant};

/// Studies in the place of a single run.
#[derive(Debug, Args)]
pub(super) struct StudyArgs {
    /// Refine the grid until Sum and ONAA change by less than --tolerance (1%), with every method
    #[arg(long, hide_short_help = true, help_heading = STUDIES, conflicts_with_all = ["sensitivity", "budget", "figures", "require", "jams", "window"],
          conflicts_with_all = ["method", "resolution", "depth_tolerance", "ErrorArgs"])]
    converge: bool,
    /// Time limit of each method with --converge or --method all, such as "20s" or "2 min" [default: 60s]
    #[arg(long, hide_short_help = true, help_heading = STUDIES, value_name = "TIME", value_parser = duration)]
    pub(super) time_limit: Option<Duration>,
    /// Compute the sensitivity of the Sum to ρ, centre of rotation and aspect ratio, with the same sampled poses
    #[arg(long, hide_short_help = true, help_heading = STUDIES, conflicts_with_all = ["figures", "require", "budget", "tolerance", "jams", "window"],
          conflicts_with_all = ["method", "resolution", "depth_tolerance", "ErrorArgs"])]
    sensitivity: bool,
}

const STUDIES: &str = "Studies of several runs";

/// Runs the requested study, if any.
pub(super) fn run(args: &RunArgs) -> Option<Result<ExitStatus, Failure>> {
    let study = &args.study;
    if study.converge { Some(converge(args)) } else { study.sensitivity.then(|| sensitivity(args)) }
}

fn converge(args: &RunArgs) -> Result<ExitStatus, Failure> {
    let default = convergence::ConvergenceSettings::default();
    let settings = convergence::ConvergenceSettings {
        tolerance: args.sample.tolerance.unwrap_or(default.tolerance),
        time_limit_s: args.study.time_limit.map_or(default.time_limit_s, |limit| limit.as_secs_f64()),
        descents: args.sample.samples.map(|descents| descents as usize),
        seed: args.sample.seed,
        ..default
    };
    study(args, figure::convergence, |problem, exec| Ok(convergence::run(problem, &settings, exec)?))
}

fn sensitivity(args: &RunArgs) -> Result<ExitStatus, Failure> {
    let settings = sensitivity::SensitivitySettings {
        poses: args.sample.samples.map(|poses| poses as usize),
        seed: args.sample.seed,
        ..sensitivity::SensitivitySettings::default()
    };
    study(args, figure::sensitivity, |problem, exec| Ok(sensitivity::run(problem, &settings, exec)?))
}

/// Computes a study of the design, writes it to the `-o` path, and prints it.
pub(super) fn study<T: Subject>(
    args: &RunArgs,
    draw: fn(&ReportOf<T>) -> Picture,
    compute: impl FnOnce(&Problem, &Exec) -> Result<T, Failure>,
) -> Result<ExitStatus, Failure> {
    let started = Instant::now();
    let output = Output::of(&args.print, args.place.output(), args.place.force, T::KIND)?;
    let problem = args.design.problem()?;
    let running = args.exec.start()?;
    let exec = &running.exec;
    let result = compute(&problem, exec)?;
    let timing = Timing { total_s: started.elapsed().as_secs_f64(), threads: exec.threads() };
    let report = ReportOf::new(problem.design(), result, Vec::new(), Some(timing));
    let mut notes = lines(&problem.warnings());
    let pictures = || Ok(vec![(T::KIND, draw(&report))]);
    notes.extend(output.write(&report, pictures, |_| Ok(String::new()), exec)?);
    drop(running);
    output.print(&report, &notes)
}
