//! Draws the passes over layers: see [`layers`](crate::render::layers).

use super::{Picture, Renderer, Surfaces, emitted_triangles};
use crate::gpu::{GpuError, Recorder};
use crate::mesh::{Material, Mesh};
use crate::render::Scene;
use crate::render::layers::LayerPass;
use crate::render::needs::{Needs, has_layers};
use crate::render::pipelines::{Draw, LayerDraw, Triangles};
use crate::render::steps::{LayerPart, LayerStep};
use crate::render::target::depth_attachment;
use crate::settings::{NormalsAt, Settings, SplitSide};

impl Renderer {
    /// Records one step of a pass over layers. The arena holds the step's chunk.
    ///
    /// # Errors
    /// A pipeline or a texture can't be made: out of memory, or a lost device.
    pub(super) fn draw_layer(
        &self,
        recorder: &mut Recorder,
        scene: &Scene,
        picture: &Picture,
        LayerStep { pass, part, is_first }: LayerStep,
    ) -> Result<(), GpuError> {
        let Picture { target, settings, rects, frames, materials } = picture;
        let depths = target.layer_depths(&self.gpu)?;
        let found = pass.found();
        let depth = found.map(|(texture, nothing)| depth_attachment(&depths[texture], is_first.then_some(nothing)));
        let color = found.is_none().then(|| target.color(wgpu::Color::TRANSPARENT, false, false));
        let half = match part {
            Some(LayerPart::Chunk(half, _)) => half,
            Some(LayerPart::Source) | None => SplitSide::Right,
        };
        let (Some(drawn), Some(frame)) = (scene.half(half), &frames[half as usize]) else { return Ok(()) };
        let triangles = match part {
            Some(LayerPart::Source) => Triangles::Source,
            _ => emitted_triangles(settings),
        };
        let pipelines = self.layer_pipelines(drawn.tessellator.mesh(), pass, triangles, settings)?;
        let (scene_group, layer_group) = (self.scene_group(drawn, frame), self.layer_group(picture, pass)?);
        recorder.render("draw", color, depth, |render_pass| {
            render_pass.set_bind_group(0, &scene_group, &[]);
            render_pass.set_bind_group(3, &layer_group, &[]);
            match part {
                None => {}
                Some(LayerPart::Source) => {
                    self.draw_source(render_pass, &pipelines, drawn, materials, rects[SplitSide::Left as usize]);
                }
                Some(LayerPart::Chunk(_, chunk)) => {
                    let pulled = triangles == Triangles::Pulled;
                    let surfaces = Surfaces { materials: pipelines, pulled, fronts: false, sifted: false };
                    let chunk = drawn.tessellator.chunk(chunk);
                    self.draw_chunk(render_pass, drawn, materials, rects[half as usize], &surfaces, &chunk);
                }
            }
        });
        Ok(())
    }

    /// The pipelines that draw each of the mesh's materials in a pass: none for a material that hides what is behind it.
    fn layer_pipelines(
        &self,
        mesh: &Mesh,
        pass: LayerPass,
        triangles: Triangles,
        settings: &Settings,
    ) -> Result<Vec<Vec<wgpu::RenderPipeline>>, GpuError> {
        let draws = mesh.materials.iter().map(|material| draws(mesh, material, pass, triangles, settings));
        draws.map(|draws| draws.into_iter().map(|draw| self.get(draw)).collect()).collect()
    }

    fn layer_group(&self, picture: &Picture, pass: LayerPass) -> Result<wgpu::BindGroup, GpuError> {
        let passed = &picture.target.layer_depths(&self.gpu)?[pass.passed()];
        // Colours that show measurements hide everything behind them.
        let unknown = || self.unknown.as_entire_binding();
        let view = wgpu::BindingResource::TextureView;
        let bound = [unknown(), unknown(), view(passed), view(picture.target.depths())];
        let entries: Vec<_> =
            (0..).zip(bound).map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource }).collect();
        Ok(self.gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("layer"),
            layout: &self.pipelines.layer_layout,
            entries: &entries,
        }))
    }
}

/// The draws of a material in a pass, in order.
fn draws(mesh: &Mesh, material: &Material, pass: LayerPass, triangles: Triangles, settings: &Settings) -> Vec<Draw> {
    let own: &[_] = match pass {
        _ if !material.shows_behind() => &[],
        LayerPass::Begin => &[],
        LayerPass::Find { toward_eye: false, .. } => &[LayerDraw::Away],
        LayerPass::Find { toward_eye: true, .. } => &[LayerDraw::Toward],
        LayerPass::Composite { .. } if material.look.transmits() => &[LayerDraw::Filter, LayerDraw::Add],
        LayerPass::Composite { .. } => &[LayerDraw::Over],
    };
    let places = match pass {
        LayerPass::Composite { .. } if triangles != Triangles::Source => settings.used_normals_at(mesh),
        _ => NormalsAt::Vertices,
    };
    own.iter().map(|&draw| Draw::Layer(draw, triangles, places, Needs::of(mesh, settings))).collect()
}

/// All draws of a mesh's layers with these settings.
pub(super) fn layer_draws(settings: &Settings, mesh: &Mesh) -> Vec<Draw> {
    if !settings.shows_materials() || !has_layers(mesh) {
        return Vec::new();
    }
    let source = settings.split.is_some() && settings.half(SplitSide::Left).is_none();
    let triangles = std::iter::once(emitted_triangles(settings)).chain(source.then_some(Triangles::Source));
    let of = |triangles| {
        let passes = mesh.materials.iter().flat_map(|material| LayerPass::all().map(move |pass| (material, pass)));
        passes.flat_map(move |(material, pass)| draws(mesh, material, pass, triangles, settings))
    };
    triangles.flat_map(of).collect()
}
