//! Left of the split: another surface of the mesh, made beside the window and only while it is shown, and what is known of it.

use std::time::{Duration, Instant};

use super::App;
use super::beside::Beside;
use super::deviating::Deviating;
use super::document::arena_bytes;
use super::measuring::{Measuring, Trouble};
use crate::engine::Engine;
use crate::gpu::GpuError;
use crate::render::Scene;
use crate::settings::{Choice, SplitSide};
use crate::view::ScreenView;

/// What takes longer to make than this is said to be made.
const NOTICED: Duration = Duration::from_millis(300);

/// The left half's scene is the document's.
#[derive(Default)]
pub struct Left {
    making: Option<Making>,
    /// Counts scenes that were made; tells one from the next.
    pub made: u64,
    pub measuring: Measuring,
    pub deviating: Deviating,
}

/// A scene under way, on a thread of its own.
struct Making {
    document: u64,
    start: Instant,
    job: Beside<Result<Scene, GpuError>>,
}

impl Left {
    pub fn is_busy(&self) -> bool {
        self.making.is_some() || self.measuring.is_busy() || self.deviating.is_busy()
    }

    pub fn is_made(&self) -> bool {
        self.making.is_none()
    }

    /// Whether it takes so long to make that one wonders.
    pub fn takes_long(&self) -> bool {
        self.making.as_ref().is_some_and(|making| making.start.elapsed() > NOTICED)
    }

    /// Forgets what is known of a scene that is there no more.
    pub fn forget(&mut self) {
        self.making = None;
        self.measuring.forget();
        self.deviating.forget();
    }
}

impl App {
    /// Makes what is shown left of the split, or lets go of it, once no picture is under way that has it otherwise.
    pub(super) fn keep_left(&mut self, context: &egui::Context) -> Result<(), GpuError> {
        let Some(document) = self.document.as_mut().filter(|_| self.viewport.is_free()) else { return Ok(()) };
        let scene = &mut document.scene;
        let is_wanted = self.settings.half(SplitSide::Left).is_some();
        if !is_wanted {
            self.left.making = None;
        }
        if is_wanted == scene.half(SplitSide::Left).is_some() {
            return Ok(());
        }
        if !is_wanted {
            self.left.forget();
            return scene.set_left(None);
        }
        let making = self.left.making.take().filter(|making| making.document == document.generation);
        let Some(making) = making else {
            self.left.forget();
            self.left.making = Some(Making::start(context, &self.engine, scene, document.generation));
            return Ok(());
        };
        match making.job.take() {
            Some(Ok(Ok(left))) => {
                self.left.made += 1;
                scene.set_left(Some(left))?;
            }
            None => self.left.making = Some(making),
            Some(Ok(Err(error))) => self.leave_as_it_came(&error.to_string()),
            Some(Err(stopped)) => self.leave_as_it_came(&format!("making it {stopped}")),
        }
        Ok(())
    }

    fn leave_as_it_came(&mut self, why: &str) {
        self.settings.split_surface = None;
        self.error = Some(format!("no other surface can be shown left of the split: {why}"));
    }

    /// Measures the left half's cracks and the points of its edges as long as they are shown.
    pub(super) fn measure_left(&mut self, view: ScreenView) -> Result<(), Trouble> {
        let is_selected = self.selected_edge.is_some() || self.selected_triangle().is_some();
        let is_wanted = self.settings.half(SplitSide::Left).is_some() && (self.settings.overlays.cracks || is_selected);
        let Some(document) = self.document.as_mut() else { return Ok(()) };
        let left = document.scene.half_mut(SplitSide::Left).filter(|left| is_wanted && left.tessellator.is_counted());
        let Some(scene) = left else {
            if self.left.measuring.is_busy() {
                self.left.measuring.forget();
            }
            return Ok(());
        };
        self.left.measuring.go_on(&self.engine.gpu, scene, document.generation, view, false)?;
        Ok(())
    }

    /// What is known of a half.
    pub(super) fn measured(&self, half: SplitSide) -> &Measuring {
        match half {
            SplitSide::Left => &self.left.measuring,
            SplitSide::Right => &self.measuring,
        }
    }

    /// What is written over a half of two surfaces: the method, and while that is shown how far off it is.
    pub(super) fn half_title(&self, half: SplitSide) -> Option<String> {
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
        Self { document, start: Instant::now(), job: Beside::start(context, move || gpu.attempt(make)?) }
    }
}
