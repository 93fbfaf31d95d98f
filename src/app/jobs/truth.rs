//! What the mesh should have been: which truth it is held against, and its loading.

use std::sync::Arc;

use super::background_job::BackgroundJob;
use crate::app::App;
use crate::files::Limits;
use crate::load::{LoadError, Source};
use crate::progress::Progress;
use crate::settings::Colors;
use crate::tessellate::Displacement;
use crate::truth::Truth;

/// A truth that was chosen for the mesh.
pub(crate) struct Chosen {
    pub source: Source,
    truth: Arc<Truth>,
    /// Tells one from the next; never 0 or 1.
    generation: u64,
}

/// A truth under way; dropping it cancels it.
pub(crate) struct TruthLoad {
    pub source: Source,
    pub progress: Progress,
    /// None only while it changes hands.
    job: Option<BackgroundJob<Result<Chosen, Option<String>>>>,
}

impl TruthLoad {
    /// Loads on a thread of its own.
    fn start(context: &egui::Context, source: Source, limits: Limits) -> Self {
        static GENERATION: std::sync::atomic::AtomicU64 = std::sync::atomic::AtomicU64::new(2);
        let generation = GENERATION.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        let progress = Progress::new();
        let (wanted, own_progress) = (source.clone(), progress.clone());
        let load = move || match Truth::load(&wanted, &limits, &own_progress) {
            Ok(Some(truth)) => Ok(Chosen { source: wanted, truth: Arc::new(truth), generation }),
            Ok(None) => Err(Some(format!("{wanted} can't be a reference surface: it has no triangles"))),
            Err(LoadError::Cancelled(_)) => Err(None),
            Err(error) => Err(Some(error.to_string())),
        };
        Self { job: Some(BackgroundJob::start(context, load)), source, progress }
    }

    /// Goes on, and repaints another window when it ends.
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
    /// Starts to load what the mesh should have been beside the window; what it was held against before stays until then.
    pub fn open_truth(&mut self, context: &egui::Context, source: Source) {
        self.jobs.truth_load = Some(TruthLoad::start(context, source, self.jobs.limits));
    }

    /// The truth that was chosen for what is shown.
    pub fn truth(&self) -> Option<&Source> {
        self.truth.as_ref().map(|chosen| &chosen.source)
    }

    /// Goes back to what the mesh is held against by itself.
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
            // Cancelled by the person in front of the window, who knows.
            Err(None) => {}
        }
    }

    /// What is measured from, and what it is called. In a pose and displaced a mesh is none that a truth at rest knows of.
    pub(in crate::app) fn yardstick(&self) -> (u64, Option<Arc<Truth>>, String) {
        let limit = || (0, None, "its own limit".to_owned());
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
