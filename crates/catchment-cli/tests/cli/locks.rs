//! A folder that another process keeps locked: the program refuses it after a while and names the process, refuses at once if that
//! process waits for the program, and gives up as soon as it receives a signal.

#![cfg(target_os = "linux")]

use crate::{catchment, entries, home, starter};
use std::fs::{self, File};
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};

const EXPORT: [&str; 6] = ["export", "v.toml", "--pose", "x=0.1", "-o", "out"];

/// A folder for the output of a trial.
fn exported() -> tempfile::TempDir {
    let home = home();
    assert_eq!(catchment(home.path()).args(EXPORT).status().unwrap().code(), Some(0));
    home
}

/// The text of stderr, without its frames.
fn printout(output: &Output) -> String {
    let text = String::from_utf8_lossy(&output.stderr);
    text.split_whitespace().filter(|word| *word != "│").collect::<Vec<_>>().join(" ")
}

/// Waits until the program has a thread that listens for signals; `false` if it has ended before.
fn listens(child: &mut Child) -> bool {
    let tasks = format!("/proc/{}/task", child.id());
    while child.try_wait().unwrap().is_none() {
        let names = fs::read_dir(&tasks).into_iter().flatten().flatten();
        let mut names = names.filter_map(|task| fs::read_to_string(task.path().join("comm")).ok());
        if names.any(|name| name.trim() == "signals") {
            return true;
        }
        std::thread::yield_now();
    }
    false
}

/// Another process that keeps the folder locked until it is killed.
struct Keeper(Child);

impl Keeper {
    fn of(home: &Path) -> Self {
        let keeper =
            Command::new("flock").args(["-o", "out", "sleep", "60"]).current_dir(home).spawn().unwrap();
        let folder = File::open(home.join("out")).unwrap();
        while folder.try_lock().is_ok() {
            folder.unlock().unwrap();
            std::thread::yield_now();
        }
        Self(keeper)
    }
}

impl Drop for Keeper {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

#[test]
fn a_locked_folder_is_refused_with_the_process_that_keeps_it() {
    let home = exported();
    let keeper = Keeper::of(home.path());
    let output = catchment(home.path()).args(EXPORT).output().unwrap();
    let (printout, other) = (printout(&output), keeper.0.id());
    assert_eq!(output.status.code(), Some(5), "{printout}");
    assert!(printout.contains(&format!("cannot write out: process {other} (")), "{printout}");
    assert!(printout.contains("has kept the folder locked for 5 s"), "{printout}");
    assert!(printout.contains(&format!("end it (kill {other}), or choose another folder")), "{printout}");
    drop(keeper);
    assert_eq!(catchment(home.path()).args(EXPORT).status().unwrap().code(), Some(0));
    assert_eq!(entries(home.path()), ["out", "v.toml"]);
}

/// `flock` hands its lock down, or keeps it with -o: in both cases it waits for the program.
#[test]
fn a_lock_held_by_the_parent_process_is_reported() {
    let home = exported();
    for own in [&[][..], &["-o"]] {
        let output = starter("flock")
            .args(own)
            .args(["out", env!("CARGO_BIN_EXE_catchment")])
            .args(EXPORT)
            .current_dir(home.path())
            .env("NO_COLOR", "1")
            .output()
            .unwrap();
        let printout = printout(&output);
        assert_eq!(output.status.code(), Some(5), "{printout}");
        assert!(
            printout.contains("(flock), which started this program, keeps the folder locked"),
            "{printout}"
        );
        assert!(printout.contains("lock a file beside the folder"), "{printout}");
    }
    assert_eq!(entries(home.path()), ["out", "v.toml"]);
}

/// The exit of a program that waits for a lock and receives a signal.
fn ended_by(home: &Path, signal: &str) -> Option<i32> {
    let _keeper = Keeper::of(home);
    let mut child =
        catchment(home).args(EXPORT).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    if listens(&mut child) {
        Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap();
    }
    let output = child.wait_with_output().unwrap();
    // If the machine stalled for longer than the lock timeout, the program ended before the signal.
    let code = output.status.code().filter(|code| *code != 2)?;
    assert!(printout(&output).contains("interrupted; nothing was written"), "{}", printout(&output));
    Some(code)
}

#[test]
fn one_signal_ends_the_wait_for_a_lock() {
    let home = exported();
    for (signal, code) in [("-TERM", 143), ("-INT", 130), ("-HUP", 143)] {
        let ended = (0..5).find_map(|_| ended_by(home.path(), signal));
        assert_eq!(ended, Some(code), "{signal}");
    }
    assert_eq!(entries(home.path()), ["out", "v.toml"]);
}
