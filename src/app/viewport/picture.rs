//! The picture in the middle, drawn when anything that it is a function of has changed, step by step beside the window.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use glam::{Mat4, Vec2, vec2};

use crate::app::Document;
use crate::engine::Engine;
use crate::gpu::{GpuError, PassTime, Recorder, Timing, take_times};
use crate::measure::{CrackedEdge, Cracks};
use crate::mesh::Moment;
use crate::render::{Camera, Pixel, Renderer, Scene, Target};
use crate::settings::{Colors, Settings, SplitSide};
use crate::tessellate::{Inputs, LodView, Tessellation};
use crate::view::ScreenView;

/// Everything that the picture is a function of.
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct Wanted {
    pub document: u64,
    pub moment: Option<Moment>,
    pub lines: u64,
    /// Which distances to the truth are shown.
    pub deviation: u64,
    pub camera: Camera,
    pub settings: Settings,
    pub inputs: Inputs,
    pub clip_from_object: Mat4,
    /// Width and height in px.
    pub viewport: Vec2,
}

impl Wanted {
    /// What a half is tessellated with, if there is such a half.
    fn inputs_of(&self, half: SplitSide) -> Option<Inputs> {
        Some(Inputs {
            tessellation: Tessellation {
                surface: self.settings.half(half)?.tessellation.surface,
                ..self.inputs.tessellation
            },
            ..self.inputs
        })
    }
}

/// A picture under way: one step a submission, so that the window goes on beside it.
pub(crate) struct Drawing {
    wanted: Wanted,
    start: Instant,
    /// Steps that the device has been given, of all.
    pub given: usize,
    pub steps: usize,
}

/// Pictures of up to so many steps are finished also if something newer is wanted.
pub(crate) const SHORT: usize = 8;

/// The picture and what it cost.
pub(crate) struct Picture {
    pub target: Option<(Target, egui::TextureId)>,
    pub drawn: Option<Wanted>,
    /// What the device counts for: it is drawn before anything newer, so that a long drag shows pictures.
    counting: Option<Wanted>,
    /// The picture that is being drawn, step by step.
    pub drawing: Option<Drawing>,
    /// What the person in front of the window doesn't want to wait for.
    pub cancelled: Option<Wanted>,
    /// Whether the picture shown is not the one wanted.
    pub outdated: bool,
    timing: Timing,
    /// The last run of each pass, where the GPU's clock can be trusted.
    pub times: Vec<PassTime>,
    /// Whether those make up the last picture, which was drawn in one step.
    pub pass_times_hold: bool,
    /// From submitting the last picture to its completion, in ms.
    pub picture_ms: Option<f64>,
    /// Whether the device has finished what it was last given.
    pub in_flight: Option<Arc<AtomicBool>>,
    pictures: u64,
}

impl Picture {
    pub(crate) fn new(engine: &Engine) -> Self {
        // Waiting for every pass would stall the window; without timestamps, whole pictures are timed.
        let timing = match Timing::on(&engine.gpu) {
            Timing::Submissions(_) => Timing::Off,
            timestamps => timestamps,
        };
        Self {
            target: None,
            drawn: None,
            counting: None,
            drawing: None,
            cancelled: None,
            outdated: false,
            timing,
            times: Vec::new(),
            pass_times_hold: false,
            picture_ms: None,
            in_flight: None,
            pictures: 0,
        }
    }

    pub(crate) fn pictures(&self) -> u64 {
        self.pictures
    }

    /// Whether the picture shown is not the one wanted, or not complete.
    pub(crate) fn is_busy(&self) -> bool {
        self.outdated || self.in_flight.is_some() || self.counting.is_some()
    }

    /// Width and height of the viewport, in px.
    pub(crate) fn size(&self) -> Vec2 {
        self.target.as_ref().map_or(vec2(800.0, 600.0), |(target, _)| target.viewport())
    }

    /// The view that the LOD of what is shown was computed for.
    pub(crate) fn shown_view(&self) -> Option<LodView> {
        self.drawn.as_ref().map(|drawn| drawn.inputs.view)
    }

    /// The largest gap of these cracks in px, seen as the last picture was.
    pub(crate) fn gap_px(&self, cracks: &Cracks) -> f64 {
        self.drawn.as_ref().map_or(0.0, |drawn| cracks.max_gap_px(drawn.clip_from_object, drawn.viewport))
    }

