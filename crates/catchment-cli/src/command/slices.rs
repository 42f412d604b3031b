//! `catchment slices`: two errors at a time, finely, with everything free.

use crate::args::DesignArgs;
use crate::drop_args::DropArgs;
use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::output::{to_stderr, to_stdout};
use crate::result_folder::Study;
use catchment::landscape::Resolution;
use catchment::pose::Dof;
use catchment::report::schema::Timing;
use catchment::report::{Report, SlicesReport, figure, zarr};
use catchment::study::slices::{Settings, run as compute};
use clap::{Args, ValueEnum};
use std::path::PathBuf;
use std::time::Instant;

/// Slices: two errors vary finely, all free ones move
///
/// Every cell of a plane through zero is followed exactly, or dropped in a rigid-body engine. The errors that do not vary begin at zero and are as free
/// to move as the design says; `run --free` locks them instead, which is another question.
#[derive(Debug, Args)]
#[command(after_long_help = "Examples:\n  \
    catchment slices design.toml -o out                 all pairs of free errors, in one picture\n  \
    catchment slices design.toml --axes x,pitch --axes x,yaw --resolution 201\n  \
    catchment slices design.toml --json | jq '.slices[].onaa.edge'\n  \
    catchment slices designs/x-face-3d.toml --axes x,y --axes x,roll --axes x,pitch --axes x,yaw --method drop\n                                                        the slices that the dissertation published\n\n\
    -o DIR: slices.png, slices.svg, slices.csv, report.json, and a Zarr group such as x-pitch.zarr for each.")]
pub(crate) struct SlicesArgs {
    #[command(flatten)]
    design: DesignArgs,
    /// Two errors to vary, such as x,pitch; may be repeated [default: all pairs of free errors]
    #[arg(long, value_name = "AXIS,AXIS", value_parser = pair)]
    axes: Vec<[Dof; 2]>,
    /// Cells per axis, such as 201 or x=201,yaw=91
    #[arg(long, value_name = "CELLS", default_value = "71", value_parser = resolution)]
    resolution: Resolution,
    /// What decides every cell
    #[arg(long, value_enum, default_value_t = Method::Descent)]
    method: Method,
    #[command(flatten)]
    drop: DropArgs,
    /// Write pictures, table, report and outcomes into this folder
    #[arg(short, long, value_name = "DIR", value_hint = clap::ValueHint::DirPath)]
    output: Option<PathBuf>,
    /// Print the report as JSON instead of the table
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    exec: ExecArgs,
}

/// Methods that decide every cell by itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Method {
    /// Exact quasi-static motion
    Descent,
    /// Three drop tests in a rigid-body engine
    Drop,
}

fn pair(text: &str) -> Result<[Dof; 2], String> {
    let dof = |name: &str| {
        let name = name.trim();
        Dof::ALL
            .into_iter()
            .find(|dof| dof.name() == name)
            .ok_or_else(|| format!("there is no axis `{name}`; the axes are x, y, roll, pitch and yaw"))
    };
    match text.split_once(',') {
        Some((a, b)) => Ok([dof(a)?, dof(b)?]),
        None => Err("a slice varies two errors, such as x,pitch".to_owned()),
    }
}

fn resolution(text: &str) -> Result<Resolution, String> {
    text.parse::<Resolution>().map_err(|error| error.to_string())
}

pub(crate) fn run(args: &SlicesArgs) -> Result<ExitStatus, Failure> {
    let started = Instant::now();
    let folder = args.output.as_deref().map(|path| Study { path, name: "slices" });
    if let Some(folder) = &folder {
        folder.check()?;
    }
    let (built, pair, doubts) = args.design.build()?.into_pair()?;
    let design = &built.input.design;
    let drop = match args.method {
        Method::Descent => args.drop.refuse("descent").map(|()| None),
        Method::Drop => args.drop.settings().map(Some),
    }?;
    let settings =
        Settings { resolution: args.resolution, pairs: args.axes.clone(), drop, ..Settings::default() };

    let running = args.exec.start()?;
    let found = compute(&pair, &settings, &running.exec)?;
    let timing = Timing { total_s: started.elapsed().as_secs_f64(), threads: running.exec.threads() };
    let report = SlicesReport::new(design, &found, settings, Some(timing));
    let json = report.to_json()?;
    let mut notes: Vec<String> = doubts.into_iter().map(|doubt| format!("warning: {doubt}")).collect();
    if let Some(folder) = &folder {
        let picture = figure::slice_matrix(design, &built.connector, &found)?;
        let settings = match &report.settings.drop {
            Some(drop) => serde_json::to_value(drop)?,
            None => serde_json::to_value(&report.settings.descent)?,
        };
        let written = folder.write(&json, &report.records(), picture, &running.exec, |folder| {
            for (slice, of) in found.slices.iter().zip(&report.slices) {
                running.exec.check()?;
                let whole = Report::new(design, &slice.acceptance, settings.clone(), None, &running.exec)?;
                let path = folder.join(of.name() + ".zarr");
                zarr::write(&path, &whole, &slice.acceptance, None, &running.exec)?;
            }
            Ok(())
        })?;
        notes.push(format!("{written}, {} Zarr groups", found.slices.len()));
    }
    std::mem::drop(running);
    to_stdout(&if args.json { json } else { report.table() })?;
    to_stderr(&notes);
    Ok(ExitStatus::Done)
}
