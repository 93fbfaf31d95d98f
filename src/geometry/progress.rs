//! The progress of a long job, and the request to cancel it: one handle, shared between the job and the code that waits
//! for it.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU8, AtomicU32, Ordering};

/// The error of a job that was cancelled. It has stopped, and nothing was changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("cancelled; nothing was changed")]
pub struct Cancelled;

/// Which part of a load is running.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Stage {
    /// A mesh is being read or made.
    #[default]
    Mesh,
    /// Height images are being read.
    Heights,
    /// The mesh is being brought to the device, and its shaders are compiled.
    Device,
}

/// A handle on one job. Clones share their state: the code that waits keeps one, and the job gets another.
#[derive(Clone, Debug)]
pub struct Progress {
    shared: Arc<Shared>,
    /// The interval of the whole job that this handle's 0 to 1 is mapped to.
    part: [f32; 2],
}

impl Default for Progress {
    fn default() -> Self {
        Self { shared: Arc::default(), part: [0.0, 1.0] }
    }
}

#[derive(Debug, Default)]
struct Shared {
    cancelled: AtomicBool,
    /// The bits of an f32, since there is no atomic float.
    fraction: AtomicU32,
    /// A [`Stage`].
    stage: AtomicU8,
}

impl Progress {
    /// Returns a handle on a job of its own, which nothing has cancelled.
    pub fn new() -> Self {
        Self::default()
    }

    /// Asks the job to stop, which it does at its next [`check`](Self::check). A cancelled job can't be resumed.
    pub fn cancel(&self) {
        self.shared.cancelled.store(true, Ordering::Relaxed);
    }

    /// Tells the job whether to go on. A job calls this between two pieces of work.
    ///
    /// # Errors
    /// [`Cancelled`] after any clone's [`cancel`](Self::cancel).
    pub fn check(&self) -> Result<(), Cancelled> {
        match self.shared.cancelled.load(Ordering::Relaxed) {
            true => Err(Cancelled),
            false => Ok(()),
        }
    }

    /// Reports how much of the job is done, 0 to 1. Values outside are clamped, and NaN counts as 0.
    pub fn set(&self, fraction: f32) {
        let fraction = if fraction > 0.0 { fraction.min(1.0) } else { 0.0 };
        let [start, end] = self.part;
        self.shared.fraction.store((start + (end - start) * fraction).to_bits(), Ordering::Relaxed);
    }

    /// Does both once every 4,096 steps, of which this is one: reports how much of the job is done, and tells whether to go on.
    ///
    /// # Errors
    /// As [`check`](Self::check).
    pub fn step(&self, number: u64, fraction: impl FnOnce() -> f32) -> Result<(), Cancelled> {
        if number.is_multiple_of(4096) {
            self.set(fraction());
            self.check()?;
        }
        Ok(())
    }

    /// Returns a handle on the same job whose 0 to 1 stands for `start` to `end` of this handle's. Code that does a
    /// part of the work can report 0 to 1 without knowing about the rest.
    pub fn part(&self, start: f32, end: f32) -> Self {
        let length = self.part[1] - self.part[0];
        Self { shared: self.shared.clone(), part: [start, end].map(|at| self.part[0] + length * at) }
    }

    /// Returns a handle on the same job that reports nothing, for work that doesn't count.
    pub fn quiet(&self) -> Self {
        Self { shared: self.shared.clone(), part: [self.fraction(); 2] }
    }

    /// Reports which part of a load is running from now on.
    pub fn enter(&self, stage: Stage) {
        self.shared.stage.store(stage as u8, Ordering::Relaxed);
    }

    /// Returns which part of a load is running.
    pub fn stage(&self) -> Stage {
        let stage = self.shared.stage.load(Ordering::Relaxed);
        [Stage::Heights, Stage::Device].into_iter().find(|one| *one as u8 == stage).unwrap_or_default()
    }

    /// Returns how much of the job is done, 0 to 1.
    pub fn fraction(&self) -> f32 {
        f32::from_bits(self.shared.fraction.load(Ordering::Relaxed))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_4096th_step_reports_and_may_be_the_last() {
        let progress = Progress::new();
        assert_eq!((progress.step(4096, || 0.25), progress.fraction()), (Ok(()), 0.25));
        assert_eq!((progress.step(4097, || 0.5), progress.fraction()), (Ok(()), 0.25));
        progress.cancel();
        assert_eq!([1, 8191, 8192].map(|number| progress.step(number, || 0.5)), [Ok(()), Ok(()), Err(Cancelled)]);
    }

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
        let progress = Progress::new().part(0.5, 1.0);
        progress.set(0.5);
        progress.quiet().set(1.0);
        assert_eq!(progress.fraction(), 0.75);
        let progress = Progress::new();
        for (given, kept) in [(2.0, 1.0), (-1.0, 0.0), (f32::NAN, 0.0), (0.5, 0.5)] {
            progress.set(given);
            assert_eq!(progress.fraction(), kept);
        }
    }

    #[test]
    fn a_nested_part_maps_to_its_interval_and_shares_stage_and_cancellation() {
        let whole = Progress::new();
        let part = whole.part(0.5, 1.0).part(0.0, 0.5);
        for (own, of_whole) in [(0.0, 0.5), (0.5, 0.625), (1.0, 0.75)] {
            part.set(own);
            assert_eq!(whole.fraction(), of_whole);
        }
        part.enter(Stage::Heights);
        assert_eq!(whole.stage(), Stage::Heights);
        whole.cancel();
        assert_eq!(part.check(), Err(Cancelled));
    }
}
