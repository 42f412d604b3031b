//! `catchment zraa`: which offsets contact corrects without any rotation.

use crate::args::DesignArgs;
use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::output::{FileArgs, number, to_stdout};
use catchment::design::Design;
use catchment::method::zraa::{Settings, Zraa, circle_bounds, run as accepted_offsets};
use catchment::report::figure;
use clap::Args;
use serde_json::json;
use std::fmt::Write;

/// The zero-rotation area of acceptance: offsets corrected by sliding alone, exactly
///
/// Rotations are locked whatever the design says; of x and y those that are free count. Both: the accepted
/// offsets are an area. One: they are an interval, which for the planar families has a closed form
/// (s-face D/3, v-face D/2, x-face D to either side).
#[derive(Debug, Args)]
#[command(after_long_help = "Examples:\n  \
    catchment zraa design.toml\n  \
    catchment zraa design.toml --free x             along one axis only\n  \
    catchment zraa design.toml -o region.svg        with a picture (.svg, .png) or the polygons (.csv)\n  \
    catchment zraa design.toml --json | jq .area_d2")]
pub(crate) struct ZraaArgs {
    #[command(flatten)]
    design: DesignArgs,
    /// Print JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    file: FileArgs,
    #[command(flatten)]
    exec: ExecArgs,
}

/// Version of the JSON that `--json` prints.
const JSON_SCHEMA: u32 = 1;
/// Pixels per unit of a picture.
const PNG_SCALE: f32 = 2.0;

pub(crate) fn run(args: &ZraaArgs) -> Result<ExitStatus, Failure> {
    let kind = args.file.kind(&["svg", "png", "csv"])?;
    // Rotations play no part, so whether the mated pose holds against them is of no interest here.
    let problem = args.design.problem()?;
    let (design, pair) = (problem.design(), problem.pair());
    let running = args.exec.start()?;
    let zraa = accepted_offsets(pair, &Settings::default(), &running.exec)?;
    drop(running);
    match kind {
        Some("svg") => args.file.write(figure::region(design, &zraa).svg().as_bytes())?,
        Some("png") => args.file.write(&figure::region(design, &zraa).png(PNG_SCALE)?)?,
        Some(_) => args.file.write(&csv(&zraa)?)?,
        None => {}
    }
    to_stdout(&if args.json { json(design, &zraa) } else { text(design, &zraa)? })?;
    Ok(ExitStatus::Done)
}

/// The accepted offsets for a person.
fn text(design: &Design, zraa: &Zraa) -> Result<String, std::fmt::Error> {
    let mut text = String::new();
    writeln!(text, "{}", design.name)?;
    let bounds = circle_bounds(design, zraa);
    match zraa {
        Zraa::Interval { axis, from, to } => {
            writeln!(text, "  offsets in {} corrected without rotation", axis.name())?;
            writeln!(text, "  from    {from:.9} D{}", in_unit(design, *from, 1))?;
            writeln!(text, "  to      {to:.9} D{}", in_unit(design, *to, 1))?;
            writeln!(text, "  length  {:.9} D{}", to - from, in_unit(design, to - from, 1))?;
            if let Some([lower, upper]) = bounds {
                writeln!(
                    text,
                    "  circle  {lower:.9} … {upper:.9} D: a polygon stands for it, see chord_error"
                )?;
            }
        }
        Zraa::Region { polygons, area } => {
            writeln!(text, "  offsets in x and y corrected without rotation")?;
            writeln!(text, "  area    {area:.9} D²{}", in_unit(design, *area, 2))?;
            if let Some([lower, upper]) = bounds {
                writeln!(
                    text,
                    "  circle  {lower:.9} … {upper:.9} D²: a polygon stands for it, see chord_error"
                )?;
            }
            writeln!(text, "  tiled by {} convex polygons", polygons.len())?;
        }
    }
    Ok(text)
}

/// ` = 25 mm`, where the design has a unit.
fn in_unit(design: &Design, value: f64, power: i32) -> String {
    let square = if power == 2 { "²" } else { "" };
    design.unit.map_or_else(String::new, |unit| {
        format!(" = {:.6} {}{square}", value * design.width.powi(power), unit.symbol())
    })
}

fn json(design: &Design, zraa: &Zraa) -> String {
    let mut report = json!({ "schema": JSON_SCHEMA, "design": design });
    let bounds = circle_bounds(design, zraa);
    match zraa {
        Zraa::Interval { axis, from, to } => {
            report["axis"] = axis.name().into();
            report["from_d"] = (*from).into();
            report["to_d"] = (*to).into();
            report["length_d"] = (to - from).into();
            report["circle_length_d"] = bounds.into();
        }
        Zraa::Region { polygons, area } => {
            report["area_d2"] = (*area).into();
            report["circle_area_d2"] = bounds.into();
            report["polygons_d"] =
                polygons.iter().map(|p| p.iter().map(|v| [v.x, v.y]).collect::<Vec<_>>()).collect();
        }
    }
    format!("{report:#}\n")
}

/// One line per corner, in D; an interval has its two ends.
fn csv(zraa: &Zraa) -> Result<Vec<u8>, Failure> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    match zraa {
        Zraa::Interval { axis, from, to } => {
            writer.write_record([axis.name()])?;
            for end in [from, to] {
                writer.write_record([number(*end)])?;
            }
        }
        Zraa::Region { polygons, .. } => {
            writer.write_record(["polygon", "x", "y"])?;
            for (k, polygon) in polygons.iter().enumerate() {
                for corner in polygon {
                    writer.write_record([k.to_string(), number(corner.x), number(corner.y)])?;
                }
            }
        }
    }
    Ok(writer.into_inner()?)
}
