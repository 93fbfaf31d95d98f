//! The viewport's picture. It is drawn anew if anything that it depends on has changed, step by step while the window goes on.

use std::sync::{Arc, OnceLock};
use std::time::Instant;

use glam::{Vec2, vec2};

use super::pace::next_steps;
use crate::app::Document;
use crate::app::jobs::given::FromFiles;
use crate::app::painting::ShownPicture;
use geometry::mesh::Moment;
use geometry::tessellate::Inputs;
use geometry::view::ScreenView;
use gpu::{GpuError, PassTime, Recorder, Timing, chunks_an_arena, take_times};
use inspect::engine::Engine;
use inspect::render::{Camera, LeftPose, Pixel, Renderer, Scene, Target, WindowPipelines, half_at, section};
use inspect::settings::{ColorSource, Settings, SplitSide};

/// Everything that the picture depends on.
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct PictureRequest {
    pub document: u64,
    pub moment: Option<Moment>,
    pub left_pose: LeftPose,
    pub lines: u64,
    /// The number of the deviation result that is shown.
    pub deviation: u64,
    pub from_files: FromFiles,
    pub camera: Camera,
    pub settings: Settings,
    pub inputs: Inputs,
    pub view: ScreenView,
}

impl PictureRequest {
    /// The inputs of a half's tessellation, if there is such a half.
    pub(super) fn inputs_of(&self, half: SplitSide) -> Option<Inputs> {
        Some(self.settings.half(half)?.inputs(self.inputs.view))
    }
}

/// A picture that is being drawn. Each step is a submission of its own, so that the window can be drawn in between.
pub(crate) struct Drawing {
    wanted: PictureRequest,
    start: Instant,
    /// How many of the `steps` have been submitted.
    pub given: usize,
    pub steps: usize,
    /// How many steps were submitted together last, and how many ms they took.
    last: Option<(usize, f64)>,
}

impl Drawing {
    /// The part that is submitted, 0 to 1.
    pub(crate) fn done(&self) -> f32 {
        self.given as f32 / self.steps.max(1) as f32
    }

    /// About how many seconds the rest takes, once so much is done that it can be told.
    pub(crate) fn seconds_left(&self) -> Option<f64> {
        let done = f64::from(self.done());
        (done > 0.05).then(|| self.start.elapsed().as_secs_f64() * (1.0 - done) / done)
    }
}

/// Pictures of output that fills the arena up to so many times are short.
const SHORT: usize = 8;

#[derive(Default)]
pub(crate) struct Picture {
    pub target: Option<(Target, ShownPicture)>,
    /// The last picture, of another size. It is shown stretched until the first one of the new size is drawn.
    before: Option<ShownPicture>,
    pub drawn: Option<PictureRequest>,
    /// The document of the last picture that was drawn, in whatever size.
    pub shows: Option<u64>,
    /// The picture that the device is counting for. It is drawn before any newer one, so that a long drag shows pictures.
    counting: Option<PictureRequest>,
    /// The picture that is being drawn, step by step.
    pub drawing: Option<Drawing>,
    pub cancelled: Option<PictureRequest>,
    /// Whether the picture shown is not the one wanted.
    pub outdated: bool,
    timing: Timing,
    /// The times of each pass's last run, if the adapter has timestamps.
    pub times: Vec<PassTime>,
    /// Whether `times` add up to the last picture, because it was drawn in one step.
    pub pass_times_hold: bool,
    /// From submitting the last picture to its completion, in ms.
    pub picture_ms: Option<f64>,
    /// When work on the next picture began, which includes its counts.
    begun: Option<Instant>,
    /// How long the last picture took from the first pass to its completion, in ms.
    pub whole_ms: Option<f64>,
    /// Set once the device has finished the last submission, to how many ms that took.
    pub in_flight: Option<Arc<OnceLock<f64>>>,
    /// Pictures of up to this many steps are finished even if a newer one is wanted.
    pub short: usize,
    /// How many have been drawn.
    pub pictures: u64,
}

impl Picture {
    pub(crate) fn new(engine: &Engine) -> Self {
        // Waiting for every pass would stall the window; without timestamps, whole pictures are timed.
        let timing = match Timing::on(&engine.gpu) {
            Timing::Submissions(_) => Timing::Off,
            timestamps => timestamps,
        };
        Self { timing, short: SHORT * chunks_an_arena(&engine.gpu) as usize, ..Self::default() }
    }

