//! The reference surface that the mesh is compared with, and the job that loads it.

use std::sync::Arc;

use super::background_job::BackgroundJob;
use crate::app::App;
use geometry::progress::Progress;
use geometry::tessellate::Displacement;
use inspect::settings::Colors;
use inspect::truth::Truth;
use load::files::Limits;
use load::{Import, LoadError, Source};

/// A reference surface that was chosen for the mesh.
pub(crate) struct ChosenTruth {
    pub source: Source,
    truth: Arc<Truth>,
    /// A number of its own for each one, from 2 on: see [`App::yardstick`].
    generation: u64,
}

/// The load of a reference surface. Dropping it cancels it.
pub(crate) struct TruthLoad {
    pub source: Source,
    pub progress: Progress,
    /// None only for a moment, inside [`Self::wake`].
    job: Option<BackgroundJob<Result<ChosenTruth, Option<String>>>>,
}

impl TruthLoad {
    /// Starts to load on a thread of its own.
    fn start(context: &egui::Context, source: Source, import: Import, limits: Limits) -> Self {
        static GENERATION: std::sync::atomic::AtomicU64 = std::sync::atomic::AtomicU64::new(2);
        let generation = GENERATION.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        let progress = Progress::new();
        let (wanted, own_progress) = (source.clone(), progress.clone());
        let load = move || match Truth::load(&wanted, import, &limits, &own_progress) {
            Ok(Some(truth)) => Ok(ChosenTruth { source: wanted, truth: Arc::new(truth), generation }),
            Ok(None) => Err(Some(format!("{wanted} can't be a reference surface: it has no triangles"))),
            Err(LoadError::Cancelled(_)) => Err(None),
            Err(error) => Err(Some(error.to_string())),
        };
        Self { job: Some(BackgroundJob::start(context, load)), source, progress }
    }

    /// Lets the job repaint another window when it ends.
    pub(in crate::app) fn wake(&mut self, context: &egui::Context) {
        self.job = self.job.take().map(|job| job.waking(context));
    }
}

impl Drop for TruthLoad {
    fn drop(&mut self) {
        self.progress.cancel();
    }
}

impl App {
    /// Starts to load a reference surface. Until it is loaded, the one before it stays.
    pub fn open_truth(&mut self, context: &egui::Context, source: Source) {
        self.jobs.truth_load = Some(TruthLoad::start(context, source, self.preparation().import, self.jobs.limits));
    }

    /// Loads a reference surface of a file again, which is turned and scaled as the mesh is.
    pub(in crate::app) fn follow_truth(&mut self, context: &egui::Context) {
        let chosen = self.truth.as_ref().map(|chosen| chosen.source.clone());
        if let Some(source @ (Source::File(_) | Source::Vase)) = chosen {
            self.open_truth(context, source);
        }
    }

    /// The reference surface that was chosen for the mesh.
    pub fn truth(&self) -> Option<&Source> {
        self.truth.as_ref().map(|chosen| &chosen.source)
    }

    /// Goes back to the default reference surface: the exact surface of a shape, or the limit surface.
    pub(in crate::app) fn forget_truth(&mut self) {
        self.truth = None;
        self.jobs.truth_load = None;
    }

    pub(in crate::app) fn take_truth(&mut self) {
        let Some(load) = &self.jobs.truth_load else { return };
        let Some(result) = load.job.as_ref().and_then(BackgroundJob::take) else { return };
        let stopped = |stopped| format!("{}: loading it {stopped}; the file may be damaged", load.source.title());
        let result = result.unwrap_or_else(|error| Err(Some(stopped(error))));
        self.jobs.truth_load = None;
        match result {
            Ok(chosen) => {
                self.truth = Some(chosen);
                self.settings.overlays.colors = Colors::Deviation;
            }
            Err(Some(error)) => self.dialogs.error = Some(error),
            // It was cancelled in the window, so no message is needed.
            Err(None) => {}
        }
    }

    /// The reference surface that distances are measured from: its number, the surface (none for the limit surface), and
    /// its name. The number is 0 for the limit surface, 1 for the exact surface, and from 2 on for a chosen one. In a pose it
    /// is always the limit surface, and an exact surface isn't used for a displaced mesh.
    pub(in crate::app) fn yardstick(&self) -> (u64, Option<Arc<Truth>>, String) {
        let limit = || (0, None, "limit surface".to_owned());
        let Some(document) = self.document.as_ref().filter(|_| self.viewport.playback.moment().is_none()) else {
            return limit();
        };
        if let Some(chosen) = &self.truth {
            return (chosen.generation, Some(chosen.truth.clone()), chosen.source.title());
        }
        let is_plain = self.settings.tessellation.displacement == Displacement::Off;
        match (&document.exact, document.loaded.source.shape()) {
            (Some(exact), Some(shape)) if is_plain => {
                (1, Some(exact.clone()), format!("exact {}", shape.title().to_lowercase()))
            }
            _ => limit(),
        }
    }
}
