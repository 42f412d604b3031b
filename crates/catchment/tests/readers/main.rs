//! Every reader on the corpora of the fuzzer and thousands of mutated copies of them, the same ones in every run: no panic,
//! no hang, and no more memory than the limit below. The fuzzer itself, for hours: `just fuzz`.

#![expect(clippy::unwrap_used, reason = "a test stops where its preparation fails")]

mod mutate;
mod targets;

use mutate::{Dice, spoilt};
use peak_alloc::PeakAlloc;
use std::path::Path;
use std::time::{Duration, Instant};

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// Mutated copies per reader; the environment variable `READER_RUNS` raises the number.
const RUNS: usize = 3000;

/// Memory limit of a reader for an input of at most a megabyte, and its time limit on a busy machine.
const MOST_BYTES: usize = 64 << 20;
const LONGEST: Duration = Duration::from_secs(10);

/// The corpus of a reader.
fn corpus(name: &str) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/corpus").join(name);
    let mut paths: Vec<_> = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    assert!(!paths.is_empty(), "{} is empty", folder.display());
    paths.iter().map(|path| std::fs::read(path).unwrap()).collect()
}

/// Runs a reader on its corpus and on mutated copies.
fn replay(name: &str, reader: fn(&[u8])) {
    let seeds = corpus(name);
    let runs = std::env::var("READER_RUNS").ok().and_then(|runs| runs.parse().ok()).unwrap_or(RUNS);
    let mut dice = Dice::new(name.len() as u64);
    let spoilt = (0..runs).map(|_| {
        let seed = dice.one(&seeds);
        spoilt(&mut dice, seed, &seeds)
    });
    for (number, input) in seeds.iter().cloned().chain(spoilt).enumerate() {
        MEMORY.reset_peak_usage();
        let (before, started) = (MEMORY.current_usage(), Instant::now());
        let ended = std::panic::catch_unwind(|| reader(&input));
        let (taken, time) = (MEMORY.peak_usage().saturating_sub(before), started.elapsed());
        let shown = || format!("{name}, input {number}:\n{}", String::from_utf8_lossy(&input));
        assert!(ended.is_ok(), "a panic on {}", shown());
        assert!(taken <= MOST_BYTES, "{taken} bytes of memory on {}", shown());
        assert!(time <= LONGEST, "{time:?} on {}", shown());
    }
}

#[test]
fn mutated_inputs_are_read_or_refused() {
    for (name, reader) in targets::TARGETS {
        replay(name, *reader);
    }
}

/// The fuzzer runs these, and three targets of other crates, which have their own tests.
#[test]
fn every_corpus_has_its_reader() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/corpus");
    let folders = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name());
    let mut corpora: Vec<String> = folders.map(|name| name.into_string().unwrap()).collect();
    corpora.retain(|name| !["arguments", "request", "systems"].contains(&name.as_str()));
    corpora.sort();
    let names: Vec<&str> = targets::TARGETS.iter().map(|(name, _)| *name).collect();
    assert_eq!(corpora, names);
}
