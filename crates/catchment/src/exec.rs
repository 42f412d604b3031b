//! How a computation runs: threads, cancel, progress, memory budget. Nothing here may change a bit of a
//! result; what may change the answer is a room's `Settings`.

use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// The computation was asked to stop.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("cancelled")]
pub struct Cancelled;

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
    pub advice: String,
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

/// Called with the fraction done, in [0, 1] and never decreasing per stage, and the stage's name.
pub type Progress = Arc<dyn Fn(f64, &'static str) + Send + Sync>;

/// How to run: shared by every room, cheap to clone.
#[derive(Clone, Default)]
pub struct Exec {
    pool: Option<Arc<rayon::ThreadPool>>,
    cancel: Arc<AtomicBool>,
    progress: Option<Progress>,
    memory_budget: Option<u64>,
    deadline: Option<Instant>,
}

impl fmt::Debug for Exec {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Exec")
            .field("threads", &self.threads())
            .field("cancelled", &self.is_cancelled())
            .field("memory_budget", &self.memory_budget)
            .finish_non_exhaustive()
    }
}

impl Exec {
    /// All cores, no progress, three quarters of the available memory.
    pub fn new() -> Self {
        Self::default()
    }

    /// Uses exactly `threads` worker threads (0 means one per core).
    ///
    /// # Errors
    /// When the system refuses to start that many threads.
    pub fn with_threads(mut self, threads: usize) -> Result<Self, rayon::ThreadPoolBuildError> {
        self.pool = Some(Arc::new(rayon::ThreadPoolBuilder::new().num_threads(threads).build()?));
        Ok(self)
    }

    /// Reports progress to `progress`.
    #[must_use]
    pub fn with_progress(mut self, progress: Progress) -> Self {
        self.progress = Some(progress);
        self
    }

    /// Refuses any single result larger than `bytes`.
    #[must_use]
    pub fn with_memory_budget(mut self, bytes: u64) -> Self {
        self.memory_budget = Some(bytes);
        self
    }

    /// Stops at `deadline` as if a stop had been asked for: the result is whole or there is none.
    #[must_use]
    pub fn with_deadline(mut self, deadline: Instant) -> Self {
        self.deadline = Some(deadline);
        self
    }

    /// The flag that stops the computation when set: hand it to a signal handler.
    pub fn cancel_flag(&self) -> Arc<AtomicBool> {
        Arc::clone(&self.cancel)
    }

    /// Whether a stop was asked for, or the deadline is over.
    pub fn is_cancelled(&self) -> bool {
        self.cancel.load(Ordering::Relaxed)
            || self.deadline.is_some_and(|deadline| Instant::now() >= deadline)
    }

    /// `Err` once a stop was asked for. Rooms call this at least once per rotation or per pose.
    pub fn check(&self) -> Result<(), Cancelled> {
        if self.is_cancelled() { Err(Cancelled) } else { Ok(()) }
    }

    /// Reports `fraction` of `stage` as done.
    pub fn report(&self, fraction: f64, stage: &'static str) {
        if let Some(progress) = &self.progress {
            progress(fraction.clamp(0.0, 1.0), stage);
        }
    }

    /// The same for a part of a stage: what it reports as [0, 1] is passed on as `span` of `stage`.
    #[must_use]
    pub fn part(&self, span: [f64; 2], stage: &'static str) -> Self {
        let mut part = self.clone();
        part.progress = self.progress.clone().map(|progress| -> Progress {
            Arc::new(move |fraction, _| progress(span[0] + (span[1] - span[0]) * fraction, stage))
        });
        part
    }

    /// Number of worker threads.
    pub fn threads(&self) -> usize {
        self.pool.as_ref().map_or_else(rayon::current_num_threads, |p| p.current_num_threads())
    }

    /// Runs `work` on this pool; rayon iterators inside it use its threads.
    pub fn install<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        match &self.pool {
            Some(pool) => pool.install(work),
            None => work(),
        }
    }

    /// Bytes one result may use: the set budget, else three quarters of the memory the system says is free.
    pub fn memory_budget(&self) -> u64 {
        self.memory_budget.unwrap_or_else(|| available_memory() / 4 * 3)
    }

    /// Checks a memory need *before* allocating.
    pub fn ensure_fits(
        &self,
        what: &'static str,
        needed: u64,
        advice: impl FnOnce(u64) -> String,
    ) -> Result<(), OutOfBudget> {
        let budget = self.memory_budget();
        if needed <= budget {
            return Ok(());
        }
        Err(OutOfBudget { what, needed, budget, advice: advice(budget) })
    }
}

/// Memory the system can hand out without swapping; 4 GiB where it does not say.
fn available_memory() -> u64 {
    const FALLBACK: u64 = 4 << 30;
    let Ok(text) = std::fs::read_to_string("/proc/meminfo") else { return FALLBACK };
    text.lines()
        .find_map(|line| line.strip_prefix("MemAvailable:"))
        .and_then(|rest| rest.trim().trim_end_matches("kB").trim().parse::<u64>().ok())
        .map_or(FALLBACK, |kib| kib * 1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_need_beyond_the_budget_is_refused_with_advice() {
        let exec = Exec::new().with_memory_budget(1000);
        assert!(exec.ensure_fits("a grid", 1000, |_| String::new()).is_ok());
        let error = exec.ensure_fits("a grid", 3 << 20, |budget| format!("use {budget} bytes")).unwrap_err();
        assert_eq!(
            error.to_string(),
            "a grid needs 3.0 MiB of memory, more than the 1000 B allowed; use 1000 bytes"
        );
    }

    #[test]
    fn a_part_reports_its_span_of_the_whole() {
        let seen = Arc::new(std::sync::Mutex::new(Vec::new()));
        let log = Arc::clone(&seen);
        let exec = Exec::new().with_progress(Arc::new(move |f, stage| log.lock().unwrap().push((f, stage))));
        exec.part([0.5, 0.75], "whole").report(0.5, "part");
        assert_eq!(*seen.lock().unwrap(), [(0.625, "whole")]);
    }

    #[test]
    fn a_deadline_stops_this_one_and_its_parts_alone() {
        let exec = Exec::new();
        let late = exec.clone().with_deadline(Instant::now());
        assert!(
            late.check().is_err() && late.part([0.0, 1.0], "part").is_cancelled() && !exec.is_cancelled()
        );
    }

    #[test]
    fn the_cancel_flag_is_shared_between_clones() {
        let exec = Exec::new();
        let clone = exec.clone();
        exec.cancel_flag().store(true, Ordering::Relaxed);
        assert_eq!(clone.check(), Err(Cancelled));
    }

    #[test]
    fn threads_are_what_was_asked_for() {
        assert_eq!(Exec::new().with_threads(3).unwrap().threads(), 3);
    }
}