    /// The gap of one edge in px, seen as the last picture was.
    pub(crate) fn gap_of_edge_px(&self, edge: &CrackedEdge) -> f64 {
        self.drawn.as_ref().map_or(0.0, |drawn| edge.gap_px(drawn.clip_from_object, drawn.viewport))
    }

    /// A pixel (from the left and the top) of the last picture, and which half's surface is there: the right one's also where
    /// the mesh is as it came.
    pub(crate) fn pixel(&self, at: [u32; 2]) -> Option<(SplitSide, Pixel)> {
        let Wanted { clip_from_object, settings, .. } = self.drawn?;
        let size = self.target.as_ref()?.0.size;
        let pixel = Pixel { clip_from_object, size, at, split: settings.split };
        if settings.half(SplitSide::Left).is_none() {
            return Some((SplitSide::Right, pixel));
        }
        let half = if pixel.is_left() { SplitSide::Left } else { SplitSide::Right };
        Some((half, Pixel { split: None, ..pixel }))
    }

    /// Where the picture that is shown was seen from.
    pub(crate) fn seen_from(&self) -> Option<ScreenView> {
        let Wanted { clip_from_object, viewport, .. } = self.drawn?;
        Some(ScreenView { clip_from_object, viewport })
    }

    /// Bytes of the textures drawn into.
    pub(crate) fn bytes(&self) -> u64 {
        self.target.as_ref().map_or(0, |(target, _)| target.bytes())
    }

    /// Looks whether the picture in flight has landed, and takes the times that have come in.
    pub(crate) fn land(&mut self, engine: &Engine) {
        if self.in_flight.as_ref().is_some_and(|done| done.load(Ordering::Acquire)) {
            self.in_flight = None;
            if let Some(drawing) = self.drawing.take_if(|drawing| drawing.given == drawing.steps) {
                self.picture_ms = Some(drawing.start.elapsed().as_secs_f64() * 1e3);
                self.pass_times_hold = drawing.steps == 1;
                self.drawn = Some(drawing.wanted);
                self.pictures += 1;
            }
        }
        for time in take_times(&engine.gpu, &mut self.timing) {
            match self.times.iter_mut().find(|known| known.pass == time.pass) {
                Some(known) => *known = time,
                None => self.times.push(time),
            }
        }
    }

    /// A target of the size wanted, registered with egui.
    pub(crate) fn fit(
        &mut self,
        app: &egui_wgpu::RenderState,
        engine: &Engine,
        size: [u32; 2],
    ) -> Result<(), GpuError> {
        if self.target.as_ref().is_some_and(|(target, _)| target.size == size) {
            return Ok(());
        }
        let target = Target::new(&engine.gpu, size)?;
        let mut renderer = app.renderer.write();
        let (view, filter) = (target.shown_view(), wgpu::FilterMode::Nearest);
        let id = match self.target.take() {
            Some((_, id)) => {
                renderer.update_egui_texture_from_wgpu_texture(&engine.gpu.device, &view, filter, id);
                id
            }
            None => renderer.register_native_texture(&engine.gpu.device, &view, filter),
        };
        self.target = Some((target, id));
        self.drawn = None;
        self.drawing = None;
        Ok(())
    }