    /// Stops work on the next picture, so that a preview can be drawn. What the device has begun is not shown.
    pub(crate) fn make_way(&mut self) {
        (self.counting, self.begun) = (None, None);
        // A picture that is submitted as a whole replaces the one before it, even if it comes too late.
        self.drawing = self.drawing.take_if(|drawing| drawing.given == drawing.steps);
        self.outdated = true;
    }

    /// Whether the picture shown is not the one wanted, or not complete.
    pub(crate) fn is_busy(&self) -> bool {
        self.outdated || self.in_flight.is_some() || self.counting.is_some()
    }

    /// Width and height of the viewport, in px.
    pub(crate) fn size(&self) -> Vec2 {
        self.target.as_ref().map_or(vec2(800.0, 600.0), |(target, _)| target.viewport())
    }

    /// A pixel of the last picture, counted from the left and the top, and the half that is there.
    pub(crate) fn pixel(&self, scene: &Scene, at: [u32; 2]) -> Option<(SplitSide, Pixel)> {
        let PictureRequest { camera, view, settings, .. } = self.drawn?;
        let size = self.target.as_ref()?.0.size;
        let (half, at) = half_at(at, size, &settings);
        let bounds = scene.half(half).map_or(&scene.bounds, |own| &own.bounds);
        let clip_from_object = section::clip_from_object(&camera, view.viewport, bounds, &settings);
        Some((half, Pixel { clip_from_object, size, at, has_input: false }))
    }

    pub(crate) fn seen_from(&self) -> Option<ScreenView> {
        self.drawn.map(|drawn| drawn.view)
    }

    /// Bytes of the textures that are drawn into.
    pub(crate) fn bytes(&self) -> u64 {
        self.target.as_ref().map_or(0, |(target, _)| target.bytes())
    }

