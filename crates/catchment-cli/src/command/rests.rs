//! `catchment rests`: the equilibria of a half under its load; with `--jams`, those that are not docked.

use super::jams;
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
use catchment::report::{RestsReport, figure};
use catchment::run::rests::{RestsSettings, run as find};
use clap::Args;

/// Find every equilibrium; with --jams, the jams and their causes
///
/// Follows sampled poses of the error box by exact motion until they rest; the load acts along -z through the centre of rotation. The
/// halves may be any pair: a connector, a hand and an object, a fixture and its part, the ground and a body. Of every rest: the share of
/// sampled poses that end in it, its contacts, its stability (first- or second-order immobile, Rimon and Burdick), its escape height and
/// the end of the escape path.
///
/// --jams prints the rests that do not dock. Rests on the same features are one jam, up to the symmetries of the halves; jams are ranked by
/// their share. The position of every contact is given on both halves as drawn.
#[derive(Debug, Args)]
#[command(
    after_long_help = "\
Examples:
  catchment rests design.toml
  catchment rests design.toml -o rests.png
      every rest in section through its contacts, and in space
  catchment rests design.toml --require 'rests.0.depth_at_most_d>=0.1'
  catchment rests design.toml --json | jq '.rests[] | {pose, depth_at_most_d}'
  catchment rests design.toml --jams
  catchment rests design.toml --jams -o jams.png
  catchment rests design.toml --jams --error-sigma 'x=1 mm,y=1 mm,yaw=2 deg'
      also the shares under the errors of a robot
  catchment rests design.toml --jams --error-measured errors.csv
  catchment rests design.toml --jams --require 'outcomes.jammed.share<=0.01'
  catchment rests design.toml --jams --json | jq '.features[0]'

CSV has a line per rest; with --jams, a line per contact of every jam. For
another direction of the load, change the approach of the design.",
    mut_arg("friction", |arg| arg.requires("jams").help("With --jams: coefficient of friction between the halves")),
    mut_arg("error_sigma", |arg| arg.requires("jams").help("With --jams: also compute the shares under normal errors with these standard deviations")),
    mut_arg("error_uniform", |arg| arg.requires("jams").help("With --jams: also compute the shares under uniform errors within ± these bounds")),
    mut_arg("error_measured", |arg| arg.requires("jams")),
    mut_arg("robots", |arg| arg.requires("jams")),
)]
pub(crate) struct RestsArgs {
    #[command(flatten)]
    pub(super) search: SearchArgs,
    /// Print the jams: rests that do not dock, their contacts and their share of the failures
    #[arg(long)]
    pub(super) jams: bool,
    #[command(flatten)]
    cause: CauseArgs,
}

/// How rests are searched, printed and stored.
#[derive(Debug, Args)]
pub(super) struct SearchArgs {
    #[command(flatten)]
    pub(super) design: DesignArgs,
    /// Sampled poses of the error box [default: 4000, fewer for round halves]
    #[arg(long, alias = "motions", value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    samples: Option<u32>,
    /// Seed of the sampled poses and of all searches
    #[arg(long, hide_short_help = true, value_name = "SEED", default_value_t = 1)]
    pub(super) seed: u64,
    /// Number of rests whose stability and escape path are computed
    #[arg(long, hide_short_help = true, value_name = "N", default_value_t = 6, value_parser = clap::value_parser!(u32).range(0..=1000))]
    examine: u32,
    /// Also compute depths on a grid with these cells per axis, such as 200 or x=100,pitch=50
    #[arg(long, hide_short_help = true, value_name = "CELLS", value_parser = resolution)]
    pub(super) resolution: Option<Resolution>,
    /// Also compute a guaranteed lower bound on the escape height: simple halves, at most two free errors
    #[arg(long, hide_short_help = true)]
    pub(super) certified: bool,
    #[command(flatten)]
    pub(super) result: ResultArgs,
    #[command(flatten)]
    pub(super) exec: ExecArgs,
}

impl SearchArgs {
    /// The number of sampled poses.
    pub(super) fn samples(&self) -> Option<usize> {
        self.samples.map(|samples| samples as usize)
    }

    /// The number of rests examined for stability and escape path.
    pub(super) const fn examined(&self) -> usize {
        self.examine as usize
    }
}

/// What jams depend on beside the halves.
#[derive(Debug, Args)]
pub(super) struct CauseArgs {
    /// Coefficient of friction between the halves
    #[arg(long, value_name = "MU", value_parser = number, default_value_t = 0.0, allow_negative_numbers = true)]
    pub(super) friction: f64,
    #[command(flatten)]
    pub(super) errors: SpreadArgs,
}

pub(crate) fn run(args: &RestsArgs) -> Result<ExitStatus, Failure> {
    let RestsArgs { search, jams, cause } = args;
    if *jams {
        return jams::of(search, cause);
    }
    let settings = RestsSettings {
        motions: search.samples(),
        seed: search.seed,
        examined: search.examined(),
        resolution: search.resolution,
        certified: search.certified,
    };
    let draw = |report: &RestsReport, problem: &Problem| Ok(figure::rests(report, problem.connector())?);
    study(&search.design, &search.result, &search.exec, Some(draw), |problem, exec| {
        Ok(find(problem, &settings, exec)?)
    })
}
