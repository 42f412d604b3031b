//! `catchment run`: the area of acceptance of a design.
//!
//! ```text
//!   design ──▶ halves, mated pose ──▶ outcomes over the error grid ──▶ report ──▶ table or JSON, files, requirements
//!                                       └──▶ random poses correct the Sum ──┘
//! ```

mod all;
pub(super) mod compute;
mod errors;
mod pictures;
mod place;
mod sample;
mod study;

use crate::advice::flags;
use crate::args::DesignArgs;
use crate::drop_args::DropArgs;
use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::output::to_stdout;
use catchment::acceptance::{Acceptance, Outcome, Warning};
use catchment::contact::Pair;
use catchment::design::Design;
use catchment::exec::Exec;
use catchment::landscape::{Grid, Resolution};
use catchment::merit::success::Distribution;
use catchment::method::Method;
use catchment::method::correction::{self, ByNeighbours, Settings, Stop};
use catchment::method::partition;
use catchment::report::schema::{Timing, WarningReport};
use catchment::report::{Report, Requirement, table_with};
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser, ValueParser};
use compute::{Computed, Job};
use std::time::Instant;

/// Compute the area of acceptance: which pose errors contact corrects
///
/// Every cell of a grid over the error box is decided by the method. Random poses, most of them where the grid is in
/// doubt, are then followed exactly: they make the Sum unbiased, whatever the grid, and give it a 95 % interval.
#[derive(Debug, Args)]
#[command(after_long_help = "Examples:\n  \
    catchment run design.toml\n  \
    catchment run design.toml -o out                    table, pictures, report.json and result.zarr\n  \
    catchment run design.toml --free x,y,yaw --resolution 41,yaw=61\n  \
    catchment run design.toml --tolerance 1%            until the Sum is known to ± 1 %\n  \
    catchment run design.toml --error-sigma 'x=1 mm,y=1 mm,yaw=2 deg' --require 'success.probability>=0.99'\n  \
    catchment run design.toml --json | jq .onaa.edge\n  \
    catchment run design.toml --method all              every method, and how they agree\n  \
    catchment run design.toml --free x,yaw --method drop --friction 0.2\n  \
    catchment run design.toml --converge -o out         finer grids until stable, with every method\n  \
    catchment run design.toml --sensitivity             slopes against rho, COR and aspect ratio\n\n\
    The JSON of equal runs is equal byte for byte, whatever the number of threads, but for `timing` (and the seconds of\n\
    --converge, which may end it earlier on a slower machine).")]
pub(crate) struct RunArgs {
    #[command(flatten)]
    design: DesignArgs,
    #[command(flatten)]
    how: HowArgs,
    #[command(flatten)]
    sample: sample::SampleArgs,
    #[command(flatten)]
    errors: errors::ErrorArgs,
    #[command(flatten)]
    place: place::PlaceArgs,
    #[command(flatten)]
    study: study::StudyArgs,
    /// Print the report as JSON instead of the table
    #[arg(long)]
    json: bool,
    /// End with exit code 1 unless this holds of the JSON report, such as "onaa.edge>=0.3"; may be repeated
    #[arg(long, value_name = "PATH OP NUMBER", value_parser = requirement)]
    require: Vec<Requirement>,
    #[command(flatten)]
    exec: ExecArgs,
}

/// What changes the answer, beside the design.
#[derive(Debug, Args)]
struct HowArgs {
    /// How outcomes are decided
    #[arg(long, value_name = "METHOD", default_value = Method::ALL[0].name(), value_parser = choice_parser())]
    method: Choice,
    /// Cells per axis of the error grid, such as 30 or x=40,yaw=24 [default: by method and number of axes]
    #[arg(long, value_name = "CELLS", value_parser = resolution)]
    resolution: Option<Resolution>,
    /// Flooding: basins shallower than this are merged, in D [default: in the widest gap between the depths of the basins]
    #[arg(long, value_name = "DEPTH", value_parser = depth)]
    depth_tolerance: Option<f64>,
    /// Partition: rotation slices across the error box of every free angle [default: 24 for one angle, 4 for two]
    #[arg(long, value_name = "COUNT")]
    slices: Option<usize>,
    /// Partition: strips per D into which the moving half is cut; 1 is the dissertation's method [default: 12, or 1 for two angles]
    #[arg(long, value_name = "COUNT")]
    strips: Option<usize>,
    #[command(flatten)]
    drop: DropArgs,
}

