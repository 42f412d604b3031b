//! `catchment trace`: the way of one pose from first contact to its end.

use crate::args::DesignArgs;
use crate::drop_args::DropArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::output::{FileArgs, to_stderr, to_stdout};
use catchment::exec::Exec;
use catchment::method::descent::Settings;
use catchment::method::drop::Bench;
use catchment::method::kinematic::Start;
use catchment::pose::PoseError;
use catchment::poses::parse_pose;
use catchment::problem::Problem;
use catchment::report::schema::WarningReport;
use catchment::report::{FirstContact, LeverReport, TraceReport, csv, figure, gltf, vtk};
use clap::{Args, ValueEnum};

/// Follow one pose from first contact to its end
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
    Lengths are in D and angles in radians unless they have a unit. -o writes .png and .svg (pictures), .csv (a \
    line per contact point), .json, .vtp (way, contacts and halves for ParaView) and .glb (glTF animation, in metres).")]
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
    /// Print the whole path as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    file: FileArgs,
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

/// The endings of its files; the last two show motions.
const KINDS: [&str; 6] = ["png", "svg", "csv", "json", "vtp", "glb"];

pub(crate) fn run(args: &TraceArgs) -> Result<ExitStatus, Failure> {
    // A first contact is no motion.
    let known = if args.method == By::Kinematic { &KINDS[..4] } else { &KINDS };
    let kind = args.file.kind(known)?;
    let problem = args.design.problem()?;
    let design = problem.design();
    let error = parse_pose(&args.pose, design)
        .map_err(|findings| Failure::of_option("--pose", &args.pose, findings))?;
    if args.method == By::Kinematic {
        if let Some(change) = args.drop.changes().first() {
            return Err(Failure::with_help(
                format!(
                    "{} means nothing to the levers of the kinematic method: they know no friction and no drop",
                    change.option
                ),
                Some("leave it out, or follow the pose exactly (--method descent)".to_owned()),
            ));
        }
        let start = Start::of(&problem, &error)?;
        let report = LeverReport::new(design, FirstContact::from(&start), Vec::new(), None);
        let told = if args.json { report.to_json()? } else { report.table() };
        match kind {
            Some("csv") => args.file.write(&csv(&report.records())?)?,
            Some("json") => args.file.write(report.to_json()?.as_bytes())?,
            Some(picture) => args.file.draw(picture, &figure::lever(design, problem.connector(), &start)?)?,
            None => {}
        }
        to_stdout(&told)?;
        return Ok(ExitStatus::Done);
    }
    if args.method == By::Drop {
        return dropped(args, &problem, &error, kind);
    }
    let settings = Settings::with_friction(args.drop.friction())?;
    // Other settings are of drop tests.
    args.drop.of("descent")?;
    let (path, reason) = problem.trace(&error, &settings);
    let report = TraceReport::new(&problem, &settings, error, &path, reason);
    let said = report.warnings.iter().map(WarningReport::line).collect::<Vec<_>>();
    match kind {
        Some("csv") => args.file.write(&csv(&report.records())?)?,
        Some("json") => args.file.write(report.to_json()?.as_bytes())?,
        Some(kind @ ("vtp" | "glb")) => args.write_motion(kind, &report, &problem)?,
        Some(picture) => args.file.draw(picture, &figure::trajectory(design, problem.connector(), &path)?)?,
        None => {}
    }
    to_stdout(&if args.json { report.to_json()? } else { report.table() })?;
    to_stderr(&said);
    Ok(ExitStatus::Done)
}

/// The way of one trial.
fn dropped(
    args: &TraceArgs,
    problem: &Problem,
    error: &PoseError,
    kind: Option<&str>,
) -> Result<ExitStatus, Failure> {
    let design = problem.design();
    let settings = args.drop.settings()?;
    let path = Bench::new(problem.pair())?.trace(error, &settings, &Exec::new())?;
    let doubts: Vec<WarningReport> = problem.objections().iter().map(WarningReport::note).collect();
    let said: Vec<String> = doubts.iter().map(|doubt| format!("warning: {}", doubt.message)).collect();
    let report = TraceReport::of_drop(design, &settings, *error, &path, doubts);
    match kind {
        Some("csv") => args.file.write(&csv(&report.records())?)?,
        Some("json") => args.file.write(report.to_json()?.as_bytes())?,
        Some(kind @ ("vtp" | "glb")) => args.write_motion(kind, &report, problem)?,
        Some(picture) => {
            args.file.draw(picture, &figure::trajectory(design, problem.connector(), &path.trajectory())?)?;
        }
        None => {}
    }
    to_stdout(&if args.json { report.to_json()? } else { report.table() })?;
    to_stderr(&said);
    Ok(ExitStatus::Done)
}

impl TraceArgs {
    /// Writes the motion for VTK or as an animation.
    fn write_motion(&self, kind: &str, report: &TraceReport, problem: &Problem) -> Result<(), Failure> {
        let connector = problem.connector();
        let written =
            if kind == "glb" { gltf::glb(report, connector) } else { vtk::motion(report, connector) };
        let bytes = written
            .ok_or_else(|| Failure::with_help("the halves never met, there is no path".to_owned(), None))?;
        self.file.write(&bytes)
    }
}
