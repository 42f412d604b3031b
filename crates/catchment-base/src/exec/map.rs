//! The parallel map of items that cost much: motions, rests, trials, pieces, slabs.
//!
//! ```text
//!   items    0 1 2 3 4 5 6 7         a slot each, for the result
//!           [0 1 2 3|4 5 6 7]        halved down to parts of a few items;
//!           [0 1|2 3]  [4 5|6 7]     a thread without work takes over a half
//! ```
//!
//! `rayon` sees neither the items nor their results, only work without a type (`threads::join`): it is compiled
//! once. An iterator of `rayon` is compiled anew for every loop, into five times the code.
//!
//! Results are in the order of the items, whatever the threads. Not guaranteed: which thread computes an item
//! and when, how many states there are, and which items are skipped after a stop or an error. For millions of
//! cells of some nanoseconds the iterators of `rayon` remain: they write in place, without a call per cell, and
//! need no slots (of numbers, twice their memory).

use super::{Cancelled, Exec, threads};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Least number of parts per thread if there are many items: threads finish together even if items differ in
/// cost, and the time that a part takes by itself (some 100 ns) is small.
const PARTS: usize = 64;

/// Computes an item with a state; `None` if there is no result, and then none of those after it in its part.
type Work<'a, S, T> = &'a (dyn Fn(&mut S, usize) -> Option<T> + Sync);
/// Computes the items of a part, from a number on, into their slots.
type Fill<'a, T> = &'a (dyn Fn(usize, &mut [Option<T>]) + Sync);

impl Exec {
    /// Results of `work(0)`, …, `work(count - 1)` in this order, each computed on some thread.
    ///
    /// # Errors
    /// [`Cancelled`] if a stop is requested before the last item has begun; checked before every item.
    pub fn map<T: Send>(&self, count: usize, work: impl Fn(usize) -> T + Sync) -> Result<Vec<T>, Cancelled> {
        self.map_with(count, || (), |(), k| work(k))
    }

    /// The same with a state (buffers, caches) that passes from item to item; it must not change a result.
    ///
    /// # Errors
    /// As for [`Exec::map`].
    pub fn map_with<S: Send, T: Send>(
        &self,
        count: usize,
        state: impl Fn() -> S + Sync,
        work: impl Fn(&mut S, usize) -> T + Sync,
    ) -> Result<Vec<T>, Cancelled> {
        let unless_stopped = |state: &mut S, k: usize| (!self.is_cancelled()).then(|| work(state, k));
        all(slots(self, count, &state, &unless_stopped)).ok_or(Cancelled)
    }

    /// The same of items that may fail. Items after one that failed are skipped, items before it are not.
    ///
    /// # Errors
    /// That of the first item that fails, in the order of the items: no number of threads changes it. If a stop
    /// is requested, [`Cancelled`] or that of some item.
    pub fn try_map<T: Send, E: Send + From<Cancelled>>(
        &self,
        count: usize,
        work: impl Fn(usize) -> Result<T, E> + Sync,
    ) -> Result<Vec<T>, E> {
        let (first, failure) = (AtomicUsize::new(usize::MAX), Mutex::new(None));
        let unless_failed = |(): &mut (), k: usize| {
            if k > first.load(Ordering::Relaxed) || self.is_cancelled() {
                return None;
            }
            let error = match work(k) {
                Ok(value) => return Some(value),
                Err(error) => error,
            };
            let mut failure = lock(&failure);
            if k <= first.fetch_min(k, Ordering::Relaxed) {
                *failure = Some(error);
            }
            None
        };
        let slots = slots(self, count, &|| (), &unless_failed);
        let failure = failure.into_inner().unwrap_or_else(PoisonError::into_inner);
        failure.map_or_else(|| all(slots).ok_or_else(|| Cancelled.into()), Err)
    }
}

/// What is in the slots, unless one is empty. A loop, since `collect` compiles into twice the code.
fn all<T>(slots: Vec<Option<T>>) -> Option<Vec<T>> {
    let mut all = Vec::with_capacity(slots.len());
    for slot in slots {
        all.push(slot?);
    }
    Some(all)
}

/// The results in slots, empty where there are none. A part takes a state that is idle, or a new one.
fn slots<S: Send, T: Send>(
    exec: &Exec,
    count: usize,
    state: &(dyn Fn() -> S + Sync),
    work: Work<'_, S, T>,
) -> Vec<Option<T>> {
    let mut slots = Vec::new();
    slots.resize_with(count, || None);
    if count == 0 {
        return slots;
    }
    let idle = Mutex::new(Vec::new());
    let fill = |first: usize, slots: &mut [Option<T>]| {
        // A statement of its own: the lock must not be held while a state is made.
        let reused = lock(&idle).pop();
        let mut own = reused.unwrap_or_else(state);
        for (k, slot) in (first..).zip(slots) {
            *slot = work(&mut own, k);
            if slot.is_none() {
                break;
            }
        }
        lock(&idle).push(own);
    };
    let most = (count / (PARTS * exec.threads())).max(1);
    exec.threads.run(&mut || halve(0, &mut slots, most, &fill));
    slots
}

