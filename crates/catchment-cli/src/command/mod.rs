//! One file per subcommand.

mod check;
mod completions;
mod man;
mod new;
mod run;
mod schema;

use crate::exit::ExitStatus;
use crate::failure::Failure;
use clap::Subcommand;

/// The subcommands.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    New(new::NewArgs),
    Check(check::CheckArgs),
    Run(Box<run::RunArgs>),
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
            Self::Schema(args) => schema::run(&args),
            Self::Completions(args) => completions::run(&args),
            Self::Man(args) => man::run(&args),
        }
    }
}
