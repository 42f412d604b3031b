//! The clock of the library. On a system without a clock (`wasm32-unknown-unknown`) no time passes:
//! stopwatches stay at zero and deadlines never expire.

use std::time::Duration;

#[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
mod moment {
    use std::time::{Duration, Instant};

    #[derive(Debug, Clone, Copy)]
    pub(super) struct Moment(Instant);

    impl Moment {
        pub(super) fn now() -> Self {
            Self(Instant::now())
        }

        pub(super) fn elapsed(self) -> Duration {
            self.0.elapsed()
        }
    }
}

#[cfg(all(target_family = "wasm", target_os = "unknown"))]
mod moment {
    use std::time::Duration;

    #[derive(Debug, Clone, Copy)]
    pub(super) struct Moment;

    impl Moment {
        pub(super) fn now() -> Self {
            Self
        }

        pub(super) fn elapsed(self) -> Duration {
            Duration::ZERO
        }
    }
}

/// Time since it was started.
#[derive(Debug, Clone, Copy)]
pub struct Stopwatch(moment::Moment);

impl Stopwatch {
    /// Starts now.
    pub fn start() -> Self {
        Self(moment::Moment::now())
    }

    /// Time since the start; zero on a system without a clock.
    pub fn elapsed(&self) -> Duration {
        self.0.elapsed()
    }

    /// The same in seconds.
    pub fn seconds(&self) -> f64 {
        self.elapsed().as_secs_f64()
    }
}

/// A span of time that ends.
#[derive(Debug, Clone, Copy)]
pub(super) struct Deadline {
    since: Stopwatch,
    limit: Duration,
}

impl Deadline {
    pub(super) fn after(limit: Duration) -> Self {
        Self { since: Stopwatch::start(), limit }
    }

    pub(super) fn is_over(&self) -> bool {
        // Without a clock nothing is ever over, not even no time at all.
        cfg!(not(all(target_family = "wasm", target_os = "unknown"))) && self.since.elapsed() >= self.limit
    }

    /// Time that is left.
    pub(super) fn left(&self) -> Duration {
        self.limit.saturating_sub(self.since.elapsed())
    }
}
