//! The engine's measurements of a scene. One walk over the emitted mesh feeds all measurements that are requested.

use glam::Vec3;

use super::Engine;
use crate::measure::{
    Accuracy, AccuracyMeasurement, AccuracyOptions, DeviationField, DeviationMeasurement, DeviationTarget, Measured,
    PatchesAbove, ScreenErrorMeasurement, Sizes, Survey, Visitor, WorstPoint,
};
use crate::reference_shape::ReferenceShape;
use crate::render::{Camera, Leak, Leaks, Scene};
use geometry::mesh::{Mesh, Topology};
use geometry::progress::Progress;
use geometry::tessellate::{Inputs, LodView, Tessellation, is_beyond_near};
use geometry::view::ScreenView;
use gpu::{GpuError, Timing};

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
    pub accuracy: Option<(&'a ReferenceShape, &'a LodView, AccuracyOptions)>,
    /// How large triangles are on screen.
    pub sizes: Option<ScreenView>,
}

/// What was measured: whatever [`Measurements`] requested.
#[derive(Default)]
pub struct MeasurementResults {
    pub survey: Option<Measured>,
    /// None also if nothing is in view.
    pub screen_error: Option<WorstPoint>,
    /// The patches that LOD by error found to be flat, whose error is the distance to the nearest point of the surface;
    /// counted with the error.
    pub flat_patches: Option<u64>,
    pub deviation: Option<DeviationField>,
    /// None also if nothing is emitted that has an area.
    pub accuracy: Option<Accuracy>,
    pub sizes: Option<Sizes>,
}

impl Engine {
    /// Measures what is emitted, and reads each of its chunks back once, however much is requested. The counts must be
    /// known.
    ///
    /// # Errors
    /// The device was lost.
    pub fn measure_all(&self, scene: &mut Scene, wanted: &Measurements) -> Result<MeasurementResults, GpuError> {
        // No other code has this handle, so it is never cancelled.
        self.measure_watched(scene, wanted, &Progress::new())
    }

    /// Like [`Self::measure_all`], and reports how much of the output was read. If `progress` is cancelled, the walk ends early
    /// and the results are not whole.
    ///
    /// # Errors
    /// The same.
    pub fn measure_watched(
        &self,
        scene: &mut Scene,
        wanted: &Measurements,
        progress: &Progress,
    ) -> Result<MeasurementResults, GpuError> {
        let Measurements { survey, screen_error, deviation, accuracy, sizes } = wanted;
        if !survey && screen_error.is_none() && deviation.is_none() && accuracy.is_none() && sizes.is_none() {
            return Ok(MeasurementResults::default());
        }
        let (mesh, topology) = scene.tessellator.posed().deformed();
        let (_, triangles) = scene.tessellator.totals();
        let mut survey = None;
        if wanted.survey {
            survey = Some(Survey::new(&mesh, &topology, self.patch_factors(scene)?, self.requested_factors(scene)?));
        }
        let of_inputs = |inputs| ScreenErrorMeasurement::new(&mesh, &topology, inputs, triangles);
        let mut screen_error = wanted.screen_error.map(of_inputs);
        let from = |target| DeviationMeasurement::new(target, &mesh, &topology, triangles, progress);
        let mut deviation = wanted.deviation.map(from);
        let of_reference_shape =
            |(reference_shape, view, options)| AccuracyMeasurement::new(reference_shape, Some(view), options, progress);
        let mut accuracy = wanted.accuracy.map(of_reference_shape);
        let mut sizes = wanted.sizes.map(Sizes::new);
        let mut visitors: Vec<&mut dyn Visitor> = Vec::new();
        visitors.extend(survey.as_mut().map(|visitor| visitor as &mut dyn Visitor));
        visitors.extend(screen_error.as_mut().map(|visitor| visitor as &mut dyn Visitor));
        visitors.extend(deviation.as_mut().map(|visitor| visitor as &mut dyn Visitor));
        visitors.extend(accuracy.as_mut().map(|visitor| visitor as &mut dyn Visitor));
        visitors.extend(sizes.as_mut().map(|visitor| visitor as &mut dyn Visitor));
        self.visit_watched(scene, &mut visitors, progress)?;
        Ok(MeasurementResults {
            survey: survey.map(Survey::finish),
            flat_patches: screen_error.as_ref().map(ScreenErrorMeasurement::flat_patches),
            screen_error: screen_error.and_then(|measurement| measurement.worst()),
            deviation: deviation.and_then(|measurement| measurement.finish().ok()),
            accuracy: accuracy.and_then(|measurement| measurement.finish().ok().flatten()),
            sizes,
        })
    }

