//! `catchment success`: the probability that contact corrects a robot's errors.

use crate::args::DesignArgs;
use crate::error_args::{EXPECTED, robots_of};
use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::result_args::{ResultArgs, study};
use crate::setting::number;
use crate::source::read_table;
use catchment::design::Design;
use catchment::diagnostic::Diagnostics;
use catchment::poses::{Distribution, Robot, Spread};
use catchment::problem::Problem;
use catchment::report::figure;
use catchment::study::success::{SuccessSettings, run as follow};
use clap::Args;
use std::path::PathBuf;

/// Compute the probability that a robot docks
///
/// Samples the expected or measured pose errors of a robot and follows them exactly, most of them near the border. Prints the probability
/// with its confidence interval, the failures and the error that dominates them, the gain from halving each standard deviation, and the
/// largest standard deviations that reach --target.
#[derive(Debug, Args)]
#[command(override_usage = USAGE, after_long_help = "\
Examples:
  catchment success design.toml --error-sigma 'x=1 mm,y=1 mm,yaw=2 deg'
  catchment success design.toml --error-measured errors.csv --target 0.999
  catchment success design.toml --robots robots.toml -o success.png
      several robots, with covariances
  catchment success design.toml --robots robots.toml \\
      --require 'success.probability>=0.95'
      for the robot that docks least often
  catchment success design.toml --robots robots.toml \\
      --require 'robots.arm A.tolerable.factor>=1'
  catchment success design.toml --error-sigma x=0.1 --json \\
      | jq '.robots[0].improve'

A file of robots has a table for each:

  [[robot]]
  name = \"arm A\"
  sigma = { x = \"1 mm\", yaw = \"2 deg\" }      # or covariance, uniform, measured

Lengths are in D and angles in radians unless they have a unit; in JSON always.")]
pub(crate) struct SuccessArgs {
    #[command(flatten)]
    pub(super) design: DesignArgs,
    #[command(flatten)]
    errors: ExpectedArgs,
    /// Success probability for which the largest standard deviations are computed
    #[arg(long, alias = "required", value_name = "SHARE", value_parser = number, default_value_t = 0.99)]
    target: f64,
    /// Sampled poses per robot [default: 8000, fewer for round halves]
    #[arg(long, alias = "motions", value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    samples: Option<u32>,
    /// Cells per axis of the grid that directs the sampling; 0 uses no grid [default: by the number of errors]
    #[arg(long, hide_short_help = true, alias = "cells", value_name = "N", value_parser = clap::value_parser!(u32).range(0..=1000))]
    resolution: Option<u32>,
    /// Seed of the sampled poses
    #[arg(long, hide_short_help = true, value_name = "SEED", default_value_t = 1)]
    seed: u64,
    /// Coefficient of friction between the halves
    #[arg(long, value_name = "MU", value_parser = number, default_value_t = 0.0, allow_negative_numbers = true)]
    friction: f64,
    #[command(flatten)]
    result: ResultArgs,
    #[command(flatten)]
    exec: ExecArgs,
}

/// The usage line: exactly one source of errors is required.
const USAGE: &str = "catchment success [OPTIONS] --error-sigma <AXIS=SIZE,…> <DESIGN>
       catchment success [OPTIONS] --robots <FILE> <DESIGN>";

/// Which errors to expect: a single source of them.
#[derive(Debug, Args)]
#[group(required = true, multiple = false)]
struct ExpectedArgs {
    /// File of robots (TOML) with their pose errors
    #[arg(long, value_name = "FILE", value_hint = clap::ValueHint::FilePath, help_heading = EXPECTED)]
    robots: Option<PathBuf>,
    /// Normal errors with these standard deviations, such as "x=1 mm,yaw=2 deg"
    #[arg(long, value_name = "AXIS=SIZE,…", help_heading = EXPECTED)]
    error_sigma: Option<String>,
    /// Uniform errors within ± these bounds, such as "x=1 mm,yaw=2 deg"
    #[arg(long, value_name = "AXIS=SIZE,…", help_heading = EXPECTED)]
    error_uniform: Option<String>,
    /// Measured pose errors: a table (CSV); - reads stdin
    #[arg(long, value_name = "FILE", value_hint = clap::ValueHint::FilePath, help_heading = EXPECTED)]
    error_measured: Option<PathBuf>,
}

pub(crate) fn run(args: &SuccessArgs) -> Result<ExitStatus, Failure> {
    study(
        &args.design,
        &args.result,
        &args.exec,
        Some(|report, _| Ok(figure::success(report))),
        |problem, exec| {
            let robots = args.errors.robots(problem)?;
            let names: Vec<&str> = robots.iter().map(|robot| robot.name.as_str()).collect();
            args.result.check_items("robots", &names)?;
            Ok(follow(problem, &robots, &args.settings(), exec)?)
        },
    )
}

impl SuccessArgs {
    fn settings(&self) -> SuccessSettings {
        SuccessSettings {
            motions: self.samples.map(|samples| samples as usize),
            seed: self.seed,
            required: self.target,
            cells: self.resolution.map(|cells| cells as usize),
            friction: self.friction,
        }
    }
}

impl ExpectedArgs {
    fn robots(&self, problem: &Problem) -> Result<Vec<Robot>, Failure> {
        type Read = fn(&str, &Design) -> Result<Distribution, Diagnostics>;
        let design = problem.design();
        if let Some(path) = &self.robots {
            return robots_of(path, design);
        }
        if let Some(path) = &self.error_measured {
            let errors = Spread::measured(read_table(path)?, design)?;
            return Ok(vec![Robot { name: "robot".to_owned(), errors }]);
        }
        let (option, text, read): (_, _, Read) = match (&self.error_sigma, &self.error_uniform) {
            (Some(text), _) => ("--error-sigma", text, Distribution::normal),
            (None, Some(text)) => ("--error-uniform", text, Distribution::uniform),
            (None, None) => return Ok(Vec::new()),
        };
        let distribution = read(text, design).map_err(|refusal| Failure::of_option(option, text, refusal))?;
        Ok(vec![Robot { name: "robot".to_owned(), errors: Spread::of(&distribution)? }])
    }
}
