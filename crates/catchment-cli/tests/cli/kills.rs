//! Interruption at any moment: the real binary under SIGKILL, SIGTERM and SIGINT while it writes.
//!
//! ```text
//!   complete 1 ──▶ run, killed at random ──▶ 1 or 2, complete? ──▶ run to the end ──▶ complete, nothing left over?
//! ```
//!
//! `CATCHMENT_KILLS=300` sets the number of kills; the moments follow from the seed and from the speed of the
//! machine.

mod writers;

use super::{catchment, entries, home, starter};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use writers::{TARGET, WRITERS, Writer, furnished};

/// The signals, sent in turn.
const SIGNALS: [&[&str]; 5] = [&["-KILL"], &["-KILL"], &["-TERM"], &["-INT"], &["-TERM", "-TERM"]];

/// Whether the target is exactly one complete version: a folder by its manifest, a file by its bytes.
fn is_whole(path: &Path, files: &[Vec<u8>]) -> bool {
    if path.is_file() {
        return files.contains(&fs::read(path).unwrap());
    }
    let Ok(text) = fs::read(path.join(".catchment.json")) else { return false };
    let manifest: serde_json::Value = serde_json::from_slice(&text).unwrap();
    let listed: BTreeMap<String, String> = serde_json::from_value(manifest["files"].clone()).unwrap();
    let mut result = BTreeMap::new();
    let mut open = vec![path.to_owned()];
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let inner = entry.unwrap().path();
            if inner.is_dir() {
                open.push(inner);
            } else {
                let name = inner.strip_prefix(path).unwrap().to_str().unwrap().to_owned();
                let content = catchment::design::MeshContent::of(&fs::read(&inner).unwrap(), 0);
                result.insert(name, content.sha256);
            }
        }
    }
    result.remove(".catchment.json");
    result == listed
}

/// A small generator (splitmix64): the same moments in every run.
fn random(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}

/// A folder in which a command has written both of its versions, one over the other.
struct Both {
    writer: Writer,
    home: tempfile::TempDir,
    target: PathBuf,
    /// The bytes of both versions, where the target is a file.
    files: Vec<Vec<u8>>,
    /// The entries of the folder after both runs.
    expected: Vec<String>,
    /// Running time of the faster version.
    lasts: Duration,
}

impl Both {
    fn of(writer: Writer) -> Self {
        let home = furnished(&writer);
        let words = writer.words(0);
        let name = words.iter().find(|word| word.starts_with(TARGET)).unwrap();
        let target = home.path().join(name);
        let mut expected = entries(home.path());
        expected.push(name.clone());
        expected.sort();
        let mut both = Self { writer, home, target, files: Vec::new(), expected, lasts: Duration::MAX };
        for version in 0..2 {
            let started = Instant::now();
            both.finish(version);
            both.lasts = both.lasts.min(started.elapsed());
            if both.target.is_file() {
                both.files.push(fs::read(&both.target).unwrap());
            }
        }
        both
    }

    /// Runs a version to completion.
    fn finish(&self, version: usize) {
        let output = catchment(self.home.path()).args(self.writer.words(version)).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    }

    /// Whether the target is one of the two versions.
    fn is_one_of_them(&self) -> bool {
        is_whole(&self.target, &self.files)
    }
}

#[cfg(unix)]
#[test]
fn killed_at_any_moment_old_or_new_is_there() {
    let wanted = std::env::var("CATCHMENT_KILLS").ok().map_or(30, |text| text.parse::<usize>().unwrap());
    let mut seed = 7;
    let (mut killed, mut replaced, mut swept) = (0, 0, 0);
    for writer in WRITERS {
        let both = Both::of(writer);
        let Both { writer, home, target, expected, lasts, .. } = &both;
        for number in 0..wanted.div_ceil(WRITERS.len()) {
            let case = format!("{}, kill {number}", writer.0);
            let before =
                fs::read_dir(target).is_ok().then(|| fs::read(target.join(".catchment.json")).unwrap());
            let mut child = catchment(home.path())
                .args(writer.words(number % 2))
                .stdout(Stdio::null())
                .stderr(Stdio::null())
                .spawn()
                .unwrap();
            std::thread::sleep(lasts.mul_f64(1.1 * random(&mut seed)));
            let pid = child.id().to_string();
            for signal in SIGNALS[(SIGNALS.len() as f64 * random(&mut seed)) as usize] {
                // The process may have ended already.
                let _ = Command::new("kill").args([*signal, &pid]).stderr(Stdio::null()).status().unwrap();
            }
            let status = child.wait().unwrap();
            assert!(matches!(status.code(), None | Some(0 | 130 | 143)), "{case}: {status}");
            killed += usize::from(status.code() != Some(0));
            assert!(both.is_one_of_them(), "{case}: lost or mixed");
            replaced += usize::from(
                before.is_some_and(|old| fs::read(target.join(".catchment.json")).unwrap() != old),
            );
            // After a signal that it can handle, a command leaves only the finished designs of a sweep and the finished rows of a table.
            let mut left = entries(home.path());
            left.retain(|name| name != "target.parts");
            let finished_rows = left.iter().position(|name| name.ends_with(".partial"));
            if let (Some(place), Some(130 | 143)) = (finished_rows, status.code()) {
                fs::remove_file(home.path().join(left.remove(place))).unwrap();
            }
            let tidy = status.code().is_none() || left == *expected;
            assert!(tidy, "{case}: {status}, but {:?}", entries(home.path()));
            swept += usize::from(entries(home.path()) != *expected);
            // Only the next run removes leftovers.
            both.finish((number + 1) % 2);
            assert!(both.is_one_of_them(), "{case}: lost or mixed after the next start");
            assert_eq!(entries(home.path()), *expected, "{case}: left-overs after the next start");
        }
    }
    println!(
        "{killed} ended early, {replaced} replaced a folder, {swept} left something, all of it put in order"
    );
    assert!(killed > 0);
}

