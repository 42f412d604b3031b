//! Any bytes as the head of a request to `view`: nobody is let in who does not know the token and the name of this machine.
//!
//! `just fuzz request 600`

#![no_main]

use catchment_fuzz as _; // its allocator
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Some(path) = catchment_cli::admitted(bytes, 9, "token") {
        let text = std::str::from_utf8(bytes).expect("what is let in is text");
        assert!(text.contains(&format!("/token/{path}")));
        assert!(["127.0.0.1:9", "localhost:9"].iter().any(|own| text.to_ascii_lowercase().contains(own)));
    }
});
