//! Protection against libraries that panic on user input.
//!
//! A panic of this program is a bug and is reported as such. A panic of a library whose results are verified
//! anyway counts as a failure of that library; a panic hook must stay silent if [`is_expected`] is true.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};

thread_local! {
    static EXPECTED: Cell<bool> = const { Cell::new(false) };
}

/// Result of `work`, which must have no side effects and stay on this thread; `None` if it panics.
pub fn attempt<T>(work: impl FnOnce() -> T) -> Option<T> {
    let before = EXPECTED.replace(true);
    // Nothing of the work is used after a panic.
    let result = catch_unwind(AssertUnwindSafe(work)).ok();
    EXPECTED.set(before);
    result
}

/// Whether a panic of this thread would be a refusal and no bug: for panic hooks.
pub fn is_expected() -> bool {
    EXPECTED.get()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_expected_only_inside_an_attempt() {
        let refused: Option<u8> = attempt(|| {
            assert!(is_expected());
            assert_eq!(attempt(|| 1), Some(1));
            assert!(is_expected());
            panic!("a library gave up")
        });
        assert_eq!(refused, None);
        assert!(!is_expected());
    }
}
