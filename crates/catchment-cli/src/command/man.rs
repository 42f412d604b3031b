//! `catchment man`: the manual pages.

use crate::args;
use crate::exit::ExitStatus;
use crate::failure::Failure;
use crate::output::to_stdout;
use clap::Args;

/// Write a manual page
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  catchment man > catchment.1
  catchment man check | man -l -")]
pub(crate) struct ManArgs {
    /// Subcommand [default: the whole program]
    subcommand: Option<String>,
}

pub(crate) fn run(args: &ManArgs) -> Result<ExitStatus, Failure> {
    let mut command = args::command();
    command.build();
    if let Some(name) = &args.subcommand {
        let Some(subcommand) = command.find_subcommand(name) else {
            let visible = command.get_subcommands().filter(|one| !one.is_hide_set());
            let names: Vec<&str> = visible.map(clap::Command::get_name).collect();
            let help = format!("one of {}", names.join(", "));
            return Err(Failure::with_help(format!("there is no subcommand `{name}`"), Some(help)));
        };
        command = subcommand.clone();
    }
    let mut roff = Vec::new();
    clap_mangen::Man::new(command).render(&mut roff)?;
    to_stdout(&String::from_utf8_lossy(&roff))?;
    Ok(ExitStatus::Done)
}