impl HowArgs {
    /// The settings of the partition; `None` of its options may be given for any other method.
    fn partition(&self, method: Method, design: &Design) -> Result<partition::Settings, Failure> {
        if method != Method::Partition && (self.slices.is_some() || self.strips.is_some()) {
            let message =
                format!("--slices and --strips are settings of partition; {} has none", method.name());
            return Err(Failure::with_help(
                message,
                Some("add --method partition, or leave them out".to_owned()),
            ));
        }
        let default = partition::Settings::for_rotations(design.alignment.free.rotations());
        Ok(partition::Settings {
            slices: self.slices.unwrap_or(default.slices),
            strips: self.strips.unwrap_or(default.strips),
        })
    }
}

/// One method, or all of them.
#[derive(Debug, Clone, Copy)]
enum Choice {
    One(Method),
    All,
}

/// What stands for all methods.
const ALL: &str = "all";

/// What a person may write for a method.
fn possible_methods() -> [PossibleValue; Method::ALL.len()] {
    Method::ALL.map(|method| PossibleValue::new(method.name()).help(method.summary()))
}

fn method_of(name: &str) -> Option<Method> {
    Method::ALL.into_iter().find(|method| method.name() == name)
}

/// Reads the name of one method.
pub(super) fn method_parser() -> ValueParser {
    PossibleValuesParser::new(possible_methods())
        .try_map(|name| method_of(&name).ok_or("no such method"))
        .into()
}

/// Reads the name of one method, or `all`.
fn choice_parser() -> ValueParser {
    let all = PossibleValue::new(ALL).help("every method that applies, side by side, and how they agree");
    PossibleValuesParser::new(possible_methods().into_iter().chain([all]))
        .map(|name| method_of(&name).map_or(Choice::All, Choice::One))
        .into()
}

/// Cells per axis where several methods share a grid and nothing was said, for one to five axes: what descent can
/// afford, and even, which keeps cells off the mirror planes where transport is weak.
pub(super) fn even_cells(pair: &Pair) -> [usize; 5] {
    Method::Descent.default_cells(pair).map(|cells| (cells - 1).max(Resolution::LEAST))
}

pub(super) fn resolution(text: &str) -> Result<Resolution, String> {
    text.parse::<Resolution>().map_err(|error| error.to_string())
}

fn requirement(text: &str) -> Result<Requirement, String> {
    text.parse::<Requirement>().map_err(|error| error.to_string())
}

fn depth(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(depth) if depth >= 0.0 && depth.is_finite() => Ok(depth),
        _ => Err("a depth is a number of D, at least 0".to_owned()),
    }
}

pub(crate) fn run(args: &RunArgs) -> Result<ExitStatus, Failure> {
    if let Some(studied) = study::run(args) {
        return studied;
    }
    let how = &args.how;
    let method = match how.method {
        Choice::One(method) => method,
        Choice::All => return all::run(args),
    };
    if args.study.time_limit.is_some() {
        let message = "--time-limit is for --converge and --method all".to_owned();
        return Err(Failure::with_help(
            message,
            Some("--budget limits the time of the random poses".to_owned()),
        ));
    }
    let started = Instant::now();
    if how.depth_tolerance.is_some() && method.rule().is_none() {
        let message = format!("--depth-tolerance is a setting of flooding; {} has none", method.name());
        return Err(Failure::with_help(message, Some("add --method flood, or leave it out".to_owned())));
    }
    let dropped = match method {
        Method::Drop => how.drop.settings().map(Some),
        other => how.drop.refuse(other.name()).map(|()| None),
    }?;
    let place = args.place.checked()?;
    let (built, pair, doubts) = args.design.build()?.into_pair()?;
    let design = &built.input.design;
    if let Err(refusal) = method.applies_to(design) {
        let finding = built.input.finding("connector.family", format!("--method {refusal}"), None);
        return Err(built.input.refused(vec![finding]).into());
    }
    let grid = how
        .resolution
        .unwrap_or_default()
        .grid(&design.alignment, &method.default_cells(&pair))
        .map_err(|error| Failure::with_help(format!("--resolution: {error}"), None))?;
    let job = Job {
        design,
        pair: &pair,
        grid,
        method,
        depth_tolerance: how.depth_tolerance,
        partition: how.partition(method, design)?,
        drop: dropped,
        sample: args.sample.settings(method, &pair),
        heights: place.wants_heights(),
    };
    let distribution = args.errors.distribution(design)?;
    check_requirements(&args.require, &job, distribution.as_ref())?;

    let running = args.exec.start()?;
    let computed = compute::compute(&job, &running.exec)?;
    let timing = Timing { total_s: started.elapsed().as_secs_f64(), threads: running.exec.threads() };
    let report = report(&job, &computed, doubts, distribution, Some(timing), &running.exec)?;
    let json = report.to_json()?;
    let written = place.write(&job, &built, &computed, &report, &running.exec)?;
    drop(running);

    let printed = if args.json { to_stdout(&json) } else { to_stdout(&table_with(&report, flags)) };
    let mut notes = written;
    let unmet = unmet(&args.require, &serde_json::from_str(&json)?)?;
    let status = if unmet.is_empty() { ExitStatus::Done } else { ExitStatus::RequirementNotMet };
    notes.extend(unmet);
    crate::output::to_stderr(&notes);
    if status == ExitStatus::Done {
        printed?;
    }
    Ok(status)
}

