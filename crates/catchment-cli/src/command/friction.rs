//! `catchment friction`: what friction takes.

use crate::args::DesignArgs;
use crate::asked::AskedArgs;
use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::output::FileArgs;
use crate::setting::number;
use catchment::report::schema::{Timing, WarningReport};
use catchment::report::{FrictionReport, csv, figure};
use catchment::study::friction::{Friction, FrictionError, Settings, run as follow};
use clap::Args;
use std::time::Instant;

/// What friction takes: what docks at each, from which on poses no longer do, and what sticks first
///
/// Follows the same random poses of the error box by exact motion with Coulomb friction at every coefficient of a ladder, and finds by
/// bisection where each is lost. Prints the share that docks, what is lost and gained against none, how many might have stuck on the way by
/// Coulomb's law, up to which friction most of what docks without it docks still, and the features on which the first poses stick.
#[derive(Debug, Args)]
#[command(after_long_help = "Examples:\n  \
    catchment friction design.toml\n  \
    catchment friction design.toml --frictions 0.15,0.3 --motions 5000\n  \
    catchment friction design.toml -o friction.png\n  \
    catchment friction design.toml --require 'kept.p95.friction>=0.2'\n  \
    catchment friction design.toml --json | jq '.curve[] | {friction, lost}'\n\n\
    -o writes .png and .svg (pictures), .csv (a line per friction) and .json.")]
pub(crate) struct FrictionArgs {
    #[command(flatten)]
    pub(super) design: DesignArgs,
    /// Coefficients of friction, beside none [default: 0.05,0.1,0.15,0.2,0.25,0.3,0.4,0.5]
    #[arg(long, value_name = "MU,…", value_parser = number, value_delimiter = ',')]
    frictions: Vec<f64>,
    /// Random poses of the error box [default: 1000, fewer for round halves]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    motions: Option<u32>,
    /// Their seed
    #[arg(long, value_name = "SEED", default_value_t = 1)]
    seed: u64,
    #[command(flatten)]
    asked: AskedArgs,
    #[command(flatten)]
    file: FileArgs,
    #[command(flatten)]
    exec: ExecArgs,
}

pub(crate) fn run(args: &FrictionArgs) -> Result<ExitStatus, Failure> {
    let started = Instant::now();
    let kind = args.file.kind(&["png", "svg", "csv", "json"])?;
    let problem = args.design.problem()?;
    let settings = args.settings();
    args.asked.check(&FrictionReport::new(problem.design(), &Friction::form(&settings), Vec::new(), None))?;
    let running = args.exec.start()?;
    running.may_be_left();
    let found = follow(&problem, &settings, &running.exec).map_err(refused)?;
    let timing = Timing { total_s: started.elapsed().as_secs_f64(), threads: running.exec.threads() };
    drop(running);
    let doubts = problem.objections().iter().map(WarningReport::note).collect();
    let report = FrictionReport::new(problem.design(), &found, doubts, Some(timing));
    match kind {
        Some(kind @ ("png" | "svg")) => args.file.draw(kind, &figure::friction(&report))?,
        Some("csv") => args.file.write(&csv(&report.records())?)?,
        Some(_) => args.file.write(report.to_json()?.as_bytes())?,
        None => {}
    }
    args.asked.tell(&report, FrictionReport::table)
}

impl FrictionArgs {
    fn settings(&self) -> Settings {
        let default = Settings::default();
        let frictions = if self.frictions.is_empty() { default.frictions } else { self.frictions.clone() };
        Settings { frictions, motions: self.motions.map(|motions| motions as usize), seed: self.seed }
    }
}

/// Why there is no answer, with what helps.
fn refused(error: FrictionError) -> Failure {
    match &error {
        FrictionError::NoFrictions => Failure::with_help(
            error.to_string(),
            Some("--frictions 0.1,0.2 follows poses at these two".to_owned()),
        ),
        _ => error.into(),
    }
}
