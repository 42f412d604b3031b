//! `catchment jams`: why it jams.

use super::run::resolution;
use crate::args::DesignArgs;
use crate::error_args::SpreadArgs;
use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::result_args::{ResultArgs, study};
use crate::setting::number;
use catchment::landscape::Resolution;
use catchment::problem::Problem;
use catchment::report::{JamsReport, figure};
use catchment::run::jams::{JamsSettings, run as find, run_for as find_for};
use clap::Args;

/// Find the jams, their contacts and their escape paths
///
/// Follows random poses of the error box by exact motion. Places of rest on the same features are one jam, up to the symmetries of the
/// halves; the jams are ranked by how many poses end there. Of each: what touches, where on either half as it was drawn, how firmly it
/// holds, and how far it must be lifted at most to get out.
#[derive(Debug, Args)]
#[command(after_long_help = "Examples:\n  \
    catchment jams design.toml\n  \
    catchment jams design.toml -o jams.png          each jam cut through its contacts, and in space\n  \
    catchment jams design.toml --error-sigma 'x=1 mm,y=1 mm,yaw=2 deg'\n                                                  shares of the errors that your robot makes, too\n  \
    catchment jams design.toml --error-measured errors.csv\n  \
    catchment jams design.toml --require 'outcomes.jammed.share<=0.01'\n  \
    catchment jams design.toml --json | jq '.features[0]'\n\n\
    CSV has a line per contact of every jam.")]
pub(crate) struct JamsArgs {
    #[command(flatten)]
    pub(super) design: DesignArgs,
    /// Random poses of the error box [default: 4000, fewer for round halves]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    motions: Option<u32>,
    /// Seed of the random poses and of all searches
    #[arg(long, value_name = "SEED", default_value_t = 1)]
    seed: u64,
    /// How many jams are examined: how firmly they hold, and the way out
    #[arg(long, value_name = "N", default_value_t = 6, value_parser = clap::value_parser!(u32).range(0..=1000))]
    examine: u32,
    /// A grid over the error box whose merge tree says depths, too, such as 200 or x=100,pitch=50
    #[arg(long, value_name = "CELLS", value_parser = resolution)]
    resolution: Option<Resolution>,
    /// How far it must be lifted at least, too, for certain: of simple halves with one or two free errors, in seconds
    #[arg(long)]
    certified: bool,
    /// Coefficient of friction between the halves
    #[arg(long, value_name = "MU", value_parser = number, default_value_t = 0.0, allow_negative_numbers = true)]
    friction: f64,
    #[command(flatten)]
    errors: SpreadArgs,
    #[command(flatten)]
    result: ResultArgs,
    #[command(flatten)]
    exec: ExecArgs,
}

pub(crate) fn run(args: &JamsArgs) -> Result<ExitStatus, Failure> {
    let draw = |report: &JamsReport, problem: &Problem| {
        Ok(figure::jams(&report.design, &report.result, problem.connector())?)
    };
    study(&args.design, &args.result, &args.exec, Some(draw), |problem, exec| {
        let settings = args.settings();
        match args.errors.spread(problem.design())? {
            Some(spread) => Ok(find_for(problem, &settings, &spread, exec)?),
            None => Ok(find(problem, &settings, exec)?),
        }
    })
}

impl JamsArgs {
    fn settings(&self) -> JamsSettings {
        JamsSettings {
            motions: self.motions.map(|motions| motions as usize),
            seed: self.seed,
            errors: None,
            examined: self.examine as usize,
            friction: self.friction,
            resolution: self.resolution,
            certified: self.certified,
        }
    }
}
