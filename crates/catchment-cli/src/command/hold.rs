//! `catchment hold`: the force and torque that a docked half withstands.

use crate::args::{DesignArgs, quantity};
use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::result_args::{ResultArgs, study};
use crate::setting::number;
use catchment::design::Quantity;
use catchment::poses::parse_pose;
use catchment::problem::Problem;
use catchment::report::figure;
use catchment::study::hold::{HoldError, HoldSettings, HoldingForces, run as find};
use clap::Args;

/// Compute the force and torque that a docked half withstands
///
/// A preload along -z through the centre of rotation presses the half into its mated pose. The command finds the smallest lateral force, in
/// every direction, and the smallest torque about every free axis that the contacts cannot balance: as shares of the preload, or in N. It
/// gives both for a guided half (which moves with the push and along z only) and for a half that may tilt.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  catchment hold design.toml
  catchment hold design.toml --friction 0.2 --preload 40 -o hold.png
  catchment hold design.toml --lever '30 mm'
      pushed 30 mm above the face centre
  catchment hold design.toml --pose 'x=0.1,pitch=100 deg'
      at the rest that this pose reaches
  catchment hold design.toml --require 'least_force>=0.3'
  catchment hold design.toml --json | jq '.weakest.smooth_free'

Forces are shares of the preload, torques of the preload times D, and angles
are in radians in CSV and JSON.")]
pub(crate) struct HoldArgs {
    #[command(flatten)]
    pub(super) design: DesignArgs,
    /// Coefficient of friction between the halves
    #[arg(long, value_name = "MU", value_parser = number, default_value_t = 0.0, allow_negative_numbers = true)]
    friction: f64,
    /// Preload in newtons; prints forces in N instead of shares of the preload
    #[arg(long, value_name = "NEWTONS", value_parser = newtons, allow_hyphen_values = true)]
    preload: Option<f64>,
    /// Height of the push above the face centre of the moving half, in D or with a unit, such as "30 mm"
    #[arg(long, value_name = "LENGTH", value_parser = quantity, allow_hyphen_values = true, default_value = "0")]
    lever: Quantity,
    /// Pose error to release; the half is held at the rest that it reaches [default: the mated pose]
    #[arg(long, value_name = "ERRORS", allow_hyphen_values = true)]
    pose: Option<String>,
    /// Largest gap that counts as contact: play that is taken up [default: 1e-4 D]
    #[arg(long, hide_short_help = true, value_name = "LENGTH", value_parser = quantity, allow_hyphen_values = true)]
    play: Option<Quantity>,
    /// Number of lateral directions
    #[arg(long, hide_short_help = true, value_name = "N", default_value_t = 72, value_parser = clap::value_parser!(u32).range(4..=3600))]
    directions: u32,
    #[command(flatten)]
    result: ResultArgs,
    #[command(flatten)]
    exec: ExecArgs,
}

pub(crate) fn run(args: &HoldArgs) -> Result<ExitStatus, Failure> {
    study(
        &args.design,
        &args.result,
        &args.exec,
        Some(|report, _| Ok(figure::hold(report)?)),
        |problem, exec| {
            let found = find(problem, &args.settings(problem)?, exec).map_err(refused)?;
            Ok(HoldingForces { preload_n: args.preload, ..found })
        },
    )
}

impl HoldArgs {
    fn settings(&self, problem: &Problem) -> Result<HoldSettings, Failure> {
        let design = problem.design();
        let length = |option: &str, quantity: &Quantity| {
            quantity
                .length_d(&design.scale())
                .map_err(|defect| Failure::with_help(format!("{option}: {defect}"), defect.help()))
        };
        let pose = match &self.pose {
            None => None,
            Some(text) => Some(
                parse_pose(text, design)
                    .map_err(|diagnostics| Failure::of_option("--pose", text, diagnostics))?,
            ),
        };
        let play = self.play.as_ref().map(|play| length("--play", play)).transpose()?;
        let defaults = HoldSettings::default();
        Ok(HoldSettings {
            friction: self.friction,
            directions: self.directions as usize,
            lever: length("--lever", &self.lever)?,
            play: play.unwrap_or(defaults.play),
            pose,
        })
    }
}

/// Parses a preload in newtons.
fn newtons(text: &str) -> Result<f64, String> {
    let preload =
        number(text).map_err(|reason| format!("a preload is a number of newtons, such as 40; {reason}"))?;
    if preload > 0.0 {
        return Ok(preload);
    }
    Err("a preload presses the half on: a number above 0, in newtons".to_owned())
}

/// The error of the study, with advice.
fn refused(error: HoldError) -> Failure {
    let help = match &error {
        HoldError::NoRest { .. } => {
            Some("catchment trace --pose shows its way; start from a pose that comes to rest")
        }
        HoldError::NotHeld => Some(
            "catchment check says whether the aligned pose is a mated one; --play takes what is farther apart for touching",
        ),
        _ => None,
    };
    match help {
        Some(help) => Failure::explained(&error, Some(help.to_owned())),
        None => error.into(),
    }
}
