//! The real binary: exit code, stdout and stderr together.

#![allow(clippy::unwrap_used, reason = "a test that cannot be set up should stop")]

mod area;
mod check;
mod new;
mod plumbing;

use std::path::Path;
use std::process::{Command, Stdio};

/// The binary in a folder, with nothing of the tester's terminal.
fn catchment(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_catchment"));
    command
        .current_dir(folder)
        .stdin(Stdio::null())
        .env_clear()
        .env("NO_COLOR", "1")
        .env("LC_ALL", "C.UTF-8")
        .env("TERM", "xterm");
    command
}

/// What a run of the binary did.
fn run(folder: &Path, args: &[&str]) -> String {
    let output = catchment(folder).args(args).output().unwrap();
    format!(
        "exit {}\n--- stdout\n{}--- stderr\n{}",
        output.status.code().unwrap(),
        String::from_utf8(output.stdout).unwrap(),
        String::from_utf8(output.stderr).unwrap(),
    )
}
