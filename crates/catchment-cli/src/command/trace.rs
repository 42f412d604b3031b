//! `catchment trace`: the way of one pose from first contact to its end.

use crate::args::DesignArgs;
use crate::errors::pose;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::output::{FileArgs, number, to_stderr, to_stdout};
use catchment::design::Design;
use catchment::method::descent::{self, Settings, Trajectory, Waypoint};
use catchment::pose::{Dof, PoseError};
use catchment::report::figure;
use clap::Args;
use serde_json::json;
use std::fmt::Write;

/// Follow one pose from first contact to its end
///
/// The motion is exact and quasi-static: no friction, no inertia, contact kept. Prints waypoints spread over the
/// path; -o writes all of them, or a picture.
#[derive(Debug, Args)]
#[command(after_long_help = "Examples:\n  \
    catchment trace design.toml --pose \"x=0.2,pitch=10 deg\"\n  \
    catchment trace design.toml --pose \"x=5 mm\" -o trace.png\n  \
    catchment trace design.toml --pose \"x=0.2,yaw=0.3\" --json | jq .outcome\n\n\
    Lengths are in D and angles in radians unless they have a unit. -o writes .png and .svg (pictures), .csv (a \
    line per contact point) and .json.")]
pub(crate) struct TraceArgs {
    #[command(flatten)]
    design: DesignArgs,
    /// The pose error to start from, such as "x=0.2,pitch=10 deg"; what is not named is 0
    #[arg(long, value_name = "ERRORS", allow_hyphen_values = true)]
    pose: String,
    /// Print the whole path as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    file: FileArgs,
}

/// Version of the JSON that `--json` prints.
const JSON_SCHEMA: u32 = 1;
/// Pixels per unit of a picture.
const PNG_SCALE: f32 = 2.0;
/// Lines of the printed table, about.
const LINES: usize = 24;

pub(crate) fn run(args: &TraceArgs) -> Result<ExitStatus, Failure> {
    let kind = args.file.kind(&["png", "svg", "csv", "json"])?;
    let problem = args.design.problem()?;
    let (design, pair) = (problem.design(), problem.pair());
    let doubts: Vec<String> = problem.doubts().iter().map(ToString::to_string).collect();
    let error = pose(&args.pose, design)?;
    let path = descent::trace(pair, &error, &Settings::default());
    match kind {
        Some("csv") => args.file.write(&csv(&path)?)?,
        Some("json") => args.file.write(json(design, &error, &path, &doubts).as_bytes())?,
        Some(picture) => {
            let drawn = figure::trajectory(design, problem.connector(), &path)?;
            if picture == "png" {
                args.file.write(&drawn.png(PNG_SCALE)?)?;
            } else {
                args.file.write(drawn.svg().as_bytes())?;
            }
        }
        None => {}
    }
    to_stdout(&if args.json { json(design, &error, &path, &doubts) } else { table(design, &path)? })?;
    to_stderr(&doubts.iter().map(|doubt| format!("warning: {doubt}")).collect::<Vec<_>>());
    Ok(ExitStatus::Done)
}

/// Waypoints spread evenly over the path, the first and the last among them.
fn spread(path: &Trajectory) -> Vec<&Waypoint> {
    let total = path.waypoints.last().map_or(0.0, |w| w.travelled);
    let mut chosen: Vec<usize> = (0..LINES)
        .map(|k| total * k as f64 / (LINES - 1) as f64)
        .map(|s| path.waypoints.partition_point(|w| w.travelled < s))
        .chain(path.waypoints.len().checked_sub(1))
        .collect();
    chosen.dedup();
    chosen.into_iter().filter_map(|k| path.waypoints.get(k)).collect()
}

