//! Draws the passes over layers: see [`layers`](crate::render::layers).

use super::Renderer;
use super::picture::Picture;
use super::surfaces::{MaterialDraw, Surfaces};
use crate::render::covered_area::{Area, covered_area, is_empty, union};
use crate::render::draws::{Draw, Faces, LayerDraw, Shading, SurfaceDraw, Triangles};
use crate::render::halves::HalfPlace;
use crate::render::layers::LayerPass;
use crate::render::needs::{Needs, PictureKind, has_layers};
use crate::render::steps::LayerStep;
use crate::render::surface_draws::{emitted_triangles, own_faces};
use crate::render::target::depth_attachment;
use crate::render::{Camera, Scene, Target};
use crate::settings::{NormalsAt, Settings, SplitSide};
use geometry::mesh::{Material, Mesh};
use geometry::tessellate::LodView;
use gpu::{GpuError, Recorder, bind_group};

/// How far rounding moves a vertex at most, in units in the last place of the mesh's largest coordinate.
const ROUNDING_ULPS: f32 = 64.0;

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
        let Picture { target, settings, layer_areas, frames, .. } = picture;
        let all = union(layer_areas[0].area, layer_areas[1].area);
        if is_empty(all) {
            return Ok(());
        }
        let half = part.map_or(SplitSide::Right, |(half, _)| half);
        let of_half = settings.half(half).unwrap_or(**settings);
        let Some(frame) = &frames[half as usize] else { return Ok(()) };
        let drawn = scene.half(half).unwrap_or(scene);
        let surfaces = Surfaces {
            materials: self.layer_pipelines(drawn.tessellator.mesh(), picture, half, &of_half, pass)?,
            pulled: emitted_triangles(&of_half) == Triangles::Pulled,
            fronts: false,
            sifted: false,
        };
        let (scene_group, layer_group) = (self.scene_group(drawn, frame), self.layer_group(picture, pass)?);
        let is_whole = all == [0, 0, target.size[0], target.size[1]];
        // A clear of all of a picture is faster than a draw, but takes far longer than a draw of a small part.
        let nothing = pass.nothing().filter(|_| is_first);
        let cleared = nothing.filter(|_| is_whole);
        let part_clear = nothing.filter(|_| !is_whole).map(|depth| self.get(clear(pass, depth))).transpose()?;
        let depth = depth_attachment(&target.layer_depths(&self.gpu)?[pass.found()], cleared);
        let has_colors = matches!(pass, LayerPass::Back { .. });
        let color = has_colors.then(|| target.color(wgpu::Color::TRANSPARENT, false, false));
        recorder.render("draw", color, Some(depth), |render_pass| {
            if let Some(pipeline) = &part_clear {
                let [x, y, width, height] = all;
                render_pass.set_scissor_rect(x, y, width, height);
                render_pass.set_pipeline(pipeline);
                render_pass.draw(0..3, 0..1);
            }
            render_pass.set_bind_group(0, &scene_group, &[]);
            render_pass.set_bind_group(3, &layer_group, &[]);
            if let Some((_, chunk)) = part {
                let chunk = drawn.tessellator.chunk(chunk);
                self.draw_chunk(render_pass, drawn, &layer_areas[half as usize], &surfaces, &chunk);
            }
        });
        Ok(())
    }

    /// What draws each of the mesh's materials in a pass: nothing for a material that hides what is behind it.
    fn layer_pipelines(
        &self,
        mesh: &Mesh,
        picture: &Picture,
        half: SplitSide,
        settings: &Settings,
        pass: LayerPass,
    ) -> Result<Vec<Vec<MaterialDraw>>, GpuError> {
        let kind = self.kind(false);
        let groups = picture.materials[half as usize].iter().zip(&picture.found_materials[half as usize]);
        let of_material = |(material, (lit, found)): (&Material, (&wgpu::BindGroup, &wgpu::BindGroup))| {
            draws(mesh, material, pass, settings, kind)
                .into_iter()
                .map(|(step, draw)| {
                    let group = if step.finds() { found } else { lit };
                    Ok((self.get(draw)?, group.clone()))
                })
                .collect()
        };
        mesh.materials.iter().zip(groups).map(of_material).collect()
    }

    /// The parts of both halves, which are at these places, that layers can cover: nothing in a picture without layers, or in a draft.
    pub(super) fn layer_areas(
        &self,
        scene: &Scene,
        target: &Target,
        camera: &Camera,
        settings: &Settings,
        places: [HalfPlace; 2],
    ) -> [HalfPlace; 2] {
        let whole = [0, 0, target.size[0], target.size[1]];
        let covered = |half| match settings.half(half).zip(scene.half(half)) {
            Some((settings, own)) if !settings.shows_materials() || !has_layers(own.tessellator.mesh()) => [0; 4],
            Some(_) if target.is_draft => [0; 4],
            Some(_) if self.peels_everywhere => whole,
            Some((settings, own)) => layer_area(own, target, camera, &settings),
            None => [0; 4],
        };
        SplitSide::BOTH.map(|half| places[half as usize].part(covered(half)))
    }

    fn layer_group(&self, picture: &Picture, pass: LayerPass) -> Result<wgpu::BindGroup, GpuError> {
        let passed = &picture.target.layer_depths(&self.gpu)?[pass.passed()];
        // Colours that show measurements hide everything behind them.
        let unknown = || self.unknown.as_entire_binding();
        let bound = [unknown(), unknown(), wgpu::BindingResource::TextureView(passed)];
        Ok(bind_group(&self.gpu, "layer", &self.pipelines.layer_layout, (0..).zip(bound)))
    }
}