/// Everything that was found, evaluated.
pub(super) fn report(
    job: &Job,
    computed: &Computed,
    doubts: Vec<String>,
    distribution: Option<Distribution>,
    timing: Option<Timing>,
    exec: &Exec,
) -> Result<Report, Failure> {
    let mut report = Report::new(job.design, &computed.acceptance, computed.settings.clone(), timing, exec)?;
    if let Some(sample) = &computed.sample {
        report = report.with_sample(&sample.corrected, sample.seed, sample.settings.clone());
    } else if job.method != Method::Descent {
        report.warnings.push(WarningReport::from(Warning::NoInterval));
    }
    if let Some(basins) = &computed.basins {
        report = report.with_basins(&computed.acceptance, basins);
    }
    if let Some(partition) = &computed.partition {
        report = report.with_partition(partition);
    }
    if let Some(distribution) = distribution {
        report = report.with_success(&computed.acceptance, distribution, exec)?;
    }
    report.warnings.extend(doubts.into_iter().map(|text| WarningReport::from(Warning::Note { text })));
    Ok(report)
}

/// Refuses a requirement that no report of this job can answer, before anything is computed: they are tried on the
/// report of an empty result.
fn check_requirements(
    requirements: &[Requirement],
    job: &Job,
    distribution: Option<&Distribution>,
) -> Result<(), Failure> {
    if requirements.is_empty() {
        return Ok(());
    }
    let grid = Grid::over(&job.design.alignment, |_| Resolution::LEAST);
    let acceptance = Acceptance {
        method: job.method.name(),
        outcomes: vec![Outcome::Aligned; grid.len()],
        domain: catchment::acceptance::Domain::Grid(grid.clone()),
        warnings: Vec::new(),
    };
    let sample = job.sample_of(|settings| {
        let by = ByNeighbours::new(&acceptance.outcomes, grid.shape());
        let settings = Settings { stop: Stop::Samples(1), ..*settings };
        let aligned = |poses: Vec<_>, _: &_| Ok(vec![Outcome::Aligned; poses.len()]);
        correction::estimate(&grid, &by, &settings, &Exec::new(), aligned)
    })?;
    let basins = job.basins_of(&grid)?;
    let computed =
        Computed { acceptance, settings: job.settings()?, sample, landscape: None, basins, partition: None };
    let timing = Some(Timing { total_s: 0.0, threads: 1 });
    let empty = report(job, &computed, Vec::new(), distribution.cloned(), timing, &Exec::new())?;
    unmet(requirements, &serde_json::to_value(&empty)?).map(drop)
}

/// A line for every requirement that is not met.
fn unmet(requirements: &[Requirement], report: &serde_json::Value) -> Result<Vec<String>, Failure> {
    let mut lines = Vec::new();
    for requirement in requirements {
        let value = requirement
            .value(report)
            .map_err(|error| Failure::with_help(format!("--require '{requirement}': {error}"), None))?;
        if !requirement.is_met_by(value) {
            lines.push(format!("not met: {requirement} (it is {value})"));
        }
    }
    Ok(lines)
}
