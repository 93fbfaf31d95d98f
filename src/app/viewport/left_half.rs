//! Left of the split: another surface of the mesh, made beside the window and only while it is shown, and what is known of it.

use std::time::{Duration, Instant};

use crate::app::App;
use crate::app::jobs::background_job::BackgroundJob;
use crate::app::jobs::deviation_job::DeviationJob;
use crate::app::jobs::document::arena_bytes;
use crate::app::jobs::measure_job::{MeasureJob, Trouble};
use crate::engine::Engine;
use crate::gpu::GpuError;
use crate::render::Scene;
use crate::settings::{Choice, SplitSide};
use crate::view::ScreenView;

/// What takes longer to make than this is said to be made.
const NOTICED: Duration = Duration::from_millis(300);

/// The left half's scene is the document's.
#[derive(Default)]
pub(crate) struct LeftHalf {
    making: Option<Making>,
    /// Counts scenes that were made; tells one from the next.
    pub made: u64,
    pub measuring: MeasureJob,
    pub deviating: DeviationJob,
}

/// A scene under way, on a thread of its own.
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

    /// Whether it takes so long to make that one wonders.
    pub(crate) fn takes_long(&self) -> bool {
        self.making.as_ref().is_some_and(|making| making.start.elapsed() > NOTICED)
    }

    /// Forgets what is known of a scene that is there no more.
    pub(crate) fn forget(&mut self) {
        self.making = None;
        self.measuring.forget();
        self.deviating.forget();
    }
}

impl App {
    /// Makes what is shown left of the split, or lets go of it, once no picture is under way that has it otherwise.
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
            Some(Ok(Ok(left))) => {
                self.viewport.left.made += 1;
                scene.set_left(Some(left))?;
            }
            None => self.viewport.left.making = Some(making),
            Some(Ok(Err(error))) => self.leave_as_it_came(&error.to_string()),
            Some(Err(stopped)) => self.leave_as_it_came(&format!("making it {stopped}")),
        }
        Ok(())
    }

    fn leave_as_it_came(&mut self, why: &str) {
        self.settings.split_surface = None;
        self.dialogs.error = Some(format!("no other surface can be shown left of the split: {why}"));
    }

    /// Measures the left half's cracks and the points of its edges as long as they are shown.
    pub(in crate::app) fn measure_left(&mut self, view: ScreenView) -> Result<(), Trouble> {
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
        self.viewport.left.measuring.go_on(&self.engine.gpu, scene, document.generation, view, false)?;
        Ok(())
    }

    /// What is known of a half.
    pub(in crate::app) fn measured(&self, half: SplitSide) -> &MeasureJob {
        match half {
            SplitSide::Left => &self.viewport.left.measuring,
            SplitSide::Right => &self.jobs.measure,
        }
    }

    /// What is written over a half of two surfaces: the method, and while that is shown how far off it is.
    pub(in crate::app) fn half_title(&self, half: SplitSide) -> Option<String> {
        let name = self.settings.half(half)?.tessellation.surface.label();
        Some(match self.largest_text(half) {
            Some(largest) => format!("{name}: {largest}"),
            None => name.to_owned(),
        })
    }
}

impl Making {
    fn start(context: &egui::Context, engine: &Engine, scene: &Scene, document: u64) -> Self {
        let (gpu, make) = (engine.gpu.clone(), scene.beside(arena_bytes(engine)));
        Self { document, start: Instant::now(), job: BackgroundJob::start(context, move || gpu.attempt(make)?) }
    }
}
