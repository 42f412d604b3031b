//! The table that every bench prints: what was done, how often per second, beside the judge in the same run and
//! beside the stored rate.
//!
//! ```text
//!   cargo bench -p catchment-core                    compare with benches/rates.json
//!   cargo bench -p catchment-core -- pyramid         only works with this word in their name
//!   cargo bench -p catchment-core -- --store         keep what was measured as the new stored rates
//! ```
//!
//! Rates are medians of several rounds. Within a round the work and its judge take turns, so that a drifting
//! machine cancels out of their ratio; it does not cancel out of the ratio to stored rates, least of all to those
//! of another machine. Peak memory counts where the bench installs [`peak_alloc::PeakAlloc`]. Without `--bench`, as
//! under `cargo test`, every work runs once, for its assertions alone.

use peak_alloc::PeakAlloc;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

/// Rounds of which the median counts.
const ROUNDS: usize = 7;
/// Seconds for which a round repeats shorter works: far above the clock's resolution.
const SHORTEST_ROUND: f64 = 0.02;
/// Works that take more seconds are not repeated more often than needed for a median.
const LONG: f64 = 0.7;
const ROUNDS_OF_LONG: usize = 3;

/// The rates of one bench, as they are stored.
#[derive(Debug, Default, Serialize, Deserialize)]
struct Stored {
    machine: String,
    date: String,
    commit: String,
    per_second: BTreeMap<String, f64>,
}

/// What was measured of one work.
struct Row {
    name: String,
    per_second: f64,
    peak_bytes: Option<f64>,
    to_brute: Option<f64>,
}

/// The table of one bench.
pub(crate) struct Rates {
    bench: &'static str,
    filter: Option<String>,
    store: bool,
    timed: bool,
    rows: Vec<Row>,
}

impl Rates {
    /// An empty table; what to measure is on the command line.
    pub(crate) fn of(bench: &'static str) -> Self {
        let arguments: Vec<String> = std::env::args().skip(1).collect();
        let has = |flag: &str| arguments.iter().any(|a| a == flag);
        let filter = arguments.iter().find(|a| !a.starts_with('-')).cloned();
        Self { bench, filter, store: has("--store"), timed: has("--bench"), rows: Vec::new() }
    }

    /// Measures `work`, which does `count` of `unit`; `brute` does the same slowly.
    pub(crate) fn measure(
        &mut self,
        name: &str,
        unit: &'static str,
        count: usize,
        work: &mut dyn FnMut(),
        brute: Option<&mut dyn FnMut()>,
    ) {
        let name = format!("{unit}, {name}");
        if self.filter.as_ref().is_some_and(|word| !name.contains(word)) {
            return;
        }
        let (first, peak) = peak_of(work);
        let mut brute = brute;
        let first_brute = brute.as_mut().map_or(0.0, |brute| time(brute));
        if !self.timed {
            return;
        }
        let repeats = (SHORTEST_ROUND / first.max(1e-9)).ceil() as usize;
        let rounds = if first + first_brute > LONG { ROUNDS_OF_LONG } else { ROUNDS };
        let (mut seconds, mut ratios) = (Vec::new(), Vec::new());
        for _ in 0..rounds {
            let slow = brute.as_mut().map(|brute| time(brute));
            let fast = time(&mut || (0..repeats).for_each(|_| work())) / repeats as f64;
            seconds.push(fast);
            ratios.extend(slow.map(|slow| slow / fast));
        }
        self.rows.push(Row {
            name,
            per_second: count as f64 / median(seconds),
            peak_bytes: peak.map(|bytes| bytes as f64 / count as f64),
            to_brute: brute.map(|_| median(ratios)),
        });
    }

