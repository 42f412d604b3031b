//! `catchment export`: a drop test as world files of other engines.

use crate::args::DesignArgs;
use crate::drop_args::DropArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::output::{to_stderr, to_stdout, written};
use crate::signals;
use catchment::exec::Exec;
use catchment::method::drop::export::{Scene, mjcf, sdf};
use catchment::poses::parse_pose;
use catchment::report::folder::{Files, save_files};
use catchment::report::schema::WarningReport;
use catchment::report::{ExportBody, ExportReport, write};
use clap::Args;
use std::path::PathBuf;

/// Write a drop test for other engines: MJCF for MuJoCo, SDF for Gazebo
///
/// The same pieces, mass, inertia, damping, friction, force, start and locked degrees of freedom as `--method drop`, so that
/// whoever doubts it can run it again. A comment in each file says the units and what was set.
#[derive(Debug, Args)]
#[command(after_long_help = "Examples:\n  \
    catchment export design.toml --pose \"x=0.2,pitch=10 deg\" -o trial\n  \
    catchment export design.toml --pose x=0.1 --friction 0.3 -o trial\n  \
    python -m mujoco.viewer --mjcf=trial/trial.xml      then load key 0\n  \
    gz sim trial/trial.sdf\n\n\
    -o DIR: trial.xml (MJCF, all inside), trial.sdf and the meshes that it names. Pieces are convex; a mesh with undercuts is\n\
    refused, because other engines would replace it by its convex hull.")]
pub(crate) struct ExportArgs {
    #[command(flatten)]
    design: DesignArgs,
    /// The pose error to start from, such as "x=0.2,pitch=10 deg"; what is not named is 0
    #[arg(long, value_name = "ERRORS", allow_hyphen_values = true)]
    pose: String,
    /// Write into this folder
    #[arg(short, long, value_name = "DIR", value_hint = clap::ValueHint::DirPath)]
    output: PathBuf,
    /// Print what was written as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    drop: DropArgs,
}

const MJCF: &str = "trial.xml";
const SDF: &str = "trial.sdf";

/// The kind of such a folder.
const KIND: &str = "export";

pub(crate) fn run(args: &ExportArgs) -> Result<ExitStatus, Failure> {
    let exec = Exec::new();
    signals::listen(&exec.cancel_flag())?;
    write::check_folder(&args.output, KIND)?;
    let problem = args.design.problem()?;
    let (design, pair) = (problem.design(), problem.pair());
    let error = parse_pose(&args.pose, design)
        .map_err(|findings| Failure::of_option("--pose", &args.pose, findings))?;
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
    let said: Vec<String> = problem.objections().iter().map(|doubt| format!("warning: {doubt}")).collect();
    let body = ExportBody {
        design: design.clone(),
        settings: serde_json::to_value(&settings)?,
        start: error,
        mjcf: file(MJCF),
        sdf: file(SDF),
        meshes,
    };
    let report = ExportReport::new(body, problem.objections().iter().map(WarningReport::note).collect());
    to_stdout(&if args.json { report.to_json()? } else { report.table() })?;
    to_stderr(&said);
    Ok(ExitStatus::Done)
}
