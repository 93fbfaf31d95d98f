//! An allocator that counts what a whole binary has taken from it.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

static TAKEN: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);

struct Counting;

#[global_allocator]
static COUNTING: Counting = Counting;

// SAFETY: all is the system's own allocator; beside it, sizes are counted.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let taken = TAKEN.fetch_add(layout.size(), Relaxed) + layout.size();
        PEAK.fetch_max(taken, Relaxed);
        // SAFETY: as the caller promises.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, place: *mut u8, layout: Layout) {
        TAKEN.fetch_sub(layout.size(), Relaxed);
        // SAFETY: as the caller promises.
        unsafe { System.dealloc(place, layout) }
    }
}

/// Bytes that are taken now.
#[allow(dead_code, reason = "not every test asks for it")]
pub fn taken() -> usize {
    TAKEN.load(Relaxed)
}

/// Bytes that `job` had taken at most, beyond those that were taken before it.
#[allow(dead_code, reason = "not every test asks for it")]
pub fn peak_of<T>(job: impl FnOnce() -> T) -> (T, usize) {
    let before = taken();
    PEAK.store(before, Relaxed);
    let result = job();
    (result, PEAK.load(Relaxed) - before)
}
