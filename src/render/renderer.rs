//! Draws pictures, in the same way for the window, the commands and the tests.

mod layer_passes;

use std::ops::Range;
use std::sync::Arc;

use self::layer_passes::layer_draws;
use super::coverage::{Coverage, CoveragePipelines};
use super::covered_area::{Area, is_empty};
use super::deviation::Deviations;
use super::environment::{Environment, LightView};
use super::frame::frame;
use super::ground::Ground;
use super::layout::{linear, overlay_bits};
use super::look::Look;
use super::matcap::{MatcapPicture, Matcaps};
use super::materials::Materials;
use super::needs::{Cut, Needs, PictureKind};
use super::pipelines::{Draw, DrawPipelines, Faces, Occluded, Triangles};
use super::steps::{Step, halves, runs, steps};
use super::target::samples;
use super::tone::{TONE_CURVE_NEUTRAL, TONE_CURVE_NONE};
use super::{Camera, Scene, Target};
use crate::gpu::layout::DrawArgs;
use crate::gpu::{ChunkBuffers, Gpu, GpuError, Lazy, Recorder, bind_group};
use crate::mesh::{Material, Mesh, Texture};
use crate::settings::{Colors, Lighting, NormalsAt, Overlays, Settings, SplitSide, ToneCurve};
use crate::tessellate::CoverageView;

/// Draws pictures of any scene on a device. Its pipelines are made when they are first needed.
pub struct Renderer {
    gpu: Gpu,
    materials: Materials,
    studio: Lazy<Arc<Environment>>,
    matcaps: Matcaps,
    pipelines: DrawPipelines,
    coverage: CoveragePipelines,
    /// The buffer that is bound where deviations, or patches' own least, aren't known.
    unknown: wgpu::Buffer,
    samples: u32,
    /// From this many triangles per pixel on, those that cover no sample are removed before the others are drawn.
    pub sift_from: f32,
    /// Whether all materials of a mesh have the shader that any of them needs, or each has one that leaves out what it doesn't need itself.
    /// On a graphics card that is faster; a software driver takes longer to compile a shader than to draw many pictures with it.
    pub shares_shaders: bool,
    /// Whether passes over layers go over whole pictures, and not only over the part that layers can cover.
    pub peels_everywhere: bool,
}

/// The pipelines that draw the surfaces of a mesh in drafts of pictures with the same settings.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct DraftPipelines(Vec<Draw>);

/// With fewer triangles per pixel, a GPU draws all of them in less time than it takes to remove some.
const SIFT_FROM: f32 = 0.5;
/// A software rasteriser always draws all triangles in less time: it takes no longer for a small triangle than those passes do.
const SIFT_FROM_IN_SOFTWARE: f32 = f32::INFINITY;

/// The offset in [`DrawArgs`] of the arguments for draws that pull their vertices.
const PULL_ARGS: u64 = std::mem::offset_of!(DrawArgs, pull_vertex_count) as u64;

impl Renderer {
    /// Makes layouts, a sampler and a white texture. Compiles nothing yet.
    pub fn new(gpu: &Gpu) -> Self {
        let materials = Materials::new(gpu);
        Self {
            gpu: gpu.clone(),
            pipelines: DrawPipelines::new(gpu, &materials),
            materials,
            studio: Lazy::default(),
            matcaps: Matcaps::new(),
            coverage: CoveragePipelines::new(),
            unknown: Deviations::unknown(gpu),
            samples: samples(gpu),
            shares_shaders: gpu.is_software(),
            peels_everywhere: false,
            sift_from: if gpu.is_software() { SIFT_FROM_IN_SOFTWARE } else { SIFT_FROM },
        }
    }

    /// The same, with another light in place of the studio's.
    #[cfg(test)]
    pub(crate) fn lit_by(gpu: &Gpu, environment: Environment) -> Self {
        let renderer = Self::new(gpu);
        // There is none yet, so that nothing fails.
        let _ = renderer.studio.get_or_try_make(|| Ok(Arc::new(environment)));
        renderer
    }

    /// Uploads a picture of a lit sphere, for [`Scene::matcap`].
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    pub fn matcap(&self, picture: &Texture) -> Result<MatcapPicture, GpuError> {
        MatcapPicture::new(&self.gpu, &self.materials, picture)
    }

