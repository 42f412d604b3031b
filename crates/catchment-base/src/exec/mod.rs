//! Execution of a computation: threads, cancellation, clock, progress, memory budget. Nothing here changes a
//! bit of a result; settings that change the result are in a module's `Settings`.
//!
//! Only this module uses system services: threads, the time, and the amount of free memory. On a system
//! without them (`wasm32-unknown-unknown` lacks all) work runs on the caller's thread, no time passes, and 4
//! GiB count as free.

mod clock;
mod guard;
mod map;
mod memory;
mod progress;
mod tally;
mod threads;

pub use clock::Stopwatch;
pub use guard::attempt;
pub use guard::is_expected as is_panic_expected;
pub use memory::{Bytes, OutOfBudget};
pub use progress::Progress;
pub use tally::Tally;
pub use threads::ThreadsError;

use crate::diagnostic::{Advice, Advised};
use clock::Deadline;
use progress::Reporter;
use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use threads::Threads;

/// Size of a result, in bytes, up to which the free memory of the system is not read: reading takes longer than such a
/// result.
const SMALL: u64 = 1 << 20;

/// The computation was cancelled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("cancelled")]
pub struct Cancelled;

/// How to run: shared by every room, cheap to clone.
#[derive(Clone, Default)]
pub struct Exec {
    threads: Threads,
    cancel: Arc<AtomicBool>,
    progress: Option<Reporter>,
    memory_budget: Option<u64>,
    deadline: Option<Deadline>,
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
    /// A thread per core, or the number in the environment variable `RAYON_NUM_THREADS` (fewer if the system
    /// refuses them), no progress, three quarters of the available memory.
    pub fn new() -> Self {
        Self::default()
    }

    /// Uses exactly `threads` worker threads of its own; 0 means as many as in [`Exec::new`].
    ///
    /// # Errors
    /// The system refuses to start that many threads; or `threads` is 0, and the environment variable
    /// `RAYON_NUM_THREADS` is not a number from 0 to 1024.
    pub fn with_threads(mut self, threads: usize) -> Result<Self, ThreadsError> {
        self.threads = if threads == 0 { Threads::shared()? } else { Threads::exactly(threads)? };
        Ok(self)
    }

    /// Reports progress to `progress`, as of a new run.
    #[must_use]
    pub fn with_progress(mut self, progress: Progress) -> Self {
        self.progress = Some(Reporter::new(progress));
        self
    }

    /// The same for another run: its stages start from 0 again. A part of a run stays a part of it.
    #[must_use]
    pub fn anew(&self) -> Self {
        Self { progress: self.progress.as_ref().map(Reporter::anew), ..self.clone() }
    }

    /// Refuses any single result larger than `bytes`.
    #[must_use]
    pub fn with_memory_budget(mut self, bytes: u64) -> Self {
        self.memory_budget = Some(bytes);
        self
    }

    /// Cancels the computation after `limit` from now, or after an earlier limit: the result is then complete
    /// or absent. Has no effect on a system without a clock.
    #[must_use]
    pub fn with_time_limit(mut self, limit: Duration) -> Self {
        let left = self.deadline.map_or(limit, |earlier| earlier.left().min(limit));
        self.deadline = Some(Deadline::after(left));
        self
    }

    /// The flag that stops the computation when set: hand it to a signal handler.
    pub fn cancel_flag(&self) -> Arc<AtomicBool> {
        Arc::clone(&self.cancel)
    }

    /// Whether a stop was requested, or the time limit has passed.
    pub fn is_cancelled(&self) -> bool {
        self.cancel.load(Ordering::Relaxed) || self.deadline.is_some_and(|deadline| deadline.is_over())
    }

    /// `Err` once a stop was requested. Modules call this at least once per rotation or per pose.
    pub fn check(&self) -> Result<(), Cancelled> {
        if self.is_cancelled() { Err(Cancelled) } else { Ok(()) }
    }

    /// Reports `fraction` of `stage` as done. Values below an earlier report from another thread are not
    /// passed on.
    pub fn report(&self, fraction: f64, stage: &'static str) {
        if let Some(progress) = &self.progress {
            progress.report(fraction, stage);
        }
    }

    /// The same for a part of a stage: its reports in [0, 1] are passed on as `span` of `stage`, and if this
    /// is a part itself, as that span of its own.
    #[must_use]
    pub fn part(&self, span: [f64; 2], stage: &'static str) -> Self {
        Self { progress: self.progress.as_ref().map(|whole| whole.part(span, stage)), ..self.clone() }
    }

    /// Number of worker threads.
    pub fn threads(&self) -> usize {
        self.threads.count()
    }

