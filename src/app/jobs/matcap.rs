//! A picture of a lit sphere from a file, in place of those that are made in code.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use super::background_job::BackgroundJob;
use crate::app::App;
use geometry::mesh::Texture;
use geometry::names::shown_path;
use inspect::settings::Colors;
use load::load_matcap;

/// A picture of a lit sphere that was opened.
pub(crate) struct ChosenMatcap {
    pub path: PathBuf,
    picture: Arc<Texture>,
    /// A number of its own for each, from 1 on.
    pub generation: u64,
}

/// Reading such a picture.
pub(crate) struct MatcapJob {
    path: PathBuf,
    job: BackgroundJob<Result<Texture, String>>,
}

impl ChosenMatcap {
    /// The file's name.
    pub(crate) fn name(&self) -> String {
        shown_path(Path::new(self.path.file_name().unwrap_or_default()))
    }

    pub(crate) fn picture(&self) -> Arc<Texture> {
        self.picture.clone()
    }
}

impl MatcapJob {
    /// Lets the job repaint another window when it ends.
    pub(crate) fn waking(self, context: &egui::Context) -> Self {
        Self { job: self.job.waking(context), ..self }
    }
}

impl App {
    /// Starts to read a picture of a lit sphere, which the surface then shows. Until it is read, all stays as it is.
    pub fn open_matcap(&mut self, context: &egui::Context, path: PathBuf) {
        // The copied command needs the whole path.
        let path = std::path::absolute(&path).unwrap_or(path);
        let (wanted, limits) = (path.clone(), self.jobs.limits);
        let read = move || load_matcap(&wanted, &limits).map_err(|error| error.to_string());
        self.jobs.matcap = Some(MatcapJob { path, job: BackgroundJob::start(context, read) });
    }

    /// The file of the picture of a lit sphere, if one was opened.
    pub fn matcap_image(&self) -> Option<&Path> {
        self.matcap.as_ref().map(|chosen| &*chosen.path)
    }

    /// Goes back to the lit spheres that are made in code.
    pub(in crate::app) fn forget_matcap(&mut self) {
        self.matcap = None;
        self.jobs.matcap = None;
    }

    /// Takes a picture that was read.
    pub(in crate::app) fn take_matcap(&mut self) {
        static GENERATION: AtomicU64 = AtomicU64::new(1);
        let Some(ended) = self.jobs.matcap.as_ref().and_then(|matcap| matcap.job.take()) else { return };
        let Some(MatcapJob { path, .. }) = self.jobs.matcap.take() else { return };
        match ended.unwrap_or_else(|stopped| Err(format!("reading {} {stopped}", shown_path(&path)))) {
            Ok(picture) => {
                let generation = GENERATION.fetch_add(1, Ordering::Relaxed);
                self.matcap = Some(ChosenMatcap { path, picture: Arc::new(picture), generation });
                self.settings.overlays.colors = Colors::Matcap;
            }
            Err(why) => self.dialogs.error = Some(why),
        }
    }

    /// Gives the scene the picture of a file, or takes it back, while no picture is under way. Returns the number of the one that
    /// the scene has; 0 for those that are made in code.
    pub(in crate::app) fn give_matcap(&mut self) -> u64 {
        let wanted = self.matcap.as_ref().map_or(0, |chosen| chosen.generation);
        let Some(document) = &mut self.document else { return 0 };
        if document.matcap != wanted && self.viewport.picture.is_free() {
            let upload = |chosen: &ChosenMatcap| self.engine.renderer.matcap(&chosen.picture);
            match self.matcap.as_ref().map(upload).transpose() {
                Ok(picture) => (document.scene.matcap, document.matcap) = (picture, wanted),
                Err(error) => {
                    (document.scene.matcap, document.matcap) = (None, 0);
                    self.forget_matcap();
                    self.dialogs.error = Some(error.to_string());
                    return 0;
                }
            }
        }
        document.matcap
    }
}
