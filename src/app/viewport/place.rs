//! Turns the camera to a place that was measured, and to where nothing hides it.

use glam::Vec2;

use crate::app::App;
use crate::app::jobs::measure_job::MeasureError;
use crate::app::jobs::walk::{Parts, Walk};
use geometry::tessellate::factors::patch_is_culled;
use inspect::gates::{Spot, Standpoints};
use inspect::measure::Sight;
use inspect::render::{Camera, half_places};
use inspect::settings::{Settings, SplitSide};

/// A place that is about to be shown: what hides it is being found out.
pub(crate) struct Showing {
    half: SplitSide,
    standpoints: Standpoints,
    /// A patch that doesn't hide the place, because it is what is to be seen.
    patch: Option<u32>,
    /// The walk over the tessellation with this number.
    walk: Option<(u64, Walk<Sight>)>,
}

impl App {
    /// Shows a place of a half, and freezes LOD as it was measured. `patch` is one that doesn't hide the place.
    pub(in crate::app) fn show_place(&mut self, half: SplitSide, spot: &Spot, patch: Option<u32>) {
        let Some(document) = &self.document else { return };
        let (camera, size) = (&self.viewport.camera, self.viewport.picture.size());
        let standpoints = Standpoints::new(spot, camera, size, &document.scene.bounds);
        let factors = |patch| self.results().map(|results| results.found.outlines.factors(patch));
        // A patch that emitted nothing would still emit nothing.
        if !patch.and_then(factors).is_some_and(patch_is_culled) {
            self.keep_measured();
        }
        if let Some(document) = &mut self.document {
            document.showing = Some(Showing { half, standpoints, patch, walk: None });
        }
    }

    /// Goes on with finding out what hides the place that is about to be shown. `is_drawn` says whether the picture is complete.
    ///
    /// # Errors
    /// The device was lost, or the thread that follows the lines of sight panicked.
    pub(in crate::app) fn go_on_showing(&mut self, is_drawn: bool) -> Result<(), MeasureError> {
        let Some(document) = &mut self.document else { return Ok(()) };
        let Some(showing) = &mut document.showing else { return Ok(()) };
        let scene = document.scene.half_mut(showing.half);
        // What is never drawn hides nothing.
        let waits = self.viewport.picture.cancelled.is_none() && !self.viewport.playback.is_playing();
        let (true, Some(scene)) = (waits, scene) else {
            self.look(&[]);
            return Ok(());
        };
        if !is_drawn || !scene.tessellator.is_counted() {
            return Ok(());
        }
        let emitted = scene.tessellator.generation();
        let Some((_, walk)) = showing.walk.as_mut().filter(|(of, _)| *of == emitted) else {
            let (settings, half, size) = (&self.settings, showing.half, self.viewport.picture.size());
            let Some((at, eyes, near)) = showing.standpoints.lines(|camera| beside(camera, settings, half, size))
            else {
                self.look(&[]);
                return Ok(());
            };
            let mut sight = Sight::new(at, eyes, near).through(showing.patch);
            let visit = move |parts: &Parts| parts.visit(&mut [&mut sight]).map(|()| sight);
            showing.walk = Some((emitted, Walk::start(&self.engine.gpu, scene, None, visit)?));
            return Ok(());
        };
        match walk.go_on(&self.engine.gpu, scene)? {
            None => {}
            Some(Ok(sight)) => self.look(sight.as_ref().map(Sight::clear).unwrap_or_default()),
            Some(Err(stopped)) => {
                self.look(&[]);
                return Err(MeasureError::Looking(stopped));
            }
        }
        Ok(())
    }

    /// Turns the camera to the place. `clear` has the part of each line of sight that is clear, if that is known.
    fn look(&mut self, clear: &[f64]) {
        let showing = self.document.as_mut().and_then(|document| document.showing.take());
        let Some(Showing { half, standpoints, .. }) = showing else { return };
        let size = self.viewport.picture.size();
        self.viewport.camera = beside(standpoints.clearest(clear), &self.settings, half, size);
    }
}

/// The camera with what is in the middle of its view in the middle of a half of the split.
fn beside(mut camera: Camera, settings: &Settings, half: SplitSide, size: Vec2) -> Camera {
    if settings.split.is_none() {
        return camera;
    }
    let place = half_places(size.to_array().map(|side| side as u32), settings)[half as usize];
    camera.pan(place.middle(), size);
    camera
}
