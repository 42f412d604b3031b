//! `catchment man`: the manual pages.

use crate::args::Cli;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::output::to_stdout;
use clap::{Args, CommandFactory};

/// Write a manual page (roff)
#[derive(Debug, Args)]
#[command(after_long_help = "Examples:\n  \
    catchment man > catchment.1\n  \
    catchment man check | man -l -")]
pub(crate) struct ManArgs {
    /// Of this subcommand instead of the whole program
    subcommand: Option<String>,
}

pub(crate) fn run(args: &ManArgs) -> Result<ExitStatus, Failure> {
    let mut command = Cli::command();
    command.build();
    let page = match &args.subcommand {
        None => command,
        Some(name) => match command.find_subcommand(name) {
            Some(subcommand) => subcommand.clone(),
            None => {
                let names: Vec<&str> = command.get_subcommands().map(clap::Command::get_name).collect();
                let help = format!("one of {}", names.join(", "));
                return Err(Failure::with_help(format!("there is no subcommand `{name}`"), Some(help)));
            }
        },
    };
    let mut roff = Vec::new();
    clap_mangen::Man::new(page).render(&mut roff)?;
    to_stdout(&String::from_utf8_lossy(&roff))?;
    Ok(ExitStatus::Done)
}
