//! The threads of a run. The process-wide pool of `rayon` is never used: a run cannot set its size, and it
//! panics if the system refuses threads.
//!
//! ```text
//!   with_threads(n)   a separate pool of n threads, or an error
//!   default           a shared pool for all other runs: a thread per core (or RAYON_NUM_THREADS threads), half as
//!                     many while the system refuses, and at last no pool: the caller's own thread does everything
//!   each              items of work in parallel, each on a thread that works for it alone
//! ```
//!
//! A thread that has its stack but finds no memory for its further startup ends the process. Therefore the
//! program starts no threads whose stacks would fill the remaining address space: such requests are
//! rejected in advance.

use super::memory::{self, Bytes};
use crate::terminal::escaped;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::ffi::OsString;
use std::num::NonZero;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::thread::Builder;

/// The system does not start the requested threads.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ThreadsError {
    /// The system refuses them.
    #[error(
        "the system does not start {threads} threads ({reason}): ask for fewer, or for as many as it gives"
    )]
    Refused {
        /// The requested number.
        threads: usize,
        /// Error of the system.
        reason: String,
    },
    /// The environment variable is not a valid number of threads.
    #[error(
        "the environment variable {VARIABLE} is \"{}\", not a number of threads from 0 to {MOST}: set it to one, or unset it",
        escaped(value)
    )]
    Environment {
        /// Its value, shortened if it is long.
        value: String,
    },
}

/// The environment variable with the number of threads for runs without an explicit number: that of `rayon`.
const VARIABLE: &str = "RAYON_NUM_THREADS";
/// Upper limit on the number of threads, whatever the environment.
const MOST: usize = 1024;

/// Number of threads in the environment variable; 0 if it is not set.
///
/// # Errors
/// Its value is not a number from 0 to 1024.
fn wanted(value: Option<OsString>) -> Result<usize, ThreadsError> {
    /// Longest value that a message repeats, in characters.
    const LONGEST: usize = 40;
    let Some(value) = value.filter(|value| !value.is_empty()) else { return Ok(0) };
    let value = value.to_string_lossy();
    let number = value.trim().parse().ok().filter(|threads| *threads <= MOST);
    number.ok_or_else(|| ThreadsError::Environment { value: value.chars().take(LONGEST).collect() })
}

/// Value of the environment variable.
fn environment() -> Option<OsString> {
    std::env::var_os(VARIABLE)
}

/// Place of execution.
#[derive(Clone, Default)]
pub(super) enum Threads {
    /// In the pool of all runs without their own threads.
    #[default]
    Shared,
    /// In a pool of its own.
    Own(Arc<ThreadPool>),
    /// On the caller's own thread.
    Here,
}

impl Threads {
    /// The threads of all runs without their own.
    pub(super) fn shared() -> Result<Self, ThreadsError> {
        wanted(environment()).map(|_| Self::Shared)
    }

    pub(super) fn exactly(threads: usize) -> Result<Self, ThreadsError> {
        let refused = |reason: String| ThreadsError::Refused { threads, reason };
        ensure_room(threads, memory::limit()).map_err(refused)?;
        let pool = ThreadPoolBuilder::new().num_threads(threads).stack_size(STACK).build();
        Ok(Self::Own(Arc::new(pool.map_err(|error| refused(error.to_string()))?)))
    }

    fn pool(&self) -> Option<&ThreadPool> {
        match self {
            Self::Shared => shared(),
            Self::Own(pool) => Some(pool),
            Self::Here => None,
        }
    }

    pub(super) fn count(&self) -> usize {
        self.pool().map_or(1, ThreadPool::current_num_threads)
    }

    pub(super) fn install<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        let (mut work, mut result) = (Some(work), None);
        self.run(&mut || result = work.take().map(|work| work()));
        match result {
            Some(result) => result,
            None => unreachable!("run calls its work"),
        }
    }

    /// Calls `work` once. It has no type of its own, so this is compiled once for all.
    pub(super) fn run(&self, work: &mut (dyn FnMut() + Send)) {
        match self.pool() {
            Some(pool) => pool.install(work),
            None => alone(work),
        }
    }
}

/// Does both in the pool of this thread, side by side if another of its threads is free. For work without a
/// type: compiled once.
pub(super) fn join(first: &mut (dyn FnMut() + Send), second: &mut (dyn FnMut() + Send)) {
    rayon::join(first, second);
}

/// The stack of a thread, in bytes.
const STACK: usize = 2 << 20;
/// Stacks may take at most one in this many parts of the memory that the limits of this process leave.
const STACKS_PART: u64 = 2;

/// Error if the limits of this process leave no room for the stacks of this many threads.
fn ensure_room(threads: usize, left: u64) -> Result<(), String> {
    let stacks = (threads as u64).saturating_mul(STACK as u64);
    if stacks <= left / STACKS_PART {
        return Ok(());
    }
    Err(format!(
        "their stacks take {}, and the limits of this process leave {} for everything",
        Bytes(stacks),
        Bytes(left)
    ))
}

