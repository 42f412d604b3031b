//! Counting of the finished items of a stage, from all threads.

use super::Exec;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Least number of reports of a stage that has as many items.
const REPORTS: usize = 100;
/// Most items between two reports: they may take seconds each.
const MOST_BETWEEN: usize = 256;

/// Counts finished items and reports their share of the stage: at least after every hundredth of them, and
/// after every 256.
pub struct Tally<'a> {
    exec: &'a Exec,
    stage: &'static str,
    count: usize,
    between: usize,
    done: AtomicUsize,
}

impl Exec {
    /// A tally of the `count` items of `stage`, none of which is finished.
    pub fn tally(&self, count: usize, stage: &'static str) -> Tally<'_> {
        let between = (count / REPORTS).clamp(1, MOST_BETWEEN);
        Tally { exec: self, stage, count, between, done: AtomicUsize::new(0) }
    }
}

impl Tally<'_> {
    /// `items` more are finished.
    pub fn add(&self, items: usize) {
        let before = self.done.fetch_add(items, Ordering::Relaxed);
        let done = before + items;
        if before / self.between < done / self.between || done == self.count {
            self.exec.report(done as f64 / self.count as f64, self.stage);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::{Arc, Mutex};

    /// The reported shares of `count` items, finished `at_once` at a time.
    fn shares(count: usize, at_once: usize) -> Vec<f64> {
        let heard = Arc::new(Mutex::new(Vec::new()));
        let hearing = Arc::clone(&heard);
        let exec = Exec::new().with_progress(Arc::new(move |share, stage| {
            assert_eq!(stage, "work");
            hearing.lock().unwrap().push(share);
        }));
        let tally = exec.tally(count, "work");
        let mut left = count;
        while left > 0 {
            let items = left.min(at_once);
            tally.add(items);
            left -= items;
        }
        let heard = heard.lock().unwrap();
        heard.clone()
    }

    #[test]
    fn few_items_are_reported_one_by_one_and_many_by_hundredths() {
        assert_eq!(shares(4, 1), [0.25, 0.5, 0.75, 1.0]);
        assert_eq!(shares(0, 1), [0.0; 0]);
        for count in [100, 101, 999, 12_345] {
            let shares = shares(count, 1);
            assert!((100..=200).contains(&shares.len()), "{count}: {} reports", shares.len());
            assert!(shares.is_sorted() && shares.last() == Some(&1.0), "{count}");
        }
        assert_eq!(shares(256_000, 1).len(), 1000);
    }

    #[test]
    fn items_finished_together_are_reported_together() {
        assert_eq!(shares(10, 4), [0.4, 0.8, 1.0]);
        assert_eq!(shares(12_800, 64).len(), 100);
    }

    #[test]
    fn many_threads_count_every_item_once() {
        let exec = Exec::new().with_threads(4).unwrap();
        let last = Arc::new(Mutex::new(0.0));
        let hearing = Arc::clone(&last);
        let exec = exec.with_progress(Arc::new(move |share, _| *hearing.lock().unwrap() = share));
        let tally = exec.tally(5000, "work");
        exec.map(5000, |_| tally.add(1)).unwrap();
        assert_eq!(*last.lock().unwrap(), 1.0);
    }
}
