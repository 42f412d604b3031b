//! Any bytes as a design file. What must hold is said beside the function.
//!
//! `cargo +nightly fuzz run design -- -rss_limit_mb=1024 -malloc_limit_mb=256 -dict=fuzz/design.dict`

#![no_main]

#[path = "../../crates/catchment/tests/readers/targets.rs"]
mod targets;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| targets::design_file(bytes));