/// What sets the depths of a pass to this one.
fn clear(pass: LayerPass, depth: f32) -> Draw {
    Draw::LayerClear { at_infinity: depth == 0.0, has_colors: matches!(pass, LayerPass::Back { .. }) }
}

/// An area that holds all pixels which layers cover in a picture of a scene with these settings.
fn layer_area(scene: &Scene, target: &Target, camera: &Camera, settings: &Settings) -> Area {
    let whole = [0, 0, target.size[0], target.size[1]];
    // Control points of the user's own may be anywhere.
    if scene.tessellator.surface_shader().is_some() {
        return whole;
    }
    let Some(bounds) = scene.tessellator.posed().see_through_bounds() else { return whole };
    let clip_from_object = camera.clip_from_object(target.viewport(), &scene.bounds);
    let room = settings.reach(scene.tessellator.mesh()) + ROUNDING_ULPS * scene.ulp;
    let inputs = settings.inputs(LodView::default());
    let surfaces = || inputs.surfaces(scene.tessellator.mesh());
    let areas = bounds.iter().flat_map(|own| surfaces().map(|surface| own.of_surface(surface))).map(|own| match own {
        Some(bounds) => covered_area(&bounds.grown(room), clip_from_object, target.size),
        None => whole,
    });
    areas.fold([0; 4], union)
}

/// The draws of a material in a pass, in order, and what they do with layers.
fn draws(
    mesh: &Mesh,
    material: &Material,
    pass: LayerPass,
    settings: &Settings,
    kind: PictureKind,
) -> Vec<(LayerDraw, Draw)> {
    let own: &[_] = match pass {
        _ if !material.shows_behind() => &[],
        LayerPass::Begin => &[],
        LayerPass::Away { .. } => &[LayerDraw::Away],
        LayerPass::Back { composites: false, .. } => &[LayerDraw::Toward],
        LayerPass::Back { finds, .. } => {
            // What distorts has the colours behind it from a picture of them.
            let all: &[_] = if material.look.transmits() && !material.look.distorts() {
                &[LayerDraw::Filter, LayerDraw::Add, LayerDraw::Toward]
            } else {
                &[LayerDraw::Over, LayerDraw::Toward]
            };
            if finds { all } else { &all[..all.len() - 1] }
        }
    };
    let normals = |layer: LayerDraw| match layer {
        _ if layer.finds() => NormalsAt::Vertices,
        _ => settings.used_normals_at(mesh),
    };
    let shading = Shading::Lit(Needs::new(mesh, material, settings, kind));
    let triangles = emitted_triangles(settings);
    let faces = own_faces(settings, material).unwrap_or(Faces::Both);
    let draw = |&layer: &LayerDraw| {
        let own = SurfaceDraw { triangles, faces, normals: normals(layer), shading, layer: Some(layer) };
        (layer, Draw::Surface(own))
    };
    own.iter().map(draw).collect()
}

/// All draws of a mesh's layers with these settings.
pub(super) fn layer_draws(settings: &Settings, mesh: &Mesh, kind: PictureKind) -> Vec<Draw> {
    if !settings.shows_materials() || !has_layers(mesh) {
        return Vec::new();
    }
    let passes = mesh.materials.iter().flat_map(|material| LayerPass::all().map(move |pass| (material, pass)));
    let draws = passes.flat_map(|(material, pass)| draws(mesh, material, pass, settings, kind));
    let clears = LayerPass::all().filter_map(|pass| pass.nothing().map(|depth| clear(pass, depth)));
    draws.map(|(_, draw)| draw).chain(clears).collect()
}
