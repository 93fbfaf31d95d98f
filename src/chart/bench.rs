//! One setting after another, timed and measured.

use std::time::Duration;

use super::{Errors, Row, Setting, Time};
use crate::engine::{Engine, Runs};
use crate::gpu::{GpuError, Timing};
use crate::measure::AccuracyOptions;
use crate::render::{Camera, Scene, Target};
use crate::truth::Truth;

/// How much is spent on a setting.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    pub runs: Runs,
    pub accuracy: AccuracyOptions,
    /// Settings of more triangles are left out.
    pub most_triangles: u64,
}

impl Default for Effort {
    fn default() -> Self {
        let runs = Runs { least: 3, most: 100, within: Duration::from_millis(200) };
        Self { runs, accuracy: AccuracyOptions::default(), most_triangles: 500_000 }
    }
}

/// A mesh on the device, seen from one place, and what it is held against.
pub struct Bench<'a> {
    pub engine: &'a Engine,
    /// As it is named in rows.
    pub mesh: String,
    pub scene: Scene,
    pub target: &'a Target,
    pub camera: Camera,
    pub truth: Option<&'a Truth>,
    pub effort: Effort,
}

impl Bench<'_> {
    /// Measures a setting; none if it has more triangles than the effort allows.
    ///
    /// # Errors
    /// The device was lost.
    pub fn measure(&mut self, setting: &Setting) -> Result<Option<Row>, GpuError> {
        let Self { engine, scene, target, camera, .. } = self;
        let settings = setting.settings();
        let inputs = settings.inputs(camera.lod_view(target.viewport(), &scene.bounds));
        engine.count(scene, &inputs, &mut Timing::Off)?;
        let (vertices, triangles) = scene.tessellator.totals();
        if triangles > self.effort.most_triangles {
            return Ok(None);
        }
        let passes = engine.time(scene, target, camera, &settings, self.effort.runs)?;
        let mut row = Row {
            mesh: self.mesh.clone(),
            adapter: engine.gpu.info.name.clone(),
            setting: *setting,
            triangles,
            vertices,
            time: Time::of(&passes),
            errors: None,
            max_error_px: None,
        };
        match self.truth {
            Some(truth) => {
                let accuracy = engine.accuracy(scene, truth, &inputs.view, self.effort.accuracy)?;
                row.max_error_px = accuracy.and_then(|accuracy| accuracy.worst_px).map(|worst| worst.value);
                row.errors = accuracy.map(|accuracy| {
                    let distances = accuracy.relative(accuracy.both_ways());
                    let normal_degrees = accuracy.normals.largest;
                    Errors { largest: distances.largest, rms: distances.rms, normal_degrees }
                });
            }
            None => row.max_error_px = engine.deviation(scene, &inputs)?.map(|worst| worst.px),
        }
        Ok(Some(row))
    }
}
