//! `catchment success`: whether a robot's errors are corrected.

use crate::args::DesignArgs;
use crate::error_args::robots_of;
use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::result_args::{ResultArgs, study};
use crate::setting::number;
use crate::source::read_table;
use catchment::design::{Design, Diagnostics};
use catchment::poses::{Distribution, Robot, Spread};
use catchment::problem::Problem;
use catchment::report::figure;
use catchment::study::success::{SuccessSettings, run as follow};
use clap::Args;
use std::path::PathBuf;

/// Compute the probability that a robot docks
///
/// Random errors as they are expected, or measured ones, some of them followed exactly: most where a grid over them leaves doubt. Prints the
/// probability with its interval, what fails and what fails first, what it gains to halve each standard deviation, and how large they may be
/// for a success that is required.
#[derive(Debug, Args)]
#[command(after_long_help = "Examples:\n  \
    catchment success design.toml --error-sigma 'x=1 mm,y=1 mm,yaw=2 deg'\n  \
    catchment success design.toml --error-measured errors.csv --required 0.999\n  \
    catchment success design.toml --robots robots.toml -o success.png\n                                                  several robots, covariances\n  \
    catchment success design.toml --robots robots.toml --require 'success.probability>=0.95'\n                                                  of the robot that docks most seldom\n  \
    catchment success design.toml --robots robots.toml --require 'robots.arm A.tolerable.factor>=1'\n  \
    catchment success design.toml --error-sigma x=0.1 --json | jq '.robots[0].improve'\n\n\
    A file of robots has a table for each:\n\n  \
    [[robot]]\n  \
    name = \"arm A\"\n  \
    sigma = { x = \"1 mm\", yaw = \"2 deg\" }      # or covariance, uniform, measured\n\n\
    Lengths are in D and angles in radians unless they have a unit; in JSON always.")]
pub(crate) struct SuccessArgs {
    #[command(flatten)]
    pub(super) design: DesignArgs,
    #[command(flatten)]
    errors: ExpectedArgs,
    /// The success for which the largest standard deviations are sought
    #[arg(long, value_name = "SHARE", value_parser = number, default_value_t = 0.99)]
    required: f64,
    /// Exact motions of each robot's probability [default: 8000, fewer for round halves]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    motions: Option<u32>,
    /// Cells per axis of the grid that says where to look; 0 for none [default: by the number of errors]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=1000))]
    cells: Option<u32>,
    /// Seed of the random errors
    #[arg(long, value_name = "SEED", default_value_t = 1)]
    seed: u64,
    /// Coefficient of friction between the halves
    #[arg(long, value_name = "MU", value_parser = number, default_value_t = 0.0, allow_negative_numbers = true)]
    friction: f64,
    #[command(flatten)]
    result: ResultArgs,
    #[command(flatten)]
    exec: ExecArgs,
}

/// Which errors to expect: one of these.
#[derive(Debug, Args)]
#[group(required = true, multiple = false)]
struct ExpectedArgs {
    /// A file of robots (TOML), each with its errors
    #[arg(long, value_name = "FILE", value_hint = clap::ValueHint::FilePath, help_heading = "Errors to expect")]
    robots: Option<PathBuf>,
    /// Normal errors of these standard deviations, such as "x=1 mm,yaw=2 deg"
    #[arg(long, value_name = "AXIS=SIZE,…", help_heading = "Errors to expect")]
    error_sigma: Option<String>,
    /// Errors uniform within ± these, such as "x=1 mm,yaw=2 deg"
    #[arg(long, value_name = "AXIS=SIZE,…", help_heading = "Errors to expect")]
    error_uniform: Option<String>,
    /// Errors as they were measured: a table of poses (CSV); - reads stdin
    #[arg(long, value_name = "FILE", value_hint = clap::ValueHint::FilePath, help_heading = "Errors to expect")]
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
            motions: self.motions.map(|motions| motions as usize),
            seed: self.seed,
            required: self.required,
            cells: self.cells.map(|cells| cells as usize),
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
