//! The engine's measurements of a scene. One walk over the emitted mesh feeds all measurements that are asked for.

use super::Engine;
use crate::gpu::GpuError;
use crate::measure::{
    Accuracy, AccuracyMeasurement, AccuracyOptions, DeviationField, DeviationMeasurement, DeviationTarget, Measured,
    ScreenError, ScreenErrorMeasurement, Sizes, Survey, Visitor,
};
use crate::progress::Progress;
use crate::render::{Camera, Scene};
use crate::tessellate::{Inputs, LodView, is_beyond_near};
use crate::truth::Truth;
use crate::view::ScreenView;

/// What is to be measured; nothing by default.
#[derive(Clone, Copy, Default)]
pub struct Measurements<'a> {
    /// Cracks, folds, and what else a [`Survey`] finds.
    pub survey: bool,
    /// The largest distance on screen between what is emitted and the surface that it approximates. The inputs must be
    /// those of the counts, and they give the view.
    pub screen_error: Option<&'a Inputs>,
    /// The distance from this surface, all over.
    pub deviation: Option<&'a DeviationTarget>,
    /// The distances to a reference surface and back, also in px as seen from the view. All of the mesh must be emitted.
    pub accuracy: Option<(&'a Truth, &'a LodView, AccuracyOptions)>,
    /// How large triangles are on screen.
    pub sizes: Option<ScreenView>,
}

/// What was measured: whatever [`Measurements`] asked for.
#[derive(Default)]
pub struct MeasurementResults {
    pub survey: Option<Measured>,
    /// None also if nothing is in view.
    pub screen_error: Option<ScreenError>,
    /// The patches that LOD by error found to be flat, whose error is the distance to the nearest point of the surface;
    /// counted with the error.
    pub flat_patches: Option<u64>,
    pub deviation: Option<DeviationField>,
    /// None also if nothing is emitted that has an area.
    pub accuracy: Option<Accuracy>,
    pub sizes: Option<Sizes>,
}

impl Engine {
    /// Measures what is emitted, and reads each of its chunks back once, however much is asked for. The counts must be
    /// known.
    ///
    /// # Errors
    /// The device was lost.
    pub fn measure_all(&self, scene: &mut Scene, wanted: &Measurements) -> Result<MeasurementResults, GpuError> {
        let Measurements { survey, screen_error, deviation, accuracy, sizes } = wanted;
        if !survey && screen_error.is_none() && deviation.is_none() && accuracy.is_none() && sizes.is_none() {
            return Ok(MeasurementResults::default());
        }
        let (mesh, topology) = scene.tessellator.posed().deformed();
        let (_, triangles) = scene.tessellator.totals();
        let mut survey = None;
        if wanted.survey {
            survey = Some(Survey::new(&mesh, &topology, self.patch_factors(scene)?, self.asked_factors(scene)?));
        }
        let of_inputs = |inputs| ScreenErrorMeasurement::new(&mesh, &topology, inputs, triangles);
        let mut screen_error = wanted.screen_error.map(of_inputs);
        // No other code has this handle, so it is never cancelled.
        let progress = Progress::new();
        let from = |target| DeviationMeasurement::new(target, &mesh, &topology, triangles, &progress);
        let mut deviation = wanted.deviation.map(from);
        let of_truth = |(truth, view, options)| AccuracyMeasurement::new(truth, Some(view), options);
        let mut accuracy = wanted.accuracy.map(of_truth);
        let mut sizes = wanted.sizes.map(Sizes::new);
        let mut visitors: Vec<&mut dyn Visitor> = Vec::new();
        visitors.extend(survey.as_mut().map(|visitor| visitor as &mut dyn Visitor));
        visitors.extend(screen_error.as_mut().map(|visitor| visitor as &mut dyn Visitor));
        visitors.extend(deviation.as_mut().map(|visitor| visitor as &mut dyn Visitor));
        visitors.extend(accuracy.as_mut().map(|visitor| visitor as &mut dyn Visitor));
        visitors.extend(sizes.as_mut().map(|visitor| visitor as &mut dyn Visitor));
        self.visit(scene, &mut visitors)?;
        Ok(MeasurementResults {
            survey: survey.map(Survey::finish),
            flat_patches: screen_error.as_ref().map(ScreenErrorMeasurement::flat_patches),
            screen_error: screen_error.and_then(|measurement| measurement.worst()),
            deviation: deviation.and_then(|measurement| measurement.finish().ok()),
            accuracy: accuracy.and_then(AccuracyMeasurement::finish),
            sizes,
        })
    }

    /// The survey alone: cracks, folds, and what else it finds. The counts must be known.
    ///
    /// # Errors
    /// The device was lost.
    pub fn measure(&self, scene: &mut Scene) -> Result<Measured, GpuError> {
        let (mesh, topology) = scene.tessellator.posed().deformed();
        let mut survey = Survey::new(&mesh, &topology, self.patch_factors(scene)?, self.asked_factors(scene)?);
        self.visit(scene, &mut [&mut survey])?;
        Ok(survey.finish())
    }

    /// Counts the pixels through which one can see into a closed mesh from `camera`: see [`crate::render::LeakCounter`].
    /// Returns none where such a count means nothing: the mesh is open or reaches the near plane, or patches that face away
    /// are left out. The counts must be known.
    ///
    /// # Errors
    /// The device was lost.
    pub fn leaks(
        &self,
        scene: &mut Scene,
        measured: &Measured,
        size: [u32; 2],
        camera: &Camera,
    ) -> Result<Option<u64>, GpuError> {
        let viewport = glam::vec2(size[0] as f32, size[1] as f32);
        let clip_from_object = camera.clip_from_object(viewport, &scene.bounds);
        // Patches that clipping left out aren't in the measured extent, so their corners are tested as well.
        let corners = scene.tessellator.posed().deformed().0.bounds();
        let whole = [measured.extent[0].min(corners.min), measured.extent[1].max(corners.max)];
        let closed = scene.tessellator.topology().is_closed_and_oriented() && measured.culled.facing_away == 0;
        if !closed || !is_beyond_near(clip_from_object, whole) {
            return Ok(None);
        }
        self.leaks.count(&self.gpu, scene, size, clip_from_object).map(Some)
    }
}
