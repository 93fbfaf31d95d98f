//! Draws a picture, step by step: see [`steps`](crate::render::steps).

use super::Renderer;
use super::surfaces::Surfaces;
use crate::render::covered_area::is_empty;
use crate::render::draws::{Draw, Occluded};
use crate::render::frame::frame;
use crate::render::ground::Ground;
use crate::render::halves::{HalfPlace, half_places};
use crate::render::layers::LayerPass;
use crate::render::layout::linear;
use crate::render::steps::{Step, steps};
use crate::render::{Camera, Scene, Target};
use crate::settings::{ColorSource, Settings, SplitSide};
use gpu::{GpuError, Recorder, whole};

/// What all steps of a picture share.
pub(super) struct Picture<'a> {
    pub target: &'a Target,
    pub settings: &'a Settings,
    /// Where both halves are.
    pub places: [HalfPlace; 2],
    /// The parts of both halves that layers can cover.
    pub layer_areas: [HalfPlace; 2],
    /// The constants of both halves.
    pub frames: [Option<wgpu::Buffer>; 2],
    /// The bind groups of both halves' materials.
    pub materials: [Vec<wgpu::BindGroup>; 2],
    /// The same for passes that find layers; none in a picture without layers.
    pub found_materials: [Vec<wgpu::BindGroup>; 2],
    pub steps: Vec<Step>,
    /// Whether a material distorts what is behind it: it is drawn with a picture of that.
    distorts: bool,
    camera: &'a Camera,
    /// What draws the light behind everything in both halves, if it is shown.
    backgrounds: [Option<(wgpu::RenderPipeline, wgpu::BindGroup)>; 2],
    /// The index of the step with the ground.
    ground_step: usize,
}

