//! Opens meshes and loads them again. A new load cancels the one before it.

use std::path::PathBuf;

use super::document::{Load, NotLoaded};
use super::leak_job::LeakJob;
use super::measure_job::MeasureJob;
use super::silhouette_job::SilhouetteJob;
use crate::app::App;
use crate::engine::{Loaded, Preparation};
use crate::load::Source;
use crate::load::environment_file::is_environment;
use crate::load::format::Format;

impl App {
    /// Starts to load a mesh on a thread of its own; a load that is under way is cancelled. If it is the mesh that is open,
    /// it keeps its view and its preparation.
    pub fn open(&mut self, context: &egui::Context, source: Source) {
        let same = self.document.as_ref().filter(|document| document.loaded.source == source);
        let preparation = same.map(|document| document.loaded.preparation.clone());
        let keep_view = preparation.is_some();
        let preparation = preparation.unwrap_or_else(|| self.plain());
        self.jobs.load = Some(Load::start(&self.engine, context, source, preparation, self.settings, keep_view));
    }

    /// Loads the same mesh again after `change` has changed its preparation.
    pub fn prepare(&mut self, context: &egui::Context, change: impl FnOnce(&mut Preparation)) {
        let Some(Loaded { source, .. }) = self.document.as_ref().map(|document| &document.loaded) else { return };
        let mut preparation = self.preparation();
        change(&mut preparation);
        self.jobs.load = Some(Load::start(&self.engine, context, source.clone(), preparation, self.settings, true));
    }

    /// The preparation of the mesh, or of the load of the same mesh that is under way.
    pub(in crate::app) fn preparation(&self) -> Preparation {
        let again = self.jobs.load.as_ref().filter(|load| load.keep_view).map(|load| &load.preparation);
        let shown = self.document.as_ref().map(|document| &document.loaded.preparation);
        again.or(shown).cloned().unwrap_or_else(|| self.plain())
    }

    /// A preparation that leaves the mesh as the file has it.
    fn plain(&self) -> Preparation {
        Preparation { limits: self.jobs.limits, ..Preparation::default() }
    }

    /// Loads the same mesh again; settings and camera stay.
    pub fn reload(&mut self, context: &egui::Context) {
        if let Some(source) = self.document.as_ref().map(|document| document.loaded.source.clone()) {
            self.open(context, source);
        }
    }

    pub(in crate::app) fn take_loaded(&mut self, context: &egui::Context) {
        // Framing the mesh needs the viewport's size, which is known after the first frame.
        if self.viewport.picture.target.is_none() {
            return;
        }
        let Some(load) = &mut self.jobs.load else { return };
        let Some(result) = load.take() else { return };
        let (keep_view, source, remark) = (load.keep_view, load.source.clone(), load.remark.take());
        self.jobs.load = None;
        match result {
            Ok(document) => {
                if !keep_view {
                    (self.viewport.frozen, self.viewport.ruler) = (None, None);
                    self.forget_truth();
                }
                self.panels.chart.stop();
                let title = format!("{} - pnaen", document.loaded.source.title());
                context.send_viewport_cmd(egui::ViewportCommand::Title(title));
                let scene = document.loaded.scene;
                let before = self.document.replace(document);
                // Scenes may be at different places, and of different sizes.
                let is_other_scene = before.as_ref().is_some_and(|before| before.loaded.scene != scene);
                if before.is_some() {
                    self.dialogs.error = None;
                }
                self.dialogs.error = remark.or(self.dialogs.error.take());
                self.take_heights(before.and_then(|document| document.loaded.preparation.heights).as_ref());
                self.keep_playback(keep_view);
                if !keep_view || is_other_scene {
                    self.frame();
                }
                self.look_as_before(keep_view);
                self.jobs.measure = MeasureJob::default();
                self.jobs.leaks = LeakJob::default();
                self.jobs.silhouette = SilhouetteJob::default();
                self.viewport.left.forget();
                self.viewport.preview.forget();
                self.keep_factors(context, keep_view);
                self.deselect();
            }
            Err(Some(NotLoaded { mut why, is_gone })) => {
                if is_gone && self.persistence.gone(&source) {
                    why += "; it was removed from the recent files";
                }
                self.dialogs.error = Some(why);
                // If the first file can't be loaded, the window shows its default mesh.
                if self.document.is_none() {
                    self.open(context, Source::default());
                }
            }
            // It was cancelled in the window, so no message is needed.
            Err(None) => {}
        }
    }

    /// Opens a file that is dropped on the window. Of several, it opens the first mesh, or else the first file, and the first
    /// environment beside it.
    pub(in crate::app) fn take_dropped(&mut self, context: &egui::Context) {
        let dropped: Vec<PathBuf> =
            context.input(|input| input.raw.dropped_files.iter().map(|file| file.path().to_owned()).collect());
        let (environments, others): (Vec<_>, Vec<_>) = dropped.into_iter().partition(|path| is_environment(path));
        if let Some(path) = environments.into_iter().next() {
            self.open_environment(context, path);
        }
        let mesh = others.iter().find(|path| Format::of_name(path).is_some());
        let Some(path) = mesh.or(others.first()) else { return };
        self.open_path(context, path.clone());
        if let Some(load) = self.jobs.load.as_mut().filter(|_| others.len() > 1) {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            load.remark =
                Some(format!("{} files were dropped. Only one can be open, so {name} was opened.", others.len()));
        }
    }
}
