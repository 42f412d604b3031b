//! The allocator of every fuzz target, with a limit. libFuzzer's own (`-malloc_limit_mb`) works with a sanitizer only.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Bytes that a reader may hold for an input of at most a megabyte; the harness itself uses little.
const MOST: usize = 256 << 20;

#[global_allocator]
static ALLOCATOR: Limited = Limited(AtomicUsize::new(0));

/// The system's allocator, with a counter of the allocated bytes.
struct Limited(AtomicUsize);

impl Limited {
    fn take(&self, bytes: usize) {
        if self.0.fetch_add(bytes, Ordering::Relaxed) + bytes > MOST {
            // Headroom for the panic message.
            self.0.store(0, Ordering::Relaxed);
            panic!("more than {MOST} bytes are held: the last request was for {bytes}");
        }
    }

    fn give_back(&self, bytes: usize) {
        // Saturates at zero after the panic above.
        let _ = self
            .0
            .fetch_update(Ordering::Relaxed, Ordering::Relaxed, |held| Some(held.saturating_sub(bytes)));
    }
}

// SAFETY: forwards every call to the system's allocator with the same arguments.
unsafe impl GlobalAlloc for Limited {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        self.take(layout.size());
        // SAFETY: the caller's contract.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        self.give_back(layout.size());
        // SAFETY: the caller's contract.
        unsafe { System.dealloc(memory, layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        self.take(layout.size());
        // SAFETY: the caller's contract.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        self.take(size);
        self.give_back(layout.size());
        // SAFETY: the caller's contract.
        unsafe { System.realloc(memory, layout, size) }
    }
}
