//! Limits on the memory of a result.

use crate::diagnostic::Advised;
use std::fmt;

/// A result would not fit in the memory budget.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{what} needs {} of memory, more than the {} allowed; {advice}", Bytes(*needed), Bytes(*budget))]
pub struct OutOfBudget {
    /// The allocation.
    pub what: &'static str,
    /// Bytes it needs.
    pub needed: u64,
    /// Bytes it may use.
    pub budget: u64,
    /// Advice.
    #[source]
    pub advice: Advised,
}

/// A byte count that prints in a suitable unit.
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

/// Memory that the system can provide without swapping, within the limits of this process; 4 GiB if the
/// system does not report it.
pub(super) fn available() -> u64 {
    const FALLBACK: u64 = 4 << 30;
    let limit = limit();
    system::free(system::ROOT).unwrap_or(FALLBACK).min(limit)
}

/// Memory that this process may still use before the system refuses or ends it; practically infinite without
/// a limit.
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
