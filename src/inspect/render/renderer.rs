//! Draws pictures, in the same way for the window, the commands and the tests.

mod bind_groups;
#[cfg(any(test, feature = "for_tests"))]
mod for_tests;
mod layer_passes;
mod picture;
mod preparation;
mod surfaces;

use std::ops::Range;
use std::sync::Arc;

use super::coverage::coverage_pipelines;
use super::difference::DifferenceDrawer;
use super::draws::Draw;
use super::environment::Environment;
use super::matcap::{MatcapPicture, Matcaps, sphere_group};
use super::materials::Materials;
use super::needs::PictureKind;
use super::pipelines::DrawPipelines;
use super::steps::{runs, steps};
use super::target::samples;
use super::{Camera, Scene, Target};
use crate::settings::Settings;
use geometry::mesh::Texture;
use gpu::{ComputePipeline, Gpu, GpuError, Lazy, Recorder, uniform_buffer};

pub use preparation::DraftPipelines;

/// Draws pictures of any scene on a device. Its pipelines are made when they are first needed.
pub struct Renderer {
    gpu: Gpu,
    /// What the materials of all scenes share.
    pub(crate) materials: Materials,
    studio: Lazy<Arc<Environment>>,
    matcaps: Matcaps,
    pipelines: DrawPipelines,
    coverage: [ComputePipeline; 3],
    difference: DifferenceDrawer,
    /// The buffer without samples that is bound where deviations, or patches' minimum triangle counts, aren't known.
    unknown: wgpu::Buffer,
    samples: u32,
    /// From this many triangles per pixel on, those that cover no sample are removed before the others are drawn.
    pub sift_from: f32,
    /// Whether all materials of a mesh share one shader, which has what any of them needs. Otherwise each has a shader without what it
    /// doesn't need itself, which graphics cards draw faster. A software driver takes longer to compile another shader than to draw
    /// many pictures with the shared one.
    pub shares_shaders: bool,
    /// Whether passes over layers go over whole pictures, and not only over the part that layers can cover.
    pub peels_everywhere: bool,
}

/// With fewer triangles per pixel, a GPU draws all of them in less time than it takes to remove some.
const SIFT_FROM: f32 = 0.5;
/// A software rasteriser always draws all triangles in less time: it takes no longer for a small triangle than those passes do.
const SIFT_FROM_IN_SOFTWARE: f32 = f32::INFINITY;

impl Renderer {
    /// Makes layouts, a sampler and a white texture. Compiles nothing yet.
    pub fn new(gpu: &Gpu) -> Self {
        Self {
            gpu: gpu.clone(),
            materials: Materials::new(gpu),
            pipelines: DrawPipelines::new(gpu),
            studio: Lazy::default(),
            matcaps: Matcaps::default(),
            coverage: coverage_pipelines(),
            difference: DifferenceDrawer::new(),
            unknown: uniform_buffer(gpu, "unknown", bytemuck::bytes_of(&0.0_f32)),
            samples: samples(gpu),
            shares_shaders: gpu.is_software(),
            peels_everywhere: false,
            sift_from: if gpu.is_software() { SIFT_FROM_IN_SOFTWARE } else { SIFT_FROM },
        }
    }

    /// Uploads a picture of a lit sphere, for [`Scene::matcap`].
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    pub fn matcap(&self, picture: &Texture) -> Result<MatcapPicture, GpuError> {
        sphere_group(&self.gpu, &self.materials, picture).map(MatcapPicture)
    }

    /// Draws the scene into the target, chunk after chunk. The scene must be counted. A chunk is emitted unless the arena still
    /// holds it. Layers and normals are drawn in further walks over all chunks, since surfaces may hide them.
    ///
    /// # Errors
    /// A pipeline can't be made: out of memory, or a lost device.
    pub fn draw(
        &self,
        recorder: &mut Recorder,
        scene: &mut Scene,
        target: &Target,
        camera: &Camera,
        settings: &Settings,
    ) -> Result<(), GpuError> {
        let all = 0..Self::step_count(scene, settings);
        self.draw_steps(recorder, scene, target, camera, settings, all)
    }

    /// The number of steps in which [`Self::draw_steps`] draws the scene: at least 1.
    pub fn step_count(scene: &Scene, settings: &Settings) -> usize {
        runs(scene, &steps(scene, settings)).len()
    }

    /// Draws some of the steps of a picture. The target shows the picture after all steps were drawn in order.
    ///
    /// # Errors
    /// A pipeline can't be made: out of memory, or a lost device.
    pub fn draw_steps(
        &self,
        recorder: &mut Recorder,
        scene: &mut Scene,
        target: &Target,
        camera: &Camera,
        settings: &Settings,
        range: Range<usize>,
    ) -> Result<(), GpuError> {
        let settings = &settings.drawn();
        let picture = self.picture(scene, target, camera, settings)?;
        for index in runs(scene, &picture.steps).into_iter().take(range.end).skip(range.start).flatten() {
            self.draw_step(recorder, scene, &picture, index)?;
        }
        Ok(())
    }

    fn get(&self, draw: Draw) -> Result<wgpu::RenderPipeline, GpuError> {
        self.pipelines.get(&self.gpu, &self.materials, draw)
    }

    fn kind(&self, is_draft: bool) -> PictureKind {
        PictureKind { samples: self.samples, is_draft, shares_shaders: self.shares_shaders }
    }
}
