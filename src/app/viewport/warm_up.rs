//! Draws a preview once, out of sight, while the window has nothing else to do. A software driver compiles a shader when it first
//! draws with it, which takes the better part of a second: the first drag must not wait for that.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use super::picture::PictureRequest;
use super::preview::{Shape, count, draw};
use crate::app::App;
use crate::app::jobs::background_job::BackgroundJob;
use crate::app::jobs::job_list::Work;
use crate::app::jobs::scenes::arena_bytes;
use gpu::GpuError;
use inspect::engine::Engine;
use inspect::render::{DraftPipelines, Scene, Target};
use inspect::settings::Settings;

/// The window must have had nothing to do for so long.
const IDLE: Duration = Duration::from_millis(300);
/// How often it is looked whether the driver is done.
const LOOK: Duration = Duration::from_millis(30);
/// Width and height of the picture, in px. What a driver compiles doesn't depend on it.
const SIDE: u32 = 64;

/// What has been drawn before the camera moved, and what is under way.
#[derive(Default)]
pub(crate) struct WarmUp {
    /// The mesh, and the pipelines of its previews that were drawn with. What could not be drawn isn't tried again.
    done: (u64, Vec<DraftPipelines>),
    /// Since when the window has had nothing to do.
    idle: Option<Instant>,
    step: Option<Step>,
    /// How many pictures have been drawn.
    pub drawings: u64,
}

enum Step {
    /// A scene of its own is made, since that of the window keeps the triangles of its picture.
    Making(BackgroundJob<Result<Scene, GpuError>>, PictureRequest),
    Counting(Box<Scene>, PictureRequest),
    /// Set once the device has finished the picture.
    Drawing(Arc<AtomicBool>),
}

impl WarmUp {
    pub(crate) fn is_busy(&self) -> bool {
        self.step.is_some()
    }

    /// Ends, since the camera moves already.
    pub(super) fn give_way(&mut self) {
        (self.step, self.idle) = (None, None);
    }

    /// Whether the window has had nothing to do for long enough. If not, it is looked again when that may be so.
    fn has_rested(&mut self, context: &egui::Context) -> bool {
        let idle = self.idle.get_or_insert_with(Instant::now).elapsed();
        if let Some(left) = IDLE.checked_sub(idle) {
            context.request_repaint_after(left);
        }
        idle >= IDLE
    }

    /// Goes on with what is under way. Returns what is next.
    fn go_on(&mut self, context: &egui::Context, engine: &Engine, step: Step) -> Result<Option<Step>, GpuError> {
        match step {
            Step::Making(job, wanted) => match job.take() {
                None => Ok(Some(Step::Making(job, wanted))),
                Some(Ok(scene)) => {
                    context.request_repaint();
                    Ok(Some(Step::Counting(Box::new(scene?), wanted)))
                }
                // Previews do without.
                Some(Err(_)) => Ok(None),
            },
            Step::Counting(mut scene, wanted) => {
                context.request_repaint();
                if !count(&mut scene, &wanted)? {
                    return Ok(Some(Step::Counting(scene, wanted)));
                }
                self.drawings += 1;
                let target = Target::draft(&engine.gpu, [SIDE; 2])?;
                draw(engine, &mut scene, &target, &wanted).map(|done| Some(Step::Drawing(done)))
            }
            Step::Drawing(done) if done.load(Ordering::Acquire) => Ok(None),
            Step::Drawing(done) => {
                context.request_repaint_after(LOOK);
                Ok(Some(Step::Drawing(done)))
            }
        }
    }
}

impl App {
    /// Draws the preview that a drag would begin with, once for each mesh and pipelines, if the window shows the full picture and has
    /// nothing else to do. Drivers of graphics cards compile when a pipeline is made, and fast, so that nothing is done for these.
    pub(super) fn warm_up(&mut self, context: &egui::Context, full: &PictureRequest) {
        if !self.engine.gpu.is_software() {
            return;
        }
        if let Some(step) = self.viewport.warm_up.step.take() {
            let warm_up = &mut self.viewport.warm_up;
            // What fails here fails again in a preview, which says so.
            let next = self.engine.gpu.attempt(|| warm_up.go_on(context, &self.engine, step));
            warm_up.step = next.and_then(|next| next).unwrap_or_default();
            return;
        }
        let is_idle = !self.is_busy() && !self.is_playing() && self.viewport.picture.drawn.as_ref() == Some(full);
        if !is_idle || !self.viewport.preview.is_due(&self.viewport.picture) {
            self.viewport.warm_up.idle = None;
            return;
        }
        if !self.viewport.warm_up.has_rested(context) {
            return;
        }
        let Some((wanted, shape)) = self.cheaper_picture(context, full) else { return };
        let Some(document) = self.document.as_mut().filter(|_| !self.jobs.has(Work::StandIn)) else { return };
        let scene = match (shape, document.stand_in.scene()) {
            (Shape::StandIn, Some(stand_in)) => stand_in,
            _ => &mut document.scene,
        };
        // The scene has no left half, whose pipelines are those of the right one.
        let settings = Settings { split: None, ..wanted.settings };
        let pipelines = self.engine.renderer.draft_pipelines(scene, &settings);
        let warm_up = &mut self.viewport.warm_up;
        if warm_up.done.0 != document.generation {
            warm_up.done = (document.generation, Vec::new());
        }
        if warm_up.done.1.contains(&pipelines) {
            return;
        }
        warm_up.done.1.push(pipelines.clone());
        let (engine, make) = (self.engine.clone(), scene.sibling(arena_bytes(&self.engine)));
        let make = move || -> Result<Scene, GpuError> {
            engine.renderer.prepare_draft(&pipelines)?;
            engine.gpu.attempt(make)?
        };
        warm_up.step = Some(Step::Making(BackgroundJob::start(context, make), PictureRequest { settings, ..wanted }));
    }
}
