//! `catchment validate`: a prediction beside robot trials.

use super::outcome::Point;
use super::plan::repeatability;
use crate::args::DesignArgs;
use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::result_args::ResultArgs;
use crate::setting::number;
use crate::source::read_table;
use catchment::document::Subject;
use catchment::method::descent;
use catchment::pose::PoseError;
use catchment::poses::RobotTrialTable;
use catchment::report::schema::Timing;
use catchment::report::{ValidationReport, figure};
use catchment::study::plan::panels;
use catchment::study::validate::{Validation, ValidationSettings, run as judge};
use clap::Args;
use std::path::PathBuf;
use std::time::Instant;

/// Compare a prediction with the outcomes of robot trials
///
/// Reads the table of `catchment plan` with its column `outcome` filled in (aligned, jammed, missed, aligned-elsewhere; empty for a trial
/// that was not made), follows every pose again, and prints a verdict: consistent, inconsistent or undecided. Disagreements within a few
/// standard deviations of the border do not count against the prediction, nor do as many as the errors of the robot explain.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  catchment validate plan.csv design.toml \\
      --repeatability 'x=1 mm,y=1 mm,yaw=1 deg'
  catchment validate plan.csv design.toml --repeatability 'x=1 mm' \\
      --figure trials.png
      observed outcomes over the predicted area
  catchment validate plan.csv design.toml --repeatability 'x=1 mm' \\
      --estimate-friction
      the friction that explains the failures
  catchment validate plan.csv design.toml --repeatability 'x=1 mm' \\
      --require 'consistent>=1' --require 'agreement.ci95.0>=0.9'
  catchment validate plan.csv design.toml --repeatability 'x=1 mm' --json \\
      | jq '.disagreements[0]'
  catchment validate plan.csv out --repeatability 'x=1 mm'
      against a result of `run -o`, with its friction

Columns: every free error of the design, as x_mm or yaw_deg, and outcome; trial
and line as in the plan, each trial once. Other columns are ignored. Lengths are
in D and angles in radians unless they have a unit; in JSON always.",
    mut_arg("path", |path| path.value_name("DESIGN_OR_RESULT")
        .help("Design file, or folder written by `run -o`")
        .value_hint(clap::ValueHint::AnyPath)))]
pub(crate) struct ValidateArgs {
    /// Table of trials (CSV); - reads stdin
    #[arg(value_name = "PLAN", value_hint = clap::ValueHint::FilePath)]
    plan: PathBuf,
    #[command(flatten)]
    pub(super) design: DesignArgs,
    /// Repeatability of the robot: standard deviation of each error, such as "x=0.1 mm,yaw=0.2 deg"; errors that are not named are exact
    #[arg(long, alias = "accuracy", value_name = "AXIS=SIZE,…")]
    repeatability: String,
    /// k: ignore disagreements nearer to the border than k times the repeatability
    #[arg(long, value_name = "K", value_parser = number, default_value_t = catchment::study::validate::LIMIT)]
    limit: f64,
    /// Point of the moving half at which the table gives x and y
    #[arg(long, value_enum, default_value_t = Point::Face)]
    offsets_at: Point,
    /// Coefficient of friction of the prediction [default: 0, or that of the result]
    #[arg(long, value_name = "MU", value_parser = number, allow_negative_numbers = true)]
    friction: Option<f64>,
    /// Estimate the friction that explains the trials
    #[arg(long)]
    estimate_friction: bool,
    /// Seed of the search for the border
    #[arg(long, value_name = "SEED", default_value_t = 1)]
    seed: u64,
    #[command(flatten)]
    result: ResultArgs,
    #[command(flatten)]
    exec: ExecArgs,
}

pub(crate) fn run(args: &ValidateArgs) -> Result<ExitStatus, Failure> {
    let started = Instant::now();
    let absent: &[&str] = if args.estimate_friction { &[] } else { &["friction"] };
    args.result.check_requirements(Validation::KIND, absent)?;
    let output = args.result.check(Validation::KIND, true)?;
    let running = args.exec.start()?;
    running.may_be_left();
    let (problem, decided_with) = args.design.decided(&running.exec)?;
    let settings = ValidationSettings {
        accuracy: repeatability(&args.repeatability, &problem)?,
        limit: args.limit,
        friction: args.friction.unwrap_or(decided_with),
        estimate_friction: args.estimate_friction,
        seed: args.seed,
    };
    let source = read_table(&args.plan)?;
    let table = RobotTrialTable::parse(&source.text, problem.design(), args.offsets_at.into())
        .map_err(|diagnostics| diagnostics.of(source.clone()))?;
    let validation = judge(&problem, &table.rows, &settings, &running.exec)?;
    let validation = Validation { offsets_at: table.offsets_at, ..validation };
    let slices = if output.wants_picture() {
        let poses: Vec<PoseError> = validation.trials.iter().map(|trial| trial.point.error).collect();
        let motions = descent::DescentSettings::with_friction(settings.friction)?;
        panels(&problem, &poses, &settings.accuracy, &motions, &running.exec)?
    } else {
        Vec::new()
    };
    let timing = Timing { total_s: started.elapsed().as_secs_f64(), threads: running.exec.threads() };
    drop(running);
    let report = ValidationReport::new(problem.design(), validation, problem.warnings(), Some(timing));
    output.finish(&report, || Ok(figure::validation(&report, &slices)))
}
