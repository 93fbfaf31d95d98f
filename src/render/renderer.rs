//! The one way a picture is drawn.

use std::ops::Range;

use super::coverage::{Coverage, CoveragePipelines};
use super::deviation::Deviations;
use super::frame::frame;
use super::layout::{linear, overlay_bits};
use super::pipelines::{Layer, chunk_layout, deviation_layout, material_layout, pipeline, scene_layout};
use super::scene::{LineSegment, upload};
use super::steps::{Step, halves, steps};
use super::{Camera, Scene, Target};
use crate::gpu::{ChunkBuffers, Gpu, Recorder, VERTEX_HALF};
use crate::mesh::Texture;
use crate::settings::{Colors, Half, Overlays, Settings};
use crate::tessellate::CoverageView;

/// Long-lived: one for a device, whatever is loaded.
pub struct Renderer {
    gpu: Gpu,
    scene_layout: wgpu::BindGroupLayout,
    pub(super) material_layout: wgpu::BindGroupLayout,
    chunk_layout: wgpu::BindGroupLayout,
    deviation_layout: wgpu::BindGroupLayout,
    /// Where no distances are known.
    unknown: wgpu::Buffer,
    pub(super) white: wgpu::TextureView,
    pub(super) sampler: wgpu::Sampler,
    /// Both sides, then fronts only. Without anything on the surface, not even a texture.
    plain: [wgpu::RenderPipeline; 2],
    /// With nothing but a texture on it.
    textured: [wgpu::RenderPipeline; 2],
    indexed: [wgpu::RenderPipeline; 2],
    pulled: [wgpu::RenderPipeline; 2],
    source: wgpu::RenderPipeline,
    /// Through everything and faint, then what is in sight.
    lines: [wgpu::RenderPipeline; 2],
    normals: [wgpu::RenderPipeline; 2],
    coverage: CoveragePipelines,
    /// From how many triangles a px on those that cover no sample are left out before the others are drawn.
    pub sift_from: f32,
}

/// Where there are fewer triangles a px, a rasteriser is done with them before the passes are that would spare it some.
const SIFT_FROM: f32 = 0.5;
/// One in software takes no longer for a small triangle than those passes do.
const SIFT_FROM_IN_SOFTWARE: f32 = f32::INFINITY;

/// Bytes from a [`crate::gpu::layout::DrawArgs`]'s start to its arguments for pulled drawing.
const PULL_ARGS: u64 = std::mem::offset_of!(crate::gpu::layout::DrawArgs, pull_vertex_count) as u64;

/// Both sides, then fronts only.
const SIDES: [Layer; 2] = [Layer::Surface, Layer::Fronts];

/// Of an emitted vertex's halves.
const PLACE: [wgpu::VertexAttribute; 2] = wgpu::vertex_attr_array![0 => Float32x3, 1 => Uint32];
const DETAIL: [wgpu::VertexAttribute; 2] = wgpu::vertex_attr_array![2 => Uint32x2, 3 => Float32x2];

/// An emitted vertex's halves, as vertex buffers.
fn vertex_halves(step_mode: wgpu::VertexStepMode) -> [Option<wgpu::VertexBufferLayout<'static>>; 2] {
    let half = |attributes| wgpu::VertexBufferLayout { array_stride: VERTEX_HALF, step_mode, attributes };
    [Some(half(&PLACE)), Some(half(&DETAIL))]
}

