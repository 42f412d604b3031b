//! The `catchment` command: typed arguments → meaning → library → print.
//!
//! Data goes to stdout, everything else to stderr. Exit codes: see [`exit::ExitStatus`].

mod advice;
mod allocation;
mod args;
mod bug;
mod command;
mod drop_args;
mod error_args;
mod exec_args;
mod exit;
mod failure;
mod method_args;
mod output;
mod setting;
mod signals;
mod source;
mod usage;

use args::Cli;
use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    let status = bug::caught(|| match Cli::try_parse() {
        Ok(cli) => cli.command.run().unwrap_or_else(failure::Failure::show),
        Err(usage) => usage::tell(usage),
    });
    status.into()
}
