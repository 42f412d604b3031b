//! `catchment trace`: the way of one pose from first contact to its end.

use crate::args::DesignArgs;
use crate::drop_args::DropArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::result_args::{Output, ResultArgs, warnings};
use catchment::document::Subject;
use catchment::exec::Exec;
use catchment::method::descent::{DescentSettings, Trajectory};
use catchment::method::drop::Bench;
use catchment::method::kinematic::LeverPose;
use catchment::poses::parse_pose;
use catchment::problem::Problem;
use catchment::report::{FirstContact, LeverReport, ReportBody, TraceBody, TraceReport, figure, gltf, vtk};
use clap::{Args, ValueEnum};

/// Follow one pose error to its outcome: contacts, path, picture
///
/// The motion is exact and quasi-static: no inertia, contact kept, Coulomb friction where it is given; by the drop method it is one trial
/// in a rigid-body engine, with speed, mass and bounce, from where the half is let go. Prints waypoints spread over the
/// path; -o writes all of them, or a picture. By the kinematic method it is the first contact alone: rotation points, lever
/// arms and angles of the dissertation's planar analysis.
#[derive(Debug, Args)]
#[command(after_long_help = "Examples:\n  \
    catchment trace design.toml --pose \"x=0.2,pitch=10 deg\"\n  \
    catchment trace design.toml --pose \"x=5 mm\" -o trace.png\n  \
    catchment trace design.toml --pose \"x=5 mm\" -o trace.glb       an animation, for browsers, Blender and slides\n  \
    catchment trace design.toml --pose \"x=0.2,yaw=0.3\" --json | jq .outcome\n  \
    catchment trace x-face.toml --cor=-0.5 --pose \"x=0.2,pitch=10 deg\" --method kinematic -o levers.svg\n  \
    catchment trace design.toml --pose \"x=0.2,pitch=10 deg\" --method drop --damping 10 --speed 2\n\n\
    Lengths are in D and angles in radians unless they have a unit. CSV has a line per contact \
    point. -o also writes .vtp (path, contacts and halves for ParaView) and .glb (glTF animation, in metres).")]
pub(crate) struct TraceArgs {
    #[command(flatten)]
    pub(super) design: DesignArgs,
    /// The pose error to start from, such as "x=0.2,pitch=10 deg"; what is not named is 0
    #[arg(long, value_name = "ERRORS", allow_hyphen_values = true)]
    pose: String,
    /// What follows the pose
    #[arg(long, value_enum, default_value_t = By::Descent)]
    method: By,
    #[command(flatten)]
    drop: DropArgs,
    #[command(flatten)]
    result: ResultArgs,
}

/// What can be shown of one pose.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum By {
    /// The exact quasi-static motion
    Descent,
    /// The first contact of a planar face: rotation points, lever arms, angles
    Kinematic,
    /// One dynamic drop test in a rigid-body engine, from where the half is let go
    Drop,
}

/// What shows motions.
const MOTIONS: [&str; 2] = ["vtp", "glb"];

pub(crate) fn run(args: &TraceArgs) -> Result<ExitStatus, Failure> {
    let (kind, own): (_, &[&'static str]) = match args.method {
        // A first contact is no motion.
        By::Kinematic => (FirstContact::KIND, &[]),
        By::Descent | By::Drop => (TraceBody::KIND, &MOTIONS),
    };
    let output = args.result.check_with(kind, true, own)?;
    let problem = args.design.problem()?;
    let design = problem.design();
    let error = parse_pose(&args.pose, design)
        .map_err(|diagnostics| Failure::of_option("--pose", &args.pose, diagnostics))?;
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
            let report = TraceReport::of_drop(design, &settings, error, &path, warnings(&problem));
            finish(output, &report, &problem, &path.trajectory())
        }
        By::Descent => {
            let settings = DescentSettings::with_friction(args.drop.friction())?;
            // Other settings are of drop tests.
            args.drop.of("descent")?;
            let (path, reason) = problem.trace(&error, &settings);
            let report = TraceReport::new(&problem, &settings, error, &path, reason);
            finish(output, &report, &problem, &path)
        }
    }
}

/// Writes and prints a path, for VTK and as an animation too.
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
        let bytes = motion
            .ok_or_else(|| Failure::with_help("the halves never met, there is no path".to_owned(), None))?;
        output.write_own(&bytes)?;
    }
    output.finish(report, || Ok(figure::trajectory(problem.design(), connector, path)?))
}