impl Renderer {
    pub fn new(gpu: &Gpu) -> Self {
        let scene_layout = scene_layout(gpu);
        let material_layout = material_layout(gpu);
        let chunk_layout = chunk_layout(gpu);
        let deviation_layout = deviation_layout(gpu);
        let surface = crate::gpu::shader_module(gpu, "draw");
        let layouts = [Some(&scene_layout), Some(&material_layout), Some(&chunk_layout), Some(&deviation_layout)];
        let as_it_came = [layouts[0], layouts[1], None, layouts[3]];
        let halves = vertex_halves(wgpu::VertexStepMode::Vertex);
        let bare =
            |entries, buffers: &[_]| SIDES.map(|layer| pipeline(gpu, &layouts[..2], &surface, entries, buffers, layer));
        let plain = bare(("plain_vertex", "plain_fragment"), &halves[..1]);
        let textured = bare(("textured_vertex", "textured_fragment"), &halves);
        let surface = |entry, layouts: &[_], buffers: &[_], layer| {
            pipeline(gpu, layouts, &surface, (entry, "surface_fragment"), buffers, layer)
        };
        let segment = wgpu::VertexBufferLayout {
            array_stride: size_of::<LineSegment>() as u64,
            step_mode: wgpu::VertexStepMode::Instance,
            attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x3, 3 => Float32],
        };
        let lines = crate::gpu::shader_module(gpu, "lines");
        let lines = |vertex, layouts: &[_], buffers: &[_]| {
            [("hidden_line_fragment", Layer::Everywhere), ("line_fragment", Layer::InSight)]
                .map(|(fragment, layer)| pipeline(gpu, layouts, &lines, (vertex, fragment), buffers, layer))
        };
        let with_chunk = [layouts[0], None, layouts[2]];
        Self {
            gpu: gpu.clone(),
            plain,
            textured,
            indexed: SIDES.map(|layer| surface("indexed_vertex", &layouts, &halves, layer)),
            pulled: SIDES.map(|layer| surface("pulled_vertex", &layouts, &[], layer)),
            source: surface("source_vertex", &as_it_came, &[], Layer::Surface),
            lines: lines("line_vertex", &layouts[..1], &[Some(segment)]),
            normals: lines("normal_vertex", &with_chunk, &vertex_halves(wgpu::VertexStepMode::Instance)),
            white: upload(gpu, &Texture { size: [1, 1], rgba: vec![255; 4] }),
            sampler: gpu.device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("base color"),
                address_mode_u: wgpu::AddressMode::Repeat,
                address_mode_v: wgpu::AddressMode::Repeat,
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                mipmap_filter: wgpu::MipmapFilterMode::Linear,
                ..Default::default()
            }),
            scene_layout,
            material_layout,
            chunk_layout,
            deviation_layout,
            unknown: Deviations::unknown(gpu),
            coverage: CoveragePipelines::new(gpu),
            sift_from: if gpu.is_software() { SIFT_FROM_IN_SOFTWARE } else { SIFT_FROM },
        }
    }

    /// Draws the scene, whose counts must be known, into the target: chunk after chunk, each emitted unless the arena
    /// still holds it. Normals come after all surfaces, which could hide them: another round of chunks.
    pub fn draw(
        &self,
        recorder: &mut Recorder,
        scene: &mut Scene,
        target: &Target,
        camera: &Camera,
        settings: &Settings,
    ) {
        let all = 0..Self::step_count(scene, settings);
        self.draw_steps(recorder, scene, target, camera, settings, all);
    }

    /// In how many steps [`Self::draw_steps`] draws the scene: one a chunk and round, and one if there is none.
    pub fn step_count(scene: &Scene, settings: &Settings) -> usize {
        steps(scene, settings).len()
    }

    /// Draws some of the steps of a picture; all of them, in order, make it. It is seen once the last is done.
    pub fn draw_steps(
        &self,
        recorder: &mut Recorder,
        scene: &mut Scene,
        target: &Target,
        camera: &Camera,
        settings: &Settings,
        range: Range<usize>,
    ) {
        let rects = halves(target.size, settings.split);
        let frames =
            Half::BOTH.map(|half| scene.half(half).map(|half| frame(&self.gpu, half, target, camera, settings)));
        let steps = steps(scene, settings);
        let has_left = settings.half(Half::Left).and(scene.half(Half::Left)).is_some();
        for (index, step) in steps.iter().enumerate().take(range.end).skip(range.start) {
            let half = step.half();
            let Some(drawn) = scene.half_mut(half) else { continue };
            if let Some(chunk) = step.chunk() {
                drawn.tessellator.emit(recorder, chunk);
            }
            let (first, last) = (index == 0, index + 1 == steps.len());
            let color = target.color(linear_color(settings.background), first, last);
            let mut surfaces = self.surface_pipelines(drawn, target, camera, settings);
            if let Step::Surface(_, chunk) = *step {
                surfaces.sifted = self.sift(recorder, drawn, target, camera, chunk, &surfaces);
            }
            let (Some(drawn), Some(frame)) = (scene.half(half), &frames[half as usize]) else { continue };
            let (group, rect) = (self.scene_group(drawn, frame), rects[half as usize]);
            recorder.render("draw", color, target.depth(first), |pass| {
                pass.set_bind_group(0, &group, &[]);
                if first && !has_left {
                    self.draw_source(pass, scene, rects[Half::Left as usize]);
                }
                match *step {
                    Step::Surface(_, chunk) => {
                        pass.set_bind_group(3, &self.deviation_group(drawn, Some(chunk)), &[]);
                        self.draw_chunk(pass, drawn, rect, &surfaces, &drawn.tessellator.chunk(chunk));
                    }
                    Step::Normals(_, chunk) => self.draw_normals(pass, rect, &drawn.tessellator.chunk(chunk)),
                    Step::Nothing => {}
                }
                if last {
                    self.draw_lines(pass, scene, rects[Half::Right as usize]);
                    if let Some(left) = scene.half(Half::Left).filter(|_| has_left) {
                        self.draw_lines(pass, left, rects[Half::Left as usize]);
                    }
                }
            });
        }
    }

    /// The pipelines of the emitted triangles, without and with a texture, and whether they pull their vertices.
    fn surface_pipelines(&self, scene: &Scene, target: &Target, camera: &Camera, settings: &Settings) -> Surfaces<'_> {
        // These look at whole triangles, and at backs.
        let Overlays { wireframe, folds, back_faces, colors, .. } = settings.overlays;
        let pulled = wireframe || folds || matches!(colors, Colors::TriangleSize | Colors::Deviation);
        let clip_from_object = camera.clip_from_object(target.viewport(), &scene.bounds);
        let fronts = !folds && !back_faces && scene.tessellator.shows_fronts_only(clip_from_object);
        let materials = match pulled {
            true => [&self.pulled; 2],
            false if overlay_bits(&settings.overlays) == 0 => [&self.plain, &self.textured],
            false => [&self.indexed; 2],
        };
        Surfaces { materials: materials.map(|sides| &sides[usize::from(fronts)]), pulled, fronts, sifted: false }
    }

    /// Keeps only what may be seen of a chunk that was emitted, if that is worth it. False where all of it is to be drawn.
    fn sift(
        &self,
        recorder: &mut Recorder,
        scene: &mut Scene,
        target: &Target,
        camera: &Camera,
        chunk: usize,
        surfaces: &Surfaces,
    ) -> bool {
        let (gpu, chunk) = (&self.gpu, scene.tessellator.chunk(chunk));
        let (_, triangles) = scene.tessellator.totals();
        if surfaces.pulled || (triangles as f32) < self.sift_from * target.viewport().element_product() {
            return false;
        }
        if !scene.coverage.as_ref().is_some_and(|coverage| coverage.has_room(&chunk)) {
            let material_count = scene.tessellator.buffers().material_count;
            scene.coverage = Coverage::new(gpu, &chunk, material_count).ok();
        }
        let Some(coverage) = &scene.coverage else { return false };
        let clip_from_object = camera.clip_from_object(target.viewport(), &scene.bounds);
        let view =
            CoverageView::new(clip_from_object, target.viewport(), gpu.samples, surfaces.fronts, gpu.subpixel_bits);
        coverage.keep(recorder, &self.coverage, gpu, &chunk, view);
        true
    }

    fn draw_source(&self, pass: &mut wgpu::RenderPass, scene: &Scene, [x, y, width, height]: [u32; 4]) {
        if width == 0 || height == 0 {
            return;
        }
        pass.set_scissor_rect(x, y, width, height);
        pass.set_pipeline(&self.source);
        pass.set_bind_group(3, &self.deviation_group(scene, None), &[]);
        for (material, patches) in scene.materials.iter().zip(&scene.tessellator.topology().material_patches) {
            pass.set_bind_group(1, material, &[]);
            pass.draw(3 * patches.start..3 * patches.end, 0..1);
        }
    }

    fn draw_chunk(
        &self,
        pass: &mut wgpu::RenderPass,
        scene: &Scene,
        [x, y, width, height]: [u32; 4],
        surfaces: &Surfaces,
        chunk: &ChunkBuffers,
    ) {
        if width == 0 || height == 0 {
            return;
        }
        pass.set_scissor_rect(x, y, width, height);
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
        for (material, own) in scene.materials.iter().zip(&scene.tessellator.mesh().materials) {
            pass.set_pipeline(surfaces.materials[usize::from(own.texture.is_some())]);
            pass.set_bind_group(1, material, &[]);
            if surfaces.pulled {
                pass.draw_indirect(draw_args, args + PULL_ARGS);
            } else {
                pass.draw_indexed_indirect(draw_args, args);
            }
            args += size_of::<crate::gpu::layout::DrawArgs>() as u64;
        }
    }

    /// A line from every vertex of a chunk.
    fn draw_normals(&self, pass: &mut wgpu::RenderPass, [x, y, width, height]: [u32; 4], chunk: &ChunkBuffers) {
        if width == 0 || height == 0 {
            return;
        }
        pass.set_scissor_rect(x, y, width, height);
        pass.set_bind_group(2, &self.chunk_group(chunk), &[]);
        set_vertices(pass, chunk);
        for pipeline in &self.normals {
            pass.set_pipeline(pipeline);
            pass.draw(0..6, 0..chunk.chunk.vertex_count);
        }
    }

    fn draw_lines(&self, pass: &mut wgpu::RenderPass, scene: &Scene, [x, y, width, height]: [u32; 4]) {
        if let Some((buffer, count)) = &scene.lines
            && width > 0
            && height > 0
        {
            pass.set_scissor_rect(x, y, width, height);
            pass.set_vertex_buffer(0, buffer.slice(..));
            for pipeline in &self.lines {
                pass.set_pipeline(pipeline);
                pass.draw(0..6, 0..*count);
            }
        }
    }

    fn scene_group(&self, scene: &Scene, frame: &wgpu::Buffer) -> wgpu::BindGroup {
        let buffers = scene.tessellator.buffers();
        let (vertices, indices) = scene.tessellator.arena();
        let bound = [frame, &buffers.points, &buffers.corners, &buffers.patches, vertices, indices, frame];
        let bound: Vec<_> = (0..).zip(bound).collect();
        crate::gpu::bind_group(&self.gpu, "scene", &self.scene_layout, &bound)
    }

    fn deviation_group(&self, scene: &Scene, chunk: Option<usize>) -> wgpu::BindGroup {
        let known = scene.known_deviation().zip(chunk).and_then(|(deviation, chunk)| deviation.chunks.get(chunk));
        let bound = [(0, known.unwrap_or(&self.unknown))];
        crate::gpu::bind_group(&self.gpu, "deviation", &self.deviation_layout, &bound)
    }

    fn chunk_group(&self, chunk: &ChunkBuffers) -> wgpu::BindGroup {
        crate::gpu::bind_group(&self.gpu, "chunk", &self.chunk_layout, &[(0, chunk.slab), (1, chunk.patch_factors)])
    }
}

fn set_vertices(pass: &mut wgpu::RenderPass, chunk: &ChunkBuffers) {
    for (slot, (buffer, bytes)) in (0..).zip(chunk.vertices()) {
        pass.set_vertex_buffer(slot, buffer.slice(bytes));
    }
}

/// Pipelines of the emitted triangles.
struct Surfaces<'a> {
    /// Of materials without a texture, and with one.
    materials: [&'a wgpu::RenderPipeline; 2],
    pulled: bool,
    /// Whether what faces away is left out.
    fronts: bool,
    /// Whether what covers no sample is.
    sifted: bool,
}

/// sRGB bytes as the linear colour that a clear takes.
fn linear_color(srgb: [u8; 3]) -> wgpu::Color {
    let [r, g, b] = linear(srgb).map(f64::from);
    wgpu::Color { r, g, b, a: 1.0 }
}
