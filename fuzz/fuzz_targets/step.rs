//! Any bytes as the answer of the interpreter that meshes STEP files. What must hold is said beside the function.
//!
//! `just fuzz step 600`

#![no_main]

#[path = "../../crates/catchment/tests/readers/targets.rs"]
mod targets;

use catchment_fuzz as _; // its allocator
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| targets::step_answer(bytes));