impl Renderer {
    /// Makes what the steps of a picture share.
    ///
    /// # Errors
    /// A pipeline can't be made: out of memory, or a lost device.
    pub(super) fn picture<'a>(
        &self,
        scene: &Scene,
        target: &'a Target,
        camera: &'a Camera,
        settings: &'a Settings,
    ) -> Result<Picture<'a>, GpuError> {
        let light = |half| settings.half(half).map_or(Ok(None), |own| self.light(scene, &own));
        let lights = [light(SplitSide::Left)?, light(SplitSide::Right)?];
        let places = half_places(target.size, settings);
        let half_frame = |half| {
            let (drawn, settings) = scene.half(half).zip(settings.half(half))?;
            Some(frame(&self.gpu, drawn, &scene.usual(), target, camera, &settings, &places[half as usize]))
        };
        let steps = steps(scene, settings);
        let background = |half: SplitSide| {
            let is_shown = !target.is_transparent && settings.half(half).is_some_and(|own| own.shows_environment());
            let shown = lights[half as usize].as_ref().filter(|_| is_shown);
            shown.map(|light| self.background(light)).transpose()
        };
        let layer_areas = self.layer_areas(scene, target, camera, settings, places);
        let has_layers = !layer_areas.iter().all(|place| is_empty(place.area));
        let found_materials = |half| match scene.half(half) {
            Some(own) if has_layers => {
                self.materials.found_groups(&self.gpu, &self.placed(own, half, settings), &target.depth)
            }
            _ => Vec::new(),
        };
        let any_distorts = |own: &Scene| own.tessellator.mesh().materials.iter().any(|own| own.look.distorts());
        let distorts = has_layers && SplitSide::BOTH.iter().any(|half| scene.half(*half).is_some_and(any_distorts));
        let behind = if distorts { Some(whole(target.behind(&self.gpu)?)) } else { None };
        let materials = |half: SplitSide| {
            self.material_groups(scene, half, settings, lights[half as usize].as_ref(), behind.as_ref())
        };
        Ok(Picture {
            places,
            layer_areas,
            found_materials: SplitSide::BOTH.map(found_materials),
            frames: SplitSide::BOTH.map(half_frame),
            materials: [materials(SplitSide::Left)?, materials(SplitSide::Right)?],
            backgrounds: [background(SplitSide::Left)?, background(SplitSide::Right)?],
            ground_step: ground_step(&steps, scene, camera),
            steps,
            distorts,
            target,
            camera,
            settings,
        })
    }

    /// Records the step with this index.
    ///
    /// # Errors
    /// A pipeline can't be made: out of memory, or a lost device.
    pub(super) fn draw_step(
        &self,
        recorder: &mut Recorder,
        scene: &mut Scene,
        picture: &Picture,
        index: usize,
    ) -> Result<(), GpuError> {
        let &Picture { target, settings, camera, .. } = picture;
        let step = picture.steps[index];
        match step {
            Step::Layer(_) if picture.layer_areas.iter().all(|place| is_empty(place.area)) => return Ok(()),
            Step::Keep => return target.keep(recorder, &self.gpu, 0),
            Step::Difference => target.keep(recorder, &self.gpu, 1)?,
            Step::Over | Step::Surface(..) | Step::Layer(_) | Step::Normals(..) => {}
        }
        let Some(drawn) = scene.half_mut(step.half()) else { return Ok(()) };
        let of_half = settings.half(step.half()).unwrap_or(*settings);
        if let Some((_, chunk)) = step.part() {
            drawn.tessellator.emit(recorder, chunk)?;
            if of_half.overlays.colors.source() == ColorSource::MinimumTriangles {
                drawn.tessellator.record_minimum(recorder)?;
            }
        }
        if let Step::Layer(layer) = step {
            if picture.distorts && layer.pass == LayerPass::Begin {
                target.keep_behind(recorder, &self.gpu, &self.materials.mipmaps)?;
            }
            return self.draw_layer(recorder, scene, picture, layer);
        }
        let mut surfaces = self.surfaces(drawn, &picture.materials[step.half() as usize], target, camera, &of_half)?;
        // Coverage is that of the view before it is moved.
        if let Step::Surface(half, chunk) = step
            && picture.places[half as usize].shift == 0
        {
            surfaces.sifted = self.sift(recorder, drawn, target, camera, chunk, &surfaces)?;
        }
        self.record_step(recorder, scene, picture, index, &surfaces)?;
        if step == Step::Difference { self.difference.draw(recorder, &self.gpu, target) } else { Ok(()) }
    }

    /// Records the draws of a step that draws no layers: surfaces or normals, and what is drawn after them.
    ///
    /// # Errors
    /// A pipeline can't be made: out of memory, or a lost device.
    fn record_step(
        &self,
        recorder: &mut Recorder,
        scene: &Scene,
        picture: &Picture,
        index: usize,
        surfaces: &Surfaces,
    ) -> Result<(), GpuError> {
        let Picture { target, settings, places, frames, steps, backgrounds, .. } = picture;
        let ends = |at: Option<usize>| {
            at.and_then(|at| steps.get(at)).is_none_or(|step| matches!(step, Step::Keep | Step::Difference))
        };
        let (step, is_first) = (steps[index], ends(index.checked_sub(1)));
        // Layers begin with a picture of what is behind them.
        let next = steps.get(index + 1);
        let is_behind = picture.distorts && matches!(next, Some(Step::Layer(next)) if next.pass == LayerPass::Begin);
        let is_last = is_behind || ends(Some(index + 1));
        let shown = SplitSide::BOTH.map(|half| {
            let (own, frame) = scene.half(half).zip(frames[half as usize].as_ref())?;
            Some((own, self.scene_group(own, frame), &places[half as usize]))
        });
        let Some((drawn, group, place)) = &shown[step.half() as usize] else { return Ok(()) };
        // The difference comes under lines over nothing. What is compared has a background: its alpha is that of the wireframe.
        let is_alone = step == Step::Difference;
        let compares = matches!(steps.last(), Some(Step::Difference));
        let is_empty = if compares { is_alone } else { target.is_transparent };
        let [r, g, b] = linear(settings.background_color()).map(f64::from);
        let background = if is_empty { wgpu::Color::TRANSPARENT } else { wgpu::Color { r, g, b, a: 1.0 } };
        let color = target.color(background, is_first || is_alone, is_last);
        let has_normals = matches!(step, Step::Normals(..));
        let has_ground = index == picture.ground_step && settings.halves().any(|own| own.overlays.grid) && !compares;
        let has_lines = shown.iter().flatten().any(|(own, ..)| own.lines.is_some()) && index + 1 == steps.len();
        let normals = has_normals.then(|| self.line_pipelines(Draw::Normals)).transpose()?;
        let ground = has_ground.then(|| self.get(Draw::Ground)).transpose()?;
        let lines = has_lines.then(|| self.line_pipelines(Draw::Lines)).transpose()?;
        recorder.render("draw", Some(color), Some(target.depth(is_first)), |pass| {
            pass.set_bind_group(0, group, &[]);
            if is_first && backgrounds.iter().any(Option::is_some) {
                draw_in(pass, &shown, |pass, half, _| {
                    // Halves that are compared are drawn one after the other in the same place.
                    let is_drawn = half == step.half() || !settings.shows_difference();
                    let own = backgrounds[half as usize].as_ref().filter(|_| is_drawn);
                    if let Some((pipeline, light)) = own {
                        pass.set_pipeline(pipeline);
                        pass.set_bind_group(1, light, &[]);
                        pass.draw(0..3, 0..1);
                    }
                });
                pass.set_bind_group(0, group, &[]);
            }
            match step {
                Step::Surface(_, chunk) => {
                    pass.set_bind_group(3, &self.measured_group(drawn, chunk), &[]);
                    self.draw_chunk(pass, drawn, place, surfaces, &drawn.tessellator.chunk(chunk));
                }
                Step::Normals(_, chunk) => {
                    self.draw_normals(pass, normals.iter().flatten(), place, &drawn.tessellator.chunk(chunk));
                }
                Step::Over | Step::Layer(_) | Step::Keep | Step::Difference => {}
            }
            if let Some(ground) = &ground {
                pass.set_pipeline(ground);
                draw_in(pass, &shown, |pass, half, _| {
                    if settings.half(half).is_some_and(|own| own.overlays.grid) {
                        pass.draw(0..6, 0..1);
                    }
                });
            }
            if let Some(lines) = &lines {
                draw_in(pass, &shown, |pass, _, own| draw_lines(pass, lines, own));
            }
        });
        Ok(())
    }

    /// The pipelines for lines: first for all of them, faintly, then for the parts in sight.
    fn line_pipelines(&self, draw: fn(Occluded) -> Draw) -> Result<[wgpu::RenderPipeline; 2], GpuError> {
        Ok([self.get(draw(Occluded::Through))?, self.get(draw(Occluded::InSight))?])
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

/// What draws over a half: its scene, bind group and place; none if it isn't shown.
type ShownHalf<'a> = Option<(&'a Scene, wgpu::BindGroup, &'a HalfPlace)>;

/// Draws in both halves.
fn draw_in(
    pass: &mut wgpu::RenderPass,
    halves: &[ShownHalf; 2],
    draw: impl Fn(&mut wgpu::RenderPass, SplitSide, &Scene),
) {
    for (half, shown) in SplitSide::BOTH.into_iter().zip(halves) {
        let Some((own, group, place)) = shown else { continue };
        if place.confine(pass) {
            pass.set_bind_group(0, group, &[]);
            draw(pass, half, own);
        }
    }
}

fn draw_lines(pass: &mut wgpu::RenderPass, pipelines: &[wgpu::RenderPipeline; 2], scene: &Scene) {
    if let Some((buffer, count)) = &scene.lines {
        pass.set_vertex_buffer(0, buffer.slice(..));
        for pipeline in pipelines {
            pass.set_pipeline(pipeline);
            pass.draw(0..6, 0..*count);
        }
    }
}
