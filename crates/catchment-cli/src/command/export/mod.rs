//! `catchment export`: files for other programs.
//!
//! ```text
//!   a design  ──▶ a drop test as world files: MJCF for MuJoCo, SDF for Gazebo
//!   a result  ──▶ the set over three axes for VTK and ParaView, or all cells as a table
//! ```

mod set;

use crate::args::{DesignArgs, dofs};
use crate::drop_args::DropArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::output::written;
use crate::result_args::PrintArgs;
use crate::signals;
use crate::source::is_stream;
use catchment::exec::Exec;
use catchment::method::drop::export::{Scene, mjcf, sdf};
use catchment::pose::DofSet;
use catchment::poses::parse_pose;
use catchment::report::folder::{Files, save_files};
use catchment::report::{ExportBody, ExportReport, write};
use clap::Args;
use std::path::PathBuf;

/// Write files for ParaView, pandas, MuJoCo and Gazebo
///
/// Of a result of `run -o`: the accepted set over up to three of its axes, as VTK image data or as its border surface, or all cells as a
/// table. Of a design: a drop simulation with the solids, mass, inertia, damping, friction, force, start and locked errors of --method drop,
/// so that you can repeat it in another engine. Pieces stay as in the design. A comment in each file states units and settings.
#[derive(Debug, Args)]
#[command(
    after_long_help = "\
Examples:
  catchment export out -o set.vti
      every cell: outcome, share, height
  catchment export out -o set.vtp --axes x,y,yaw --at \"pitch=5 deg\"
      the border of the accepted set
  catchment export out -o set.csv
      a line per cell, for pandas
  catchment export design.toml --pose \"x=0.2,pitch=10 deg\" -o trial
  catchment export design.toml --pose x=0.1 --friction 0.3 -o trial
  python -m mujoco.viewer --mjcf=trial/trial.xml
      then load key 0
  gz sim trial/trial.sdf

Of a result, -o writes .vti, .vtp or .csv, lengths in D and angles in radians.
Of a design, -o DIR writes trial.xml (MJCF with all meshes), trial.sdf and its
meshes. Pieces are convex; a mesh with undercuts is refused, because other
engines replace it by its convex hull.",
    mut_arg("path", |path| path.value_name("DESIGN|RESULT")
        .help("Design, folder written by `run -o`, or its NAME.zarr")
        .value_hint(clap::ValueHint::AnyPath))
)]
pub(crate) struct ExportArgs {
    #[command(flatten)]
    pub(super) design: DesignArgs,
    /// Of a design: pose error to start from, such as "x=0.2,pitch=10 deg"; errors that are not named are 0
    #[arg(long, value_name = "ERRORS", allow_hyphen_values = true)]
    pose: Option<String>,
    /// Of a result: up to three axes, such as x,y,yaw [default: the first three]
    #[arg(long, value_name = "AXES", value_parser = dofs)]
    axes: Option<DofSet>,
    /// Of a result: position along the other axes, such as "pitch=5 deg"; axes that are not named are at 0
    #[arg(long, value_name = "ERRORS", allow_hyphen_values = true)]
    at: Option<String>,
    /// Write into this folder; of a result, into this file
    ///
    /// `-` is stdout, which takes the table of a result.
    #[arg(short, long, value_name = "DIR|FILE", value_hint = clap::ValueHint::AnyPath)]
    output: PathBuf,
    /// Replace a file that exists
    ///
    /// A folder that catchment wrote is replaced without it, and no other folder.
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    print: PrintArgs,
    #[command(flatten)]
    drop: DropArgs,
}

const MJCF: &str = "trial.xml";
const SDF: &str = "trial.sdf";

/// Report kind that marks such a folder.
const KIND: &str = "export";

pub(crate) fn run(args: &ExportArgs) -> Result<ExitStatus, Failure> {
    let exec = Exec::new();
    signals::listen(&exec.cancel_flag())?;
    if args.design.path.is_dir() {
        return set::run(args, &exec);
    }
    if is_stream(&args.output) {
        let help = "name a folder: -o trial".to_owned();
        let message = "a drop test is several files, which stdout does not take".to_owned();
        return Err(Failure::with_help(message, Some(help)));
    }
    let of_a_result = [("--axes", args.axes.is_some()), ("--at", args.at.is_some())];
    if let Some((option, _)) = of_a_result.into_iter().find(|(_, given)| *given) {
        let help = "name a folder that `run -o` wrote, or its NAME.zarr".to_owned();
        return Err(Failure::with_help(format!("{option} is about a stored result"), Some(help)));
    }
    let Some(pose) = &args.pose else {
        let help = "--pose says where its drop test starts; a stored result needs none".to_owned();
        return Err(Failure::with_help(
            "a design is exported with the pose error of a trial".to_owned(),
            Some(help),
        ));
    };
    write::check_folder(&args.output, KIND, &exec)?;
    let problem = args.design.halves()?;
    let (design, pair) = (problem.design(), problem.pair());
    let error =
        parse_pose(pose, design).map_err(|diagnostics| Failure::of_option("--pose", pose, diagnostics))?;
    let settings = args.drop.settings()?;
    let scene = Scene::new(&design.name, pair, &settings, &error)?;
    let world = sdf::write(&scene)?;
    let meshes = world.meshes.len();
    let inside = |(name, bytes)| (format!("{}/{name}", sdf::MESHES), bytes);
    let mut files: Files = world.meshes.into_iter().map(inside).collect();
    files.push((SDF.to_owned(), world.text.into_bytes()));
    files.push((MJCF.to_owned(), mjcf::write(&scene).into_bytes()));
    save_files(&args.output, KIND, &files, &exec)?;
    written(&args.output);
    let file = |name: &str| args.output.join(name).display().to_string();
    let body = ExportBody {
        design: design.clone(),
        settings: serde_json::to_value(&settings)?,
        start: error,
        mjcf: file(MJCF),
        sdf: file(SDF),
        meshes,
    };
    let report = ExportReport::new(body, problem.warnings());
    args.print.print(&report, &report.described())
}
