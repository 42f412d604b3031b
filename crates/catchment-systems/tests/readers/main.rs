//! Every reader on the corpus of the fuzzer and on thousands of spoilt copies of it, the same ones in every run: no panic, no hang.

#[path = "../../../catchment/tests/readers/mutate.rs"]
mod mutate;
mod targets;

use mutate::{Dice, spoilt};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Spoilt copies; more by the environment variable `READER_RUNS`.
const RUNS: usize = 6000;
/// As long as one may take on a busy machine.
const LONGEST: Duration = Duration::from_secs(10);

#[test]
fn files_are_read_or_refused() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/corpus/systems");
    let mut paths: Vec<PathBuf> =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    let seeds: Vec<Vec<u8>> = paths.iter().map(|path| std::fs::read(path).unwrap()).collect();
    assert!(seeds.len() >= 8);
    let runs = std::env::var("READER_RUNS").ok().and_then(|runs| runs.parse().ok()).unwrap_or(RUNS);
    let mut dice = Dice::new(12);
    let copies = (0..runs).map(|_| {
        let seed = dice.one(&seeds);
        spoilt(&mut dice, seed, &seeds)
    });
    for (number, input) in seeds.iter().cloned().chain(copies).enumerate() {
        let started = Instant::now();
        let ended = std::panic::catch_unwind(|| targets::file(&input));
        let (time, shown) = (started.elapsed(), String::from_utf8_lossy(&input));
        assert!(ended.is_ok(), "a panic on input {number}:\n{shown}");
        assert!(time <= LONGEST, "{time:?} on input {number}:\n{shown}");
    }
}