    /// Runs `work` on these threads; rayon iterators inside it use them. For items that cost much see
    /// [`Exec::map`].
    pub fn install<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        self.threads.install(work)
    }

    /// Runs `count` pieces of work, and returns their results in order. At most `side_by_side` run at once,
    /// each on its own thread and without progress reports of its own: suitable for many small pieces of
    /// different size. The finished share is reported as `stage`.
    pub fn each<T: Send>(
        &self,
        count: usize,
        side_by_side: usize,
        stage: &'static str,
        work: impl Fn(usize, &Self) -> T + Sync,
    ) -> Vec<T> {
        let lanes = self.threads().min(side_by_side).min(count);
        let tally = self.tally(count, stage);
        let finished = |value| {
            tally.add(1);
            value
        };
        self.report(0.0, stage);
        if lanes <= 1 {
            let alone = Self { progress: None, ..self.clone() };
            return (0..count).map(|k| finished(work(k, &alone))).collect();
        }
        let lane = Self { threads: Threads::Here, progress: None, ..self.clone() };
        threads::side_by_side(count, lanes, |k| finished(work(k, &lane)))
    }

    /// Bytes that a result may use: the set budget, else three quarters of the free memory of the system.
    /// Never more than the limits of this process leave (its address space, its control group): beyond them
    /// it would be ended.
    pub fn memory_budget(&self) -> u64 {
        match self.memory_budget {
            Some(bytes) => bytes.min(memory::limit()),
            None => memory::available() / 4 * 3,
        }
    }

    /// Compares what a result needs with the budget, *before* anything is allocated.
    ///
    /// Without a set budget, 1 MiB and less always fits.
    ///
    /// # Errors
    /// If it needs more; `advice(budget)` gives the sizes that fit.
    pub fn ensure_fits(
        &self,
        what: &'static str,
        needed: u64,
        advice: impl FnOnce(u64) -> Vec<Advice>,
    ) -> Result<(), OutOfBudget> {
        if self.memory_budget.is_none() && needed <= SMALL {
            return Ok(());
        }
        let budget = self.memory_budget();
        if needed <= budget {
            return Ok(());
        }
        Err(OutOfBudget { what, needed, budget, advice: Advised(advice(budget)) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Mutex;

    type Told = Arc<Mutex<Vec<(f64, &'static str)>>>;

    fn listening() -> (Exec, Told) {
        let reports = Told::default();
        let log = Arc::clone(&reports);
        (Exec::new().with_progress(Arc::new(move |f, stage| log.lock().unwrap().push((f, stage)))), reports)
    }

    #[test]
    fn a_need_beyond_the_budget_is_refused_with_advice() {
        let exec = Exec::new().with_memory_budget(1000);
        assert!(exec.ensure_fits("a grid", 1000, |_| Vec::new()).is_ok());
        let advice = vec![Advice::CoarserGrid, Advice::MoreMemory];
        let error = exec.ensure_fits("a grid", 3 << 20, |_| advice.clone()).unwrap_err();
        assert_eq!(
            error.to_string(),
            "a grid needs 3.0 MiB of memory, more than the 1000 B allowed; use a coarser grid, or allow more memory"
        );
    }

    #[test]
    fn nested_parts_report_their_span_of_the_whole() {
        let (exec, reports) = listening();
        let part = exec.part([0.5, 0.75], "whole");
        part.part([0.0, 0.5], "part").report(0.5, "inner");
        part.report(0.5, "part");
        part.part([0.5, 1.0], "part").report(2.0, "inner");
        assert_eq!(*reports.lock().unwrap(), [(0.5625, "whole"), (0.625, "whole"), (0.75, "whole")]);
    }

    #[test]
    fn overtaken_progress_is_dropped_and_stages_stay_separate() {
        let (exec, reports) = listening();
        exec.report(0.5, "a");
        exec.report(0.25, "b");
        exec.part([0.0, 1.0], "a").report(0.4, "b");
        exec.part([0.6, 0.2], "a").report(1.0, "b");
        exec.report(f64::NAN, "a");
        exec.clone().report(0.5, "a");
        assert_eq!(*reports.lock().unwrap(), [(0.5, "a"), (0.25, "b"), (0.5, "a")]);
        exec.anew().report(0.1, "a");
        assert_eq!(reports.lock().unwrap()[3], (0.1, "a"));
    }

    #[test]
    fn progress_never_goes_back_whatever_the_threads_and_parts() {
        const STEPS: usize = 2000;
        let (exec, reports) = listening();
        let outer = exec.part([0.1, 0.9], "whole");
        std::thread::scope(|scope| {
            for thread in 0..4 {
                let part = outer.part([0.2 * f64::from(thread), 0.3 + 0.2 * f64::from(thread)], "part");
                let (exec, inner) = (&exec, part.part([0.5, 1.0], "half"));
                scope.spawn(move || {
                    for step in 0..STEPS {
                        let fraction = step as f64 / STEPS as f64;
                        part.report(0.5 * fraction, "x");
                        inner.report(fraction, "y");
                        exec.report(fraction, "descents");
                    }
                });
            }
        });
        let reports = reports.lock().unwrap();
        for stage in ["whole", "descents"] {
            let of: Vec<f64> = reports.iter().filter(|(_, name)| *name == stage).map(|(f, _)| *f).collect();
            assert!(of.len() > STEPS / 2 && of.is_sorted(), "{stage}: {}", of.len());
        }
    }

    #[test]
    fn a_time_limit_stops_only_its_exec_and_parts() {
        let exec = Exec::new();
        let late = exec.clone().with_time_limit(Duration::ZERO);
        assert!(
            late.check().is_err() && late.part([0.0, 1.0], "part").is_cancelled() && !exec.is_cancelled()
        );
        assert!(late.with_time_limit(Duration::MAX).is_cancelled(), "the earlier limit holds");
        assert!(!exec.with_time_limit(Duration::MAX).is_cancelled());
    }

    #[test]
    fn the_cancel_flag_is_shared_between_clones() {
        let exec = Exec::new();
        let clone = exec.clone();
        exec.cancel_flag().store(true, Ordering::Relaxed);
        assert_eq!(clone.check(), Err(Cancelled));
    }

    #[test]
    fn with_threads_sets_the_thread_count() {
        assert_eq!(Exec::new().with_threads(3).unwrap().threads(), 3);
    }
}
