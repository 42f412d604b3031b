//! `catchment compare`: two acceptances beside each other.
//!
//! ```text
//!   A  design ──▶ decided by a method ──┐
//!      folder of `run -o` ──▶ read ─────┼──▶ the cells that both have ──▶ overlap, confusions, distances, picture
//!   B  likewise, or A again ────────────┘
//! ```

use super::run::compute::{Job, compute};
use super::run::{even_cells, method_parser, resolution};
use crate::exec_args::ExecArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::geometry::Built;
use crate::output::{to_stderr, to_stdout};
use crate::result_folder::{Files, RESULT, Study, encode};
use crate::source::Input;
use catchment::acceptance::Acceptance;
use catchment::exec::Exec;
use catchment::landscape::Resolution;
use catchment::merit::comparison::{Comparison, Paired};
use catchment::method::correction::{Settings, Stop};
use catchment::method::drop::Settings as DropSettings;
use catchment::method::{Method, partition};
use catchment::report::figure::FigureError;
use catchment::report::schema::Timing;
use catchment::report::{Compared, ComparisonReport, Report, figure, zarr};
use clap::Args;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Compare two areas of acceptance: two methods, two designs, or two results of `run -o`
///
/// Overlap (Jaccard), Sum and ONAA side by side, which outcomes are confused, and how far from the border of the
/// first the two differ. Both are over the same error box and the same cells, or one is finer by an odd factor.
#[derive(Debug, Args)]
#[command(after_long_help = "Examples:\n  \
    catchment compare design.toml --methods descent,flood\n  \
    catchment compare old.toml new.toml -o out          two designs, with a picture\n  \
    catchment compare out design.toml --methods descent a stored result against a fresh one\n  \
    catchment compare a.zarr b.zarr --json | jq .comparison.jaccard\n\n\
    -o DIR: difference.png, difference.svg, difference.csv (the confusions), report.json.")]
pub(crate) struct CompareArgs {
    /// A design, a folder written by `run -o`, or its NAME.zarr
    #[arg(value_name = "A", value_hint = clap::ValueHint::AnyPath)]
    first: PathBuf,
    /// The other; without it, A is decided by two methods
    #[arg(value_name = "B", value_hint = clap::ValueHint::AnyPath)]
    second: Option<PathBuf>,
    /// The method of every design among A and B, in their order; one counts for both [default: transport]
    #[arg(long, value_name = "METHOD", value_delimiter = ',', value_parser = method_parser())]
    methods: Vec<Method>,
    /// Cells per axis, such as 30 or x=40,yaw=24 [default: those of a stored result, else by number of axes]
    #[arg(long, value_name = "CELLS", value_parser = resolution)]
    resolution: Option<Resolution>,
    /// Print the report as JSON instead of the table
    #[arg(long)]
    json: bool,
    /// Write picture, table and report into this folder
    #[arg(short, long, value_name = "DIR", value_hint = clap::ValueHint::DirPath)]
    output: Option<PathBuf>,
    #[command(flatten)]
    exec: ExecArgs,
}

/// One of the two, as far as it is known before anything is computed.
enum Source {
    /// A stored result.
    Stored(PathBuf),
    /// A design, and who decides it.
    Design(PathBuf, Method),
}

/// Seed of the random poses that settle doubtful cells: that of `run`.
const SEED: u64 = 1;

