//! `catchment latch`: the latching X-Face, from a few lengths to laser-cutter drawings.

use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::output::written;
use crate::result_args::ResultArgs;
use crate::signals;
use crate::source::read_table;
use catchment::exec::Exec;
use catchment::report::folder::{encode, save_files};
use catchment::report::{ReportBody, csv};
use catchment_systems::latch::figure::{LatchDrawings, chart};
use catchment_systems::latch::force::Forces;
use catchment_systems::latch::{LatchBody, LatchDesign, TableBody, connector, drawing, press, report, table};
use clap::Args;
use std::path::{Path, PathBuf};

/// Design a latching X-Face: forces and laser-cutter drawings
///
/// Two equal halves align, press their arms aside and hook into each other. The outline follows the design principles of the dissertation
/// (chapter 6); the command checks every rule and prints it with its reason. Forces are fits to nine measured prototypes, with an error of
/// 10 %.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  catchment latch design.toml
      rules, stiffness, forces and bonding ratio
  catchment latch design.toml -o out
      DXF and SVG of every sheet, pictures, the record of a press
  catchment latch --table
      the nine measured prototypes beside the model
  catchment latch --table --csv

The design file has a table [latch] with any of width, overhang, neck, hook,
kerf, sheet, separator, layers, E (GPa), poisson, slit_distance, slit_depth,
slit_gap, wide_slit, cutout_depth, l_eq, spline_start, spline_end, bend, sides
(1 or 3), base, dowel, module_width, rotor_distance, and a table [press] with
friction, offset, tilt. Missing keys have the values of the dissertation. -o DIR
writes NAME.dxf (the part), NAME-cut.dxf and NAME-cut.svg (the path of the
laser) and connector.toml (the aligning part of the face, for `catchment run`).")]
pub(crate) struct LatchArgs {
    /// Design file; - reads stdin
    #[arg(value_name = "DESIGN", value_hint = clap::ValueHint::FilePath, required_unless_present = "table")]
    design: Option<PathBuf>,
    /// Print table 6.1 beside the model instead
    #[arg(long, conflicts_with = "design")]
    table: bool,
    #[command(flatten)]
    result: ResultArgs,
}

pub(crate) fn run(args: &LatchArgs) -> Result<ExitStatus, Failure> {
    match &args.design {
        Some(design) => of_design(args, design),
        None => of_table(args),
    }
}

fn of_table(args: &LatchArgs) -> Result<ExitStatus, Failure> {
    let output = args.result.check(TableBody::KIND, true)?;
    let forces = Forces::new()?;
    output.finish(&table::report(&forces), || Ok(chart(&forces, None)))
}

fn of_design(args: &LatchArgs, design: &Path) -> Result<ExitStatus, Failure> {
    let mut output = args.result.check(LatchBody::KIND, true)?;
    let folder = output.take_folder();
    // Read before the signal handler starts: waiting for a pipe cannot be cancelled.
    let source = read_table(design)?;
    let exec = Exec::new();
    signals::listen(&exec.cancel_flag())?;
    let (latch, geometry) = LatchDesign::read(source)?;
    let (forces, record) = (Forces::new()?, press::record(&latch, &geometry)?);
    let drawn = LatchDrawings { latch: &latch, geometry: &geometry, record: &record, forces: &forces };
    let mut report = report::report(&latch, &geometry, &forces, &record);
    if let Some(folder) = folder {
        let mut files = drawing::files(&latch, &geometry)?;
        files.extend(encode(&drawn.all(), &exec)?);
        files.push(("press.csv".to_owned(), csv(&report.records())?));
        files.push(("connector.toml".to_owned(), connector::design(&latch, &geometry).into_bytes()));
        report.files = files.iter().map(|(name, _)| name.clone()).collect();
        files.push(("report.json".to_owned(), report.to_json()?.into_bytes()));
        save_files(folder, LatchBody::KIND, &files, &exec)?;
        written(folder);
    }
    output.finish(&report, || Ok(drawn.overview()))
}
