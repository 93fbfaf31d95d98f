//! How far a long job is, and the wish that it stop: one handle, shared between the job and whoever waits for it.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};

/// The job was told to stop and has stopped; nothing was kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("cancelled; nothing was changed")]
pub struct Cancelled;

/// A handle on one job. Clones share their state, so the waiting side keeps one and the job gets another.
#[derive(Clone, Debug, Default)]
pub struct Progress {
    shared: Arc<Shared>,
}

#[derive(Debug, Default)]
struct Shared {
    cancelled: AtomicBool,
    /// The bits of an f32: there is no atomic float.
    fraction: AtomicU32,
}

impl Progress {
    pub fn new() -> Self {
        Self::default()
    }

    /// Asks the job to stop. It does at its next [`check`](Self::check); there is no way back.
    pub fn cancel(&self) {
        self.shared.cancelled.store(true, Ordering::Relaxed);
    }

    /// For the job, between two pieces of work.
    ///
    /// # Errors
    /// [`Cancelled`] once anyone has called [`cancel`](Self::cancel).
    pub fn check(&self) -> Result<(), Cancelled> {
        match self.shared.cancelled.load(Ordering::Relaxed) {
            true => Err(Cancelled),
            false => Ok(()),
        }
    }

    /// For the job: how much is done, 0 to 1 (other values are clamped, NaN counts as 0).
    pub fn set(&self, fraction: f32) {
        let fraction = if fraction > 0.0 { fraction.min(1.0) } else { 0.0 };
        self.shared.fraction.store(fraction.to_bits(), Ordering::Relaxed);
    }

    /// How much is done, 0 to 1.
    pub fn fraction(&self) -> f32 {
        f32::from_bits(self.shared.fraction.load(Ordering::Relaxed))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clones_share_their_state() {
        let (job, waiting) = {
            let progress = Progress::new();
            (progress.clone(), progress)
        };
        job.set(0.25);
        assert_eq!(waiting.fraction(), 0.25);
        assert_eq!(job.check(), Ok(()));
        waiting.cancel();
        assert_eq!(job.check(), Err(Cancelled));
    }

    #[test]
    fn fractions_stay_in_range() {
        let progress = Progress::new();
        for (given, kept) in [(2.0, 1.0), (-1.0, 0.0), (f32::NAN, 0.0), (0.5, 0.5)] {
            progress.set(given);
            assert_eq!(progress.fraction(), kept);
        }
    }
}