    /// Draws what is wanted, if it isn't drawn yet and the device is free. The counts come back first; until then, and
    /// until all steps are drawn, the last picture stays.
    pub(crate) fn draw(&mut self, engine: &Engine, document: &mut Document, wanted: &Wanted) -> Result<(), GpuError> {
        self.counting = self.counting.filter(|counting| counting.document == document.generation);
        let mut keeps_on = |drawing: &mut Drawing| {
            drawing.wanted == *wanted || (drawing.steps <= SHORT && drawing.wanted.document == document.generation)
        };
        self.drawing = self.drawing.take_if(&mut keeps_on);
        // What is selected meanwhile is no reason to draw after all.
        let same =
            |cancelled: &Wanted| Wanted { lines: wanted.lines, deviation: wanted.deviation, ..*cancelled } == *wanted;
        self.cancelled = self.cancelled.filter(same);
        let under_way = self.drawing.as_ref().map(|drawing| drawing.wanted).or(self.counting);
        let wanted = under_way.unwrap_or(*wanted);
        if self.cancelled.is_some() {
            return Ok(());
        }
        let scene = &mut document.scene;
        let is_counted = self.count(engine, scene, &wanted, under_way.is_none())?;
        let Some((target, _)) = &self.target else { return Ok(()) };
        if self.in_flight.is_some() || !is_counted {
            return Ok(());
        }
        self.counting = None;
        if self.drawn == Some(wanted) {
            return Ok(());
        }
        if self.holds(scene, &wanted) {
            return Ok(());
        }
        let steps = Renderer::step_count(scene, &wanted.settings);
        let start = || Drawing { wanted, start: Instant::now(), given: 0, steps };
        let drawing = self.drawing.get_or_insert_with(start);
        let next = drawing.given..drawing.given + 1;
        drawing.given = next.end;
        let mut recorder = Recorder::new(&engine.gpu, &mut self.timing);
        engine.renderer.draw_steps(&mut recorder, scene, target, &wanted.camera, &wanted.settings, next)?;
        let done = Arc::new(AtomicBool::new(false));
        self.in_flight = Some(done.clone());
        recorder.submit();
        engine.gpu.queue.on_submitted_work_done(move || done.store(true, Ordering::Release));
        Ok(())
    }

    /// Lets the device count what each half will emit, with these inputs if `anew` is set. True once it is known; while the
    /// left half is still being made, it isn't.
    fn count(&mut self, engine: &Engine, scene: &mut Scene, wanted: &Wanted, anew: bool) -> Result<bool, GpuError> {
        let mut is_counted = true;
        for half in SplitSide::BOTH {
            let Some(inputs) = wanted.inputs_of(half) else { continue };
            let Some(scene) = scene.half_mut(half) else { return Ok(false) };
            let tessellator = &mut scene.tessellator;
            if anew {
                tessellator.set(&inputs)?;
            }
            if tessellator.needs_count() {
                let mut recorder = Recorder::new(&engine.gpu, &mut self.timing);
                tessellator.count(&mut recorder)?;
                recorder.submit();
                tessellator.request_counts();
                self.counting = Some(*wanted);
            }
            is_counted &= self.in_flight.is_none() && tessellator.poll_counts()?;
        }
        Ok(is_counted)
    }

    /// Whether the last picture stays until the distances are known that the new one shows: so from the same place, where
    /// without them it would only flicker.
    fn holds(&self, scene: &Scene, wanted: &Wanted) -> bool {
        let from_here = |drawn: &Wanted| {
            (drawn.document, drawn.moment, drawn.camera) == (wanted.document, wanted.moment, wanted.camera)
        };
        let shows = wanted.settings.overlays.colors == Colors::Deviation;
        let mut halves =
            SplitSide::BOTH.into_iter().filter_map(|half| wanted.settings.half(half).and(scene.half(half)));
        let is_known = halves.all(Scene::knows_deviation);
        shows && self.drawing.is_none() && !is_known && self.drawn.as_ref().is_some_and(from_here)
    }

    /// Whether nothing is under way that a new pose would disturb.
    pub(crate) fn is_free(&self) -> bool {
        self.drawing.is_none() && self.counting.is_none() && self.in_flight.is_none()
    }

    /// Whether a picture is under way that takes more than a few steps.
    pub(crate) fn is_long(&self) -> bool {
        self.drawing.as_ref().is_some_and(|drawing| drawing.steps > SHORT)
    }

    /// The device refused what was wanted: that isn't drawn again by itself, and what may be half drawn isn't shown.
    pub(crate) fn refuse(&mut self, scene: &mut Scene, wanted: &Wanted) {
        (self.drawn, self.drawing, self.counting) = (None, None, None);
        self.cancelled = Some(*wanted);
        for half in SplitSide::BOTH {
            if let Some(scene) = scene.half_mut(half) {
                scene.tessellator.forget();
            }
        }
    }

    /// Leaves the picture under way as it is: the last one stays until something else is wanted.
    pub(crate) fn cancel(&mut self) {
        self.cancelled = self.drawing.take().map(|drawing| drawing.wanted);
    }
}
