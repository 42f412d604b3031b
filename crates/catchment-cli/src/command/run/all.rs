//! `catchment run --method all`: every method that applies, on one grid, and how they agree.

use super::compute::{Computed, Job, compute};
use super::{RunArgs, even_cells, report};
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::output::{to_stderr, to_stdout};
use catchment::acceptance::Acceptance;
use catchment::exec::Exec;
use catchment::merit::comparison::{Overlap, Paired, confusion};
use catchment::merit::sum::Sum;
use catchment::method::Method;
use catchment::report::schema::Timing;
use catchment::report::{Agreement, AgreementReport, Decided, MethodResult, figure};
use std::time::{Duration, Instant};

/// How long each method may take when nothing was said.
const TIME_LIMIT: Duration = Duration::from_mins(1);

/// Decides the design by every method that applies to it.
pub(super) fn run(args: &RunArgs) -> Result<ExitStatus, Failure> {
    let started = Instant::now();
    refuse_options(args)?;
    let folder = args.place.study("methods")?;
    let (built, pair, doubts) = args.design.build()?.into_pair()?;
    let design = &built.input.design;
    let grid = args
        .how
        .resolution
        .unwrap_or_default()
        .grid(&design.alignment, &even_cells(&pair))
        .map_err(|error| Failure::with_help(format!("--resolution: {error}"), None))?;
    let limit = args.study.time_limit.unwrap_or(TIME_LIMIT);
    let drops = args.how.drop.settings()?;
    let running = args.exec.start()?;
    let total = Method::ALL.len() as f64;
    let mut found: Vec<Acceptance> = Vec::new();
    let mut methods = Vec::new();
    for (k, method) in Method::ALL.into_iter().enumerate() {
        let part = running.exec.part([k as f64 / total, (k + 1) as f64 / total], "methods");
        let job = Job {
            design,
            pair: &pair,
            grid: grid.clone(),
            method,
            depth_tolerance: None,
            partition: args.how.partition(Method::Partition, design)?,
            drop: (method == Method::Drop).then(|| drops.clone()),
            sample: args.sample.settings(method, &pair),
            heights: false,
        };
        let (result, left_out) = match within(&job, limit, &part) {
            Ok((result, acceptance)) => {
                found.push(acceptance);
                (Some(result), None)
            }
            // Whoever stops the run wants nothing more of it.
            Err(failure) if running.exec.is_cancelled() => return Err(failure),
            Err(failure) => (None, Some(failure.message())),
        };
        methods.push(Decided { method: method.name(), result, left_out });
    }
    let agreement = agreement(&found, &running.exec)?;
    let unit = found.first().map_or_else(String::new, |first| Sum::of(first, &design.alignment).unit());
    let limit_s = limit.as_secs_f64();
    let mut report = AgreementReport::new(design, grid.shape(), limit_s, unit, methods, agreement);
    report.timing =
        Some(Timing { total_s: started.elapsed().as_secs_f64(), threads: running.exec.threads() });
    let json = report.to_json()?;
    let mut notes: Vec<String> = doubts.into_iter().map(|doubt| format!("warning: {doubt}")).collect();
    if let Some(folder) = folder {
        let picture = figure::agreement(&report);
        notes.push(folder.write(&json, &report.records(), picture, &running.exec, |_| Ok(()))?);
    }
    drop(running);
    to_stdout(&if args.json { json } else { report.table() })?;
    to_stderr(&notes);
    Ok(ExitStatus::Done)
}

/// One method, unless it does not apply or takes too long.
fn within(job: &Job, limit: Duration, exec: &Exec) -> Result<(MethodResult, Acceptance), Failure> {
    job.method.applies_to(job.design).map_err(|refusal| Failure::with_help(refusal.reason, None))?;
    let started = Instant::now();
    let timed = exec.clone().with_deadline(started + limit);
    let outcome = || -> Result<(Computed, MethodResult), Failure> {
        let computed = compute(job, &timed)?;
        let seconds = started.elapsed().as_secs_f64();
        let found = report(job, &computed, Vec::new(), None, None, &timed)?;
        let result = MethodResult::of(&found, seconds);
        Ok((computed, result))
    };
    match outcome() {
        Ok((computed, result)) => Ok((result, computed.acceptance)),
        Err(_) if timed.is_cancelled() && !exec.is_cancelled() => {
            let message = format!("it takes longer than the {} s allowed", limit.as_secs_f64());
            Err(Failure::with_help(
                message,
                Some("allow more with --time-limit, or lower --resolution".to_owned()),
            ))
        }
        Err(failure) => Err(failure),
    }
}

/// How each two agree.
fn agreement(found: &[Acceptance], exec: &Exec) -> Result<Vec<Vec<Agreement>>, Failure> {
    let between = |a: &Acceptance, b: &Acceptance| -> Result<Agreement, Failure> {
        let paired = Paired::of(a, b)?;
        Ok(Overlap::of(&confusion(&paired.first, &paired.second, exec)?).into())
    };
    found.iter().map(|a| found.iter().map(|b| between(a, b)).collect()).collect()
}

/// Options that are about one result.
fn refuse_options(args: &RunArgs) -> Result<(), Failure> {
    let wrong = [
        ("--depth-tolerance", args.how.depth_tolerance.is_some()),
        ("--require", !args.require.is_empty()),
        ("--figures", args.place.wants_figures_alone()),
        ("--error-sigma or --error-uniform", args.errors.is_some()),
    ];
    match wrong.into_iter().find(|(_, given)| *given) {
        Some((option, _)) => {
            let message = format!("{option} is about the result of one method, not of all");
            Err(Failure::with_help(message, Some("name one --method".to_owned())))
        }
        None => Ok(()),
    }
}
