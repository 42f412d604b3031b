//! The `catchment` command: typed arguments → meaning → library → print.
//!
//! Data goes to stdout, everything else to stderr. Exit codes: see [`exit::ExitStatus`].

mod advice;
mod args;
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

use args::Cli;
use clap::Parser;
use exit::ExitStatus;
use std::process::ExitCode;

fn main() -> ExitCode {
    let status = match Cli::try_parse() {
        Ok(cli) => cli.command.run().unwrap_or_else(failure::Failure::show),
        Err(usage) => {
            // Help and version are data; a reader that has gone away is no trouble.
            let shown = usage.print();
            if usage.use_stderr() || shown.is_err_and(|e| e.kind() != std::io::ErrorKind::BrokenPipe) {
                ExitStatus::Failed
            } else {
                ExitStatus::Done
            }
        }
    };
    status.into()
}
