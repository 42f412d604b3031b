//! `catchment run --method all`: every applicable method on one grid, and their agreement.

use super::RunArgs;
use super::study::study;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use catchment::report::figure;
use catchment::study::agreement::{AgreementError, AgreementSettings, run as decide_by_all};

/// Runs every method that applies to the design.
pub(super) fn run(args: &RunArgs) -> Result<ExitStatus, Failure> {
    refuse_options(args)?;
    let default = AgreementSettings::default();
    let settings = AgreementSettings {
        methods: args.how.settings.of_all()?,
        resolution: args.resolution.unwrap_or_default(),
        sample: args.sample.sample(),
        seed: args.sample.seed,
        time_limit: args.study.time_limit.unwrap_or(default.time_limit),
    };
    study(args, figure::agreement, |problem, exec| {
        decide_by_all(problem, &settings, exec).map_err(|error| match error {
            AgreementError::Resolution(error) => Failure::with_help(format!("--resolution: {error}"), None),
            error => error.into(),
        })
    })
}

/// Rejects options that apply to a single result.
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