    /// What the materials of all scenes share.
    pub fn materials(&self) -> &Materials {
        &self.materials
    }

    /// Makes the pipelines that a picture of the scene with these settings needs, as far as that is known before the scene is
    /// counted. It may run on any thread. A picture that needs one of these pipelines meanwhile waits for it.
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    pub fn prepare(&self, scene: &Scene, settings: &Settings) -> Result<(), GpuError> {
        if settings.shows_materials() && settings.lighting == Lighting::Studio {
            self.studio()?;
        }
        if settings.overlays.colors == Colors::Matcap {
            self.matcaps.group(&self.gpu, &self.materials, settings.matcap)?;
        }
        if settings.overlays.colors == Colors::Excess {
            scene.tessellator.prepare_own_least(settings.tessellation.partitioning)?;
        }
        let mut draws = self.surface_draws(scene, settings, false);
        draws.extend(layer_draws(settings, scene.tessellator.mesh(), self.kind(false)));
        draws.extend(settings.shows_environment().then_some(Draw::Background));
        draws.extend(settings.overlays.grid.then_some(Draw::Ground));
        if settings.overlays.normals {
            draws.extend([Occluded::Through, Occluded::InSight].map(Draw::Normals));
        }
        draws.into_iter().try_for_each(|draw| self.get(draw).map(|_| ()))
    }

    /// The pipelines for surfaces that a [draft](Target::draft) of the scene needs, as far as that is known before the scene is
    /// counted.
    pub(crate) fn draft_pipelines(&self, scene: &Scene, settings: &Settings) -> DraftPipelines {
        let mut draws = self.surface_draws(scene, settings, true);
        draws.dedup();
        DraftPipelines(draws)
    }

    /// Makes these pipelines. It may run on any thread.
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    pub(crate) fn prepare_draft(&self, DraftPipelines(draws): &DraftPipelines) -> Result<(), GpuError> {
        draws.iter().try_for_each(|&draw| self.get(draw).map(|_| ()))
    }

    /// How the surfaces of a scene are drawn, as far as that is known before it is counted.
    fn surface_draws(&self, scene: &Scene, settings: &Settings, is_draft: bool) -> Vec<Draw> {
        let culls = settings.tessellation.cull_back_faces && scene.tessellator.is_solid();
        let faces = if culls { Faces::Fronts } else { Faces::Both };
        let (mesh, kind) = (scene.tessellator.mesh(), self.kind(is_draft));
        let emitted = mesh.materials.iter().map(|own| surface_draw(settings, mesh, own, faces, kind));
        let has_source = settings.split.is_some() && settings.half(SplitSide::Left).is_none();
        let source = mesh.materials.iter().filter(|_| has_source).map(|own| source_draw(settings, mesh, own, kind));
        emitted.chain(source).collect()
    }

