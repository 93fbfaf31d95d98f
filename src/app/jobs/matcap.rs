//! A picture of a lit sphere from a file, in place of those that are made in code.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::companion_files::{OpenFile, absolute_path};
use super::job_list::Work;
use crate::app::App;
use geometry::names::shown_path;
use inspect::settings::Colors;
use load::load_matcap;

impl App {
    /// Starts to read a picture of a lit sphere, which the surface then shows. Until it is read, all stays as it is.
    pub fn open_matcap(&mut self, context: &egui::Context, path: PathBuf) {
        let path = absolute_path(path);
        let (wanted, limits, what) = (path.clone(), self.jobs.limits, shown_path(&path));
        let read = move |_: &_| load_matcap(&wanted, &limits).map_err(|error| error.to_string());
        self.read_companion(context, Work::Matcap, String::new(), what, read, |app, picture| {
            app.matcap = Some(OpenFile::new(path, Arc::new(picture)));
            app.settings.overlays.colors = Colors::Matcap;
        });
    }

    /// The file of the picture of a lit sphere, if one was opened.
    pub fn matcap_image(&self) -> Option<&Path> {
        self.matcap.as_ref().map(|chosen| &*chosen.path)
    }

    /// Goes back to the lit spheres that are made in code.
    pub(in crate::app) fn forget_matcap(&mut self) {
        self.matcap = None;
        self.jobs.stop(Work::Matcap);
    }
}
