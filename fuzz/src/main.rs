//! One program for all fuzz targets: the environment variable `CATCHMENT_FUZZ` names the one that runs. `fuzz/run` starts it.
//!
//! What must hold of a target is said beside its function; the tests of the readers run the same functions.

#![no_main]

mod limited;
#[path = "../../crates/catchment/tests/readers/targets.rs"]
mod readers;
#[path = "../../crates/catchment-systems/tests/readers/targets.rs"]
mod systems;

use libfuzzer_sys::fuzz_target;
use std::sync::OnceLock;

/// What an input goes to.
type Target = fn(&[u8]);

/// The targets by their names, which are those of their corpora.
const TARGETS: [(&str, Target); 18] = [
    ("arguments", arguments),
    ("design", readers::design_file),
    ("drawing", readers::drawing),
    ("dynamics", readers::dynamics),
    ("lines", readers::line),
    ("obj", readers::obj_file),
    ("ply", readers::ply_file),
    ("poses", readers::pose_table),
    ("report", readers::report),
    ("request", request),
    ("requirement", readers::requirement),
    ("resolution", readers::resolution),
    ("robots", readers::robots),
    ("step", readers::step_answer),
    ("stl", readers::stl_file),
    ("systems", systems::file),
    ("threemf", readers::threemf_file),
    ("zarr", readers::group),
];

fuzz_target!(|bytes: &[u8]| {
    static TARGET: OnceLock<Target> = OnceLock::new();
    TARGET.get_or_init(chosen)(bytes);
});

/// The target that the environment names.
fn chosen() -> Target {
    let name = std::env::var("CATCHMENT_FUZZ").unwrap_or_default();
    let target = TARGETS.iter().find(|(known, _)| *known == name);
    target.map_or_else(
        || {
            let names: Vec<&str> = TARGETS.iter().map(|(known, _)| *known).collect();
            eprintln!("CATCHMENT_FUZZ is `{name}`; it names one of {}", names.join(", "));
            std::process::exit(2)
        },
        |(_, target)| *target,
    )
}

/// A command line, a word per line: read, or refused with a message that steers no terminal.
fn arguments(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    let words = std::iter::once("catchment").chain(text.lines());
    if let Some(said) = catchment_cli::usage_error(words) {
        assert!(!said.is_empty());
        assert!(!said.chars().any(|c| c.is_control() && c != '\n' && c != '\t'), "{said:?}");
    }
}

/// The head of a request to `view`: it is refused without the token and the name of this machine.
fn request(bytes: &[u8]) {
    if let Some(path) = catchment_cli::admitted(bytes, 9, "token") {
        let text = std::str::from_utf8(bytes).expect("what is let in is text");
        assert!(text.contains(&format!("/token/{path}")));
        assert!(["127.0.0.1:9", "localhost:9"].iter().any(|own| text.to_ascii_lowercase().contains(own)));
    }
}