    /// Takes a picture that the device has finished, and the times that have come in.
    pub(crate) fn land(&mut self, engine: &Engine) {
        if let Some(taken) = self.in_flight.take_if(|done| done.get().is_some()) {
            if let Some((_, ms)) = self.drawing.as_mut().and_then(|drawing| drawing.last.as_mut()) {
                *ms = taken.get().copied().unwrap_or_default();
            }
            if let Some(drawing) = self.drawing.take_if(|drawing| drawing.given == drawing.steps) {
                self.picture_ms = Some(drawing.start.elapsed().as_secs_f64() * 1e3);
                self.pass_times_hold = drawing.steps == 1;
                self.whole_ms = self.begun.take().map(|begun| begun.elapsed().as_secs_f64() * 1e3).or(self.whole_ms);
                self.drawn = Some(drawing.wanted);
                self.shows = Some(drawing.wanted.document);
                self.before = None;
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

    /// Makes a target of this size, if there is none yet.
    pub(crate) fn fit(&mut self, painting: &WindowPipelines, engine: &Engine, size: [u32; 2]) -> Result<(), GpuError> {
        if self.target.as_ref().is_some_and(|(target, _)| target.size == size) {
            return Ok(());
        }
        let target = Target::new(&engine.gpu, size)?;
        if self.drawn.take().is_some() {
            self.before = self.target.take().map(|(_, shown)| shown);
        }
        let shown = ShownPicture::new(painting, &engine.gpu, &target, wgpu::FilterMode::Nearest);
        self.target = Some((target, shown));
        self.drawing = None;
        Ok(())
    }

    /// What is shown: the picture, or until it is drawn for the first time in this size the one before it. None before the first
    /// picture.
    pub(crate) fn shown(&self) -> Option<&ShownPicture> {
        let drawn = self.target.as_ref().filter(|_| self.drawn.is_some());
        drawn.map(|(_, shown)| shown).or(self.before.as_ref())
    }

    /// Draws what is wanted, if it isn't drawn yet and the device is free, in steps that keep the device busy for about so many ms
    /// at once. The counts come back first; until then, and until all steps are drawn, the last picture stays.
    pub(crate) fn draw(
        &mut self,
        engine: &Engine,
        document: &mut Document,
        wanted: &PictureRequest,
        ms: f64,
    ) -> Result<(), GpuError> {
        self.counting = self.counting.filter(|counting| counting.document == document.generation);
        let mut keeps_on = |drawing: &mut Drawing| {
            drawing.wanted == *wanted || (drawing.steps <= self.short && drawing.wanted.document == document.generation)
        };
        self.drawing = self.drawing.take_if(&mut keeps_on);
        // Selecting something doesn't draw a picture whose drawing was cancelled.
        let same = |cancelled: &PictureRequest| {
            PictureRequest { lines: wanted.lines, deviation: wanted.deviation, ..*cancelled } == *wanted
        };
        self.cancelled = self.cancelled.filter(same);
        let under_way = self.drawing.as_ref().map(|drawing| drawing.wanted).or(self.counting);
        let wanted = under_way.unwrap_or(*wanted);
        if self.cancelled.is_some() {
            return Ok(());
        }
        let scene = &mut document.scene;
        if self.drawn != Some(wanted) {
            self.begun.get_or_insert_with(Instant::now);
        }
        let is_counted = self.count(scene, &wanted, under_way.is_none())?;
        if self.in_flight.is_some() || !is_counted {
            return Ok(());
        }
        self.counting = None;
        if self.drawn == Some(wanted) || self.holds(scene, &wanted) {
            return Ok(());
        }
        let Some((target, _)) = &mut self.target else { return Ok(()) };
        target.keep_only_for(&wanted.settings);
        let steps = Renderer::step_count(scene, &wanted.settings);
        let start = || Drawing { wanted, start: Instant::now(), given: 0, steps, last: None };
        let drawing = self.drawing.get_or_insert_with(start);
        let at_once = drawing.last.map_or(1, |(steps, taken)| next_steps(steps, taken, ms));
        let next = drawing.given..steps.min(drawing.given + at_once);
        (drawing.given, drawing.last) = (next.end, Some((next.len(), 0.0)));
        let mut recorder = Recorder::new(&engine.gpu, &mut self.timing);
        engine.renderer.draw_steps(&mut recorder, scene, target, &wanted.camera, &wanted.settings, next)?;
        let (done, start) = (Arc::new(OnceLock::new()), Instant::now());
        self.in_flight = Some(done.clone());
        recorder.submit();
        engine.gpu.queue.on_submitted_work_done(move || {
            let _ = done.set(start.elapsed().as_secs_f64() * 1e3);
        });
        Ok(())
    }

    /// Lets the device count what each half will emit, with the wanted inputs if `anew` is set. Returns true once the counts
    /// are known, and false while the left half is still being made.
    fn count(&mut self, scene: &mut Scene, wanted: &PictureRequest, anew: bool) -> Result<bool, GpuError> {
        let mut is_counted = true;
        for half in SplitSide::BOTH {
            let Some(inputs) = wanted.inputs_of(half) else { continue };
            let Some(scene) = scene.half_mut(half) else { return Ok(false) };
            let tessellator = &mut scene.tessellator;
            if anew {
                tessellator.set(&inputs)?;
            }
            if tessellator.count(&mut self.timing)? {
                self.counting = Some(*wanted);
            }
            is_counted &= self.in_flight.is_none() && tessellator.poll_counts()?;
        }
        Ok(is_counted)
    }

    /// Whether the last picture stays until the new one's deviation is known. It does so for an unchanged camera, where
    /// a picture without deviation would only flicker.
    fn holds(&self, scene: &Scene, wanted: &PictureRequest) -> bool {
        let from_here = |drawn: &PictureRequest| {
            (drawn.document, drawn.moment, drawn.camera) == (wanted.document, wanted.moment, wanted.camera)
        };
        let is_shown = |own: &Settings| own.overlays.colors.source() == ColorSource::ReferenceSurface;
        let shown = |half| wanted.settings.half(half).filter(is_shown).and(scene.half(half));
        let is_known = SplitSide::BOTH.into_iter().filter_map(shown).all(Scene::knows_deviation);
        // Nothing may be measured of a surface shader.
        wanted.from_files.surface == 0
            && self.drawing.is_none()
            && !is_known
            && self.drawn.as_ref().is_some_and(from_here)
    }

    /// Whether no picture is under way, so that the scene may change.
    pub(crate) fn is_free(&self) -> bool {
        self.drawing.is_none() && self.counting.is_none() && self.in_flight.is_none()
    }

    /// Whether a picture that isn't short is under way.
    pub(crate) fn is_long(&self) -> bool {
        self.drawing.as_ref().is_some_and(|drawing| drawing.steps > self.short)
    }

    /// Handles a picture that the device refused: it isn't drawn again by itself, nor shown, as it may be half drawn.
    pub(crate) fn refuse(&mut self, scene: &mut Scene, wanted: &PictureRequest) {
        (self.drawn, self.drawing, self.counting) = (None, None, None);
        self.cancelled = Some(*wanted);
        for half in SplitSide::BOTH {
            if let Some(scene) = scene.half_mut(half) {
                scene.tessellator.forget();
            }
        }
    }

    /// Stops drawing. The last picture stays until another one is wanted.
    pub(crate) fn cancel(&mut self) {
        self.cancelled = self.drawing.take().map(|drawing| drawing.wanted);
    }
}
