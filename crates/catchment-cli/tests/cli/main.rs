//! Tests of the real binary: exit code, stdout and stderr together.

#![allow(clippy::unwrap_used, reason = "a test that cannot be set up should stop")]

mod area;
mod bad_inputs;
mod catalog;
mod chain;
mod chance;
mod check;
mod compare;
mod compose;
mod defaults;
mod exits;
mod files;
mod friction;
mod hold;
mod hostile;
mod invert;
mod jams;
mod kills;
mod latch;
mod limits;
mod locks;
mod meshes;
mod new;
mod place;
mod place_refused;
mod plan;
mod planar;
mod plumbing;
mod poses;
mod prisms;
mod raw_parts;
mod renamed;
mod rests;
mod run_regressions;
mod seat;
mod solids;
mod step;
mod streams;
mod studies;
mod success;
mod sweep;
mod tables;
mod view;
mod window;
mod wire;

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// Runs the binary with this text on stdin.
fn piped(folder: &Path, stdin: &[u8], args: &[&str]) -> Output {
    let mut child = catchment(folder)
        .args(args)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // A command that does not read stdin may end before.
    let _ = child.stdin.take().unwrap().write_all(stdin);
    child.wait_with_output().unwrap()
}

/// Runs the binary in a folder, without the tester's terminal settings or defaults: without HOME there is no file of defaults.
fn catchment(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_catchment"));
    command
        .current_dir(folder)
        .stdin(Stdio::null())
        .env_clear()
        .env("NO_COLOR", "1")
        .env("LC_ALL", "C.UTF-8")
        .env("TERM", "xterm")
        // No STEP mesher runs, whatever is installed on this machine.
        .env("CATCHMENT_PYTHON", "no/python3");
    command
}

/// A system program that starts the binary, without the tester's own defaults.
fn starter(program: &str) -> Command {
    const OF_THE_TESTER: [&str; 6] = [
        "HOME",
        "XDG_CONFIG_HOME",
        "CATCHMENT_THREADS",
        "CATCHMENT_MEMORY",
        "CATCHMENT_UNIT",
        "CATCHMENT_COLOR",
    ];
    let mut command = Command::new(program);
    for name in OF_THE_TESTER {
        command.env_remove(name);
    }
    command
}

/// Exit code and output of a run of the binary.
fn run(folder: &Path, args: &[&str]) -> String {
    let output = catchment(folder).args(args).output().unwrap();
    format!(
        "exit {}\n--- stdout\n{}--- stderr\n{}",
        output.status.code().unwrap(),
        String::from_utf8(output.stdout).unwrap(),
        String::from_utf8(output.stderr).unwrap(),
    )
}

/// The committed designs.
fn designs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../designs")
}

/// The printed output of a run, as JSON.
fn json(folder: &Path, args: &[&str]) -> serde_json::Value {
    let output = catchment(folder).args(args).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// A planar design.
const V_FACE: &str =
    "[connector]\nfamily = \"v-face\"\naspect_ratio = 1.0\n[alignment]\nrotation_length = 1.0\n";

/// A folder with a planar design in it.
fn home() -> tempfile::TempDir {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("v.toml"), V_FACE).unwrap();
    dir
}

/// Names in a folder, sorted.
fn entries(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// Names in a folder that the program has written, sorted: the entries of its manifest, and the manifest
/// itself.
fn written(folder: &Path) -> Vec<String> {
    let mut names = entries(folder);
    assert_eq!(names.remove(0), ".catchment.json", "{names:?}");
    names
}
