//! How long files that change are waited for.

use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// How many looks must find changed files the same before they count as written completely. A program that writes for minutes makes
/// pauses: where files change again soon after they seemed complete, more looks are needed the next time.
#[derive(Default)]
pub(crate) struct Patience(Mutex<(Option<Instant>, u32)>);

impl Patience {
    /// The most looks, which is 5 s.
    const MOST: u32 = 25;
    /// What is soon.
    const SOON: Duration = Duration::from_secs(10);

    /// Files begin to change. Returns how many looks are needed.
    pub(super) fn begin(&self) -> u32 {
        let mut own = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let is_soon = own.0.is_some_and(|ended| ended.elapsed() < Self::SOON);
        own.1 = if is_soon { (4 * own.1).min(Self::MOST) } else { 1 };
        own.1
    }

    /// Files seem to be complete.
    pub(super) fn end(&self) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).0 = Some(Instant::now());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_that_change_again_soon_are_waited_for_longer() {
        let patience = Patience::default();
        let looks = [1, 4, 16, 25, 25].map(|expected| {
            let looks = patience.begin();
            patience.end();
            (looks, expected)
        });
        assert!(looks.iter().all(|(looks, expected)| looks == expected), "{looks:?}");
    }
}
