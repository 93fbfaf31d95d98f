//! Counts the leaks of what is shown while the window goes on: a chunk is drawn at a time, and a thread of its own looks for
//! the pixels.

use super::background_job::BackgroundJob;
use super::measure_job::MeasureError;
use crate::app::App;
use geometry::view::ScreenView;
use gpu::Readback;
use inspect::engine::Engine;
use inspect::render::{Leak, LeakCount, Scene, leaks_in};

/// The leaks of what is shown, once counted.
#[derive(Default)]
pub(crate) struct LeakJob {
    /// The tessellation and the view that they are counted for.
    of: Option<(u64, ScreenView)>,
    counting: Option<Counting>,
    found: Option<Vec<Leak>>,
}

enum Counting {
    Drawing(LeakCount),
    PendingReadback(Readback),
    Grouping(BackgroundJob<Option<Vec<Leak>>>),
}

impl LeakJob {
    /// The leaks in a view, the largest first, once they are counted.
    fn found(&self, view: ScreenView) -> Option<&[Leak]> {
        let is_same = self.of.is_some_and(|(_, counted)| counted == view);
        self.found.as_deref().filter(|_| is_same)
    }

    pub(crate) fn is_busy(&self) -> bool {
        self.counting.is_some()
    }

    /// Stops counting. It isn't started again by itself.
    pub(crate) fn give_up(&mut self) {
        self.counting = None;
    }

    /// Goes on counting a scene's leaks, whose counts must be known, or starts over if its tessellation or the view has changed.
    ///
    /// # Errors
    /// The device was lost, or the thread panicked.
    pub(crate) fn go_on(
        &mut self,
        context: &egui::Context,
        engine: &Engine,
        scene: &mut Scene,
        view: ScreenView,
    ) -> Result<(), MeasureError> {
        let of = Some((scene.tessellator.generation(), view));
        if self.of != of {
            let size = view.viewport.to_array().map(|side| side as u32);
            let count = engine.start_leaks(size, view.clip_from_object)?;
            *self = Self { of, counting: Some(Counting::Drawing(count)), found: None };
            return Ok(());
        }
        self.counting = match self.counting.take() {
            None => None,
            Some(Counting::Drawing(mut count)) => Some(match count.draw_next(&engine.gpu, scene)? {
                Some(counts) => Counting::PendingReadback(counts),
                None => Counting::Drawing(count),
            }),
            Some(Counting::PendingReadback(mut counts)) => Some(match counts.poll()? {
                true => grouping(context, counts, view),
                false => Counting::PendingReadback(counts),
            }),
            Some(Counting::Grouping(job)) => match job.take() {
                None => Some(Counting::Grouping(job)),
                Some(leaks) => {
                    self.found = leaks.map_err(MeasureError::Leaking)?;
                    None
                }
            },
        };
        Ok(())
    }
}

fn grouping(context: &egui::Context, counts: Readback, view: ScreenView) -> Counting {
    let width = view.viewport.x as usize;
    // No bytes come from a lost device, which is reported elsewhere.
    Counting::Grouping(BackgroundJob::start(context, move || Some(leaks_in(&counts.bytes().ok()?, width))))
}

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
        if measure.is_closed_in(view) && measure.found().is_some() {
            return document.leaks.go_on(context, &self.engine, &mut document.scene, view);
        }
        document.leaks.give_up();
        Ok(())
    }

    /// The leaks in the view that was measured last, the largest first, once they are counted.
    pub fn leaks(&self) -> Option<&[Leak]> {
        self.document.as_ref()?.leaks.found(self.results()?.seen.view)
    }

    /// The cracked edge that comes closest to a leak on screen.
    pub(in crate::app) fn edge_of_leak(&self, leak: &Leak) -> Option<u32> {
        let (document, results) = (self.document.as_ref()?, self.results()?);
        Some(results.found.crack_seen_at(&document.shown().1, &results.seen.view, leak.px)?.edge)
    }
}
