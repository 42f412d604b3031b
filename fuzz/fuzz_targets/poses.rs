//! Any bytes as a table of poses. What must hold is said beside the function.
//!
//! `cargo +nightly fuzz run poses -- -rss_limit_mb=1024 -malloc_limit_mb=256`

#![no_main]

#[path = "../../crates/catchment/tests/readers/targets.rs"]
mod targets;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| targets::pose_table(bytes));
