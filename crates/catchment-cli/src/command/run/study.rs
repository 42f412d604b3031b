//! `catchment run --converge` and `--sensitivity`: what one run alone cannot show.

use super::RunArgs;
use super::sample::duration;
use crate::exec_args::Running;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::output::{tell, written};
use catchment::problem::Problem;
use catchment::report::figure::Picture;
use catchment::report::folder::{StudyFolder, encode};
use catchment::report::schema::Timing;
use catchment::report::{ConvergenceReport, SensitivityReport, figure};
use catchment::study::{convergence, sensitivity};
use clap::Args;
use std::time::{Duration, Instant};

/// Studies in the place of a single run.
#[derive(Debug, Args)]
pub(super) struct StudyArgs {
    /// Refine the grid until Sum and ONAA are stable to --tolerance (1%), with every method side by side
    #[arg(long, help_heading = STUDIES, conflicts_with_all = ["sensitivity", "budget", "figures", "require", "jams", "window"],
          conflicts_with_all = ["method", "resolution", "depth_tolerance", "ErrorArgs"])]
    converge: bool,
    /// --converge, --method all: how long each method may take, such as "20s" or "2 min" [default: 60s]
    #[arg(long, help_heading = STUDIES, value_name = "TIME", value_parser = duration)]
    pub(super) time_limit: Option<Duration>,
    /// How the Sum moves with rho, the centre of rotation and the aspect ratio, by the same random poses
    #[arg(long, help_heading = STUDIES, conflicts_with_all = ["figures", "require", "budget", "tolerance", "jams", "window"],
          conflicts_with_all = ["method", "resolution", "depth_tolerance", "ErrorArgs"])]
    sensitivity: bool,
}

const STUDIES: &str = "Studies in the place of a single run";

/// Does the study that was asked for, if one was.
pub(super) fn run(args: &RunArgs) -> Option<Result<ExitStatus, Failure>> {
    let study = &args.study;
    if study.converge { Some(converge(args)) } else { study.sensitivity.then(|| sensitivity(args)) }
}

fn converge(args: &RunArgs) -> Result<ExitStatus, Failure> {
    let started = Instant::now();
    let folder = args.place.study("convergence")?;
    let problem = args.design.problem()?;
    let default = convergence::Settings::default();
    let settings = convergence::Settings {
        tolerance: args.sample.tolerance.unwrap_or(default.tolerance),
        time_limit_s: args.study.time_limit.map_or(default.time_limit_s, |limit| limit.as_secs_f64()),
        descents: args.sample.samples.map(|descents| descents as usize),
        seed: args.sample.seed,
        ..default
    };
    let running = args.exec.start()?;
    let found = convergence::run(&problem, &settings, &running.exec)?;
    let timing = Timing { total_s: started.elapsed().as_secs_f64(), threads: running.exec.threads() };
    let report = ConvergenceReport::new(problem.design(), found, Some(timing));
    let told = Told {
        json: report.to_json()?,
        table: report.table(),
        records: report.records(),
        picture: figure::convergence(problem.design(), &report.found),
    };
    told.tell(args, folder, &problem, running)
}

fn sensitivity(args: &RunArgs) -> Result<ExitStatus, Failure> {
    let started = Instant::now();
    let folder = args.place.study("sensitivity")?;
    let problem = args.design.problem()?;
    let settings = sensitivity::Settings {
        poses: args.sample.samples.map(|poses| poses as usize),
        seed: args.sample.seed,
        ..sensitivity::Settings::default()
    };
    let running = args.exec.start()?;
    let found = sensitivity::run(&problem, &settings, &running.exec)?;
    let timing = Timing { total_s: started.elapsed().as_secs_f64(), threads: running.exec.threads() };
    let report = SensitivityReport::new(problem.design(), found, Some(timing));
    let told = Told {
        json: report.to_json()?,
        table: report.table(),
        records: report.records(),
        picture: figure::sensitivity(problem.design(), &report.found),
    };
    told.tell(args, folder, &problem, running)
}

/// A study in every form that it is told in.
struct Told {
    json: String,
    table: String,
    records: Vec<Vec<String>>,
    picture: Picture,
}

impl Told {
    /// Writes what is to be written, prints the rest.
    fn tell(
        self,
        args: &RunArgs,
        folder: Option<StudyFolder>,
        problem: &Problem,
        running: Running,
    ) -> Result<ExitStatus, Failure> {
        let mut notes: Vec<String> =
            problem.objections().iter().map(|doubt| format!("warning: {doubt}")).collect();
        if let Some(folder) = folder {
            let pictures = encode(&[(folder.name, self.picture)], &running.exec)?;
            notes.push(folder.write(&self.json, &self.records, pictures, &running.exec, |_| Ok(()))?);
            written(folder.path);
        }
        drop(running);
        tell(if args.print.json { &self.json } else { &self.table }, &notes)
    }
}
