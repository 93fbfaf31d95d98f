//! An allocator that counts the memory of a whole program.
#![allow(unsafe_code, reason = "an allocator is unsafe by its nature")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

static TAKEN: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);

struct Counting;

#[global_allocator]
static COUNTING: Counting = Counting;

// SAFETY: the system's allocator does all the work; this one only counts sizes.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let taken = TAKEN.fetch_add(layout.size(), Relaxed) + layout.size();
        PEAK.fetch_max(taken, Relaxed);
        // SAFETY: the caller keeps the contract of this function, which is that of the system's.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, place: *mut u8, layout: Layout) {
        TAKEN.fetch_sub(layout.size(), Relaxed);
        // SAFETY: the caller keeps the contract of this function, which is that of the system's.
        unsafe { System.dealloc(place, layout) }
    }
}

/// The number of bytes that are taken now.
#[allow(dead_code, reason = "not every test asks for it")]
pub(crate) fn taken() -> usize {
    TAKEN.load(Relaxed)
}

/// Runs `job`. Returns its result, and the most bytes that were taken meanwhile, beyond those taken before.
#[allow(dead_code, reason = "not every test asks for it")]
pub(crate) fn peak_of<T>(job: impl FnOnce() -> T) -> (T, usize) {
    let before = taken();
    PEAK.store(before, Relaxed);
    let result = job();
    (result, PEAK.load(Relaxed) - before)
}
