//! One program for all fuzz targets: the environment variable `CATCHMENT_FUZZ` selects one. `fuzz/run` starts it.
//!
//! The function of a target documents its properties; the tests of the readers run the same functions.

#![no_main]

mod limited;
#[path = "../../crates/catchment/tests/readers/targets.rs"]
mod readers;
#[path = "../../crates/catchment-systems/tests/readers/targets.rs"]
mod systems;

use libfuzzer_sys::fuzz_target;
use std::sync::OnceLock;

/// Targets other than the readers.
const OTHERS: &[readers::Target] =
    &[("arguments", arguments), ("request", request), ("systems", systems::file)];

fuzz_target!(|bytes: &[u8]| {
    static TARGET: OnceLock<fn(&[u8])> = OnceLock::new();
    TARGET.get_or_init(chosen)(bytes);
});

/// The target selected by the environment.
fn chosen() -> fn(&[u8]) {
    let name = std::env::var("CATCHMENT_FUZZ").unwrap_or_default();
    let targets = || readers::TARGETS.iter().chain(OTHERS);
    let target = targets().find(|(known, _)| *known == name);
    target.map_or_else(
        || {
            let names: Vec<&str> = targets().map(|(known, _)| *known).collect();
            eprintln!("CATCHMENT_FUZZ is `{name}`; it names one of {}", names.join(", "));
            std::process::exit(2)
        },
        |(_, target)| *target,
    )
}

/// A command line, one word per line: accepted, or refused with a message without terminal control
/// characters.
fn arguments(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    let words = std::iter::once("catchment").chain(text.lines());
    if let Some(said) = catchment_cli::usage_error(words) {
        assert!(!said.is_empty());
        assert!(!said.chars().any(|c| c.is_control() && c != '\n' && c != '\t'), "{said:?}");
    }
}

/// The head of a request to `view`: refused without the token and the name of this machine.
fn request(bytes: &[u8]) {
    if let Some(path) = catchment_cli::admitted(bytes, 9, "token") {
        let text = std::str::from_utf8(bytes).expect("what is let in is text");
        assert!(text.contains(&format!("/token/{path}")));
        assert!(["127.0.0.1:9", "localhost:9"].iter().any(|own| text.to_ascii_lowercase().contains(own)));
    }
}
