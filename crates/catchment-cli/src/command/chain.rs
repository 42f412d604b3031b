//! `catchment chain`: chains of modules.

use crate::args::with_advice;
use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::result_args::ResultArgs;
use crate::source::read_design;
use catchment::design::Quantity;
use catchment::exec::Stopwatch;
use catchment::report::ReportBody;
use catchment::report::schema::Timing;
use catchment::run::Requirement;
use catchment_systems::chain::file::{ChainFile, MOST_MODULES};
use catchment_systems::chain::report::{ChainBody, ChainReport};
use catchment_systems::chain::study::{self, ChainSettings};
use catchment_systems::chain::{figure, report};
use clap::Args;
use std::path::PathBuf;

/// Compute where a chain of modules ends and whether it docks
///
/// The file names the modules, their joint errors, the connector at their faces and the joint commands. Errors are added up to first order and
/// by sampled chains, followed exactly until they dock or jam. A sequence is folded step by step with servos as springs: the command prints
/// when each layer of a latch snaps, and refuses modules that collide.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  catchment chain chain.toml
  catchment chain p-sequence.toml -o steps.svg
      the chain after every step
  catchment chain chain.toml --modules 2..20 --joint-sigma 0.5deg,1deg,2deg
      the number of modules that still dock
  catchment chain chain.toml --require 'probability>=0.99'
  catchment chain p-sequence.toml --json | jq .folding.events

`probability` is for the chain of the file: for every docking of its sequence,
or for its last face if it stays straight.")]
pub(crate) struct ChainArgs {
    /// Chain file (TOML); - reads stdin
    #[arg(value_name = "FILE", value_hint = clap::ValueHint::FilePath)]
    path: PathBuf,
    /// Also compute straight chains of so many modules, such as 2..20 or 4,8,12
    #[arg(long, value_name = "NUMBERS", value_parser = modules)]
    modules: Option<Modules>,
    /// Standard deviations of the joints of these chains, such as 0.5deg,1deg
    #[arg(long, value_name = "ANGLES", value_parser = angles)]
    joint_sigma: Option<Angles>,
    /// Number of sampled chains
    #[arg(long, alias = "chains", value_name = "N", default_value_t = 1000, value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    samples: u64,
    /// Seed of the sampled chains
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    #[command(flatten)]
    result: ResultArgs,
    #[command(flatten)]
    exec: ExecArgs,
}

/// Numbers of modules, in order.
#[derive(Debug, Clone)]
struct Modules(Vec<usize>);

/// Angles in radians.
#[derive(Debug, Clone)]
struct Angles(Vec<f64>);

fn modules(text: &str) -> Result<Modules, String> {
    let most = MOST_MODULES as usize;
    let number = |text: &str| match text.trim().parse::<usize>() {
        Ok(n) if (1..=most).contains(&n) => Ok(n),
        _ => Err(format!("`{}` is no number of modules from 1 to {most}", text.trim())),
    };
    if let Some((first, last)) = text.split_once("..") {
        let (first, last) = (number(first)?, number(last)?);
        if first > last {
            return Err(format!("{first}..{last} goes down; write {last}..{first}"));
        }
        return Ok(Modules((first..=last).collect()));
    }
    let mut list = text.split(',').map(number).collect::<Result<Vec<_>, _>>()?;
    list.sort_unstable();
    list.dedup();
    Ok(Modules(list))
}

fn angles(text: &str) -> Result<Angles, String> {
    /// The largest standard deviation that a chain file accepts, in radians.
    const LARGEST: f64 = 0.5;
    let angle = |text: &str| {
        let quantity: Quantity = text.trim().parse().map_err(|defect| with_advice(&defect))?;
        let angle = quantity.angle_rad().map_err(|error| error.to_string())?;
        let shown = text.trim();
        (0.0..=LARGEST)
            .contains(&angle)
            .then_some(angle)
            .ok_or(format!("`{shown}` is not from 0 to {LARGEST} rad"))
    };
    text.split(',').map(angle).collect::<Result<_, _>>().map(Angles)
}

pub(crate) fn run(args: &ChainArgs) -> Result<ExitStatus, Failure> {
    let output = args.result.check(ChainBody::KIND, true)?;
    let file = ChainFile::read(read_design(&args.path)?)?;
    let settings = ChainSettings {
        chains: args.samples,
        seed: args.seed,
        modules: args.modules.clone().map(|list| list.0).unwrap_or_default(),
        joint_sigmas: args.joint_sigma.clone().map(|list| list.0).unwrap_or_default(),
    };
    let running = args.exec.start()?;
    let (watch, threads) = (Stopwatch::start(), running.exec.threads());
    let study = study::run(&file, &settings, &running.exec)?;
    drop(running);
    let timing = Timing { total_s: watch.seconds(), threads };
    let report = report::report(&study, args.result.requirements(), Some(timing));
    check_requirements(args.result.requirements(), &report)?;
    output.finish(&report, || Ok(figure::draw(&report, &study)))
}

/// Rejects requirements on values that this report does not contain.
fn check_requirements(requirements: &[Requirement], report: &ChainReport) -> Result<(), Failure> {
    for requirement in requirements {
        report.verdicts(std::slice::from_ref(requirement)).map_err(|error| {
            Failure::with_help(format!("--require '{requirement}': {error}"), advice(report))
        })?;
    }
    Ok(())
}

/// Advice for a report without a probability.
fn advice(report: &ChainReport) -> Option<String> {
    let text = "a probability needs a [connector] in the file: design = \"x-face.toml\"";
    report.connector.is_none().then(|| text.to_owned())
}
