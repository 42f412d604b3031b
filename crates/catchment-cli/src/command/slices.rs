//! `catchment slices`: two errors at a time on a fine grid, all degrees of freedom free.

use super::run::resolution;
use crate::args::DesignArgs;
use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::method_args::PoseMethodArgs;
use crate::output::lines;
use crate::result_args::ResultArgs;
use catchment::document::Subject;
use catchment::landscape::Resolution;
use catchment::pose::Dof;
use catchment::report::schema::Timing;
use catchment::report::{SlicesReport, SlicesResult, figure, save_slices};
use catchment::study::slices::{SlicesError, SlicesSettings, ensure_fits, run as compute};
use catchment::terminal::escaped;
use clap::Args;
use std::path::Path;
use std::time::Instant;

/// Compute fine sections through the area, two errors at a time
///
/// Follows every cell of a plane through zero by exact motion, or simulates it in a rigid-body engine. The other errors start at zero and
/// stay free to move as in the design; `run --free` locks them instead, which gives another area.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  catchment slices design.toml -o out
      all pairs of free errors, in a single picture
  catchment slices design.toml --axes x,pitch --axes x,yaw --resolution 201
  catchment slices design.toml --json | jq '.slices[].onaa.edge'
  catchment slices designs/x-face-3d.toml --axes x,y --axes x,roll \\
      --axes x,pitch --axes x,yaw --method drop
      the slices that the dissertation published

A folder also gets a Zarr group such as x-pitch.zarr for each slice.")]
pub(crate) struct SlicesArgs {
    #[command(flatten)]
    pub(super) design: DesignArgs,
    /// Two errors to vary, such as x,pitch; may be repeated [default: all pairs of free errors]
    #[arg(long, value_name = "AXIS,AXIS", value_parser = pair)]
    axes: Vec<[Dof; 2]>,
    /// Cells per axis, such as 201 or x=201,yaw=91
    #[arg(long, value_name = "CELLS", default_value = "71", value_parser = resolution)]
    resolution: Resolution,
    #[command(flatten)]
    method: PoseMethodArgs,
    #[command(flatten)]
    result: ResultArgs,
    #[command(flatten)]
    exec: ExecArgs,
}

fn pair(text: &str) -> Result<[Dof; 2], String> {
    let dof = |name: &str| name.trim().parse::<Dof>().map_err(|error| escaped(&error.to_string()));
    match text.split_once(',') {
        Some((a, b)) => Ok([dof(a)?, dof(b)?]),
        None => Err("a slice varies two errors, such as x,pitch".to_owned()),
    }
}

pub(crate) fn run(args: &SlicesArgs) -> Result<ExitStatus, Failure> {
    let started = Instant::now();
    let output = args.result.check(SlicesResult::KIND, true)?;
    let problem = args.design.problem()?;
    let settings =
        SlicesSettings { resolution: args.resolution, pairs: args.axes.clone(), method: args.method.of()? };
    let running = args.exec.start()?;
    let exec = &running.exec;
    let refused = |error| match error {
        SlicesError::Resolution(error) => Failure::with_help(format!("--resolution: {error}"), None),
        error => error.into(),
    };
    let cells = ensure_fits(&problem, &settings, exec).map_err(refused)?;
    if output.wants_picture() {
        figure::ensure_fits(cells, exec)?;
    }
    let results = compute(&problem, &settings, exec).map_err(refused)?;
    let timing = Timing { total_s: started.elapsed().as_secs_f64(), threads: exec.threads() };
    let design = problem.design();
    let report = SlicesReport::new(design, SlicesResult::of(&results, settings), Vec::new(), Some(timing));
    let picture = || Ok(vec![("slices", figure::slice_matrix(design, problem.connector(), &results)?)]);
    let groups = |folder: &Path| {
        save_slices(&results, folder, &problem, &report, exec)?;
        Ok(format!(", {} Zarr groups", results.slices.len()))
    };
    let mut notes = lines(&problem.warnings());
    notes.extend(output.write(&report, picture, groups, exec)?);
    drop(running);
    output.print(&report, &notes)
}