    /// The survey alone: cracks, folds, and what else it finds. The counts must be known.
    ///
    /// # Errors
    /// The device was lost.
    pub fn measure(&self, scene: &mut Scene) -> Result<Measured, GpuError> {
        let wanted = Measurements { survey: true, ..Measurements::default() };
        Ok(self.measure_all(scene, &wanted)?.survey.unwrap_or_default())
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
        let leaks = self.leaks_with_places(scene, measured, size, camera)?;
        Ok(leaks.map(|leaks| leaks.iter().map(|leak| u64::from(leak.pixels)).sum()))
    }

    /// The same leaks with their places, the largest first.
    fn leaks_with_places(
        &self,
        scene: &mut Scene,
        measured: &Measured,
        size: [u32; 2],
        camera: &Camera,
    ) -> Result<Option<Vec<Leak>>, GpuError> {
        let viewport = glam::vec2(size[0] as f32, size[1] as f32);
        let clip_from_object = camera.clip_from_object(viewport, &scene.bounds);
        let (mesh, topology) = scene.tessellator.posed().deformed();
        if !closed_extent(&mesh, &topology, measured).is_some_and(|extent| is_beyond_near(clip_from_object, extent)) {
            return Ok(None);
        }
        self.leak_counter.find(&self.gpu, scene, size, clip_from_object).map(Some)
    }

    /// Finds the leaks in a view, also where patches that face away are left out: these are emitted for it. The scene must have
    /// been counted with `inputs` and `measured`, and is when this returns.
    ///
    /// # Errors
    /// The picture is larger than the adapter draws, or the device was lost.
    pub fn find_leaks(
        &self,
        scene: &mut Scene,
        inputs: &Inputs,
        measured: &Measured,
        size: [u32; 2],
        camera: &Camera,
    ) -> Result<Leaks, GpuError> {
        let (_, topology) = scene.tessellator.posed().deformed();
        if let Some(uncounted) = Leaks::uncounted(&topology) {
            return Ok(uncounted);
        }
        if measured.culled.facing_away > 0 {
            let tessellation = Tessellation { cull_back_faces: false, ..inputs.tessellation };
            let whole = Inputs { tessellation, ..*inputs };
            self.count(scene, &whole, &mut Timing::Off)?;
            let measured = self.measure(scene)?;
            let leaks = self.find_leaks(scene, &whole, &measured, size, camera)?;
            self.count(scene, inputs, &mut Timing::Off)?;
            return Ok(leaks);
        }
        Ok(self.leaks_with_places(scene, measured, size, camera)?.map_or(Leaks::NearPlane, Leaks::Counted))
    }

    /// Counts the patches that are farther than a tolerance from the surface that they approximate, on screen. The inputs must be
    /// those of the counts, and they give the view.
    ///
    /// # Errors
    /// The device was lost.
    pub fn patches_above(
        &self,
        scene: &mut Scene,
        inputs: &Inputs,
        tolerance_px: f32,
    ) -> Result<PatchesAbove, GpuError> {
        let (mesh, topology) = scene.tessellator.posed().deformed();
        let (_, triangles) = scene.tessellator.totals();
        let measurement = ScreenErrorMeasurement::new(&mesh, &topology, inputs, triangles);
        let mut measurement = measurement.counting_above(tolerance_px);
        self.visit(scene, &mut [&mut measurement])?;
        Ok(measurement.above())
    }
}

/// The least and the largest coordinates of what was emitted and of its mesh, in object units. None if leaks of it can't be
/// counted: the mesh is open, or patches were left out because they face away.
pub fn closed_extent(mesh: &Mesh, topology: &Topology, measured: &Measured) -> Option<[Vec3; 2]> {
    // Patches that clipping left out aren't in the measured extent, so their corners count as well.
    let (corners, [least, most]) = (mesh.bounds(), measured.extent);
    let is_closed = topology.is_closed_and_oriented() && measured.culled.facing_away == 0;
    is_closed.then(|| [least.min(corners.min), most.max(corners.max)])
}