/// Passes the numbers below `count` to `work`, on `lanes` independent threads: in a pool, a thread that waits
/// in one piece could begin another, and hold both in memory. Without threads everything runs on the caller's
/// thread.
pub(super) fn side_by_side<T: Send>(count: usize, lanes: usize, work: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let done: Vec<Mutex<Option<T>>> = (0..count).map(|_| Mutex::new(None)).collect();
    let next = AtomicUsize::new(0);
    let lane = || {
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            let Some(slot) = done.get(number) else { break };
            let value = work(number);
            *slot.lock().unwrap_or_else(PoisonError::into_inner) = Some(value);
        }
    };
    std::thread::scope(|scope| {
        let started = (0..lanes).filter(|_| Builder::new().spawn_scoped(scope, lane).is_ok()).count();
        if started == 0 {
            lane();
        }
    });
    done.into_iter().filter_map(|slot| slot.into_inner().unwrap_or_else(PoisonError::into_inner)).collect()
}

/// The pool of all runs without their own, if the system provides a thread at all.
fn shared() -> Option<&'static ThreadPool> {
    static SHARED: OnceLock<Option<ThreadPool>> = OnceLock::new();
    SHARED
        .get_or_init(|| {
            let cores = std::thread::available_parallelism().map_or(1, NonZero::get);
            // The start of a run rejects an invalid setting; here is no way to report it.
            let threads = wanted(environment()).ok().filter(|threads| *threads > 0).unwrap_or(cores);
            most(threads, |threads| {
                ensure_room(threads, memory::limit()).ok()?;
                ThreadPoolBuilder::new().num_threads(threads).stack_size(STACK).build().ok()
            })
        })
        .as_ref()
}

/// Result of `start` for the largest of `most`, half of it, … 1 that it accepts.
fn most<T>(most: usize, start: impl FnMut(usize) -> Option<T>) -> Option<T> {
    std::iter::successors(Some(most.max(1)), |n| (*n > 1).then_some(n / 2)).find_map(start)
}

/// Runs `work` on this thread alone, as the only member of a pool.
fn alone<T>(work: impl FnOnce() -> T) -> T {
    // Once a thread is its own pool it stays so.
    if rayon::current_thread_index().is_none() {
        // Starts no thread; fails only if the thread already belongs to a pool.
        let _ = ThreadPoolBuilder::new().num_threads(1).use_current_thread().build();
    }
    work()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rayon::prelude::*;

    #[test]
    fn fewer_threads_are_taken_where_more_are_refused() {
        let limited = |limit: usize| most(13, move |n| (n <= limit).then_some(n));
        assert_eq!(
            [20, 13, 12, 5, 2, 1, 0].map(limited),
            [Some(13), Some(13), Some(6), Some(3), Some(1), Some(1), None]
        );
    }

    #[test]
    fn an_invalid_thread_count_in_the_environment_is_refused() {
        let wanted = |value: &str| wanted(Some(value.into()));
        assert_eq!([wanted(""), wanted("0"), wanted(" 8 "), wanted("1024")], [Ok(0), Ok(0), Ok(8), Ok(1024)]);
        for value in ["1000000000", "1025", "-1", "many", "1e3", "99999999999999999999999"] {
            let refused = wanted(value).unwrap_err().to_string();
            assert!(
                refused.contains(&format!("is \"{value}\"")) && refused.contains("unset it"),
                "{refused}"
            );
        }
        assert!(wanted("1\u{1b}[2J").unwrap_err().to_string().contains("1\\u{1b}[2J"));
        assert!(wanted(&"9".repeat(10_000)).unwrap_err().to_string().len() < 200);
        assert_eq!(super::wanted(None), Ok(0));
    }

    #[test]
    fn thread_stacks_take_at_most_half_of_the_free_memory() {
        const MIB: u64 = 1 << 20;
        assert_eq!(ensure_room(1024, u64::MAX), Ok(()));
        assert_eq!(ensure_room(1024, 4096 * MIB), Ok(()));
        let why = "their stacks take 2.0 GiB, and the limits of this process leave 4.0 GiB for everything";
        assert_eq!(ensure_room(1024, 4096 * MIB - 1), Err(why.to_owned()));
        assert!(ensure_room(usize::MAX, 1 << 60).is_err());
    }

    #[test]
    fn work_side_by_side_comes_back_in_order() {
        for lanes in [0, 1, 3, 20] {
            let squares =
                side_by_side(10, lanes, |k| Threads::Here.install(|| (0..=k).into_par_iter().sum::<usize>()));
            assert_eq!(squares, (0..10).map(|k| k * (k + 1) / 2).collect::<Vec<_>>());
        }
    }

    #[test]
    fn alone_runs_everything_on_the_calling_thread() {
        let here = std::thread::spawn(|| {
            let me = std::thread::current().id();
            for _ in 0..2 {
                let there = alone(|| {
                    (0..1000).into_par_iter().map(|_| std::thread::current().id()).collect::<Vec<_>>()
                });
                assert!(there.into_iter().all(|id| id == me));
                assert_eq!(alone(rayon::current_num_threads), 1);
            }
        });
        here.join().unwrap();
    }
}
