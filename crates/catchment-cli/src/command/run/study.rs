//! `catchment run --converge` and `--sensitivity`: what one run alone cannot show.

use super::RunArgs;
use super::sample::duration;
use crate::exec_args::Running;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::output::{to_stderr, to_stdout};
use crate::result_folder::Study;
use catchment::method::Method;
use catchment::report::figure::Picture;
use catchment::report::schema::Timing;
use catchment::report::{ConvergenceReport, SensitivityReport, figure};
use catchment::study::{convergence, sensitivity};
use clap::Args;
use std::time::{Duration, Instant};

/// Studies in the place of a single run.
#[derive(Debug, Args)]
pub(super) struct StudyArgs {
    /// Refine the grid until Sum and ONAA are stable to --tolerance (1%), with every method side by side
    #[arg(long, help_heading = STUDIES, conflicts_with_all = ["sensitivity", "budget", "figures", "require"],
          conflicts_with_all = ["method", "resolution", "depth_tolerance", "ErrorArgs"])]
    converge: bool,
    /// --converge, --method all: how long each method may take, such as "20s" or "2 min" [default: 60s]
    #[arg(long, help_heading = STUDIES, value_name = "TIME", value_parser = duration)]
    pub(super) time_limit: Option<Duration>,
    /// How the Sum moves with rho, the centre of rotation and the aspect ratio, by the same random poses
    #[arg(long, help_heading = STUDIES, conflicts_with_all = ["figures", "require", "budget", "tolerance"],
          conflicts_with_all = ["method", "resolution", "depth_tolerance", "ErrorArgs"])]
    sensitivity: bool,
}

const STUDIES: &str = "Studies in the place of a single run";

/// Random poses of a sensitivity, as a multiple of those of a run: slopes need more of them.
const POSES_PER_SAMPLE: usize = 3;

/// Does the study that was asked for, if one was.
pub(super) fn run(args: &RunArgs) -> Option<Result<ExitStatus, Failure>> {
    let study = &args.study;
    if study.converge { Some(converge(args)) } else { study.sensitivity.then(|| sensitivity(args)) }
}

fn converge(args: &RunArgs) -> Result<ExitStatus, Failure> {
    let started = Instant::now();
    let folder = args.place.study("convergence")?;
    let (built, pair, doubts) = args.design.build()?.into_pair()?;
    let design = &built.input.design;
    let default = convergence::Settings::default();
    let settings = convergence::Settings {
        tolerance: args.sample.tolerance.unwrap_or(default.tolerance),
        time_limit_s: args.study.time_limit.map_or(default.time_limit_s, |limit| limit.as_secs_f64()),
        descents: args
            .sample
            .samples
            .map_or_else(|| Method::Descent.default_samples(&pair), |descents| descents as usize),
        seed: args.sample.seed,
        ..default
    };
    let running = args.exec.start()?;
    let found = convergence::run(&pair, &settings, &running.exec)?;
    let timing = Timing { total_s: started.elapsed().as_secs_f64(), threads: running.exec.threads() };
    let report = ConvergenceReport::new(design, found, Some(timing));
    let told = Told {
        json: report.to_json()?,
        table: report.table(),
        records: report.records(),
        picture: figure::convergence(design, &report.found),
    };
    told.tell(args, folder, doubts, running)
}

fn sensitivity(args: &RunArgs) -> Result<ExitStatus, Failure> {
    let started = Instant::now();
    let folder = args.place.study("sensitivity")?;
    let (built, pair, doubts) = args.design.build()?.into_pair()?;
    let design = &built.input.design;
    let default = || POSES_PER_SAMPLE * Method::Descent.default_samples(&pair);
    let settings = sensitivity::Settings {
        poses: args.sample.samples.map_or_else(default, |poses| poses as usize),
        seed: args.sample.seed,
        ..sensitivity::Settings::default()
    };
    let running = args.exec.start()?;
    let found = sensitivity::run(design, &settings, &running.exec)?;
    let timing = Timing { total_s: started.elapsed().as_secs_f64(), threads: running.exec.threads() };
    let report = SensitivityReport::new(design, found, Some(timing));
    let told = Told {
        json: report.to_json()?,
        table: report.table(),
        records: report.records(),
        picture: figure::sensitivity(design, &report.found),
    };
    told.tell(args, folder, doubts, running)
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
        folder: Option<Study>,
        doubts: Vec<String>,
        running: Running,
    ) -> Result<ExitStatus, Failure> {
        let mut notes: Vec<String> = doubts.into_iter().map(|doubt| format!("warning: {doubt}")).collect();
        if let Some(folder) = folder {
            notes.push(folder.write(&self.json, &self.records, self.picture, &running.exec, |_| Ok(()))?);
        }
        drop(running);
        to_stdout(if args.json { &self.json } else { &self.table })?;
        to_stderr(&notes);
        Ok(ExitStatus::Done)
    }
}