    /// Makes the pipelines of all draws, also of those that no picture has needed yet. Measurements of memory use it.
    ///
    /// # Errors
    /// Out of memory, or a lost device.
    pub fn prepare_all(&self) -> Result<(), GpuError> {
        Draw::all()
            .into_iter()
            .chain(Draw::of_looks())
            .try_for_each(|draw| self.pipelines.get(&self.gpu, draw).map(|_| ()))
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
        let light = self.light(scene, settings)?;
        let rects = halves(target.size, settings.split);
        let half_frame = |half| {
            let [left, _, width, _] = rects[half as usize];
            // The mesh without tessellation is drawn with the right half's scene.
            let drawn = scene.half(half).or((width > 0).then_some(&*scene))?;
            Some(frame(&self.gpu, drawn, target, camera, settings, left))
        };
        let picture = Picture {
            target,
            settings,
            rects,
            layer_areas: self.layer_areas(scene, target, camera, settings, rects),
            frames: SplitSide::BOTH.map(half_frame),
            materials: self.material_groups(scene, settings, light.as_ref())?,
        };
        let Picture { rects, frames, materials, .. } = &picture;
        let background = match &light {
            Some(light) if settings.shows_environment() && !target.is_transparent() => Some(self.background(light)?),
            _ => None,
        };
        let steps = steps(scene, settings);
        let ground_step = ground_step(&steps, scene, camera);
        let runs = runs(scene, &steps);
        let has_left = settings.half(SplitSide::Left).and(scene.half(SplitSide::Left)).is_some();
        for index in runs.into_iter().take(range.end).skip(range.start).flatten() {
            let step = &steps[index];
            let half = step.half();
            if matches!(step, Step::Layer(_)) && picture.layer_areas.into_iter().all(is_empty) {
                continue;
            }
            let Some(drawn) = scene.half_mut(half) else { continue };
            if let Some(chunk) = step.chunk() {
                drawn.tessellator.emit(recorder, chunk)?;
                if settings.overlays.colors == Colors::Excess {
                    drawn.tessellator.record_own_least(recorder)?;
                }
            }
            if let Step::Layer(layer) = *step {
                self.draw_layer(recorder, scene, &picture, layer)?;
                continue;
            }
            let (first, last) = (index == 0, index + 1 == steps.len());
            let color = target.color(linear_color(settings.background_color()), first, last);
            let mut surfaces = self.surfaces(drawn, target, camera, settings)?;
            if let Step::Surface(_, chunk) = *step {
                surfaces.sifted = self.sift(recorder, drawn, target, camera, chunk, &surfaces)?;
            }
            let (Some(drawn), Some(frame)) = (scene.half(half), &frames[half as usize]) else { continue };
            let (group, rect) = (self.scene_group(drawn, frame), rects[half as usize]);
            let source = if first && !has_left && rects[SplitSide::Left as usize][2] > 0 {
                Some(self.source_pipelines(scene.tessellator.mesh(), target, settings)?)
            } else {
                None
            };
            let has_lines =
                scene.lines.is_some() || scene.half(SplitSide::Left).is_some_and(|left| left.lines.is_some());
            let lines = if last && has_lines { Some(self.line_pipelines(Draw::Lines)?) } else { None };
            let ground =
                if index == ground_step && settings.overlays.grid { Some(self.get(Draw::Ground)?) } else { None };
            let normals = if let Step::Normals(..) = step { Some(self.line_pipelines(Draw::Normals)?) } else { None };
            recorder.render("draw", Some(color), Some(target.depth(first)), |pass| {
                pass.set_bind_group(0, &group, &[]);
                if let Some((pipeline, group)) = background.as_ref().filter(|_| first) {
                    pass.set_pipeline(pipeline);
                    pass.set_bind_group(1, group, &[]);
                    pass.draw(0..3, 0..1);
                }
                if let Some(source) = &source {
                    pass.set_bind_group(3, &self.measured_group(scene, None), &[]);
                    self.draw_source(pass, source, scene, materials, rects[SplitSide::Left as usize]);
                }
                match *step {
                    Step::Surface(_, chunk) => {
                        pass.set_bind_group(3, &self.measured_group(drawn, Some(chunk)), &[]);
                        self.draw_chunk(pass, drawn, materials, rect, &surfaces, &drawn.tessellator.chunk(chunk));
                    }
                    Step::Normals(_, chunk) => {
                        let pipelines = normals.iter().flatten();
                        self.draw_normals(pass, pipelines, rect, &drawn.tessellator.chunk(chunk));
                    }
                    Step::Over | Step::Layer(_) => {}
                }
                if let Some(ground) = &ground {
                    // Both halves have the same ground.
                    pass.set_scissor_rect(0, 0, target.size[0], target.size[1]);
                    pass.set_pipeline(ground);
                    pass.draw(0..6, 0..1);
                }
                if let Some(lines) = &lines {
                    draw_lines(pass, lines, scene, rects[SplitSide::Right as usize]);
                    if let Some(left) = scene.half(SplitSide::Left).filter(|_| has_left) {
                        draw_lines(pass, lines, left, rects[SplitSide::Left as usize]);
                    }
                }
            });
        }
        Ok(())
    }

    fn get(&self, draw: Draw) -> Result<wgpu::RenderPipeline, GpuError> {
        self.pipelines.get(&self.gpu, draw)
    }

    /// The light of a studio, which is made at the first call.
    fn studio(&self) -> Result<&Arc<Environment>, GpuError> {
        self.studio.get_or_try_make(|| Environment::studio(&self.gpu).map(Arc::new))
    }

    /// The light from all around of a picture with these settings; none if no material needs it.
    fn light(&self, scene: &Scene, settings: &Settings) -> Result<Option<PictureLight>, GpuError> {
        if !settings.shows_materials() {
            return Ok(None);
        }
        let environment = match &scene.environment {
            Some(environment) if settings.lighting == Lighting::Environment => environment.clone(),
            _ => self.studio()?.clone(),
        };
        let surroundings = environment.surroundings(&self.gpu, &light_view(settings));
        Ok(Some(PictureLight { environment, surroundings }))
    }

