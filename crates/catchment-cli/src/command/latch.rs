//! `catchment latch`: the latching X-Face, from a few lengths to what a laser cutter takes.

use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::output::{FileArgs, to_stderr, to_stdout, written};
use crate::signals;
use crate::source::read_table;
use catchment::exec::Exec;
use catchment::report::csv;
use catchment::report::folder::{Files, encode, save_files};
use catchment::report::schema::WarningReport;
use catchment_systems::latch::figure::{Drawn, chart};
use catchment_systems::latch::force::Forces;
use catchment_systems::latch::report::press_records;
use catchment_systems::latch::{Latch, connector, drawing, press, report, table};
use clap::Args;
use std::path::{Path, PathBuf};

/// A latching X-Face: outline, forces to latch and to break, drawings for a laser cutter
///
/// Two halves of one shape align, press their arms aside and hook into each other. The outline follows from the
/// dissertation's design principles (chapter 6); every rule is checked and told with its reason. Forces are fits to nine
/// measured prototypes, with the error of a tenth.
#[derive(Debug, Args)]
#[command(after_long_help = "Examples:\n  \
    catchment latch design.toml            its rules, stiffness, forces and bonding ratio\n  \
    catchment latch design.toml -o out     DXF and SVG of every sheet, pictures, the record of a press\n  \
    catchment latch --table                the nine measured prototypes beside the model\n  \
    catchment latch --table -o table.csv   the same for programs; .svg and .png draw the chart\n\n\
    The design file has a table [latch] with any of width, overhang, neck, hook, kerf, sheet, separator, layers, E (GPa),\n\
    poisson, slit_distance, slit_depth, slit_gap, wide_slit, cutout_depth, l_eq, spline_start, spline_end, bend, sides (1 or\n\
    3), base, dowel, module_width, rotor_distance, and a table [press] with friction, offset, tilt. What is absent is the\n\
    dissertation's. -o DIR: NAME.dxf is the part, NAME-cut.dxf and NAME-cut.svg the laser's path; connector.toml is the\n\
    aligning part of the face for `catchment run`.")]
pub(crate) struct LatchArgs {
    /// The design file, or - for stdin
    #[arg(value_name = "DESIGN", value_hint = clap::ValueHint::FilePath, required_unless_present = "table")]
    design: Option<PathBuf>,
    /// Print table 6.1 beside the model instead
    #[arg(long, conflicts_with = "design")]
    table: bool,
    /// Print JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    file: FileArgs,
}

/// The kind of such a folder.
const KIND: &str = "latch";

pub(crate) fn run(args: &LatchArgs) -> Result<ExitStatus, Failure> {
    match &args.design {
        Some(design) => of_design(args, design),
        None => of_table(args),
    }
}

fn of_table(args: &LatchArgs) -> Result<ExitStatus, Failure> {
    let kind = args.file.kind(&["csv", "svg", "png"])?;
    let forces = Forces::new()?;
    let report = table::report(&forces);
    match kind {
        Some("csv") => args.file.write(&csv(&report.records())?)?,
        Some(kind) => args.file.draw(kind, &chart(&forces, None))?,
        None => {}
    }
    to_stdout(&if args.json { report.to_json()? } else { report.table() })?;
    Ok(ExitStatus::Done)
}

fn of_design(args: &LatchArgs, design: &Path) -> Result<ExitStatus, Failure> {
    let folder = args.file.folder(KIND)?;
    // A pipe may be waited for, which does not listen.
    let source = read_table(design)?;
    let exec = Exec::new();
    signals::listen(&exec.cancel_flag())?;
    let (latch, geometry) = Latch::read(source)?;
    let (forces, record) = (Forces::new()?, press::record(&latch, &geometry)?);
    let drawn = Drawn { latch: &latch, geometry: &geometry, record: &record, forces: &forces };
    let mut files: Files = Vec::new();
    if folder.is_some() {
        files.extend(drawing::files(&latch, &geometry)?);
        files.extend(encode(&drawn.all(), &exec)?);
        files.push(("press.csv".to_owned(), csv(&press_records(&record))?));
        files.push(("connector.toml".to_owned(), connector::design(&latch, &geometry).into_bytes()));
    }
    let names = files.iter().map(|(name, _)| name.clone()).collect();
    let report = report::report(&latch, &geometry, &forces, &record, names);
    if let Some(folder) = folder {
        files.push(("report.json".to_owned(), report.to_json()?.into_bytes()));
        save_files(folder, KIND, &files, &exec)?;
        written(folder);
    }
    to_stdout(&if args.json { report.to_json()? } else { report.table() })?;
    to_stderr(&report.warnings.iter().map(WarningReport::line).collect::<Vec<_>>());
    Ok(ExitStatus::Done)
}