/// Fills slots by parts of at most `most`.
fn halve<T: Send>(first: usize, slots: &mut [Option<T>], most: usize, fill: Fill<'_, T>) {
    if slots.len() <= most {
        return fill(first, slots);
    }
    let middle = slots.len() / 2;
    let (left, right) = slots.split_at_mut(middle);
    threads::join(&mut || halve(first, left, most, fill), &mut || halve(first + middle, right, most, fill));
}

/// Locks even after a panic: no lock is held while an item is computed, so its content is whole.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::panic::{AssertUnwindSafe, catch_unwind};

    const COUNTS: [usize; 4] = [0, 1, 2, 1000];

    fn all_threads() -> [Exec; 3] {
        [1, 2, 4].map(|threads| Exec::new().with_threads(threads).unwrap())
    }

    fn stop(exec: &Exec) {
        exec.cancel_flag().store(true, Ordering::Relaxed);
    }

    /// An error of an item, or a stop.
    #[derive(Debug, PartialEq)]
    enum Error {
        Of(usize),
        Stop,
    }

    impl From<Cancelled> for Error {
        fn from(_: Cancelled) -> Self {
            Self::Stop
        }
    }

    #[test]
    fn results_are_in_order_for_any_count_and_threads() {
        for exec in all_threads() {
            for count in COUNTS {
                let expected: Vec<String> = (0..count).map(|k| k.to_string()).collect();
                assert_eq!(exec.map(count, |k| k.to_string()).unwrap(), expected);
                assert_eq!(exec.try_map(count, |k| Ok::<_, Error>(k.to_string())).unwrap(), expected);
            }
        }
    }

    #[test]
    fn a_map_within_a_map_and_on_the_callers_thread_is_the_same() {
        let triangular = |exec: &Exec| {
            let row = |n| exec.map(n, |k| k).unwrap().into_iter().sum::<usize>();
            exec.map(30, row).unwrap()
        };
        let expected: Vec<usize> = (0..30).map(|n| n * (n.max(1) - 1) / 2).collect();
        for exec in all_threads() {
            assert_eq!(triangular(&exec), expected);
            for lane in exec.each(3, 2, "maps", |_, lane| triangular(lane)) {
                assert_eq!(lane, expected);
            }
        }
    }

    #[test]
    fn states_are_reused() {
        for exec in all_threads() {
            let made = AtomicUsize::new(0);
            let state = || {
                made.fetch_add(1, Ordering::Relaxed);
                Vec::new()
            };
            let squares = exec.map_with(1000, state, |buffer, k| {
                buffer.clear();
                buffer.resize(k, k);
                buffer.iter().sum::<usize>()
            });
            assert_eq!(squares.unwrap(), (0..1000).map(|k| k * k).collect::<Vec<_>>());
            assert!((1..=exec.threads()).contains(&made.into_inner()));
        }
    }

    #[test]
    fn after_a_stop_nothing_is_computed() {
        for exec in all_threads() {
            stop(&exec);
            for count in COUNTS {
                let failed = (count > 0).then_some(Cancelled);
                assert_eq!(exec.map(count, |_| unreachable!()).map(|_: Vec<()>| ()).err(), failed);
                let tried = exec.try_map(count, |_| -> Result<(), Error> { unreachable!() });
                assert_eq!(tried.err(), failed.map(Error::from));
            }
        }
    }

    #[test]
    fn it_is_cancelled_if_and_only_if_an_item_was_skipped() {
        for threads in [1, 2, 4] {
            for at in [0, 1, 500, 999] {
                let exec = Exec::new().with_threads(threads).unwrap();
                let done = AtomicUsize::new(0);
                let result = exec.map(1000, |k| {
                    if k == at {
                        stop(&exec);
                    }
                    done.fetch_add(1, Ordering::Relaxed)
                });
                let done = done.into_inner();
                assert_eq!(result.is_err(), done < 1000);
                // A thread alone goes in order.
                assert!(threads > 1 || done == at + 1, "{done} of {at}");
            }
        }
    }

    #[test]
    fn the_first_error_counts_whatever_the_threads() {
        for exec in all_threads() {
            let done = AtomicUsize::new(0);
            let result = exec.try_map(1000, |k| {
                done.fetch_add(1, Ordering::Relaxed);
                if k % 300 == 299 { Err(Error::Of(k)) } else { Ok(k) }
            });
            assert_eq!(result, Err(Error::Of(299)));
            let done = done.into_inner();
            assert!((300..=1000).contains(&done) && (exec.threads() > 1 || done == 300), "{done}");
        }
    }

    #[test]
    fn a_panic_reaches_the_caller() {
        for exec in all_threads() {
            let map = || exec.map_with(100, Vec::<u8>::new, |_, k| assert_ne!(k, 70, "item 70"));
            assert!(catch_unwind(AssertUnwindSafe(map)).is_err());
            assert_eq!(exec.map(2, |k| k), Ok(vec![0, 1]), "the threads work on");
        }
    }
}
