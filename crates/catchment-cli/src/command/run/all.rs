//! `catchment run --method all`: every method that applies, on one grid, and how they agree.

use super::RunArgs;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::output::{tell, written};
use catchment::report::schema::Timing;
use catchment::report::{AgreementReport, figure};
use catchment::study::agreement::{AgreementError, Settings, run as decide_by_all};
use std::time::Instant;

/// Decides the design by every method that applies to it.
pub(super) fn run(args: &RunArgs) -> Result<ExitStatus, Failure> {
    let started = Instant::now();
    refuse_options(args)?;
    let folder = args.place.study("methods")?;
    let problem = args.design.problem()?;
    let default = Settings::default();
    let settings = Settings {
        methods: args.how.settings.of_all()?,
        resolution: args.resolution.unwrap_or_default(),
        sample: args.sample.sample(),
        seed: args.sample.seed,
        time_limit: args.study.time_limit.unwrap_or(default.time_limit),
    };
    let running = args.exec.start()?;
    let found = decide_by_all(&problem, &settings, &running.exec).map_err(|error| match error {
        AgreementError::Resolution(error) => Failure::with_help(format!("--resolution: {error}"), None),
        error => error.into(),
    })?;
    let timing = Timing { total_s: started.elapsed().as_secs_f64(), threads: running.exec.threads() };
    let report = AgreementReport::new(problem.design(), &found, settings.time_limit, Some(timing));
    let json = report.to_json()?;
    let mut notes = problem.objections().iter().map(|doubt| format!("warning: {doubt}")).collect::<Vec<_>>();
    if let Some(folder) = folder {
        let pictures =
            catchment::report::folder::encode(&[(folder.name, figure::agreement(&report))], &running.exec)?;
        notes.push(folder.write(&json, &report.records(), pictures, &running.exec, |_| Ok(()))?);
        written(folder.path);
    }
    drop(running);
    tell(&if args.print.json { json } else { report.table() }, &notes)
}

/// Options that are about one result.
fn refuse_options(args: &RunArgs) -> Result<(), Failure> {
    let wrong = [
        ("--depth-tolerance", args.how.settings.depth_tolerance.is_some()),
        ("--require", !args.print.require.is_empty()),
        ("--jams", args.jams),
        ("--window", args.window),
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
