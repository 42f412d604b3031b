//! Limits on the memory of a result.

use crate::advice::Advised;
use std::fmt;

/// A result would not fit in the memory budget.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{what} needs {} of memory, more than the {} allowed; {advice}", Bytes(*needed), Bytes(*budget))]
pub struct OutOfBudget {
    /// What would have been allocated.
    pub what: &'static str,
    /// Bytes it needs.
    pub needed: u64,
    /// Bytes it may use.
    pub budget: u64,
    /// What to do about it.
    #[source]
    pub advice: Advised,
}

/// A byte count that prints in the unit a person would choose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bytes(pub u64);

impl fmt::Display for Bytes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const UNITS: [&str; 5] = ["B", "KiB", "MiB", "GiB", "TiB"];
        let mut value = self.0 as f64;
        let mut unit = 0;
        while value >= 1024.0 && unit + 1 < UNITS.len() {
            value /= 1024.0;
            unit += 1;
        }
        if unit == 0 { write!(f, "{} B", self.0) } else { write!(f, "{value:.1} {}", UNITS[unit]) }
    }
}

/// Memory the system can hand out without swapping, and that this process may still take; 4 GiB where it does not say.
pub(super) fn available() -> u64 {
    const FALLBACK: u64 = 4 << 30;
    let limit = limit();
    system::free(system::ROOT).unwrap_or(FALLBACK).min(limit)
}

/// What this process may still take before the system refuses it or ends it; as good as no limit where there is none.
pub(super) fn limit() -> u64 {
    system::limit(system::ROOT).unwrap_or(u64::MAX)
}

#[cfg(not(target_os = "linux"))]
mod system {
    use std::path::Path;

    pub(super) const ROOT: &str = "";

    pub(super) fn free(_: impl AsRef<Path>) -> Option<u64> {
        None
    }

    pub(super) fn limit(_: impl AsRef<Path>) -> Option<u64> {
        None
    }
}

#[cfg(target_os = "linux")]
mod system;
