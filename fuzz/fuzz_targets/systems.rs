//! Any bytes as a file of the systems: latch, chain, region, heights. What must hold is said beside the function.
//!
//! `just fuzz systems 600`

#![no_main]

#[path = "../../crates/catchment-systems/tests/readers/targets.rs"]
mod targets;

use catchment_fuzz as _; // its allocator
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| targets::file(bytes));
