//! `catchment completions`: shell completion scripts.

use crate::args;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::output::to_stdout;
use clap::Args;
use clap_complete::Shell;

/// Write a shell completion script
#[derive(Debug, Args)]
#[command(after_long_help = "\
Example:
  catchment completions fish > ~/.config/fish/completions/catchment.fish")]
pub(crate) struct CompletionsArgs {
    /// Shell
    shell: Shell,
}

pub(crate) fn run(args: &CompletionsArgs) -> Result<ExitStatus, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut args::command(), "catchment", &mut script);
    to_stdout(&String::from_utf8_lossy(&script))?;
    Ok(ExitStatus::Done)
}
