//! How far a load is, and whether it is still wanted.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};

use thiserror::Error;

/// Shared between who loads and who waits; clones are the same handle.
#[derive(Clone, Debug, Default)]
pub struct Progress(Arc<State>);

#[derive(Debug, Default)]
struct State {
    cancelled: AtomicBool,
    fraction_bits: AtomicU32,
}

#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[error("loading was cancelled")]
pub struct Cancelled;

impl Progress {
    /// Asks the loader to stop at its next check.
    pub fn cancel(&self) {
        self.0.cancelled.store(true, Ordering::Relaxed);
    }

    /// # Errors
    /// The load is no longer wanted.
    pub fn check(&self) -> Result<(), Cancelled> {
        if self.0.cancelled.load(Ordering::Relaxed) { Err(Cancelled) } else { Ok(()) }
    }

    /// Sets how much is done, 0 to 1.
    pub fn set(&self, fraction: f32) {
        self.0.fraction_bits.store(fraction.to_bits(), Ordering::Relaxed);
    }

    /// How much is done, 0 to 1.
    pub fn fraction(&self) -> f32 {
        f32::from_bits(self.0.fraction_bits.load(Ordering::Relaxed))
    }
}