    /// Prints the table, and stores the rates with `--store`.
    #[expect(clippy::print_stdout, reason = "a bench prints what it measures")]
    pub(crate) fn finish(self) {
        if self.rows.is_empty() {
            return;
        }
        let mut all: BTreeMap<String, Stored> = std::fs::read_to_string(path())
            .map(|text| serde_json::from_str(&text).expect("stored rates that can be read"))
            .unwrap_or_default();
        let stored = all.entry(self.bench.to_owned()).or_default();
        let here = machine();
        println!("{}: {here}", self.bench);
        if !stored.per_second.is_empty() {
            let elsewhere = if stored.machine == here { "this machine" } else { &stored.machine };
            println!("stored: {elsewhere}, {}, commit {}", stored.date, stored.commit);
        }
        let width = self.rows.iter().map(|row| row.name.chars().count()).max().unwrap_or(0);
        println!("{:width$}  per second   ns each  peak B each  to brute  to stored", "work");
        let or_none = |text: Option<String>| text.unwrap_or_else(|| "–".to_owned());
        for row in &self.rows {
            let to_stored = stored.per_second.get(&row.name).map(|before| row.per_second / before);
            println!(
                "{:width$}  {:>10} {:>9} {:>12} {:>9} {:>10}",
                row.name,
                short(row.per_second),
                short(1e9 / row.per_second),
                or_none(row.peak_bytes.map(|bytes| format!("{bytes:.2}"))),
                or_none(row.to_brute.map(|ratio| format!("×{}", short(ratio)))),
                or_none(to_stored.map(|ratio| format!("×{ratio:.2}"))),
            );
        }
        println!();
        if self.store && self.filter.is_none() {
            let three_digits = |rate: f64| format!("{rate:.2e}").parse().expect("a number");
            *stored = Stored {
                machine: here,
                date: output_of("date", &["-u", "+%F"]),
                commit: output_of("git", &["describe", "--always", "--dirty"]),
                per_second: self.rows.iter().map(|r| (r.name.clone(), three_digits(r.per_second))).collect(),
            };
            let text = serde_json::to_string_pretty(&all).expect("plain data") + "\n";
            std::fs::write(path(), text).expect("room for the stored rates");
        } else if self.store {
            println!("not stored: rates are stored all together, without a filter\n");
        }
    }
}

fn path() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/rates.json")
}

fn time(work: &mut dyn FnMut()) -> f64 {
    let start = Instant::now();
    work();
    start.elapsed().as_secs_f64()
}

/// Seconds that the work took, and how many bytes it held at most, beside those held before.
fn peak_of(work: &mut dyn FnMut()) -> (f64, Option<usize>) {
    PeakAlloc.reset_peak_usage();
    let before = PeakAlloc.current_usage();
    let seconds = time(work);
    // Nothing is counted unless the bench has installed the counting allocator.
    (seconds, (before > 0).then(|| PeakAlloc.peak_usage().saturating_sub(before)))
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Three digits with a unit prefix.
fn short(value: f64) -> String {
    let (scaled, prefix) = match value {
        v if v >= 1e9 => (v / 1e9, " G"),
        v if v >= 1e6 => (v / 1e6, " M"),
        v if v >= 1e4 => (v / 1e3, " k"),
        v => (v, ""),
    };
    let digits = if scaled >= 100.0 {
        0
    } else if scaled >= 10.0 {
        1
    } else {
        2
    };
    format!("{scaled:.digits$}{prefix}")
}

/// Processor, cores and system.
fn machine() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = text.lines().find_map(|l| l.strip_prefix("model name")?.split_once(": ").map(|(_, m)| m));
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    format!("{cores} × {}, {}", model.unwrap_or(std::env::consts::ARCH), std::env::consts::OS)
}

/// What a program says, in one line; "unknown" where it is not there.
fn output_of(program: &str, arguments: &[&str]) -> String {
    let output = Command::new(program).args(arguments).output().ok().filter(|o| o.status.success());
    output.map_or_else(|| "unknown".to_owned(), |o| String::from_utf8_lossy(&o.stdout).trim().to_owned())
}
