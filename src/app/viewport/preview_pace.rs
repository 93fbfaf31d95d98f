//! How fast previews follow one another. Two may be under way: the window begins its next frame before the device has finished the one
//! before, and with one at a time only every second frame would have a new preview.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Previews that follow one another more slowly than this are late: 30 pictures a second leave 33 ms for each.
const LATE: Duration = Duration::from_millis(33);
/// After a preview that took longer than this the next one waits until it is finished, since the window would wait for both.
const LONG: Duration = Duration::from_millis(66);
/// So many previews are judged together, but for the slowest of them. That one may be late for another reason.
const JUDGED: usize = 6;

/// The previews that the device is drawing, and how long the last ones took.
#[derive(Default)]
pub(super) struct PreviewPace {
    /// Set once the device has finished a preview.
    in_flight: Vec<Arc<AtomicBool>>,
    /// When the last preview was submitted, until another one could be.
    waiting: Option<Instant>,
    /// How long it took from one preview until the next one could be submitted.
    waits: Vec<Duration>,
    /// Whether the last one was short.
    is_short: bool,
}

impl PreviewPace {
    pub(super) fn is_idle(&self) -> bool {
        self.in_flight.is_empty()
    }

    /// Whether another preview may be submitted.
    pub(super) fn is_free(&self) -> bool {
        self.in_flight.len() <= usize::from(self.is_short)
    }

    /// Notes that a preview is submitted. `done` is set once the device has finished it.
    pub(super) fn submit(&mut self, done: Arc<AtomicBool>, now: Instant) {
        self.in_flight.push(done);
        self.waiting = Some(now);
    }

    /// Notes which previews are finished: once a frame of the window.
    pub(super) fn land(&mut self, now: Instant) {
        self.in_flight.retain(|done| !done.load(Ordering::Acquire));
        if self.is_free()
            && let Some(submitted) = self.waiting.take()
        {
            self.note(now - submitted);
        }
    }

    fn note(&mut self, wait: Duration) {
        self.is_short = wait <= LONG;
        self.waits.push(wait);
    }

    /// Returns whether the last previews were late, once there are enough of them to tell. They aren't judged again.
    pub(super) fn take_is_slow(&mut self) -> bool {
        if self.waits.len() < JUDGED {
            return false;
        }
        let slowest = self.waits.iter().max().copied().unwrap_or_default();
        let others = self.waits.drain(..).sum::<Duration>() - slowest;
        others > LATE * (JUDGED as u32 - 1)
    }

    /// Forgets how fast the previews of a mesh were.
    pub(super) fn forget(&mut self) {
        (self.waiting, self.is_short) = (None, false);
        self.waits.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether previews with these waits are slow, in ms.
    fn is_slow(waits: [u64; JUDGED]) -> bool {
        let mut pace = PreviewPace::default();
        let verdicts = waits.map(|wait| {
            pace.note(Duration::from_millis(wait));
            pace.take_is_slow()
        });
        assert!(verdicts[..JUDGED - 1].iter().all(|slow| !slow), "too few to tell: {verdicts:?}");
        verdicts[JUDGED - 1]
    }

    #[test]
    fn previews_are_slow_by_their_mean_but_for_one() {
        assert!(!is_slow([900, 16, 33, 33, 33, 33]), "one is late while the driver compiles");
        assert!(!is_slow([20, 46, 20, 46, 20, 46]), "every second frame of the window is late");
        assert!(is_slow([23, 46, 46, 23, 46, 46]));
        assert!(is_slow([34; JUDGED]));
    }

    #[test]
    fn two_previews_are_under_way_if_they_are_short() {
        let mut pace = PreviewPace::default();
        let now = Instant::now();
        let [first, second, third] = [(); 3].map(|()| Arc::new(AtomicBool::new(false)));
        pace.submit(first.clone(), now);
        pace.land(now);
        assert!(!pace.is_free(), "it isn't known yet how long one takes");
        first.store(true, Ordering::Release);
        pace.land(now);
        assert!(pace.is_free() && pace.is_idle());
        pace.submit(second.clone(), now);
        pace.land(now);
        assert!(pace.is_free() && !pace.is_idle());
        pace.submit(third, now);
        pace.land(now);
        assert!(!pace.is_free(), "two are enough");
        second.store(true, Ordering::Release);
        pace.land(now);
        assert!(pace.is_free() && !pace.is_idle());
        pace.forget();
        assert!(!pace.is_free(), "nothing is known of the next mesh");
    }

    #[test]
    fn a_long_preview_is_alone() {
        let mut pace = PreviewPace::default();
        pace.note(LONG + Duration::from_millis(1));
        pace.submit(Arc::new(AtomicBool::new(false)), Instant::now());
        assert!(!pace.is_free());
        pace.note(LONG);
        assert!(pace.is_free());
    }
}
