//! Times and measures one setting after another.

use std::time::Duration;

use super::{Errors, Probe, Row, Setting, Time};
use geometry::defaults::with_defaults;
use geometry::tessellate::{Clip, Tessellation};
use gpu::{GpuError, Timing};
use inspect::engine::{Engine, MeasurementResults, Measurements, Runs};
use inspect::measure::{AccuracyOptions, Narrow};
use inspect::reference_shape::ReferenceShape;
use inspect::render::{Camera, Scene, Target};
use inspect::settings::Settings;

with_defaults! {
    /// How much time is spent on a setting.
    #[derive(Clone, Copy, Debug)]
    pub struct Effort {
        pub runs: Runs = Runs { least: 3, most: 100, within: Duration::from_millis(200) },
        pub accuracy: AccuracyOptions = AccuracyOptions { narrow: Narrow::QUICK, ..AccuracyOptions::default() },
        /// Settings with more triangles are left out.
        pub most_triangles: u64 = 500_000,
    }
}

/// A mesh on the device with one camera, and the reference surface that it is compared with.
pub struct Bench<'a> {
    pub engine: &'a Engine,
    /// The mesh's name in rows.
    pub mesh: String,
    pub scene: Scene,
    pub target: &'a Target,
    pub camera: Camera,
    pub reference_shape: Option<&'a ReferenceShape>,
    /// The settings that all methods have in common.
    pub base: Settings,
    pub effort: Effort,
}

impl Bench<'_> {
    /// Measures a setting. Returns `None` if it has more triangles than the effort allows.
    pub fn measure(&mut self, setting: &Setting) -> Result<Option<Row>, GpuError> {
        let probe = self.probe(&setting.applied(&self.base))?;
        let (mesh, adapter) = (self.mesh.clone(), self.engine.gpu.info.name.clone());
        Ok(probe.map(|probe| Row { mesh, adapter, setting: *setting, probe }))
    }

    /// Measures any settings, without their clipping and culling: a comparison with a reference surface needs all of the mesh.
    /// Returns `None` if that has more triangles than the effort allows.
    pub fn probe(&mut self, settings: &Settings) -> Result<Option<Probe>, GpuError> {
        let Self { engine, scene, target, camera, .. } = self;
        let settings = whole(settings);
        let inputs = settings.inputs(camera.lod_view(target.viewport(), &scene.bounds));
        engine.count(scene, &inputs, &mut Timing::Off)?;
        let (vertices, triangles) = scene.tessellator.totals();
        if triangles > self.effort.most_triangles {
            return Ok(None);
        }
        let passes = engine.time(scene, target, camera, inputs.view, &settings, self.effort.runs)?;
        let wanted = Measurements {
            accuracy: self.reference_shape.map(|reference_shape| (reference_shape, &inputs.view, self.effort.accuracy)),
            screen_error: Some(&inputs),
            ..Measurements::default()
        };
        let MeasurementResults { accuracy, screen_error, .. } = engine.measure_all(scene, &wanted)?;
        let own_px = screen_error.map(|worst| worst.value);
        let triangles_by_error = match own_px.map(|px| px as f32) {
            Some(px) if px > 0.0 => engine.triangles_by_error(scene, &inputs, px)?,
            _ => None,
        };
        let from_reference = accuracy.and_then(|accuracy| accuracy.worst_px).map(|worst| worst.value);
        let max_error_px = match self.reference_shape {
            Some(_) => from_reference,
            None => own_px,
        };
        let errors = accuracy.map(|accuracy| {
            let distances = accuracy.relative(accuracy.both_ways());
            let normal_degrees = accuracy.normals.largest;
            Errors { largest: distances.largest, rms: distances.rms.value, normal_degrees }
        });
        let time = Time::new(&passes);
        Ok(Some(Probe { triangles, vertices, time, errors, max_error_px, triangles_by_error }))
    }
}

/// The settings that are measured in place of these: without clipping, culling, overlays and split, so that all of the
/// surface is drawn, and nothing else, in the light of the camera.
pub fn whole(settings: &Settings) -> Settings {
    let tessellation = Tessellation { clip: Clip::Off, cull_back_faces: false, ..settings.tessellation };
    let Settings { normals_at, normal_maps, import, .. } = *settings;
    Settings { normals_at, normal_maps, import, ..tessellation.into() }
}
