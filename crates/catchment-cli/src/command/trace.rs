//! `catchment trace`: one pose from first contact to its end, or the outcome of every pose in a table.

use super::outcome::{Batch, Point};
use crate::args::DesignArgs;
use crate::drop_args::DropArgs;
use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::result_args::{Output, ResultArgs};
use catchment::document::Subject;
use catchment::exec::Exec;
use catchment::method::descent::{DescentSettings, Trajectory};
use catchment::method::drop::Bench;
use catchment::method::kinematic::LeverPose;
use catchment::poses::parse_pose;
use catchment::problem::Problem;
use catchment::report::{FirstContact, LeverReport, ReportBody, TraceBody, TraceReport, figure, gltf, vtk};
use clap::{ArgGroup, Args, ValueEnum};
use std::path::{Path, PathBuf};

/// Follow one pose error, or every pose of a table, to its outcome
///
/// --pose follows a single pose error from first contact to its end and prints waypoints along the path. The motion is exact and quasi-static:
/// no inertia, permanent contact, Coulomb friction if given. --method drop simulates a trial in a rigid-body engine instead, with speed, mass
/// and bounce. --method kinematic prints the first contact only: rotation points, lever arms and angles of the planar analysis.
///
/// --poses reads a table (CSV) and prints it again with the outcome of every pose (aligned, jammed, missed, undecided) and its final pose
/// error, row by row. An interrupted run prints the finished rows, or writes them into FILE.partial.
#[derive(Debug, Args)]
#[command(
    group = ArgGroup::new("start").args(["pose", "poses"]).required(true),
    after_long_help = "\
Examples:
  catchment trace design.toml --pose \"x=0.2,pitch=10 deg\"
  catchment trace design.toml --pose \"x=5 mm\" -o trace.png
  catchment trace design.toml --pose \"x=5 mm\" -o trace.glb
      an animation for browsers, Blender and slides
  catchment trace design.toml --pose \"x=0.2,yaw=0.3\" --json | jq .outcome
  catchment trace x-face.toml --cor=-0.5 --pose \"x=0.2,pitch=10 deg\" \\
      --method kinematic -o levers.svg
  catchment trace design.toml --pose \"x=0.2,pitch=10 deg\" \\
      --method drop --damping 10 --speed 2
  catchment trace design.toml --poses poses.csv -o outcomes.csv
  printf 'x_mm,pitch_deg\\n5,10\\n' | catchment trace design.toml --poses -
  catchment trace design.toml --poses poses.csv --json | jq .counts

Lengths are in D and angles in radians unless they have a unit. For one pose,
CSV has a line per contact point, and -o also writes .vtp (path, contacts and
halves for ParaView) and .glb (glTF animation, in metres).

Columns of a table: x, y, roll, pitch, yaw in any order; missing columns are 0.
The name states the unit: x_mm, y_in, x_D, pitch_deg, yaw [rad], x (mm). Other
columns are copied, and listed on stderr; a name that resembles an error (dx,
X_mm) is refused. Final errors have the units of their columns. A table has at
most 64 MiB and 1 000 000 poses.")]
pub(crate) struct TraceArgs {
    #[command(flatten)]
    pub(super) design: DesignArgs,
    /// Pose error to start from, such as "x=0.2,pitch=10 deg"; errors that are not named are 0
    #[arg(long, value_name = "ERRORS", allow_hyphen_values = true)]
    pose: Option<String>,
    /// Table of pose errors (CSV); - reads stdin. The outcomes go to stdout, or into the file of -o
    #[arg(long, value_name = "FILE", value_hint = clap::ValueHint::FilePath)]
    pub(super) poses: Option<PathBuf>,
    /// Table: point of the moving half at which x and y are measured [default: face]
    #[arg(long, hide_short_help = true, value_enum, requires = "poses", conflicts_with = "pose")]
    offsets_at: Option<Point>,
    /// Method that follows the pose
    #[arg(long, value_enum, default_value_t = By::Descent)]
    method: By,
    #[command(flatten)]
    drop: DropArgs,
    #[command(flatten)]
    result: ResultArgs,
    #[command(flatten)]
    exec: ExecArgs,
}

