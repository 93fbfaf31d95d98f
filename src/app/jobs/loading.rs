//! Opening a mesh, and loading it again: one load at a time, the latest.

use std::path::PathBuf;

use super::document::{Load, NotLoaded};
use super::measure_job::MeasureJob;
use crate::app::App;
use crate::engine::{Loaded, Preparation};
use crate::export::ending;
use crate::load::Source;

/// Endings of the names of files that hold meshes.
pub(in crate::app) const MESHES: [&str; 5] = ["gltf", "glb", "obj", "stl", "ply"];

impl App {
    /// Starts to load a mesh beside the window; a load that is under way is cancelled. The mesh that is open keeps its
    /// view, and what was made of it.
    pub fn open(&mut self, context: &egui::Context, source: Source) {
        let same = self.document.as_ref().filter(|document| document.loaded.source == source);
        let preparation = same.map(|document| document.loaded.preparation.clone());
        let keep_view = preparation.is_some();
        let preparation = preparation.unwrap_or_else(|| self.plain());
        self.jobs.load = Some(Load::start(&self.engine, context, source, preparation, self.settings, keep_view));
    }

    /// Loads the same mesh again with something else made of it: `change` changes what is, or is on its way.
    pub fn prepare(&mut self, context: &egui::Context, change: impl FnOnce(&mut Preparation)) {
        let Some(Loaded { source, .. }) = self.document.as_ref().map(|document| &document.loaded) else { return };
        let mut preparation = self.preparation();
        change(&mut preparation);
        self.jobs.load = Some(Load::start(&self.engine, context, source.clone(), preparation, self.settings, true));
    }

    /// What is made of the mesh, or will be once it is loaded again.
    pub(in crate::app) fn preparation(&self) -> Preparation {
        let again = self.jobs.load.as_ref().filter(|load| load.keep_view).map(|load| &load.preparation);
        let shown = self.document.as_ref().map(|document| &document.loaded.preparation);
        again.or(shown).cloned().unwrap_or_else(|| self.plain())
    }

    /// Nothing is made of a mesh but what the file holds.
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
        // It is framed for the viewport, whose size the first frame tells.
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
                    self.viewport.frozen = None;
                    self.forget_truth();
                }
                self.panels.chart.stop();
                let title = format!("{} - pnaen", document.loaded.source.title());
                context.send_viewport_cmd(egui::ViewportCommand::Title(title));
                let before = self.document.replace(document);
                if before.is_some() {
                    self.dialogs.error = None;
                }
                self.dialogs.error = remark.or(self.dialogs.error.take());
                self.take_heights(before.and_then(|document| document.loaded.preparation.heights).as_ref());
                self.keep_playback(keep_view);
                if !keep_view {
                    self.frame();
                }
                self.look_as_before(keep_view);
                self.jobs.measure = MeasureJob::default();
                self.viewport.left.forget();
                self.deselect();
            }
            Err(Some(NotLoaded { mut why, is_gone })) => {
                if is_gone && self.persistence.gone(&source) {
                    why += "; it isn't listed as recent any more";
                }
                self.dialogs.error = Some(why);
                // A window shows something, also if the first file can't be.
                if self.document.is_none() {
                    self.open(context, Source::default());
                }
            }
            // Cancelled by the person in front of the window, who knows.
            Err(None) => {}
        }
    }

    /// Opens what is dropped on the window: one file, the first that can be a mesh, or else the first.
    pub(in crate::app) fn take_dropped(&mut self, context: &egui::Context) {
        let dropped: Vec<PathBuf> =
            context.input(|input| input.raw.dropped_files.iter().map(|file| file.path().to_owned()).collect());
        let mesh = dropped.iter().find(|path| MESHES.contains(&ending(path).as_str()));
        let Some(path) = mesh.or(dropped.first()) else { return };
        self.open_path(context, path.clone());
        if let Some(load) = self.jobs.load.as_mut().filter(|_| dropped.len() > 1) {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            load.remark =
                Some(format!("Of {} files that were dropped only {name} is open: one is at a time.", dropped.len()));
        }
    }
}