    /// The bind groups of a scene's materials for a picture with these settings, in this light.
    fn material_groups(
        &self,
        scene: &Scene,
        settings: &Settings,
        light: Option<&PictureLight>,
    ) -> Result<Vec<wgpu::BindGroup>, GpuError> {
        if settings.overlays.colors == Colors::Matcap {
            let own = scene.matcap.as_ref().map(|picture| &picture.0);
            let group = own.map_or_else(|| self.matcaps.group(&self.gpu, &self.materials, settings.matcap), Ok)?;
            return Ok(vec![group.clone(); scene.materials.len()]);
        }
        let Some(PictureLight { environment, surroundings }) = light else {
            return Ok(scene.materials.iter().map(|own| own.group.clone()).collect());
        };
        let lights = scene.lights.as_ref();
        Ok(self.materials.lit_groups(&self.gpu, &scene.materials, (environment, surroundings), lights))
    }

    /// The pipeline and the bind group that draw this light behind everything.
    fn background(&self, light: &PictureLight) -> Result<(wgpu::RenderPipeline, wgpu::BindGroup), GpuError> {
        let entries = light.environment.backdrop(&self.gpu)?.entries(&light.surroundings);
        let layout = &self.pipelines.background_layout;
        let descriptor = wgpu::BindGroupDescriptor { label: Some("background"), layout, entries: &entries };
        Ok((self.get(Draw::Background)?, self.gpu.device.create_bind_group(&descriptor)))
    }

    fn kind(&self, is_draft: bool) -> PictureKind {
        PictureKind { samples: self.samples, is_draft, shares_shaders: self.shares_shaders }
    }

    /// The pipelines for lines: first for all of them, faintly, then for the parts in sight.
    fn line_pipelines(&self, draw: fn(Occluded) -> Draw) -> Result<[wgpu::RenderPipeline; 2], GpuError> {
        Ok([self.get(draw(Occluded::Through))?, self.get(draw(Occluded::InSight))?])
    }

    /// Decides how the emitted triangles are drawn.
    fn surfaces(
        &self,
        scene: &Scene,
        target: &Target,
        camera: &Camera,
        settings: &Settings,
    ) -> Result<Surfaces, GpuError> {
        let Overlays { folds, back_faces, .. } = settings.overlays;
        let clip_from_object = camera.clip_from_object(target.viewport(), &scene.bounds);
        // These two overlays show faces from behind.
        let fronts = !folds && !back_faces && scene.tessellator.shows_fronts_only(clip_from_object);
        let (mesh, faces) = (scene.tessellator.mesh(), if fronts { Faces::Fronts } else { Faces::Both });
        let draws =
            mesh.materials.iter().map(|own| surface_draw(settings, mesh, own, faces, self.kind(target.is_draft())));
        let materials = draws.map(|draw| Ok(vec![self.get(draw)?])).collect::<Result<_, GpuError>>()?;
        let pulled = emitted_triangles(settings) == Triangles::Pulled;
        Ok(Surfaces { materials, pulled, fronts, sifted: false })
    }

    /// The pipelines that draw input triangles, for each of the mesh's materials.
    fn source_pipelines(
        &self,
        mesh: &Mesh,
        target: &Target,
        settings: &Settings,
    ) -> Result<Vec<Vec<wgpu::RenderPipeline>>, GpuError> {
        let draws = mesh.materials.iter().map(|own| source_draw(settings, mesh, own, self.kind(target.is_draft())));
        draws.map(|draw| Ok(vec![self.get(draw)?])).collect()
    }