/// What can be shown of one pose.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum By {
    /// The exact quasi-static motion
    Descent,
    /// The first contact of a planar face: rotation points, lever arms, angles
    Kinematic,
    /// A drop simulation in a rigid-body engine
    Drop,
}

/// File formats for motions.
const MOTIONS: [&str; 2] = ["vtp", "glb"];

pub(crate) fn run(args: &TraceArgs) -> Result<ExitStatus, Failure> {
    match &args.poses {
        Some(poses) => table(args, poses),
        // clap requires one of the two.
        None => one(args, args.pose.as_deref().unwrap_or_default()),
    }
}

/// Computes the outcomes of a table of poses.
fn table(args: &TraceArgs, poses: &Path) -> Result<ExitStatus, Failure> {
    if args.method == By::Kinematic {
        let help = "--method descent follows every pose of a table, --method drop simulates it".to_owned();
        let message = "--method kinematic shows the first contact of one pose".to_owned();
        return Err(Failure::with_help(message, Some(help)));
    }
    let (json, output) = args.result.as_table(&MOTIONS)?;
    let method = args.drop.of(if args.method == By::Drop { "drop" } else { "descent" })?;
    let offsets_at = args.offsets_at.unwrap_or(Point::Face);
    Batch { design: &args.design, poses, method, offsets_at, json, output: &output, exec: &args.exec }.run()
}

/// Computes the path of one pose.
fn one(args: &TraceArgs, pose: &str) -> Result<ExitStatus, Failure> {
    let (kind, own): (_, &[&'static str]) = match args.method {
        // A first contact has no trajectory.
        By::Kinematic => (FirstContact::KIND, &[]),
        By::Descent | By::Drop => (TraceBody::KIND, &MOTIONS),
    };
    let output = args.result.check_with(kind, true, own)?;
    let problem = args.design.problem()?;
    let design = problem.design();
    let error =
        parse_pose(pose, design).map_err(|diagnostics| Failure::of_option("--pose", pose, diagnostics))?;
    match args.method {
        By::Kinematic => {
            if let Some(change) = args.drop.changes().first() {
                return Err(Failure::with_help(
                    format!(
                        "{} means nothing to the levers of the kinematic method: they know no friction and no drop",
                        change.option
                    ),
                    Some("leave it out, or follow the pose exactly (--method descent)".to_owned()),
                ));
            }
            let start = LeverPose::of(&problem, &error)?;
            let report = LeverReport::new(design, FirstContact::from(&start), Vec::new(), None);
            output.finish(&report, || Ok(figure::lever(design, problem.connector(), &start)?))
        }
        By::Drop => {
            let settings = args.drop.settings()?;
            let path = Bench::new(problem.pair())?.trace(&error, &settings, &Exec::new())?;
            let report = TraceReport::of_drop(design, &settings, error, &path, problem.warnings());
            finish(output, &report, &problem, &path.trajectory())
        }
        By::Descent => {
            let settings = DescentSettings::with_friction(args.drop.friction())?;
            // Rejects settings that belong to drop tests.
            args.drop.of("descent")?;
            let (path, reason) = problem.trace(&error, &settings);
            let report = TraceReport::new(&problem, &settings, error, &path, reason);
            finish(output, &report, &problem, &path)
        }
    }
}

/// Writes and prints a path, also for VTK and as an animation.
fn finish(
    output: Output<'_>,
    report: &TraceReport,
    problem: &Problem,
    path: &Trajectory,
) -> Result<ExitStatus, Failure> {
    let connector = problem.connector();
    if let Some(ending) = output.own() {
        let motion =
            if ending == "glb" { gltf::glb(report, connector) } else { vtk::motion(report, connector) };
        let bytes = motion.ok_or_else(|| {
            let failure = Failure::with_help("the halves never met, there is no path".to_owned(), None);
            failure.ends(ExitStatus::NotComputed)
        })?;
        output.write_own(&bytes)?;
    }
    output.finish(report, || Ok(figure::trajectory(problem.design(), connector, path)?))
}
