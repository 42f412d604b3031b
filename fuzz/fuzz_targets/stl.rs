//! The STL reader on arbitrary bytes: no panic, no unbounded memory, and what it accepts is a closed solid.

#![no_main]

use catchment::connector::stl;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(surface) = stl::from_bytes(bytes, bytes.len() as u64, 1.0) {
        assert!(surface.volume() > 0.0);
        assert!(surface.vertices.iter().all(|v| v.is_finite()));
    }
});
