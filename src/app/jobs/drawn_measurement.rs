//! Measurements for which what is shown is drawn while the window goes on: a chunk at a time, and a thread of its own evaluates what was
//! drawn.

use super::background_job::{BackgroundJob, Stopped};
use super::measure_job::MeasureError;
use geometry::view::ScreenView;
use gpu::Readback;

/// A measurement, and its last result. `D` is what draws for it.
pub(crate) struct DrawnMeasurement<D, T> {
    /// The tessellation and the view that it is about.
    of: Option<(u64, ScreenView)>,
    drawing: D,
    under_way: Option<Stage<T>>,
    found: Option<T>,
}

enum Stage<T> {
    Drawing,
    PendingReadback(Readback),
    Evaluating(BackgroundJob<Option<T>>),
}

impl<D: Default, T> Default for DrawnMeasurement<D, T> {
    fn default() -> Self {
        Self { of: None, drawing: D::default(), under_way: None, found: None }
    }
}

impl<D, T: Send + 'static> DrawnMeasurement<D, T> {
    pub(crate) fn is_busy(&self) -> bool {
        self.under_way.is_some()
    }

    /// Stops measuring. It isn't started again by itself.
    pub(crate) fn give_up(&mut self) {
        self.under_way = None;
    }

    /// The result with what it is about, once it is known.
    pub(super) fn found(&self) -> Option<((u64, ScreenView), &T)> {
        self.of.zip(self.found.as_ref())
    }

    /// Goes on measuring a tessellation, whose counts must be known, in a view. Starts over if it was another one, or in another view.
    /// `step` returns what was drawn after its last step.
    ///
    /// # Errors
    /// Those of `start` and `step`, or the device was lost; `stopped`, if the thread panicked.
    pub(super) fn go_on(
        &mut self,
        context: &egui::Context,
        of: (u64, ScreenView),
        start: impl FnOnce(&mut D) -> Result<(), MeasureError>,
        step: impl FnOnce(&mut D) -> Result<Option<Readback>, MeasureError>,
        evaluate: impl FnOnce(Vec<u8>) -> T + Send + 'static,
        stopped: fn(Stopped) -> MeasureError,
    ) -> Result<(), MeasureError> {
        if self.of != Some(of) {
            (self.of, self.under_way, self.found) = (Some(of), None, None);
            start(&mut self.drawing)?;
            self.under_way = Some(Stage::Drawing);
            return Ok(());
        }
        self.under_way = match self.under_way.take() {
            None => None,
            Some(Stage::Drawing) => Some(step(&mut self.drawing)?.map_or(Stage::Drawing, Stage::PendingReadback)),
            Some(Stage::PendingReadback(mut drawn)) => Some(match drawn.poll()? {
                // No bytes come from a lost device, which is reported elsewhere.
                true => Stage::Evaluating(BackgroundJob::start(context, move || Some(evaluate(drawn.bytes().ok()?)))),
                false => Stage::PendingReadback(drawn),
            }),
            Some(Stage::Evaluating(job)) => match job.take() {
                None => Some(Stage::Evaluating(job)),
                Some(found) => {
                    self.found = found.map_err(stopped)?;
                    None
                }
            },
        };
        Ok(())
    }
}
