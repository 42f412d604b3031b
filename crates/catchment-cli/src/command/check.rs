//! `catchment check`: everything that is wrong with a design, with its place in the file.

use crate::args::DesignArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::output::to_stdout;
use catchment::design::{ConnectorSpec, HalfSpec};
use catchment::pose::{Dof, DofSet};
use catchment::problem::{Finding, Findings, Problem, ProblemError, SourceText};
use clap::Args;
use serde_json::json;
use std::fmt::Write;

/// Check a design file: all problems at once, with their places
#[derive(Debug, Args)]
#[command(after_long_help = "Examples:\n  \
    catchment check design.toml\n  \
    catchment check design.toml --json | jq .problems")]
pub(crate) struct CheckArgs {
    #[command(flatten)]
    design: DesignArgs,
    /// Print problems, or the design as understood, as JSON
    #[arg(long)]
    json: bool,
}

/// Version of the JSON that `--json` prints.
const JSON_SCHEMA: u32 = 1;

pub(crate) fn run(args: &CheckArgs) -> Result<ExitStatus, Failure> {
    let checked = checked(&args.design);
    if args.json {
        return print_json(checked);
    }
    to_stdout(&summary(&checked?)?)?;
    Ok(ExitStatus::Done)
}

/// Every check of a design, each on what the one before let through: its file, the changes, the geometry of
/// its halves, and the pose in which they mate.
fn checked(args: &DesignArgs) -> Result<Problem, ProblemError> {
    args.draft()?.check()
}

fn print_json(checked: Result<Problem, ProblemError>) -> Result<ExitStatus, Failure> {
    let (report, status) = match checked {
        Ok(problem) => {
            let design = problem.design();
            let report = json!({
                "schema": JSON_SCHEMA,
                "file": problem.source().map(|source| &source.path),
                "ok": true,
                "design": design,
                "ungendered": problem.connector().ungendered(design.alignment.mount),
                "problems": [],
                "omitted": 0,
            });
            (report, ExitStatus::Done)
        }
        Err(ProblemError::Findings(Findings { source, list, omitted })) => {
            let problems: Vec<_> = list.iter().map(|finding| finding_json(source.as_ref(), finding)).collect();
            let report = json!({
                "schema": JSON_SCHEMA,
                "file": source.as_ref().map(|source| &source.path),
                "ok": false,
                "problems": problems,
                "omitted": omitted,
            });
            (report, ExitStatus::Failed)
        }
        Err(error @ ProblemError::Load(_)) => return Err(error.into()),
    };
    to_stdout(&format!("{report:#}\n"))?;
    Ok(status)
}

fn finding_json(source: Option<&SourceText>, finding: &Finding) -> serde_json::Value {
    let place = finding.span.as_ref().zip(source).map(|(span, source)| {
        let (line, column) = source.line_column(span.start);
        json!({ "line": line, "column": column, "bytes": [span.start, span.end] })
    });
    json!({ "message": finding.message, "help": finding.help, "place": place })
}

/// The design as understood, for a person: degrees, and lengths in the design's unit beside D.
fn summary(problem: &Problem) -> Result<String, std::fmt::Error> {
    let design = problem.design();
    let alignment = &design.alignment;
    let length = |d: f64| match design.unit {
        Some(unit) => format!("{d} D = {} {}", rounded(d * design.width), unit.symbol()),
        None => format!("{d} D"),
    };
    let mut text = String::new();
    let place = problem.source().map_or_else(String::new, |source| source.path.display().to_string());
    writeln!(text, "{place}: no problems")?;
    writeln!(text, "  name                {}", design.name)?;
    match &design.connector {
        ConnectorSpec::Family(spec) => {
            writeln!(text, "  connector           {}, H/D = {}", spec.family.name(), spec.aspect_ratio)?;
        }
        ConnectorSpec::Own(own) => {
            writeln!(text, "  fixed half          {}", half(&own.fixed))?;
            writeln!(text, "  moving half         {}", half(&own.moving))?;
        }
    }
    let alike = if problem.connector().ungendered(alignment.mount) { "alike (ungendered)" } else { "different" };
    writeln!(text, "  halves              {alike}")?;
    match design.unit {
        Some(unit) => writeln!(text, "  width D             {} {}", design.width, unit.symbol())?,
        None => writeln!(text, "  width D             {} (dimensionless)", design.width)?,
    }
    writeln!(text, "  free                {}", names(alignment.free))?;
    if !alignment.dont_care.is_empty() {
        writeln!(text, "  does not matter     {}", names(alignment.dont_care))?;
    }
    writeln!(text, "  centre of rotation  {}", length(alignment.center_of_rotation))?;
    writeln!(text, "  rotation length     {}", length(alignment.rotation_length))?;
    if alignment.symmetry > 1 {
        writeln!(text, "  symmetry            {}-fold", alignment.symmetry)?;
    }
    for dof in alignment.free.iter() {
        let half_range = alignment.half_range(dof);
        let range = if dof.is_rotation() {
            format!("{} deg", rounded(half_range.to_degrees()))
        } else {
            length(half_range)
        };
        writeln!(text, "  error in {:<10} up to {range}", dof.name())?;
    }
    Ok(text)
}

fn half(half: &HalfSpec) -> String {
    match half {
        HalfSpec::Pieces(pieces) if pieces.len() == 1 => "1 convex piece".to_owned(),
        HalfSpec::Pieces(pieces) => format!("{} convex pieces", pieces.len()),
        HalfSpec::Mesh { path, .. } => format!("mesh {}", path.display()),
    }
}

fn names(set: DofSet) -> String {
    set.iter().map(Dof::name).collect::<Vec<_>>().join(", ")
}

/// Without the last digits, which the conversion of units leaves.
fn rounded(value: f64) -> f64 {
    const DIGITS: f64 = 1e9;
    (value * DIGITS).round() / DIGITS
}
