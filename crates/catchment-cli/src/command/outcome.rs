//! `catchment outcome`: what becomes of listed pose errors.

use crate::args::DesignArgs;
use crate::drop_args::DropArgs;
use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::output::{OutputArgs, number, to_stderr};
use crate::poses::Poses;
use catchment::acceptance::{Acceptance, Domain, Outcome};
use catchment::design::Design;
use catchment::method::descent::{self, End};
use catchment::method::drop;
use catchment::pose::PoseError;
use clap::{Args, ValueEnum};
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Decide what becomes of listed pose errors
///
/// Reads a CSV table with a header and prints it again with the outcome (aligned, jammed, missed, undecided)
/// and the last pose error of every row. How many met which outcome goes to stderr.
#[derive(Debug, Args)]
#[command(after_long_help = "Examples:\n  \
    catchment outcome design.toml --poses poses.csv -o outcomes.csv\n  \
    printf 'x_mm,pitch_deg\\n5,10\\n20,-30\\n' | catchment outcome design.toml --poses -\n  \
    catchment outcome design.toml --poses poses.csv --json | jq .counts\n  \
    catchment outcome design.toml --poses poses.csv --method drop --friction 0.2\n\n\
    Columns: x, y, roll, pitch, yaw in any order, in D and radians; missing ones are 0. A unit after an underscore \
    changes that: x_mm, y_in, x_D, pitch_deg, yaw_rad. Other columns are carried through. Final errors come in the \
    units of their columns. At most 64 MiB and 1000000 poses.")]
pub(crate) struct OutcomeArgs {
    #[command(flatten)]
    design: DesignArgs,
    /// The table of pose errors (CSV); - reads stdin
    #[arg(long, value_name = "FILE", value_hint = clap::ValueHint::FilePath)]
    poses: PathBuf,
    /// What decides
    #[arg(long, value_enum, default_value_t = Method::Descent)]
    method: Method,
    #[command(flatten)]
    drop: DropArgs,
    /// Print JSON, in D and radians
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    output: OutputArgs,
    #[command(flatten)]
    exec: ExecArgs,
}

/// Methods that decide single poses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Method {
    /// Exact quasi-static motion of every pose
    Descent,
    /// Three drop tests in a rigid-body engine
    Drop,
}

/// Version of the JSON that `--json` prints.
const JSON_SCHEMA: u32 = 1;

pub(crate) fn run(args: &OutcomeArgs) -> Result<ExitStatus, Failure> {
    args.output.check()?;
    let problem = args.design.problem()?;
    let (design, pair) = (problem.design(), problem.pair());
    let doubts: Vec<String> = problem.doubts().iter().map(ToString::to_string).collect();
    let poses = Poses::read(&args.poses, design)?;
    let dropped = match args.method {
        Method::Descent => Ok(None),
        Method::Drop => args.drop.settings().map(Some),
    }?;
    let running = args.exec.start()?;
    let domain = Domain::Poses(poses.errors.clone());
    let (settings, (acceptance, ends)) = if let Some(settings) = &dropped {
        (serde_json::to_value(settings)?, drop::run(pair, domain, settings, &running.exec)?)
    } else {
        let settings = descent::Settings::default();
        (serde_json::to_value(&settings)?, descent::run(pair, domain, &settings, &running.exec)?)
    };
    std::mem::drop(running);
    let warnings: Vec<String> =
        doubts.into_iter().chain(acceptance.warnings.iter().map(ToString::to_string)).collect();
    if args.json {
        args.output.write(&json(design, settings, &poses, &acceptance, &ends, &warnings)?)?;
    } else {
        args.output.write(&csv(design, &poses, &ends)?)?;
    }
    let mut said: Vec<String> = warnings.iter().map(|warning| format!("warning: {warning}")).collect();
    said.push(summary(&acceptance));
    to_stderr(&said);
    Ok(ExitStatus::Done)
}

fn summary(acceptance: &Acceptance) -> String {
    let count = acceptance.outcomes.len();
    let parts: Vec<String> =
        Outcome::ALL.iter().zip(acceptance.counts()).map(|(o, n)| format!("{n} {}", o.name())).collect();
    let poses = if count == 1 { "pose" } else { "poses" };
    format!("{count} {poses}: {}", parts.join(", "))
}

/// The table as it came, with the outcome and the final errors.
fn csv(design: &Design, poses: &Poses, ends: &[End]) -> Result<String, Failure> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let mut records = poses.records();
    let mut header = records.next().unwrap_or_default();
    header.push_field("outcome");
    header.extend(poses.final_names());
    writer.write_record(&header)?;
    for (mut record, end) in records.zip(ends) {
        record.push_field(end.outcome.name());
        record.extend(poses.in_units(&end.error, design).map(number));
        writer.write_record(&record)?;
    }
    Ok(String::from_utf8(writer.into_inner()?)?)
}

/// The answer for programs; lengths in D, angles in radians.
#[derive(Serialize)]
struct Answer<'a> {
    schema: u32,
    design: &'a Design,
    method: &'static str,
    settings: serde_json::Value,
    counts: BTreeMap<&'static str, usize>,
    warnings: &'a [String],
    poses: Vec<Row>,
}

/// One pose.
#[derive(Serialize)]
struct Row {
    error: PoseError,
    outcome: Outcome,
    #[serde(rename = "final")]
    last: PoseError,
    /// Columns that were carried through.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    carried: BTreeMap<String, String>,
}

fn json(
    design: &Design,
    settings: serde_json::Value,
    poses: &Poses,
    acceptance: &Acceptance,
    ends: &[End],
    warnings: &[String],
) -> Result<String, Failure> {
    let carried = poses.carried();
    let rows = poses.records().skip(1).zip(&poses.errors).zip(ends).map(|((record, error), end)| Row {
        error: *error,
        outcome: end.outcome,
        last: end.error,
        carried: carried.iter().map(|(k, name)| (name.clone(), record[*k].to_owned())).collect(),
    });
    let answer = Answer {
        schema: JSON_SCHEMA,
        design,
        method: acceptance.method,
        settings,
        counts: Outcome::ALL.iter().map(|outcome| outcome.name()).zip(acceptance.counts()).collect(),
        warnings,
        poses: rows.collect(),
    };
    let mut text = serde_json::to_string_pretty(&answer)?;
    text.push('\n');
    Ok(text)
}
