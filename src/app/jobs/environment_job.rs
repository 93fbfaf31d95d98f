//! The file whose light shines on the mesh, and the job that reads it.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use super::background_job::BackgroundJob;
use crate::app::App;
use geometry::names::shown_path;
use geometry::progress::Progress;
use inspect::render::environment::Environment;
use inspect::settings::Lighting;
use load::environment_file::{EnvironmentError, EnvironmentFile};

/// A file of light that is open.
pub(crate) struct OpenEnvironment {
    /// Absolute.
    pub path: PathBuf,
    /// What was repaired, in sentences.
    pub warnings: Vec<String>,
    /// On the device.
    pub environment: Arc<Environment>,
    /// A number of its own for each, from 1 on.
    generation: u64,
}

/// A file of light that is being read. Dropping it cancels it.
pub(crate) struct EnvironmentLoad {
    /// Absolute.
    pub path: PathBuf,
    pub progress: Progress,
    /// Whether the mesh is lit by it once it is read.
    is_chosen: bool,
    /// No light, and no reason, if it was cancelled.
    job: BackgroundJob<Result<OpenEnvironment, Option<String>>>,
}

impl Drop for EnvironmentLoad {
    fn drop(&mut self) {
        self.progress.cancel();
    }
}

/// The file's name without its folder.
pub(crate) fn file_name(path: &Path) -> String {
    shown_path(Path::new(path.file_name().unwrap_or(path.as_os_str())))
}

impl App {
    /// Starts to read the light of a file, which then shines on the mesh. Until it is read, the light before it stays.
    pub fn open_environment(&mut self, context: &egui::Context, path: PathBuf) {
        self.read_environment(context, path, true);
    }

    /// The same; `is_chosen` says whether the file's light shines once it is read.
    pub(in crate::app) fn read_environment(&mut self, context: &egui::Context, path: PathBuf, is_chosen: bool) {
        static GENERATION: AtomicU64 = AtomicU64::new(1);
        let generation = GENERATION.fetch_add(1, Ordering::Relaxed);
        // The copied command, and the next window, need the whole path.
        let path = std::path::absolute(&path).unwrap_or(path);
        let progress = Progress::new();
        let (wanted, own_progress, limits) = (path.clone(), progress.clone(), self.jobs.limits);
        let gpu = self.engine.gpu.clone();
        let read = move || {
            let part = own_progress.part(0.0, 0.8);
            let EnvironmentFile { panorama, warnings } =
                EnvironmentFile::load(&wanted, &limits, &part).map_err(|error| match error {
                    EnvironmentError::Cancelled(_) => None,
                    error => Some(error.to_string()),
                })?;
            let no_room = |error| Some(format!("{}: {error}", shown_path(&wanted)));
            let environment = Arc::new(Environment::of_panorama(&gpu, panorama).map_err(no_room)?);
            Ok(OpenEnvironment { path: wanted, warnings, environment, generation })
        };
        let job = BackgroundJob::start(context, read);
        self.jobs.environment = Some(EnvironmentLoad { path, progress, is_chosen, job });
    }

    /// The file whose light is open, or else the one that is being read.
    pub fn environment_file(&self) -> Option<&Path> {
        let open = self.environment.as_ref().map(|open| &*open.path);
        open.or(self.jobs.environment.as_ref().map(|load| &*load.path))
    }

    /// Closes the file. Where its light shone, the studio's does.
    pub(in crate::app) fn close_environment(&mut self) {
        self.environment = None;
        self.cancel_environment();
    }

    /// Stops reading a file. The light before it stays.
    pub(in crate::app) fn cancel_environment(&mut self) {
        self.jobs.environment = None;
        if self.environment.is_none() && self.settings.lighting == Lighting::Environment {
            self.settings.lighting = Lighting::Studio;
        }
    }

    /// Takes the light of a file that was read.
    pub(in crate::app) fn take_environment(&mut self) {
        let Some(ended) = self.jobs.environment.as_ref().and_then(|load| load.job.take()) else { return };
        let Some(load) = self.jobs.environment.take() else { return };
        let stopped = |stopped| Err(Some(format!("{}: reading it {stopped}", shown_path(&load.path))));
        match ended.unwrap_or_else(stopped) {
            Ok(open) => {
                self.environment = Some(open);
                if load.is_chosen {
                    self.settings.lighting = Lighting::Environment;
                }
            }
            Err(why) => {
                self.cancel_environment();
                self.dialogs.error = why.or(self.dialogs.error.take());
            }
        }
    }

    /// Gives the scene the light of the file while no picture is under way. Returns the number of the one that the picture has, or
    /// 0 if it has none.
    pub(in crate::app) fn give_environment(&mut self) -> u64 {
        let wanted = self.environment_wanted();
        let Some(document) = &mut self.document else { return 0 };
        if document.environment != wanted && self.viewport.picture.is_free() {
            let open = self.environment.as_ref().filter(|_| wanted > 0);
            document.scene.set_environment(open.map(|open| open.environment.clone()));
            document.environment = wanted;
        }
        document.environment
    }

    /// The number of the file whose light the picture should have; 0 for none.
    pub(in crate::app) fn environment_wanted(&self) -> u64 {
        let is_used = self.settings.lighting == Lighting::Environment;
        self.environment.as_ref().filter(|_| is_used).map_or(0, |open| open.generation)
    }
}
