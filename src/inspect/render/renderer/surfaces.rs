//! Records the draws of surfaces: emitted triangles, and normals at vertices.

use super::Renderer;
use crate::render::coverage::Coverage;
use crate::render::draws::{Faces, Triangles};
use crate::render::halves::HalfPlace;
use crate::render::surface_draws::{emitted_triangles, surface_draw};
use crate::render::{Camera, Scene, Target};
use crate::settings::{Overlays, Settings};
use geometry::mesh::Material;
use geometry::tessellate::CoverageView;
use gpu::layout::DrawArgs;
use gpu::{ChunkBuffers, GpuError, Recorder};

/// The offset in [`DrawArgs`] of the arguments for draws that pull their vertices.
const PULL_ARGS: u64 = std::mem::offset_of!(DrawArgs, pull_vertex_count) as u64;

/// A pipeline that draws a material, and the bind group of that material.
pub(super) type MaterialDraw = (wgpu::RenderPipeline, wgpu::BindGroup);

/// How emitted triangles are drawn.
pub(super) struct Surfaces {
    /// For each of the mesh's materials what draws it, one after another.
    pub materials: Vec<Vec<MaterialDraw>>,
    /// Whether shaders pull the corners of triangles.
    pub pulled: bool,
    /// Whether faces that are seen from behind are left out.
    pub fronts: bool,
    /// Whether triangles that cover no sample were removed.
    pub sifted: bool,
}

impl Renderer {
    /// Decides how the emitted triangles are drawn.
    pub(super) fn surfaces(
        &self,
        scene: &Scene,
        materials: &[wgpu::BindGroup],
        target: &Target,
        camera: &Camera,
        settings: &Settings,
    ) -> Result<Surfaces, GpuError> {
        let Overlays { folds, back_faces, .. } = settings.overlays;
        let clip_from_object = camera.clip_from_object(target.viewport(), &scene.bounds);
        // These two overlays show faces from behind.
        let fronts = !folds && !back_faces && scene.tessellator.shows_fronts_only(clip_from_object);
        let (mesh, faces) = (scene.tessellator.mesh(), if fronts { Faces::Fronts } else { Faces::Both });
        let kind = self.kind(target.is_draft);
        let draws = |(own, group): (&Material, &wgpu::BindGroup)| {
            Ok(vec![(self.get(surface_draw(settings, mesh, own, faces, kind))?, group.clone())])
        };
        let materials = mesh.materials.iter().zip(materials).map(draws).collect::<Result<_, GpuError>>()?;
        let pulled = emitted_triangles(settings) == Triangles::Pulled;
        Ok(Surfaces { materials, pulled, fronts, sifted: false })
    }

    /// Removes triangles that cover no sample from an emitted chunk, if that saves time. Returns false if all of the chunk has to
    /// be drawn.
    pub(super) fn sift(
        &self,
        recorder: &mut Recorder,
        scene: &mut Scene,
        target: &Target,
        camera: &Camera,
        chunk: usize,
        surfaces: &Surfaces,
    ) -> Result<bool, GpuError> {
        let (gpu, chunk) = (&self.gpu, scene.tessellator.chunk(chunk));
        let (_, triangles) = scene.tessellator.totals();
        if surfaces.pulled || (triangles as f32) < self.sift_from * target.viewport().element_product() {
            return Ok(false);
        }
        if !scene.coverage.as_ref().is_some_and(|coverage| coverage.has_room(&chunk)) {
            let material_count = scene.tessellator.buffers().material_count;
            scene.coverage = Coverage::new(gpu, &chunk, material_count).ok();
        }
        let Some(coverage) = &scene.coverage else { return Ok(false) };
        let clip_from_object = camera.clip_from_object(target.viewport(), &scene.bounds);
        let view =
            CoverageView::new(clip_from_object, target.viewport(), self.samples, surfaces.fronts, gpu.subpixel_bits);
        coverage.keep(recorder, &self.coverage, gpu, &chunk, view)?;
        Ok(true)
    }

    pub(super) fn draw_chunk(
        &self,
        pass: &mut wgpu::RenderPass,
        scene: &Scene,
        place: &HalfPlace,
        surfaces: &Surfaces,
        chunk: &ChunkBuffers,
    ) {
        if !place.confine(pass) {
            return;
        }
        pass.set_bind_group(2, &self.chunk_group(chunk), &[]);
        let sifted = scene.coverage.as_ref().filter(|_| surfaces.sifted);
        let (indices, draw_args, mut args) = match sifted {
            Some(coverage) => (&coverage.indices, &coverage.draw_args, 0),
            None => (chunk.indices, chunk.draw_args, chunk.draw_args_offset),
        };
        if !surfaces.pulled {
            set_vertices(pass, chunk);
            pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint32);
        }
        for draws in &surfaces.materials {
            for (pipeline, group) in draws {
                pass.set_pipeline(pipeline);
                pass.set_bind_group(1, group, &[]);
                if surfaces.pulled {
                    pass.draw_indirect(draw_args, args + PULL_ARGS);
                } else {
                    pass.draw_indexed_indirect(draw_args, args);
                }
            }
            args += size_of::<DrawArgs>() as u64;
        }
    }

    /// Draws a line along the normal of every vertex of a chunk.
    pub(super) fn draw_normals<'a>(
        &self,
        pass: &mut wgpu::RenderPass,
        pipelines: impl Iterator<Item = &'a wgpu::RenderPipeline>,
        place: &HalfPlace,
        chunk: &ChunkBuffers,
    ) {
        if !place.confine(pass) {
            return;
        }
        pass.set_bind_group(2, &self.chunk_group(chunk), &[]);
        set_vertices(pass, chunk);
        for pipeline in pipelines {
            pass.set_pipeline(pipeline);
            pass.draw(0..6, 0..chunk.chunk.vertex_count);
        }
    }
}

fn set_vertices(pass: &mut wgpu::RenderPass, chunk: &ChunkBuffers) {
    for (slot, (buffer, bytes)) in (0..).zip(chunk.vertices()) {
        pass.set_vertex_buffer(slot, buffer.slice(bytes));
    }
}
