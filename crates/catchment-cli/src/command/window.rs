//! `catchment window`: the largest box of pose errors in which every pose docks.

use crate::args::DesignArgs;
use crate::command::run::{LONG, time};
use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::output::to_stderr;
use crate::result_args::{ResultArgs, study};
use crate::setting::number;
use catchment::pose::{Dof, PoseError};
use catchment::poses::parse_sizes;
use catchment::problem::Problem;
use catchment::run::window::{WindowError, WindowSettings, run as find, seconds as expected};
use clap::Args;

/// Find the largest box of pose errors that all dock
///
/// Searches for the tolerance window by exact motions, without a grid: every failing pose shrinks the box. Sampled poses over the whole box
/// then certify it. Prints the half-widths around zero, the single-axis limits, the limit of every error with all others inside the window,
/// the worst pose, and an upper bound on the failure rate.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  catchment window design.toml
      in the proportions of the error box
  catchment window design.toml --fix 'x=2 mm,y=2 mm'
      how large may the other errors be if x and y are given?
  catchment window design.toml --proportions 'x=1 mm,y=1 mm,yaw=2 deg'
      the other errors are zero
  catchment window design.toml --require 'window.yaw>=5 deg'
  catchment window design.toml --json | jq .window

Lengths are in D and angles in radians unless they have a unit; in JSON always.
The window is at most as large as the error box of the design.")]
pub(crate) struct WindowArgs {
    #[command(flatten)]
    pub(super) design: DesignArgs,
    /// Given half-widths, such as "x=2 mm,y=2 mm"; the window contains them, and the other errors grow
    #[arg(long, value_name = "AXIS=SIZE,…")]
    fix: Option<String>,
    /// Proportions of the other half-widths, such as "x=1 mm,yaw=2 deg"; errors that are not named are zero [default: the error box]
    #[arg(long, value_name = "AXIS=SIZE,…")]
    proportions: Option<String>,
    /// Sampled poses of the certificate; 0 skips it [default: 300000, fewer for round halves]
    #[arg(long, alias = "motions", value_name = "N", value_parser = clap::value_parser!(u32).range(0..=100_000_000))]
    samples: Option<u32>,
    /// Seed of the search and of the sampled poses
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

pub(crate) fn run(args: &WindowArgs) -> Result<ExitStatus, Failure> {
    study(&args.design, &args.result, &args.exec, None, |problem, exec| {
        let free: Vec<&str> = problem.alignment().free.iter().map(Dof::name).collect();
        args.result.check_items("window", &free)?;
        let settings = args.settings(problem)?;
        let seconds = expected(problem, &settings) / exec.threads() as f64;
        if seconds > LONG {
            to_stderr(&[format!(
                "{} errors on these halves: about {} (--samples N takes that many sampled poses)",
                free.len(),
                time(seconds)
            )]);
        }
        find(problem, &settings, exec).map_err(refused)
    })
}

impl WindowArgs {
    fn settings(&self, problem: &Problem) -> Result<WindowSettings, Failure> {
        let sizes = |option: &str, text: &Option<String>| {
            let Some(text) = text else { return Ok(None) };
            let read = parse_sizes(text, problem.design()).map(Some);
            read.map_err(|refusal| Failure::of_option(option, text, refusal))
        };
        let fixed = sizes("--fix", &self.fix)?;
        let proportions = sizes("--proportions", &self.proportions)?;
        if let (Some(fixed), Some(proportions)) = (&fixed, &proportions) {
            let both = problem.alignment().free.iter().find(|axis| {
                let k = axis.index();
                fixed[k].is_some() && proportions[k].is_some()
            });
            if let Some(axis) = both {
                let message = format!("{} is both given by --fix and among the --proportions", axis.name());
                return Err(Failure::with_help(message, Some("name it in one of them".to_owned())));
            }
        }
        Ok(WindowSettings {
            fixed: fixed.unwrap_or_default(),
            proportions: proportions.map(|sizes| PoseError::from_array(sizes.map(Option::unwrap_or_default))),
            motions: self.samples.map(|samples| samples as usize),
            seed: self.seed,
            friction: self.friction,
        })
    }
}

/// The error of the study, with advice.
fn refused(error: WindowError) -> Failure {
    let help = match &error {
        WindowError::NotDocked { .. } => Some("catchment check says where it settles instead"),
        WindowError::GivenFails { .. } => {
            Some("catchment trace --pose shows the way of that pose; lower what --fix gives, or leave it out")
        }
        WindowError::Scattered { .. } => Some(
            "catchment trace --pose shows the motion of that pose; narrow the window by --fix or --proportions",
        ),
        WindowError::Nothing => Some("leave an error out of --fix, or give it a proportion"),
        _ => None,
    };
    match help {
        Some(help) => Failure::explained(&error, Some(help.to_owned())),
        None => error.into(),
    }
}
