//! The system's allocator, and what happens when it has nothing left: a message and the exit code of a failure, where the
//! standard library would abort. Large results are compared with the memory budget long before; this is for what is left over,
//! under limits such as `ulimit -v`.

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
    if memory.is_null() {
        leave(size);
    }
    memory
}

/// How long other threads wait for the one that ends the process.
const PATIENCE: Duration = Duration::from_secs(5);

thread_local! {
    static LEAVES: Cell<bool> = const { Cell::new(false) };
}

/// Says that memory ran out, removes what is unfinished where it can, and ends the process, allocating next to nothing.
#[cold]
#[expect(clippy::exit, reason = "an allocator can neither return an error nor unwind")]
fn leave(size: usize) -> ! {
    static LEAVING: AtomicBool = AtomicBool::new(false);
    let code = i32::from(ExitStatus::Failed.code());
    if LEAVES.replace(true) {
        // There was not even enough to tidy up; the next start does.
        std::process::exit(code);
    }
    if LEAVING.swap(true, Ordering::Relaxed) {
        // Another thread ends the process, unless it waits for this one.
        std::thread::sleep(PATIENCE);
        std::process::exit(code);
    }
    // Standard error has no buffer, and numbers are written piece by piece.
    let _ = writeln!(
        io::stderr(),
        "catchment: out of memory: the system refused {size} bytes; use a coarser grid (--resolution), fewer threads (--threads), \
         or raise its limit"
    );
    abandon_at_once();
    std::process::exit(code);
}