    /// Removes triangles that cover no sample from an emitted chunk, if that saves time. Returns false if all of the chunk has to
    /// be drawn.
    fn sift(
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

    fn draw_source(
        &self,
        pass: &mut wgpu::RenderPass,
        pipelines: &[Vec<wgpu::RenderPipeline>],
        scene: &Scene,
        materials: &[wgpu::BindGroup],
        [x, y, width, height]: [u32; 4],
    ) {
        if width == 0 || height == 0 {
            return;
        }
        pass.set_scissor_rect(x, y, width, height);
        let patches = &scene.tessellator.topology().material_patches;
        for ((material, patches), pipelines) in materials.iter().zip(patches).zip(pipelines) {
            for pipeline in pipelines {
                pass.set_pipeline(pipeline);
                pass.set_bind_group(1, material, &[]);
                pass.draw(3 * patches.start..3 * patches.end, 0..1);
            }
        }
    }

    fn draw_chunk(
        &self,
        pass: &mut wgpu::RenderPass,
        scene: &Scene,
        materials: &[wgpu::BindGroup],
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
        for (material, pipelines) in materials.iter().zip(&surfaces.materials) {
            for pipeline in pipelines {
                pass.set_pipeline(pipeline);
                pass.set_bind_group(1, material, &[]);
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
    fn draw_normals<'a>(
        &self,
        pass: &mut wgpu::RenderPass,
        pipelines: impl Iterator<Item = &'a wgpu::RenderPipeline>,
        [x, y, width, height]: [u32; 4],
        chunk: &ChunkBuffers,
    ) {
        if width == 0 || height == 0 {
            return;
        }
        pass.set_scissor_rect(x, y, width, height);
        pass.set_bind_group(2, &self.chunk_group(chunk), &[]);
        set_vertices(pass, chunk);
        for pipeline in pipelines {
            pass.set_pipeline(pipeline);
            pass.draw(0..6, 0..chunk.chunk.vertex_count);
        }
    }

    fn scene_group(&self, scene: &Scene, frame: &wgpu::Buffer) -> wgpu::BindGroup {
        let buffers = scene.tessellator.buffers();
        let (vertices, indices) = scene.tessellator.arena();
        let (nets, params) = (&buffers.curve_nets, scene.tessellator.params());
        let of_mesh = [&buffers.points, &buffers.corners, &buffers.patches];
        let bound =
            [&[frame][..], &of_mesh, &[vertices, indices, frame, nets, params, &buffers.corner_details]].concat();
        let bound: Vec<_> = (0..).zip(bound).collect();
        bind_group(&self.gpu, "scene", &self.pipelines.scene_layout, &bound)
    }

    fn measured_group(&self, scene: &Scene, chunk: Option<usize>) -> wgpu::BindGroup {
        let known = scene.known_deviation().zip(chunk).and_then(|(deviation, chunk)| deviation.chunks.get(chunk));
        let least = scene.tessellator.own_least();
        let bound = [(0, known.unwrap_or(&self.unknown)), (1, least.unwrap_or(&self.unknown))];
        bind_group(&self.gpu, "measured", &self.pipelines.measured_layout, &bound)
    }

    fn chunk_group(&self, chunk: &ChunkBuffers) -> wgpu::BindGroup {
        bind_group(&self.gpu, "chunk", &self.pipelines.chunk_layout, &[(0, chunk.slab), (1, chunk.patch_factors)])
    }
}

/// The pipeline for emitted triangles of a material, in such pictures.
fn surface_draw(settings: &Settings, mesh: &Mesh, material: &Material, faces: Faces, kind: PictureKind) -> Draw {
    let places = settings.used_normals_at(mesh);
    let triangles = emitted_triangles(settings);
    if let Some(cut) = Cut::of(settings, mesh, material, kind) {
        let triangles = if triangles == Triangles::Lit { Triangles::Indexed } else { triangles };
        return Draw::Cut(triangles, faces, places, cut);
    }
    match (triangles, Look::of(settings.overlays.colors)) {
        _ if settings.shows_materials() => {
            let draw = match triangles {
                Triangles::Pulled => Draw::LitPulled,
                Triangles::Indexed => Draw::LitIndexed,
                _ => Draw::Lit,
            };
            draw(faces, places, Needs::of(mesh, material, settings, kind).own(material, kind))
        }
        (Triangles::Pulled, Some(look)) => Draw::LookPulled(faces, places, look),
        (_, Some(look)) => Draw::LookIndexed(faces, places, look),
        (Triangles::Pulled, None) => Draw::Pulled(faces, places),
        (Triangles::Indexed, None) => Draw::Indexed(faces, places),
        _ if places == NormalsAt::Pixels => Draw::PixelNormals(faces),
        _ if material.texture.is_some() => Draw::Textured(faces),
        _ => Draw::Plain(faces),
    }
}

/// How pipelines get emitted triangles.
fn emitted_triangles(settings: &Settings) -> Triangles {
    // These overlays need data of whole triangles.
    let Overlays { wireframe, folds, colors, .. } = settings.overlays;
    if wireframe || folds || matches!(colors, Colors::TriangleSize | Colors::Deviation) {
        Triangles::Pulled
    } else if overlay_bits(&settings.overlays) != 0 {
        Triangles::Indexed
    } else {
        Triangles::Lit
    }
}

/// The index of the step after whose surfaces the ground is drawn: the last one. But where layers are in front of the ground, it
/// is drawn before them. The whole mesh lies above the ground, so that it is in front of all of it or behind all of it.
fn ground_step(steps: &[Step], scene: &Scene, camera: &Camera) -> usize {
    let has_layers = steps.iter().any(|step| matches!(step, Step::Layer(_)));
    let last_surface = steps.iter().rposition(|step| matches!(step, Step::Surface(..)));
    let before_layers = last_surface.filter(|_| has_layers && Ground::under(&scene.bounds).is_seen_from_above(camera));
    before_layers.unwrap_or(steps.len() - 1)
}

/// The pipeline for input triangles of a material, in such pictures.
fn source_draw(settings: &Settings, mesh: &Mesh, material: &Material, kind: PictureKind) -> Draw {
    if let Some(cut) = Cut::of(settings, mesh, material, kind) {
        return Draw::Cut(Triangles::Source, Faces::Both, NormalsAt::Vertices, cut);
    }
    match Look::of(settings.overlays.colors) {
        _ if settings.shows_materials() => {
            Draw::LitSource(Needs::of(mesh, material, settings, kind).own(material, kind))
        }
        Some(look) => Draw::LookSource(look),
        None => Draw::Source,
    }
}

/// How settings turn and show the light.
fn light_view(settings: &Settings) -> LightView {
    LightView {
        brightness: settings.environment_brightness,
        rotation: settings.light_rotation,
        exposure: settings.exposure,
        tone_curve: match settings.tone_curve {
            ToneCurve::Neutral => TONE_CURVE_NEUTRAL,
            ToneCurve::None => TONE_CURVE_NONE,
        },
    }
}

fn draw_lines(
    pass: &mut wgpu::RenderPass,
    pipelines: &[wgpu::RenderPipeline; 2],
    scene: &Scene,
    [x, y, width, height]: [u32; 4],
) {
    if let Some((buffer, count)) = &scene.lines
        && width > 0
        && height > 0
    {
        pass.set_scissor_rect(x, y, width, height);
        pass.set_vertex_buffer(0, buffer.slice(..));
        for pipeline in pipelines {
            pass.set_pipeline(pipeline);
            pass.draw(0..6, 0..*count);
        }
    }
}

fn set_vertices(pass: &mut wgpu::RenderPass, chunk: &ChunkBuffers) {
    for (slot, (buffer, bytes)) in (0..).zip(chunk.vertices()) {
        pass.set_vertex_buffer(slot, buffer.slice(bytes));
    }
}

/// What all steps of a picture share.
struct Picture<'a> {
    target: &'a Target,
    settings: &'a Settings,
    /// Of both halves: x, y, width and height in px.
    rects: [Area; 2],
    /// The parts of both halves that layers can cover.
    layer_areas: [Area; 2],
    /// The constants of both halves.
    frames: [Option<wgpu::Buffer>; 2],
    /// The bind groups of the scene's materials.
    materials: Vec<wgpu::BindGroup>,
}

/// The light from all around in a picture.
struct PictureLight {
    environment: Arc<Environment>,
    /// Says how it is turned and shown.
    surroundings: wgpu::Buffer,
}

/// How emitted triangles are drawn.
struct Surfaces {
    /// For each of the mesh's materials the pipelines that draw it, one after another.
    materials: Vec<Vec<wgpu::RenderPipeline>>,
    /// Whether shaders pull the corners of triangles.
    pulled: bool,
    /// Whether faces that are seen from behind are left out.
    fronts: bool,
    /// Whether triangles that cover no sample were removed.
    sifted: bool,
}

/// An sRGB colour as the linear one that a clear takes.
fn linear_color(srgb: [u8; 3]) -> wgpu::Color {
    let [r, g, b] = linear(srgb).map(f64::from);
    wgpu::Color { r, g, b, a: 1.0 }
}
