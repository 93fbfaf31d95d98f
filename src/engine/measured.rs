//! What the engine measures on a scene, reading back what it emits.

use super::Engine;
use crate::gpu::GpuError;
use crate::measure::{
    Accuracy, AccuracyOptions, Deviant, Deviation, Field, Measured, Measurement, ScreenView, Sizes, Survey, Yardstick,
};
use crate::progress::Progress;
use crate::render::{Camera, Scene};
use crate::tessellate::{Inputs, LodView, is_beyond_near};
use crate::truth::Truth;

impl Engine {
    /// Reads back all that is emitted and measures it. The counts must be known.
    ///
    /// # Errors
    /// The device was lost.
    pub fn measure(&self, scene: &mut Scene) -> Result<Measured, GpuError> {
        let (mesh, topology) = scene.tessellator.posed().deformed();
        let mut survey = Survey::new(&mesh, &topology, self.patch_factors(scene)?, self.asked_factors(scene)?);
        self.read_chunks(scene, true, |first, vertices, triangles| survey.take(first, vertices, triangles))?;
        Ok(survey.finish())
    }

    /// The largest distance on screen between what is emitted and the surface that it stands for, seen from the view of
    /// `inputs`; none if nothing is in view. The counts must be known, for the same inputs.
    ///
    /// # Errors
    /// The device was lost.
    pub fn deviation(&self, scene: &mut Scene, inputs: &Inputs) -> Result<Option<Deviant>, GpuError> {
        let (mesh, topology) = scene.tessellator.posed().deformed();
        let (_, total) = scene.tessellator.totals();
        let mut deviation = Deviation::new(&mesh, &topology, inputs);
        self.read_chunks(scene, true, |_, vertices, triangles| deviation.take(vertices, triangles, total))?;
        Ok(deviation.worst())
    }

    /// How far what is emitted is from what it should have been, all over. The counts must be known.
    ///
    /// # Errors
    /// The device was lost.
    pub fn field(&self, scene: &mut Scene, yardstick: &Yardstick) -> Result<Field, GpuError> {
        let (mesh, topology) = scene.tessellator.posed().deformed();
        let mut field = Field::new(scene.tessellator.totals().1);
        let wanted = Progress::new();
        yardstick.with(&mesh, &topology, |against| {
            self.read_chunks(scene, true, |_, vertices, triangles| {
                // Nobody else knows of this progress, so that nobody cancels it.
                let _ = field.take(against, vertices, triangles, &wanted);
            })
        })?;
        Ok(field)
    }

    /// What is emitted held against a truth, in px as seen from `view`; none if nothing is emitted that has an area. All of
    /// the mesh must be emitted, and the counts be known.
    ///
    /// # Errors
    /// The device was lost.
    pub fn accuracy(
        &self,
        scene: &mut Scene,
        truth: &Truth,
        view: &LodView,
        options: AccuracyOptions,
    ) -> Result<Option<Accuracy>, GpuError> {
        let mut measurement = Measurement::new(truth, Some(view), options);
        self.read_chunks(scene, true, |_, vertices, triangles| measurement.take(vertices, triangles))?;
        Ok(measurement.finish())
    }

    /// How large what is emitted is on screen. The counts must be known.
    ///
    /// # Errors
    /// The device was lost.
    pub fn sizes(&self, scene: &mut Scene, view: ScreenView) -> Result<Sizes, GpuError> {
        let mut sizes = Sizes::new(view);
        self.read_chunks(scene, true, |_, vertices, triangles| sizes.take(vertices, triangles))?;
        Ok(sizes)
    }

    /// Pixels through which one looks into what should be closed, seen from `camera`: see [`crate::render::LeakCounter`]. None
    /// where that says nothing: the mesh is open, or reaches the near plane, or its backs are left out. The counts must be
    /// known.
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
        // What clipping left out isn't in what was measured; its corners say whether it lies behind the near plane.
        let corners = scene.tessellator.posed().deformed().0.bounds();
        let whole = [measured.extent[0].min(corners.min), measured.extent[1].max(corners.max)];
        let closed = scene.tessellator.topology().is_closed_and_oriented() && measured.culled.facing_away == 0;
        if !closed || !is_beyond_near(clip_from_object, whole) {
            return Ok(None);
        }
        self.leaks.count(&self.gpu, scene, size, clip_from_object).map(Some)
    }
}
