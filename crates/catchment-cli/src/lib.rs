//! The `catchment` command: typed arguments → meaning → library → print.
//!
//! Data goes to stdout, everything else to stderr. Exit codes: see [`ExitStatus`]. It is a library so that the fuzzer reads
//! command lines as the program does, and Python's wheel has the program; nothing here is promised to others.

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

/// Does what the command line of this process says.
pub fn run() -> ExitStatus {
    run_words(std::env::args_os())
}

/// Does what a command line says; its first word is the name of the program.
pub fn run_words(words: impl IntoIterator<Item = impl Into<OsString> + Clone>) -> ExitStatus {
    signals::outlive_file_limits();
    let words: Vec<OsString> = words.into_iter().map(Into::into).collect();
    // Whoever reads JSON types nothing.
    let is_read = words.iter().any(|word| word == "--json");
    bug::caught(|| {
        let loaded = defaults::load();
        if let Some(color) = Color::of_words(&words).or(defaults::get().color) {
            color.choose();
        }
        let cli = match args::parse(words) {
            Ok(cli) => cli,
            Err(usage) => return usage::tell(usage),
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

/// What is said of a command line that cannot be read, as it reaches a terminal; nothing of one that can, or that asks for help.
/// The first word is the name of the program.
pub fn usage_error(words: impl IntoIterator<Item = impl Into<OsString> + Clone>) -> Option<String> {
    let mut usage = args::parse(words).err().filter(clap::Error::use_stderr)?;
    usage::advise(&mut usage);
    usage::silence(&mut usage);
    Some(usage::still_steering(&usage).unwrap_or_else(|| usage.to_string()))
}

/// What the head of a request to `view` asks for below its token, if it is let in.
pub fn admitted(head: &[u8], port: u16, token: &str) -> Option<String> {
    command::admitted(head, port, token)
}
