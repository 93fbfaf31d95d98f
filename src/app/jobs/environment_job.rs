//! The file whose light shines on the mesh, and the job that reads it.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::companion_files::{OpenFile, absolute_path, file_name};
use super::job_list::Work;
use crate::app::App;
use geometry::names::shown_path;
use geometry::progress::Progress;
use inspect::render::environment::Environment;
use inspect::settings::Lighting;
use load::environment_file::EnvironmentFile;

pub(crate) struct Light {
    /// What was repaired, in sentences.
    pub warnings: Vec<String>,
    /// On the device.
    pub environment: Arc<Environment>,
}

impl App {
    /// Starts to read the light of a file, which then shines on the mesh. Until it is read, the light before it stays.
    pub fn open_environment(&mut self, context: &egui::Context, path: PathBuf) {
        self.read_environment(context, path, true);
    }

    /// The same; `is_chosen` says whether the file's light shines once it is read.
    pub(in crate::app) fn read_environment(&mut self, context: &egui::Context, path: PathBuf, is_chosen: bool) {
        let path = absolute_path(path);
        let (wanted, limits, gpu) = (path.clone(), self.jobs.limits, self.engine.gpu.clone());
        let read = move |progress: &Progress| {
            let part = progress.part(0.0, 0.8);
            let EnvironmentFile { panorama, warnings } =
                EnvironmentFile::load(&wanted, &limits, &part).map_err(|error| error.to_string())?;
            let no_room = |error| format!("{}: {error}", shown_path(&wanted));
            let environment = Arc::new(Environment::from_panorama(&gpu, panorama).map_err(no_room)?);
            Ok(Light { warnings, environment })
        };
        self.jobs.light = Some(path.clone());
        let title = format!("Reading the light of {}", file_name(&path));
        self.read_companion(context, Work::Light, title, shown_path(&path), read, move |app, light| {
            app.environment = Some(OpenFile::new(path, light));
            if is_chosen {
                app.settings.lighting = Lighting::Environment;
            }
        });
    }

    /// The file whose light is open, or else the one that is being read.
    pub fn environment_file(&self) -> Option<&Path> {
        let open = self.environment.as_ref().map(|open| &*open.path);
        open.or(self.jobs.light.as_deref().filter(|_| self.jobs.has(Work::Light)))
    }

    /// Closes the file. Where its light shone, the studio's does.
    pub(in crate::app) fn close_environment(&mut self) {
        self.environment = None;
        self.cancel_environment();
    }

    /// Stops reading a file. The light before it stays.
    pub(in crate::app) fn cancel_environment(&mut self) {
        self.jobs.stop(Work::Light);
        if self.environment.is_none() && self.settings.lighting == Lighting::Environment {
            self.settings.lighting = Lighting::Studio;
        }
    }
}