pub(crate) fn run(args: &CompareArgs) -> Result<ExitStatus, Failure> {
    let started = Instant::now();
    let folder = args.output.as_deref().map(|path| Study { path, name: "difference" });
    folder.as_ref().map_or(Ok(()), Study::check)?;
    let sources = sources(args)?;
    let running = args.exec.start()?;
    let exec = &running.exec;
    // Stored results first: their grid is what a design is decided on.
    let mut sides: [Option<(Compared, Acceptance)>; 2] = [None, None];
    for (side, source) in sides.iter_mut().zip(&sources) {
        if let Source::Stored(path) = source {
            let (report, acceptance) = zarr::read(&group(path), exec)?;
            *side = Some((Compared { source: path.display().to_string(), report }, acceptance));
        }
    }
    let stored = sides.iter().flatten().find_map(|(side, _)| as_resolution(&side.report));
    for (k, source) in sources.iter().enumerate() {
        if let Source::Design(path, method) = source {
            let part = exec.part([0.5 * k as f64, 0.5 * (k + 1) as f64], "comparing");
            sides[k] = Some(decide(path, *method, args.resolution.or(stored), &part)?);
        }
    }
    let [Some((first, a)), Some((second, b))] = sides else {
        return Err(Failure::with_help("there is nothing to compare".to_owned(), None));
    };
    let paired = Paired::of(&a, &b).map_err(|error| {
        let message = format!("cannot compare {} with {}: {error}", first.source, second.source);
        Failure::with_help(message, None)
    })?;
    let comparison = Comparison::of(&paired, &first.report.design.alignment, exec)?;
    let names = names([&first, &second]);
    let picture = folder.as_ref().map(|_| {
        let names = names.each_ref().map(String::as_str);
        figure::difference(&first.report.design, &paired, &comparison, names)
    });
    let timing = Timing { total_s: started.elapsed().as_secs_f64(), threads: exec.threads() };
    let report = ComparisonReport::new([first, second], &paired, comparison, Some(timing));
    let json = serde_json::to_string_pretty(&report)? + "\n";
    let mut notes = Vec::new();
    if let (Some(folder), Some(picture)) = (&folder, picture) {
        let mut pictures = Files::new();
        match picture {
            Ok(picture) => pictures = encode(&[(folder.name, picture)], exec)?,
            Err(FigureError::Empty { what }) => notes.push(format!("no picture: {what}")),
            Err(error) => return Err(error.into()),
        }
        notes.push(folder.write_files(&json, &report.records(), pictures, exec, |_| Ok(()))?);
    }
    drop(running);
    to_stdout(&if args.json { json } else { report.table() })?;
    to_stderr(&notes);
    Ok(ExitStatus::Done)
}

/// What A and B are, and who decides the designs among them.
fn sources(args: &CompareArgs) -> Result<[Source; 2], Failure> {
    let refused =
        |message: &str, help: &str| Err(Failure::with_help(message.to_owned(), Some(help.to_owned())));
    let paths = [&args.first, args.second.as_ref().unwrap_or(&args.first)];
    let stored = paths.map(|path| path.is_dir());
    if args.second.is_none() && (stored[0] || args.methods.len() != 2) {
        let help = "name a second design or result, or the two methods: --methods descent,flood";
        return refused("one thing cannot be compared", help);
    }
    let designs = stored.iter().filter(|stored| !**stored).count();
    if args.methods.len() > designs {
        let help = "a stored result has been decided already: name a method for each design only";
        return refused("--methods names more methods than there are designs", help);
    }
    let mut methods = args.methods.iter().copied();
    let all = args.methods.first().copied().unwrap_or(Method::ALL[0]);
    Ok([0, 1].map(|k| {
        let path = paths[k].clone();
        if stored[k] { Source::Stored(path) } else { Source::Design(path, methods.next().unwrap_or(all)) }
    }))
}

/// The Zarr group that a path stands for.
fn group(path: &Path) -> PathBuf {
    let inside = path.join(RESULT);
    if inside.is_dir() { inside } else { path.to_owned() }
}

/// The cells of a stored result, for a design beside it.
fn as_resolution(report: &Report) -> Option<Resolution> {
    report.axes.iter().try_fold(Resolution::default(), |all, axis| all.with(axis.axis, axis.cells).ok())
}

/// Decides a design, as `run` would.
fn decide(
    path: &Path,
    method: Method,
    resolution: Option<Resolution>,
    exec: &Exec,
) -> Result<(Compared, Acceptance), Failure> {
    let (built, pair, _) = Built::new(Input::read(path)?)?.into_pair()?;
    let design = &built.input.design;
    method.applies_to(design)?;
    let grid = resolution
        .unwrap_or_default()
        .grid(&design.alignment, &even_cells(&pair))
        .map_err(|error| Failure::with_help(format!("{}: {error}", path.display()), None))?;
    let samples = method.default_samples(&pair);
    let sample = (samples > 0).then_some(Settings { seed: SEED, stop: Stop::Samples(samples) });
    let drop = (method == Method::Drop).then(DropSettings::default);
    let partition = partition::Settings::for_rotations(design.alignment.free.rotations());
    let job = Job {
        design,
        pair: &pair,
        grid,
        method,
        depth_tolerance: None,
        partition,
        drop,
        sample,
        heights: false,
    };
    let computed = compute(&job, exec)?;
    let report = super::run::report(&job, &computed, Vec::new(), None, None, exec)?;
    Ok((Compared { source: path.display().to_string(), report }, computed.acceptance))
}

/// What tells the two apart: the methods of one design, else the designs, else the files.
fn names(sides: [&Compared; 2]) -> [String; 2] {
    let [a, b] = sides.map(|side| &side.report);
    if a.design == b.design && a.method != b.method {
        return [a, b].map(|report| report.method.clone());
    }
    if a.design.name != b.design.name {
        return [a, b].map(|report| format!("{} by {}", report.design.name, report.method));
    }
    sides.map(|side| format!("{} by {}", side.source, side.report.method))
}
