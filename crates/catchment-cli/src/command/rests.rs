//! `catchment rests`: where a half rests under its load.

use super::run::resolution;
use crate::args::DesignArgs;
use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::result_args::{ResultArgs, study};
use catchment::landscape::Resolution;
use catchment::problem::Problem;
use catchment::report::{RestsReport, figure};
use catchment::run::rests::{RestsSettings, run as find};
use clap::Args;

/// Find every equilibrium and how firmly it holds
///
/// The two halves may be any pair: a hand and what it grasps, a fixture and its part, the ground and what stands on it. Follows random poses of
/// the error box by exact motion to where they rest; the load acts along -z through the centre of rotation. Of each rest: its basin, what touches, whether it is
/// immobile to first order or to second (Rimon and Burdick), how far it must be lifted at most to leave, and where that leads.
#[derive(Debug, Args)]
#[command(after_long_help = "Examples:\n  \
    catchment rests design.toml\n  \
    catchment rests design.toml -o rests.png        each rest cut through its contacts, and in space\n  \
    catchment rests design.toml --require 'rests.0.depth_at_most_d>=0.1'\n  \
    catchment rests design.toml --json | jq '.rests[] | {pose, depth_at_most_d}'\n\n\
    CSV has a line per rest. Another direction of the load is another approach of the design.")]
pub(crate) struct RestsArgs {
    #[command(flatten)]
    pub(super) design: DesignArgs,
    /// Random poses of the error box [default: 4000, fewer for round halves]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    motions: Option<u32>,
    /// Seed of the random poses and of all searches
    #[arg(long, value_name = "SEED", default_value_t = 1)]
    seed: u64,
    /// How many rests are examined: by which order they are held, and the way out
    #[arg(long, value_name = "N", default_value_t = 6, value_parser = clap::value_parser!(u32).range(0..=1000))]
    examine: u32,
    /// A grid over the error box whose merge tree says depths, too, such as 200 or x=100,pitch=50
    #[arg(long, value_name = "CELLS", value_parser = resolution)]
    resolution: Option<Resolution>,
    /// How far it must be lifted at least, too, for certain: of simple halves with one or two free errors, in seconds
    #[arg(long)]
    certified: bool,
    #[command(flatten)]
    result: ResultArgs,
    #[command(flatten)]
    exec: ExecArgs,
}

pub(crate) fn run(args: &RestsArgs) -> Result<ExitStatus, Failure> {
    let settings = RestsSettings {
        motions: args.motions.map(|motions| motions as usize),
        seed: args.seed,
        examined: args.examine as usize,
        resolution: args.resolution,
        certified: args.certified,
    };
    let draw = |report: &RestsReport, problem: &Problem| Ok(figure::rests(report, problem.connector())?);
    study(&args.design, &args.result, &args.exec, Some(draw), |problem, exec| {
        Ok(find(problem, &settings, exec)?)
    })
}
