//! Counts the leaks of what is shown.

use super::drawn_measurement::DrawnMeasurement;
use super::measure_job::MeasureError;
use crate::app::App;
use geometry::view::ScreenView;
use inspect::render::{Leak, LeakCount, leaks_in};

/// The leaks of what is shown, the largest first, once counted.
pub(crate) type LeakJob = DrawnMeasurement<Option<LeakCount>, Vec<Leak>>;

impl App {
    /// Whether leaks can be counted in the view that was measured last: the mesh is closed and beyond the near plane, and nothing was
    /// left out.
    pub(in crate::app) fn may_leak(&self) -> bool {
        let measure = self.document.as_ref().map(|document| &document.right().measure);
        measure.zip(self.results()).is_some_and(|(measure, results)| measure.is_closed_in(results.seen.view))
    }

    /// Goes on counting leaks once everything else of what is shown was measured.
    pub(in crate::app) fn count_leaks(
        &mut self,
        context: &egui::Context,
        view: ScreenView,
    ) -> Result<(), MeasureError> {
        let Some(document) = &mut self.document else { return Ok(()) };
        let measure = &document.right().measure;
        if measure.is_busy() {
            return Ok(());
        }
        if !measure.is_closed_in(view) || measure.found().is_none() {
            document.leaks.give_up();
            return Ok(());
        }
        let (engine, scene, [width, height]) = (&self.engine, &mut document.scene, view.viewport.to_array());
        let start = |count: &mut Option<LeakCount>| {
            let size = [width as u32, height as u32];
            *count = Some(engine.leak_counter.start(&engine.gpu, size, view.clip_from_object)?);
            Ok(())
        };
        let of = (scene.tessellator.generation(), view);
        let step = |count: &mut Option<LeakCount>| match count {
            Some(count) => Ok(count.draw_next(&engine.gpu, scene)?),
            None => Ok(None),
        };
        let find = move |counts: Vec<u8>| leaks_in(&counts, width as usize);
        document.leaks.go_on(context, of, start, step, find, MeasureError::Leaking)
    }

    /// The leaks in the view that was measured last, the largest first, once they are counted.
    pub fn leaks(&self) -> Option<&[Leak]> {
        let ((_, view), leaks) = self.document.as_ref()?.leaks.found()?;
        (view == self.results()?.seen.view).then_some(&leaks[..])
    }
}
