//! `catchment friction`: the effect of friction on docking.

use crate::args::DesignArgs;
use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::result_args::{ResultArgs, study};
use crate::setting::number;
use catchment::report::figure;
use catchment::study::friction::{FrictionError, FrictionSettings, run as follow};
use clap::Args;

/// Compute the share that docks at every friction coefficient
///
/// Follows the same sampled poses by exact motion with Coulomb friction at increasing coefficients, and finds the coefficient at which each
/// pose fails by bisection. Prints the share that docks, the losses and gains against no friction, the poses that may stick by Coulomb's law,
/// the friction up to which most poses still dock, and the features on which the first poses stick.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  catchment friction design.toml
  catchment friction design.toml --frictions 0.15,0.3 --samples 5000
  catchment friction design.toml -o friction.png
  catchment friction design.toml --require 'kept.p95.friction>=0.2'
  catchment friction design.toml --json | jq '.curve[] | {friction, lost}'")]
pub(crate) struct FrictionArgs {
    #[command(flatten)]
    pub(super) design: DesignArgs,
    /// Coefficients of friction; 0 is always included [default: 0.05,0.1,0.15,0.2,0.25,0.3,0.4,0.5]
    #[arg(long, value_name = "MU,…", value_parser = number, value_delimiter = ',')]
    frictions: Vec<f64>,
    /// Sampled poses of the error box [default: 1000, fewer for round halves]
    #[arg(long, alias = "motions", value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    samples: Option<u32>,
    /// Seed of the sampled poses
    #[arg(long, hide_short_help = true, value_name = "SEED", default_value_t = 1)]
    seed: u64,
    #[command(flatten)]
    result: ResultArgs,
    #[command(flatten)]
    exec: ExecArgs,
}

pub(crate) fn run(args: &FrictionArgs) -> Result<ExitStatus, Failure> {
    study(
        &args.design,
        &args.result,
        &args.exec,
        Some(|report, _| Ok(figure::friction(report))),
        |problem, exec| follow(problem, &args.settings(), exec).map_err(refused),
    )
}

impl FrictionArgs {
    fn settings(&self) -> FrictionSettings {
        let default = FrictionSettings::default();
        let frictions = if self.frictions.is_empty() { default.frictions } else { self.frictions.clone() };
        FrictionSettings { frictions, motions: self.samples.map(|samples| samples as usize), seed: self.seed }
    }
}

/// The error of the study, with advice.
fn refused(error: FrictionError) -> Failure {
    match &error {
        FrictionError::NoFrictions => Failure::with_help(
            error.to_string(),
            Some("--frictions 0.1,0.2 follows poses at these two".to_owned()),
        ),
        _ => error.into(),
    }
}
