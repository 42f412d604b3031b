//! Any bytes as a command line, a word per line: read, or refused with a message that steers no terminal.
//!
//! `just fuzz arguments 600`

#![no_main]

use catchment_fuzz as _; // its allocator
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let text = String::from_utf8_lossy(bytes);
    let words = std::iter::once("catchment").chain(text.lines());
    if let Some(said) = catchment_cli::complaint(words) {
        assert!(!said.is_empty());
        assert!(!said.chars().any(|c| c.is_control() && c != '\n' && c != '\t'), "{said:?}");
    }
});
