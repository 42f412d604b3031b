//! `catchment compose`: the combined reach of two halves that both move.

use crate::args::with_advice;
use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::result_args::ResultArgs;
use crate::source::read_table;
use catchment::design::{Quantity, QuantityUnit};
use catchment::exec::Exec;
use catchment::report::figure::ensure_fits;
use catchment::report::{ReportBody, csv};
use catchment::terminal::shown;
use catchment_systems::compose::read::{ParsedRegion, ReadError, read};
use catchment_systems::compose::{
    ComposeBody, ComposeSettings, RegionFrames, compose, figure, outline_svg, report,
};
use clap::Args;
use std::path::{Path, PathBuf};

/// Combine the reach of two halves that both move
///
/// A and B are the regions that the two halves reach by their own motion, in the plane in which the robots move (lateral offset and gap). The
/// result is their Minkowski sum: every position of B's robot relative to A's from which the two regions meet.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  catchment compose hook.toml loop.toml
  catchment compose hook.toml loop.toml --keep-out a.csv,b.csv -o sum.png
  catchment compose hook.toml loop.toml --heading \"-20..20 deg\" --json \\
      | jq .volume
  catchment compose diamond.toml square.toml
      two connector designs: their zero-rotation areas
  catchment compose a.csv b.svg --outline -o sum.svg
      the outline only, to be read again

A region is a table of corners (.csv: x,y or x,y,ring, in mm), the paths of a
picture (.svg), a shape and its motion (.toml with [sweep]: annular-sector,
half-ellipse, disc, box, polygon; scale, slide, turn), or a connector design
(.toml with [connector]). CSV has the outline.")]
pub(crate) struct ComposeArgs {
    /// Region of the first half: .csv, .svg, .toml
    #[arg(value_name = "A", value_hint = clap::ValueHint::FilePath)]
    first: PathBuf,
    /// Region of the second half
    #[arg(value_name = "B", value_hint = clap::ValueHint::FilePath)]
    second: PathBuf,
    /// own: each region is in the frame of its robot, facing +y, and the second is turned by 180°. world: both are in the
    /// frame of the first
    #[arg(long, value_name = "FRAMES", default_value = "own", value_parser = ["own", "world"])]
    frames: String,
    /// Heading of the second robot relative to facing the first, such as "5 deg", or a range "-20..20 deg"
    #[arg(long, value_name = "ANGLE", default_value = "0", value_parser = headings, allow_hyphen_values = true)]
    heading: [f64; 2],
    /// Number of headings in a range
    #[arg(long, value_name = "N", default_value_t = 21, value_parser = clap::value_parser!(u16).range(2..=721))]
    headings: u16,
    /// Bodies of the two robots, which must not overlap, in the frames of A and B
    #[arg(long, value_name = "A,B", value_delimiter = ',', value_hint = clap::ValueHint::FilePath)]
    keep_out: Vec<PathBuf>,
    /// Write the outline instead of the picture: .svg or .csv
    #[arg(long, requires = "output")]
    outline: bool,
    #[command(flatten)]
    result: ResultArgs,
    #[command(flatten)]
    exec: ExecArgs,
}

pub(crate) fn run(args: &ComposeArgs) -> Result<ExitStatus, Failure> {
    let outline: &[&'static str] = if args.outline { &["svg", "csv"] } else { &[] };
    let output = args.result.check_with(ComposeBody::KIND, true, outline)?;
    if args.outline && output.own().is_none() {
        let help = "let the name of -o end in .svg or .csv".to_owned();
        return Err(Failure::with_help("--outline writes no file of this kind".to_owned(), Some(help)));
    }
    if !matches!(args.keep_out.len(), 0 | 2) {
        let help = "name both bodies, A's first: --keep-out bow.csv,stern.csv".to_owned();
        return Err(Failure::with_help("--keep-out needs two files".to_owned(), Some(help)));
    }
    let running = args.exec.start()?;
    running.may_be_left();
    let exec = &running.exec;
    if output.wants_picture() {
        ensure_fits(0, exec)?;
    }
    let halves = [region(&args.first, exec)?, region(&args.second, exec)?];
    let bodies = match &args.keep_out[..] {
        [first, second] => Some([region(first, exec)?, region(second, exec)?]),
        _ => None,
    };
    let settings = ComposeSettings {
        frames: if args.frames == "world" { RegionFrames::World } else { RegionFrames::Own },
        headings: spread(args.heading, args.headings),
        ..ComposeSettings::default()
    };
    let results = compose(halves, bodies, &settings, exec)?;
    drop(running);
    let report = report(&results);
    match output.own() {
        Some("csv") => output.write_own(&csv(&report.records())?)?,
        Some(_) => output.write_own(outline_svg(&results).as_bytes())?,
        None => {}
    }
    output.finish(&report, || Ok(figure(&results)?))
}

fn region(path: &Path, exec: &Exec) -> Result<ParsedRegion, Failure> {
    read(read_table(path)?, exec).map_err(|error| match error {
        ReadError::Diagnostics(diagnostics) => diagnostics.into(),
        ReadError::Problem(problem) => problem.into(),
        error => Failure::with_help(format!("{}: {error}", shown(path)), None).ends(ExitStatus::BadInput),
    })
}

/// Evenly spaced headings in a range; a single heading if the range is empty.
fn spread([from, to]: [f64; 2], count: u16) -> Vec<f64> {
    if from == to {
        return vec![from];
    }
    let steps = f64::from(count - 1);
    (0..count).map(|k| from + (to - from) * f64::from(k) / steps).collect()
}

/// Parses `5 deg`, `-20..20 deg`, `-0.3..0.3`.
fn headings(text: &str) -> Result<[f64; 2], String> {
    let angle = |part: &str, unit: Option<QuantityUnit>| -> Result<(f64, QuantityUnit), String> {
        let mut quantity: Quantity = part.parse().map_err(|defect| with_advice(&defect))?;
        if let (QuantityUnit::Bare, Some(unit)) = (quantity.unit, unit) {
            quantity.unit = unit;
        }
        let angle = quantity.angle_rad().map_err(|defect| format!("{defect}"))?;
        if angle.abs() > std::f64::consts::PI + 1e-9 {
            return Err("a heading is at most half a turn".to_owned());
        }
        Ok((angle, quantity.unit))
    };
    let Some((from, to)) = text.split_once("..") else {
        return angle(text, None).map(|(angle, _)| [angle; 2]);
    };
    // The unit follows the second angle and applies to both.
    let (to, unit) = angle(to, None)?;
    let (from, _) = angle(from, Some(unit))?;
    if from < to { Ok([from, to]) } else { Err("the range runs backwards or is empty".to_owned()) }
}
