//! One file per subcommand.

mod check;
mod compare;
mod completions;
mod compose;
mod export;
mod invert;
mod man;
mod new;
mod outcome;
mod reproduce;
mod run;
mod schema;
mod slices;
mod trace;
mod zraa;

use crate::exit::ExitStatus;
use crate::failure::Failure;
use clap::Subcommand;

/// The subcommands.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    New(new::NewArgs),
    Check(check::CheckArgs),
    Run(Box<run::RunArgs>),
    Compare(compare::CompareArgs),
    Slices(Box<slices::SlicesArgs>),
    Outcome(Box<outcome::OutcomeArgs>),
    Trace(trace::TraceArgs),
    Zraa(zraa::ZraaArgs),
    Compose(Box<compose::ComposeArgs>),
    Export(Box<export::ExportArgs>),
    Invert(invert::InvertArgs),
    Reproduce(reproduce::ReproduceArgs),
    Schema(schema::SchemaArgs),
    Completions(completions::CompletionsArgs),
    Man(man::ManArgs),
}

impl Command {
    /// Does what was asked for.
    pub(crate) fn run(self) -> Result<ExitStatus, Failure> {
        match self {
            Self::New(args) => new::run(&args),
            Self::Check(args) => check::run(&args),
            Self::Run(args) => run::run(&args),
            Self::Compare(args) => compare::run(&args),
            Self::Slices(args) => slices::run(&args),
            Self::Outcome(args) => outcome::run(&args),
            Self::Trace(args) => trace::run(&args),
            Self::Zraa(args) => zraa::run(&args),
            Self::Compose(args) => compose::run(&args),
            Self::Export(args) => export::run(&args),
            Self::Invert(args) => invert::run(&args),
            Self::Reproduce(args) => reproduce::run(&args),
            Self::Schema(args) => schema::run(&args),
            Self::Completions(args) => completions::run(&args),
            Self::Man(args) => man::run(&args),
        }
    }
}
