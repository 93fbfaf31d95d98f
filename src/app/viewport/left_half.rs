//! The left half of a split view with another surface. Its scene is made on a thread of its own, and only while it is shown.

use std::time::{Duration, Instant};

use crate::app::App;
use crate::app::jobs::background_job::BackgroundJob;
use crate::app::jobs::deviation_job::DeviationJob;
use crate::app::jobs::document::arena_bytes;
use crate::app::jobs::measure_job::{MeasureJob, Results, Seen, Trouble};
use crate::app::jobs::own_shader_job::OpenShader;
use gpu::GpuError;
use inspect::engine::Engine;
use inspect::render::Scene;
use inspect::settings::{Choice, SplitSide};

/// Making a scene for longer than this is shown in the window.
const NOTICED: Duration = Duration::from_millis(300);

/// The state of the left half. The document has its scene.
#[derive(Default)]
pub(crate) struct LeftHalf {
    making: Option<Making>,
    /// Counts the scenes that were made.
    pub made: u64,
    pub measuring: MeasureJob,
    pub deviating: DeviationJob,
}

/// A scene that is being made on a thread of its own.
struct Making {
    document: u64,
    start: Instant,
    job: BackgroundJob<Result<Scene, GpuError>>,
}

impl LeftHalf {
    pub(crate) fn is_busy(&self) -> bool {
        self.making.is_some() || self.measuring.is_busy() || self.deviating.is_busy()
    }

    pub(crate) fn is_made(&self) -> bool {
        self.making.is_none()
    }

    /// Whether making the scene takes so long that the window should say so.
    pub(crate) fn takes_long(&self) -> bool {
        self.making.as_ref().is_some_and(|making| making.start.elapsed() > NOTICED)
    }

    /// Forgets the measurements of a scene that no longer exists.
    pub(crate) fn forget(&mut self) {
        self.making = None;
        self.measuring.forget();
        self.deviating.forget();
    }
}

impl App {
    /// Makes the left half's scene or drops it, as the settings want it. Waits until no picture is under way.
    pub(in crate::app) fn keep_left(&mut self, context: &egui::Context) -> Result<(), GpuError> {
        let Some(document) = self.document.as_mut().filter(|_| self.viewport.picture.is_free()) else { return Ok(()) };
        let scene = &mut document.scene;
        let is_wanted = self.settings.half(SplitSide::Left).is_some();
        if !is_wanted {
            self.viewport.left.making = None;
        }
        if is_wanted == scene.half(SplitSide::Left).is_some() {
            return Ok(());
        }
        if !is_wanted {
            self.viewport.left.forget();
            return scene.set_left(None);
        }
        let making = self.viewport.left.making.take().filter(|making| making.document == document.generation);
        let Some(making) = making else {
            self.viewport.left.forget();
            self.viewport.left.making = Some(Making::start(context, &self.engine, scene, document.generation));
            return Ok(());
        };
        match making.job.take() {
            Some(Ok(Ok(mut left))) => {
                // It shows a surface of ours.
                left.tessellator.set_surface_shader(None)?;
                self.viewport.left.made += 1;
                scene.set_left(Some(left))?;
            }
            None => self.viewport.left.making = Some(making),
            Some(Ok(Err(error))) => self.leave_as_it_came(&error.to_string()),
            Some(Err(stopped)) => self.leave_as_it_came(&format!("tessellating it {stopped}")),
        }
        Ok(())
    }

    fn leave_as_it_came(&mut self, why: &str) {
        self.settings.split_surface = None;
        self.dialogs.error = Some(format!("the left half can't show another surface: {why}"));
    }

    /// Measures the left half's cracks and the points of its edges while they are shown.
    pub(in crate::app) fn measure_left(&mut self, seen: &Seen) -> Result<(), Trouble> {
        let is_selected = self.viewport.selected_edge.is_some() || self.selected_triangle().is_some();
        let is_wanted = self.settings.half(SplitSide::Left).is_some() && (self.settings.overlays.cracks || is_selected);
        let Some(document) = self.document.as_mut() else { return Ok(()) };
        let left = document.scene.half_mut(SplitSide::Left).filter(|left| is_wanted && left.tessellator.is_counted());
        let Some(scene) = left else {
            if self.viewport.left.measuring.is_busy() {
                self.viewport.left.measuring.forget();
            }
            return Ok(());
        };
        self.viewport.left.measuring.go_on(&self.engine.gpu, scene, document.generation, seen)?;
        Ok(())
    }

    /// What was measured last. The panels show all of it together: while another picture is measured, that of the picture before. None
    /// while a clip plays, and if the picture isn't drawn: these aren't measured.
    pub(in crate::app) fn results(&self) -> Option<&Results> {
        let is_measured = !self.is_playing() && self.viewport.picture.cancelled.is_none();
        self.jobs.measure.last().filter(|_| is_measured)
    }

    /// The measurements of a half.
    pub(in crate::app) fn measured(&self, half: SplitSide) -> &MeasureJob {
        match half {
            SplitSide::Left => &self.viewport.left.measuring,
            SplitSide::Right => &self.jobs.measure,
        }
    }

    /// The title of a half if the split has two surfaces: the surface, and with the deviation overlay its largest deviation.
    pub(in crate::app) fn half_title(&self, half: SplitSide) -> Option<String> {
        let name = self.surface_title(half)?;
        Some(match self.largest_text(half) {
            Some(largest) => format!("{name}: {largest}"),
            None => name,
        })
    }

    /// What the surface of a half is called: as the list of surfaces has it, or a shader's file.
    pub(in crate::app) fn surface_title(&self, half: SplitSide) -> Option<String> {
        let chosen = self.settings.half(half)?.tessellation.surface.label().to_owned();
        let own = self.surface_shader.as_ref().filter(|open| open.is_used() && half == SplitSide::Right);
        Some(own.map_or(chosen, OpenShader::name))
    }
}

impl Making {
    fn start(context: &egui::Context, engine: &Engine, scene: &Scene, document: u64) -> Self {
        let (gpu, make) = (engine.gpu.clone(), scene.beside(arena_bytes(engine)));
        Self { document, start: Instant::now(), job: BackgroundJob::start(context, move || gpu.attempt(make)?) }
    }
}