/// The same with refused memory requests in place of signals: one request, or every request from a certain one on.
/// `CATCHMENT_KILLS` raises the number of cases.
#[test]
fn refused_memory_at_any_request_old_or_new_is_there() {
    let thorough = std::env::var("CATCHMENT_KILLS").is_ok();
    let factor = if thorough { 1.2 } else { 40.0 };
    let (mut refused, mut left) = (0, 0);
    for writer in WRITERS {
        let both = Both::of(writer);
        let Both { writer, home, expected, .. } = &both;
        // The first few hundred requests precede the start of the program.
        let mut request = 100.0;
        for number in 0.. {
            let wish = format!("{:.0}{}", request, if number % 2 == 0 { "" } else { ".." });
            let case = format!("{}, request {wish}", writer.0);
            let output = catchment(home.path())
                .args(writer.words(number % 2))
                .env("CATCHMENT_REFUSED_REQUEST", wish)
                .output()
                .unwrap();
            let printout = String::from_utf8_lossy(&output.stderr);
            if output.status.success() {
                break;
            }
            assert_eq!(output.status.code(), Some(5), "{case}: {}, {printout}", output.status);
            assert!(printout.contains("out of memory: the system refused"), "{case}: {printout}");
            assert!(both.is_one_of_them(), "{case}: lost or mixed");
            refused += 1;
            left += usize::from(entries(home.path()) != *expected);
            both.finish((number + 1) % 2);
            assert!(both.is_one_of_them(), "{case}: lost or mixed after the next start");
            let mut there = entries(home.path());
            there.retain(|name| name != "target.parts");
            assert_eq!(there, *expected, "{case}: left-overs after the next start");
            request *= factor;
        }
    }
    println!("{refused} refused, {left} of them left something, all of it put in order");
    assert!(refused > 2 * WRITERS.len());
}

/// The signal handler is installed once its thread exists.
#[cfg(target_os = "linux")]
fn wait_for_handler(pid: u32) {
    let tasks = format!("/proc/{pid}/task");
    let stands = || {
        fs::read_dir(&tasks).unwrap().any(|task| {
            let name = fs::read_to_string(task.unwrap().path().join("comm")).unwrap_or_default();
            name.trim() == "signals"
        })
    };
    while !stands() {
        std::thread::yield_now();
    }
}

#[cfg(target_os = "linux")]
#[test]
fn every_request_to_end_is_heard_and_reported() {
    for (signal, twice, code) in [
        ("-INT", false, 130),
        ("-TERM", false, 143),
        ("-HUP", false, 143),
        ("-TERM", true, 143),
        ("-INT", true, 130),
    ] {
        let home = home();
        let child = catchment(home.path())
            .args(["run", "v.toml", "--resolution", "3000", "-o", "out", "--threads", "1"])
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        wait_for_handler(child.id());
        for _ in 0..=usize::from(twice) {
            let pid = child.id().to_string();
            // The process may have ended after the first signal.
            let _ = Command::new("kill").args([signal, &pid]).stderr(Stdio::null()).status().unwrap();
        }
        let output = child.wait_with_output().unwrap();
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(code), "{signal}: {stderr}");
        // The second signal ends the process immediately.
        let whole = "interrupted; nothing was written\n";
        assert!(stderr == whole || twice && whole.starts_with(&stderr), "{signal}: {stderr}");
        assert_eq!(entries(home.path()), ["v.toml"], "{signal}");
    }
}

/// Hulls in six dimensions: minutes of computation without a check for signals.
#[cfg(target_os = "linux")]
#[test]
fn the_dearest_steps_listen() {
    let home = home();
    fs::copy(super::designs().join("pyramid-pieces.toml"), home.path().join("p.toml")).unwrap();
    let child = catchment(home.path())
        .args(["run", "p.toml", "--free", "roll,pitch,yaw", "--method", "partition", "-o", "out"])
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    std::thread::sleep(Duration::from_secs(2));
    let requested = Instant::now();
    let _ = Command::new("kill").args(["-TERM", &child.id().to_string()]).status().unwrap();
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(143), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(requested.elapsed() < Duration::from_secs(20), "{:?}", requested.elapsed());
    assert_eq!(entries(home.path()), ["p.toml", "v.toml"]);
}

/// `nohup` keeps the process alive.
#[cfg(target_os = "linux")]
#[test]
fn a_signal_that_is_to_be_ignored_is() {
    let home = home();
    let script = format!(
        "trap '' HUP; exec {} run v.toml --resolution 60 --samples 0 -q",
        env!("CARGO_BIN_EXE_catchment")
    );
    let child = starter("sh")
        .args(["-c", &script])
        .current_dir(home.path())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    for _ in 0..5 {
        std::thread::sleep(Duration::from_millis(5));
        let _ = Command::new("kill").args(["-HUP", &child.id().to_string()]).stderr(Stdio::null()).status();
    }
    let status = child.wait_with_output().unwrap().status;
    // Before the shell has set its trap, the signal ends it.
    assert!(matches!(status.code(), None | Some(0)), "{status}");
}
