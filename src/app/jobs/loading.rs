//! Opens meshes and loads them again. A new load cancels the one before it.

use std::path::PathBuf;
use std::sync::Arc;

use super::document::{Load, NotLoaded};
use super::leak_job::LeakJob;
use super::measure_job::MeasureJob;
use super::silhouette_job::SilhouetteJob;
use crate::app::App;
use inspect::engine::{Loaded, Preparation};
use inspect::render::Camera;
use inspect::settings::Settings;
use load::environment_file::is_environment;
use load::format::Format;
use load::{Import, Source};

impl App {
    /// Starts to load a mesh on a thread of its own; a load that is under way is cancelled. If it is the mesh that is open,
    /// it keeps its view and its preparation.
    pub fn open(&mut self, context: &egui::Context, source: Source) {
        let same = self.document.as_ref().filter(|document| document.loaded.source == source);
        let preparation = same.map(|document| document.loaded.preparation.clone());
        let keep_view = preparation.is_some();
        let preparation = preparation.unwrap_or_else(|| self.plain(&source));
        // It is about the file before.
        self.dialogs.notice = None;
        self.jobs.load = Some(Load::start(&self.engine, context, source, preparation, self.settings, keep_view));
    }

    /// Takes the mesh that is being opened as the command line says, instead of as it was kept.
    pub fn open_as(&mut self, context: &egui::Context, change: impl FnOnce(&mut Preparation)) {
        let Some(load) = self.jobs.load.as_ref() else { return };
        let (source, mut preparation) = (load.source.clone(), load.preparation.clone());
        change(&mut preparation);
        self.settings.import = preparation.import;
        self.jobs.load = Some(Load::start(&self.engine, context, source, preparation, self.settings, false));
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
        again.or(shown).cloned().unwrap_or_else(|| self.plain(&Source::default()))
    }

    /// A preparation that leaves the mesh as the file has it, but for normals, axis and unit that were chosen.
    fn plain(&self, source: &Source) -> Preparation {
        let import = self.persistence.import_of(source, &self.settings);
        Preparation { limits: self.jobs.limits, import, ..Preparation::default() }
    }

    /// Loads the mesh again if its normals, its axis, its unit or its hidden parts were changed, also by undo. While something is dragged,
    /// and while another mesh is being loaded, it waits.
    pub(in crate::app) fn follow_file_choices(&mut self, context: &egui::Context) {
        let opens_another = self.jobs.load.as_ref().is_some_and(|load| !load.keep_view);
        if self.document.is_none() || opens_another || context.egui_is_using_pointer() {
            return;
        }
        let (import, hidden) = (self.settings.import, self.hidden.clone());
        let wanted = |preparation: &Preparation| preparation.import == import && preparation.hidden == *hidden;
        if !wanted(&self.preparation()) {
            self.prepare(context, |preparation| {
                (preparation.import, preparation.hidden) = (import, hidden.to_vec());
            });
        }
    }

    /// Goes back to the normals, the axis, the unit and the hidden parts that the mesh has, after a load that came to nothing.
    pub(in crate::app) fn keep_file_choices(&mut self) {
        if let Some(document) = &self.document {
            self.settings.import = document.loaded.preparation.import;
            self.hidden = Arc::new(document.loaded.preparation.hidden.clone());
        }
    }

    /// Takes over the axis and the unit of a mesh that was opened. This isn't a step of undo, because it follows from the mesh.
    fn take_placement(&mut self) {
        let Some(document) = &self.document else { return };
        let Import { up, unit, .. } = document.loaded.preparation.import;
        let place = move |settings: &mut Settings| {
            (settings.import.up, settings.import.unit) = (up, unit);
        };
        place(&mut self.settings);
        self.history.change_all(|step| place(&mut step.settings));
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
                self.dialogs.typed = None;
                self.panels.chart.stop();
                let title = format!("{} - pnaen", document.loaded.source.title());
                context.send_viewport_cmd(egui::ViewportCommand::Title(title));
                let place = |loaded: &Loaded| (loaded.scene, loaded.preparation.import.placement());
                let placed = place(&document.loaded);
                let before = self.document.replace(document);
                // Scenes may be at different places, and of different sizes.
                let is_placed_anew = before.as_ref().is_some_and(|before| place(&before.loaded) != placed);
                let before_is_some = before.is_some();
                let is_turned = before.as_ref().is_some_and(|before| place(&before.loaded).1 != placed.1);
                if keep_view && is_turned {
                    (self.viewport.frozen, self.viewport.ruler) = (None, None);
                    self.follow_truth(context);
                }
                if before_is_some {
                    self.dialogs.error = None;
                }
                self.dialogs.error = remark.or(self.dialogs.error.take());
                self.take_heights(before.and_then(|document| document.loaded.preparation.heights).as_ref());
                if !keep_view {
                    self.take_placement();
                    self.take_preparation();
                }
                self.keep_playback(keep_view);
                if !keep_view && before_is_some {
                    self.face_another();
                }
                if !keep_view || is_placed_anew {
                    self.frame();
                }
                self.look_as_before(keep_view);
                self.viewport.opened = Some(self.viewport.camera);
                self.jobs.measure = MeasureJob::default();
                self.jobs.leaks = LeakJob::default();
                self.jobs.silhouette = SilhouetteJob::default();
                self.viewport.left.forget();
                self.viewport.preview.forget();
                self.keep_factors(context, keep_view);
                self.deselect();
                self.viewport.showing = None;
            }
            Err(Some(NotLoaded { mut why, is_gone })) => {
                if is_gone && self.persistence.gone(&source) {
                    why += "; it was removed from the recent files";
                }
                self.dialogs.error = Some(why);
                self.keep_file_choices();
                // If the first file can't be loaded, the window shows its default mesh.
                if self.document.is_none() {
                    self.open(context, Source::default());
                }
            }
            // It was cancelled in the window, so no message is needed.
            Err(None) => {}
        }
    }

    /// Looks at another mesh from the usual direction, without what only a first start has.
    fn face_another(&mut self) {
        self.viewport.camera = Camera::framing(&Default::default(), glam::Vec2::ONE);
        let import = self.settings.import;
        if self.settings == (Settings { import, ..Settings::greeting() }) {
            self.settings = Settings { import, ..Settings::opening() };
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
