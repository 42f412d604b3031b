//! Any bytes as a file of laws. What must hold is said beside the function.
//!
//! `just fuzz dynamics 600`

#![no_main]

#[path = "../../crates/catchment/tests/readers/targets.rs"]
mod targets;

use catchment_fuzz as _; // its allocator
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| targets::dynamics(bytes));
