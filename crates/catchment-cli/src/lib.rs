//! The `catchment` command: typed arguments → meaning → library → print.
//!
//! Data goes to stdout, everything else to stderr. Exit codes: see [`ExitStatus`]. It is a library so that
//! the fuzzer parses command lines like the program, and so that Python's wheel includes the program. The API
//! is not promised to other users.

mod advice;
mod args;
mod bug;
mod color;
mod command;
mod defaults;
mod drop_args;
mod error_args;
mod exec_args;
mod exit;
mod failure;
mod groups;
mod method_args;
mod output;
mod result_args;
mod setting;
mod signals;
mod source;
mod usage;
#[cfg(test)]
mod wording;

pub use exit::ExitStatus;

use color::Color;
use std::ffi::OsString;

/// Runs the command line of this process.
pub fn run() -> ExitStatus {
    run_words(std::env::args_os())
}

/// Runs a command line; its first word is the name of the program.
pub fn run_words(words: impl IntoIterator<Item = impl Into<OsString> + Clone>) -> ExitStatus {
    signals::outlive_file_limits();
    let words: Vec<OsString> = words.into_iter().map(Into::into).collect();
    // JSON output goes to a program, which needs no suggestion of a next command.
    let is_read = words.iter().any(|word| word == "--json");
    bug::caught(|| {
        let loaded = defaults::load();
        if let Some(color) = Color::of_words(&words).or(defaults::get().color) {
            color.choose();
        }
        let cli = match args::parse(words) {
            Ok(cli) => cli,
            Err(usage) => return usage::print(usage),
        };
        if let Err(failure) = loaded {
            return failure.show();
        }
        let next = cli.command.next().filter(|_| !is_read);
        let status = cli.command.run().unwrap_or_else(failure::Failure::show);
        let next = next.filter(|_| status == ExitStatus::Done);
        output::to_stderr(&next.map(|next| format!("next: {next}")).into_iter().collect::<Vec<_>>());
        status
    })
}

/// The error message for an invalid command line, as printed on a terminal; `None` for a valid command line
/// or a request for help. The first word is the name of the program.
pub fn usage_error(words: impl IntoIterator<Item = impl Into<OsString> + Clone>) -> Option<String> {
    let mut usage = args::parse(words).err().filter(clap::Error::use_stderr)?;
    usage::advise(&mut usage);
    usage::silence(&mut usage);
    Some(usage::still_steering(&usage).unwrap_or_else(|| usage.to_string()))
}

/// The path below the token in the head of a request to `view`, if the request is admitted.
pub fn admitted(head: &[u8], port: u16, token: &str) -> Option<String> {
    command::admitted(head, port, token)
}
