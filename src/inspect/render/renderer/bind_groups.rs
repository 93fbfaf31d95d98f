//! The bind groups of a picture, and the light in them.

use std::sync::Arc;

use super::Renderer;
use crate::render::Scene;
use crate::render::draws::Draw;
use crate::render::environment::{Environment, LightView};
use crate::render::materials::PlacedMaterial;
use crate::render::needs::Needs;
use crate::settings::{ColorSource, Lighting, Settings, SplitSide};
use gpu::{ChunkBuffers, GpuError, bind_group};

/// The light from all around in a picture.
pub(super) struct PictureLight {
    environment: Arc<Environment>,
    /// Says how it is turned and shown.
    surroundings: wgpu::Buffer,
}

impl Renderer {
    /// The light of a studio, which is made at the first call.
    pub(super) fn studio(&self) -> Result<&Arc<Environment>, GpuError> {
        self.studio.get_or_try_make(|| Environment::studio(&self.gpu).map(Arc::new))
    }

    /// The light from all around in a half of a picture, which has these settings; none if no material needs it.
    pub(super) fn light(&self, scene: &Scene, settings: &Settings) -> Result<Option<PictureLight>, GpuError> {
        if !settings.shows_materials() {
            return Ok(None);
        }
        let environment = match &scene.environment {
            Some(environment) if settings.lighting == Lighting::Environment => environment.clone(),
            _ => self.studio()?.clone(),
        };
        let view = LightView {
            brightness: settings.environment_brightness,
            rotation: settings.light_rotation,
            exposure: settings.exposure,
            tone_curve: settings.tone_curve,
        };
        let surroundings = view.surroundings(&self.gpu);
        Ok(Some(PictureLight { environment, surroundings }))
    }

    /// The materials of a half, placed for the shaders that draw it with these settings.
    pub(super) fn placed<'a>(&self, drawn: &'a Scene, half: SplitSide, settings: &Settings) -> Vec<PlacedMaterial<'a>> {
        let (mesh, of_half) = (drawn.tessellator.mesh(), settings.half(half).unwrap_or(*settings));
        let maps = |own| Needs::new(mesh, own, &of_half, self.kind(false)).maps;
        drawn.materials.iter().zip(mesh.materials.iter().map(maps)).collect()
    }

    /// The bind groups of a half's materials for a picture of a scene with these settings, in this light; and what is behind
    /// layers that distort it.
    pub(super) fn material_groups(
        &self,
        scene: &Scene,
        half: SplitSide,
        settings: &Settings,
        light: Option<&PictureLight>,
        behind: Option<&wgpu::TextureView>,
    ) -> Result<Vec<wgpu::BindGroup>, GpuError> {
        let Some(drawn) = scene.half(half) else { return Ok(Vec::new()) };
        let of_half = settings.half(half).unwrap_or(*settings);
        if of_half.overlays.colors.source() == ColorSource::LitSphere {
            let own = scene.matcap.as_ref().map(|picture| &picture.0);
            let group = own.map_or_else(|| self.matcaps.group(&self.gpu, &self.materials, of_half.matcap), Ok)?;
            return Ok(vec![group.clone(); drawn.materials.len()]);
        }
        let Some(PictureLight { environment, surroundings }) = light else {
            return Ok(drawn.materials.iter().map(|own| own.group.clone()).collect());
        };
        let (lights, materials) = (drawn.lights.as_ref(), self.placed(drawn, half, settings));
        Ok(self.materials.lit_groups(&self.gpu, &materials, environment, surroundings, lights, behind))
    }

    /// The pipeline and the bind group that draw this light behind everything.
    pub(super) fn background(&self, light: &PictureLight) -> Result<(wgpu::RenderPipeline, wgpu::BindGroup), GpuError> {
        let bound = light.environment.backdrop(&self.gpu)?.bound(&light.surroundings);
        let group = bind_group(&self.gpu, "background", &self.pipelines.background_layout, bound);
        Ok((self.get(Draw::Background)?, group))
    }

    pub(super) fn scene_group(&self, scene: &Scene, frame: &wgpu::Buffer) -> wgpu::BindGroup {
        let buffers = scene.tessellator.buffers();
        let (vertices, indices) = scene.tessellator.arena();
        let (nets, params) = (&buffers.curve_nets, scene.tessellator.params());
        let of_mesh = [&buffers.points, &buffers.corners, &buffers.patches];
        let bound =
            [&[frame][..], &of_mesh, &[vertices, indices, frame, nets, params, &buffers.corner_details]].concat();
        let bound = (0..).zip(bound.into_iter().map(wgpu::Buffer::as_entire_binding));
        bind_group(&self.gpu, "scene", &self.pipelines.scene_layout, bound)
    }

    pub(super) fn measured_group(&self, scene: &Scene, chunk: usize) -> wgpu::BindGroup {
        let known = scene.known_deviation().and_then(|deviation| deviation.chunks.get(chunk));
        let least = scene.tessellator.minimum();
        let bound = [known, least].map(|known| known.unwrap_or(&self.unknown).as_entire_binding());
        bind_group(&self.gpu, "measured", &self.pipelines.measured_layout, (0..).zip(bound))
    }

    pub(super) fn chunk_group(&self, chunk: &ChunkBuffers) -> wgpu::BindGroup {
        let bound = [chunk.slab, chunk.patch_factors].map(wgpu::Buffer::as_entire_binding);
        bind_group(&self.gpu, "chunk", &self.pipelines.chunk_layout, (0..).zip(bound))
    }
}