/// The path for a person: lengths in the design's unit, or D; degrees.
fn table(design: &Design, path: &Trajectory) -> Result<String, std::fmt::Error> {
    let (width, symbol) = design.unit.map_or((1.0, "D"), |unit| (design.width, unit.symbol()));
    let length = |value: f64| format!("{:.4}", tidy(value * width));
    let moves = |dof: &Dof| {
        design.alignment.free.contains(*dof)
            || path.waypoints.iter().any(|w| w.error.to_array()[dof.index()].abs() > 1e-9)
    };
    let dofs: Vec<Dof> = Dof::ALL.into_iter().filter(moves).collect();
    let mut lines = vec![vec!["path [D]".to_owned()]];
    lines[0].extend(
        dofs.iter().map(|d| format!("{} [{}]", d.name(), if d.is_rotation() { "deg" } else { symbol })),
    );
    lines[0].extend([format!("height [{symbol}]"), "contacts".to_owned()]);
    for w in spread(path) {
        let mut line = vec![format!("{:.4}", w.travelled)];
        line.extend(dofs.iter().map(|dof| {
            let value = w.error.to_array()[dof.index()];
            if dof.is_rotation() { format!("{:.3}", tidy(value.to_degrees())) } else { length(value) }
        }));
        line.extend([length(w.height), w.touches.len().to_string()]);
        lines.push(line);
    }
    let mut text = String::new();
    writeln!(text, "{}", design.name)?;
    let widths: Vec<usize> = (0..lines[0].len())
        .map(|c| lines.iter().map(|line| line[c].chars().count()).max().unwrap_or(0))
        .collect();
    if path.waypoints.is_empty() {
        writeln!(text, "the halves never meet")?;
    } else {
        for line in &lines {
            let cells: Vec<String> = line.iter().zip(&widths).map(|(c, w)| format!("{c:>w$}")).collect();
            writeln!(text, "  {}", cells.join("  "))?;
        }
        let all = path.waypoints.len();
        writeln!(text, "{} of {all} waypoints; height is that of the centre of rotation", lines.len() - 1)?;
    }
    writeln!(text, "outcome: {}", path.outcome.name())?;
    Ok(text)
}

/// Rounding does not print as −0.0000.
fn tidy(value: f64) -> f64 {
    if value.abs() < 5e-5 { 0.0 } else { value }
}

fn json(design: &Design, error: &PoseError, path: &Trajectory, doubts: &[String]) -> String {
    let waypoints: Vec<_> = path
        .waypoints
        .iter()
        .map(|w| {
            let touches: Vec<_> = w
                .touches
                .iter()
                .map(|t| json!({ "point_d": t.point.to_array(), "normal": t.normal.to_array() }))
                .collect();
            json!({
                "travelled_d": w.travelled, "error": w.error, "height_d": w.height, "touches": touches,
            })
        })
        .collect();
    let report = json!({
        "schema": JSON_SCHEMA,
        "design": design,
        "method": "descent",
        "settings": Settings::default(),
        "start": error,
        "outcome": path.outcome,
        "end": path.waypoints.last().map(|w| w.error),
        "waypoints": waypoints,
        "warnings": doubts,
    });
    format!("{report:#}\n")
}

/// One line per contact point, in D and radians; a waypoint that touches nowhere has one line without a point.
fn csv(path: &Trajectory) -> Result<Vec<u8>, Failure> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let head =
        "waypoint travelled x y roll pitch yaw height point_x point_y point_z normal_x normal_y normal_z";
    writer.write_record(head.split(' '))?;
    for (k, w) in path.waypoints.iter().enumerate() {
        let mut line = vec![k.to_string(), number(w.travelled)];
        line.extend(w.error.to_array().map(number));
        line.push(number(w.height));
        for touch in &w.touches {
            let contact = touch.point.to_array().into_iter().chain(touch.normal.to_array());
            writer.write_record(line.iter().cloned().chain(contact.map(number)))?;
        }
        if w.touches.is_empty() {
            line.extend(std::iter::repeat_n(String::new(), 6));
            writer.write_record(&line)?;
        }
    }
    Ok(writer.into_inner()?)
}
