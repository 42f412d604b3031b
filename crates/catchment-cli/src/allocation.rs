//! The system allocator with an out-of-memory handler: a message and a failure exit code, where the standard
//! library would abort. Large results are checked against the memory budget long before; this handler covers
//! the remaining allocations, under limits such as `ulimit -v`.
//!
//! Tests build it with fault points ([`faults`]), which simulate the failure of the n-th request and
//! optionally of every later request.

#![expect(unsafe_code, reason = "an allocator has no safe form; all calls go to the system's unchanged")]

use catchment::report::write::abandon_at_once;
use catchment_cli::ExitStatus;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::io::{self, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

#[global_allocator]
static ALLOCATOR: OrLeave = OrLeave;

struct OrLeave;

// SAFETY: every call forwards the same arguments to the system allocator; a failed request ends the process.
unsafe impl GlobalAlloc for OrLeave {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: guaranteed by the caller.
        given(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: guaranteed by the caller.
        unsafe { System.dealloc(memory, layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: guaranteed by the caller.
        given(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: guaranteed by the caller.
        given(unsafe { System.realloc(memory, layout, size) }, size)
    }
}

fn given(memory: *mut u8, size: usize) -> *mut u8 {
    if memory.is_null() || faults::refuses() {
        leave(size);
    }
    memory
}

/// Simulated allocation failures; compiled only with debug assertions.
#[cfg(debug_assertions)]
pub(crate) mod faults {
    use std::sync::atomic::{AtomicU64, Ordering};

    /// Environment variable with the number of the failing request: `N` for this request alone, `N..` for
    /// this and all later requests.
    pub(crate) const NAME: &str = "CATCHMENT_REFUSED_REQUEST";

    const NONE: u64 = u64::MAX;
    static FIRST: AtomicU64 = AtomicU64::new(NONE);
    static LAST: AtomicU64 = AtomicU64::new(NONE);
    static ASKED: AtomicU64 = AtomicU64::new(0);

    /// Reads the fault points from the environment.
    pub(crate) fn prepare() {
        let Ok(message) = std::env::var(NAME) else { return };
        let number = message.trim_end_matches("..");
        let Ok(first) = number.parse() else { return };
        LAST.store(if number.len() < message.len() { NONE } else { first }, Ordering::Relaxed);
        ASKED.store(0, Ordering::Relaxed);
        FIRST.store(first, Ordering::Relaxed);
    }

    /// Counts a request and returns whether it fails.
    pub(super) fn refuses() -> bool {
        let first = FIRST.load(Ordering::Relaxed);
        if first == NONE {
            return false;
        }
        let number = ASKED.fetch_add(1, Ordering::Relaxed);
        (first..=LAST.load(Ordering::Relaxed)).contains(&number)
    }
}

/// No simulated failures: only the system refuses requests.
#[cfg(not(debug_assertions))]
pub(crate) mod faults {
    pub(crate) const fn prepare() {}

    pub(super) const fn refuses() -> bool {
        false
    }
}

/// Time that other threads wait for the thread that ends the process.
const PATIENCE: Duration = Duration::from_secs(5);

thread_local! {
    static LEAVES: Cell<bool> = const { Cell::new(false) };
}

/// Reports that memory ran out, removes unfinished files if possible, and ends the process with almost no
/// allocation.
#[cold]
fn leave(size: usize) -> ! {
    static LEAVING: AtomicBool = AtomicBool::new(false);
    if LEAVES.replace(true) {
        // Memory is too short for the cleanup; the next start does it.
        end();
    }
    if LEAVING.swap(true, Ordering::Relaxed) {
        // Another thread ends the process, unless it waits for this thread.
        std::thread::sleep(PATIENCE);
        end();
    }
    // stderr has no buffer, and numbers are written piece by piece.
    let _ = writeln!(
        io::stderr(),
        "catchment: out of memory: the system refused {size} bytes; use a coarser grid (--resolution), fewer threads (--threads), \
         or raise its limit"
    );
    abandon_at_once();
    end();
}

/// Ends the process immediately: the cleanup in [`std::process::exit`] may allocate, and that function must
/// not be re-entered.
fn end() -> ! {
    unsafe extern "C" {
        fn _exit(code: std::ffi::c_int) -> !;
    }
    // SAFETY: `_exit` accepts any number and never returns.
    unsafe { _exit(i32::from(ExitStatus::NotComputed.code())) }
}
