//! The system's allocator, and what happens when it has nothing left: a message and the exit code of a failure, where the
//! standard library would abort. Large results are compared with the memory budget long before; this is for what is left over,
//! under limits such as `ulimit -v`.
//!
//! Tests build it with fault points ([`faults`]): the system then seems to refuse the n-th request, and on wish all after it.

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

// SAFETY: every call is that of the system's allocator with the same arguments; where it refuses, the process ends.
unsafe impl GlobalAlloc for OrLeave {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as promised by the caller.
        given(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: as promised by the caller.
        unsafe { System.dealloc(memory, layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as promised by the caller.
        given(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: as promised by the caller.
        given(unsafe { System.realloc(memory, layout, size) }, size)
    }
}

fn given(memory: *mut u8, size: usize) -> *mut u8 {
    if memory.is_null() || faults::refuses() {
        leave(size);
    }
    memory
}

/// Requests that seem to be refused, in builds with debug assertions; no others have any of it.
#[cfg(debug_assertions)]
pub(crate) mod faults {
    use std::sync::atomic::{AtomicU64, Ordering};

    /// Which request from now on is refused, and whether all after it are; `N` or `N..`.
    pub(crate) const NAME: &str = "CATCHMENT_REFUSED_REQUEST";

    const NONE: u64 = u64::MAX;
    static FIRST: AtomicU64 = AtomicU64::new(NONE);
    static LAST: AtomicU64 = AtomicU64::new(NONE);
    static ASKED: AtomicU64 = AtomicU64::new(0);

    /// Reads what is wished from the environment.
    pub(crate) fn prepare() {
        let Ok(message) = std::env::var(NAME) else { return };
        let number = message.trim_end_matches("..");
        let Ok(first) = number.parse() else { return };
        LAST.store(if number.len() < message.len() { NONE } else { first }, Ordering::Relaxed);
        ASKED.store(0, Ordering::Relaxed);
        FIRST.store(first, Ordering::Relaxed);
    }

    /// Counts a request.
    pub(super) fn refuses() -> bool {
        let first = FIRST.load(Ordering::Relaxed);
        if first == NONE {
            return false;
        }
        let number = ASKED.fetch_add(1, Ordering::Relaxed);
        (first..=LAST.load(Ordering::Relaxed)).contains(&number)
    }
}

/// No request is refused but by the system.
#[cfg(not(debug_assertions))]
pub(crate) mod faults {
    pub(crate) const fn prepare() {}

    pub(super) const fn refuses() -> bool {
        false
    }
}

/// How long other threads wait for the one that ends the process.
const PATIENCE: Duration = Duration::from_secs(5);

thread_local! {
    static LEAVES: Cell<bool> = const { Cell::new(false) };
}

/// Says that memory ran out, removes what is unfinished where it can, and ends the process, allocating next to nothing.
#[cold]
fn leave(size: usize) -> ! {
    static LEAVING: AtomicBool = AtomicBool::new(false);
    if LEAVES.replace(true) {
        // There was not even enough to tidy up; the next start does.
        end();
    }
    if LEAVING.swap(true, Ordering::Relaxed) {
        // Another thread ends the process, unless it waits for this one.
        std::thread::sleep(PATIENCE);
        end();
    }
    // Standard error has no buffer, and numbers are written piece by piece.
    let _ = writeln!(
        io::stderr(),
        "catchment: out of memory: the system refused {size} bytes; use a coarser grid (--resolution), fewer threads (--threads), \
         or raise its limit"
    );
    abandon_at_once();
    end();
}

/// Ends the process here and now: what [`std::process::exit`] would still do may ask for memory, and it must not be called by itself.
fn end() -> ! {
    unsafe extern "C" {
        fn _exit(code: std::ffi::c_int) -> !;
    }
    // SAFETY: it takes any number, and nothing runs after it.
    unsafe { _exit(i32::from(ExitStatus::NotComputed.code())) }
}
