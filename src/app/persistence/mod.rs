//! Settings, the window's size, recent files and their cameras, which are saved for the next window.

mod saved_settings;
mod saved_state;
mod state_file;
#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};

use egui::ViewportCommand;

use crate::app::App;
use crate::app::dialogs::Forgetting;
use crate::app::jobs::job_list::{Jobs, Work};
use crate::app::sections::OpenSections;
use crate::commands::CompanionFile;
use inspect::render::Camera;
use inspect::settings::Settings;
use load::{Import, Source};

use saved_state::{KEPT, MAX_FILES, Placement, SavedCamera, SavedFile, SavedState};

pub(super) use saved_state::{LEAST_SIZE, WindowGeometry};
pub(super) use state_file::folder;

/// How many recent files the menu lists.
const RECENT: usize = 10;
/// How long changes are collected before they are written, in s.
const REST: f64 = 3.0;

/// The saved state, and the job that writes it.
#[derive(Default)]
pub struct Persistence {
    /// The path of the file; none if nothing is saved.
    place: Option<PathBuf>,
    kept: SavedState,
    /// The state that the file has, or will have once it is written.
    written: SavedState,
    /// Since when `kept` differs from `written`, on the window's clock in s.
    pub(in crate::app) changed: Option<f64>,
    /// The problem with the file, which is shown only once.
    said: Option<String>,
}

impl Persistence {
    /// Reads the state that was saved in a folder. Without a folder nothing is read, and nothing will be saved.
    pub fn read(folder: Option<&Path>) -> Self {
        let Some(folder) = folder else { return Self::default() };
        let read = state_file::read(folder);
        Self { written: read.kept.clone(), ..read }
    }

    pub fn settings(&self) -> &Settings {
        &self.kept.settings
    }

    pub fn frame(&self) -> &WindowGeometry {
        &self.kept.frame
    }

    /// Paths of files that were opened last, the last one first.
    pub fn recent(&self) -> impl Iterator<Item = &str> {
        self.kept.files.iter().filter(|file| !file.is_gone).take(RECENT).map(|file| file.path.as_str())
    }

    /// Puts the file of an opened mesh at the front of the recent files. Returns the camera that the mesh was last seen
    /// with, if it still fits, and its bookmarks that fit.
    pub(in crate::app) fn opened(&mut self, source: &Source, diagonal: f32) -> (Option<Camera>, Vec<Camera>) {
        let Some(path) = path_of(source) else { return Default::default() };
        let files = &mut self.kept.files;
        let known = files.iter().position(|file| file.path == path);
        let mut file = known.map_or_else(|| SavedFile::new(path), |index| files.remove(index));
        file.is_gone = false;
        let camera = file.seen.and_then(|seen| seen.camera_for(diagonal));
        let bookmarks = file.bookmarks.iter().filter_map(|bookmark| bookmark.camera_for(diagonal)).collect();
        files.insert(0, file);
        files.truncate(MAX_FILES);
        (camera, bookmarks)
    }

    /// Returns how the geometry of a file is taken: as these settings say, with the axis and the unit that were chosen for the file.
    pub(in crate::app) fn import_of(&self, source: &Source, settings: &Settings) -> Import {
        let path = path_of(source);
        let known = self.kept.files.iter().find(|file| Some(&file.path) == path.as_ref());
        let Placement { up, unit } = known.map(|file| file.placement).unwrap_or_default();
        Import { up, unit, ..settings.import }
    }

    /// Removes a file that no longer exists from the list. Returns whether it was listed. Its camera is kept.
    pub(in crate::app) fn gone(&mut self, source: &Source) -> bool {
        self.known(source).is_some_and(|file| !std::mem::replace(&mut file.is_gone, true))
    }

    fn known(&mut self, source: &Source) -> Option<&mut SavedFile> {
        let path = path_of(source)?;
        self.kept.files.iter_mut().find(|file| file.path == path)
    }

    /// Writes changes once they have been collected for a while. The first failure is shown.
    fn write_on(&mut self, context: &egui::Context, jobs: &mut Jobs) {
        let Some(place) = &self.place else { return };
        if self.kept == self.written {
            self.changed = None;
            return;
        }
        let now = context.input(|input| input.time);
        let since = now - *self.changed.get_or_insert(now);
        if since < REST {
            context.request_repaint_after(std::time::Duration::from_secs_f64(REST - since));
        } else if !jobs.has(Work::State) {
            let (place, kept) = (place.clone(), self.kept.clone());
            self.written = kept.clone();
            let write = move |_: &_| state_file::write(&place, &kept);
            jobs.start(context, Work::State, String::new(), write, |app, _, ended| {
                let failed = ended.unwrap_or_else(|stopped| Err(format!("saving settings {stopped}"))).err();
                if failed.is_some() && app.persistence.said.is_none() {
                    app.persistence.said.clone_from(&failed);
                    app.dialogs.error = app.dialogs.error.take().or(failed);
                }
            });
        }
    }
}

/// The absolute path of a file, if it is valid UTF-8.
fn path_of(source: &Source) -> Option<String> {
    let Source::File(path) = source else { return None };
    Some(std::path::absolute(path).ok()?.to_str()?.to_owned())
}

/// The geometry of the window. While it is maximised, its size is the one that it goes back to.
fn frame_now(context: &egui::Context, before: &WindowGeometry) -> WindowGeometry {
    let (zoom, size) = (context.zoom_factor(), context.viewport_rect().size());
    let [is_maximized, is_fullscreen, is_minimized] = context.input(|input| {
        let window = input.viewport();
        [window.maximized, window.fullscreen, window.minimized].map(|is_so| is_so == Some(true))
    });
    // Rounded to whole points, so that a window that opens with this size has it exactly.
    let sized = [(size.x * zoom).round(), (size.y * zoom).round()];
    let is_large = sized.iter().zip(LEAST_SIZE).all(|(side, least)| *side >= least);
    let is_own = is_large && !(is_maximized || is_fullscreen || is_minimized);
    let theme = context.options(|options| options.theme_preference);
    WindowGeometry { size: if is_own { sized } else { before.size }, is_maximized, theme, zoom }
}

impl App {
    /// Takes over the state that the last window saved.
    pub fn resume(&mut self, context: &egui::Context, mut lasting: Persistence) {
        // A first start shows what it has to show.
        if lasting.kept.settings != Settings::opening() || !lasting.kept.files.is_empty() {
            self.settings = *lasting.settings();
            self.viewport.greets = false;
        }
        for ((companion, _), path) in KEPT.into_iter().zip(lasting.kept.companions.clone()) {
            match (companion, path) {
                (CompanionFile::Environment, Some(path)) => self.read_environment(context, path.into(), false),
                (CompanionFile::Environment, None) => self.cancel_environment(),
                (_, Some(path)) => self.open_companion(context, companion, Source::File(path.into())),
                (_, None) => {}
            }
        }
        self.panels.open = lasting.kept.open;
        let divider = self.settings.split.filter(|split| *split > 0.0 && *split < 1.0);
        self.viewport.last_split = divider.unwrap_or(self.viewport.last_split);
        context.set_theme(lasting.kept.frame.theme);
        context.set_zoom_factor(lasting.kept.frame.zoom);
        self.dialogs.error = lasting.said.take().or(self.dialogs.error.take());
        self.persistence = lasting;
        // The mesh that is being opened may have been turned or scaled before.
        let opening = self.jobs.load().filter(|load| !load.keep_view);
        let opening = opening.map(|load| (load.source.clone(), load.preparation.import));
        let is_otherwise =
            |(source, import): &(Source, Import)| self.persistence.import_of(source, &self.settings) != *import;
        if let Some((source, _)) = opening.filter(is_otherwise) {
            self.open(context, source);
        }
    }

    /// Sets the camera that the mesh was last seen with, if it is known. A mesh that was loaded again keeps its view.
    pub(in crate::app) fn look_as_before(&mut self, keep_view: bool) {
        let Some(document) = &self.document else { return };
        if keep_view {
            // It may have been gone before.
            return self.persistence.known(&document.loaded.source).into_iter().for_each(|file| file.is_gone = false);
        }
        let (camera, bookmarks) = self.persistence.opened(&document.loaded.source, document.diagonal);
        self.viewport.camera = camera.unwrap_or(self.viewport.camera);
        self.viewport.bookmarks = bookmarks;
        self.view_history = Default::default();
    }

    /// Saves the window's state. Called at the end of each frame.
    pub(in crate::app) fn keep(&mut self, context: &egui::Context) {
        let files = KEPT.map(|(companion, _)| match self.companion(companion) {
            Some(Source::File(path)) => path.to_str().map(str::to_owned),
            _ => None,
        });
        let settings = self.settings_without_files();
        let open = self.source().and_then(path_of);
        let kept = &mut self.persistence.kept;
        kept.take_settings(&settings);
        (kept.open, kept.companions) = (self.panels.open, files);
        kept.frame = frame_now(context, &kept.frame);
        let file = kept.files.iter_mut().find(|file| Some(&file.path) == open.as_ref());
        if let Some((file, document)) = file.zip(self.document.as_ref()) {
            let Import { up, unit, .. } = document.loaded.preparation.import;
            let saved = |&camera: &Camera| SavedCamera { camera, diagonal: document.diagonal };
            (file.placement, file.seen) = (Placement { up, unit }, Some(saved(&self.viewport.camera)));
            file.bookmarks = self.viewport.bookmarks.iter().map(saved).collect();
        }
        self.persistence.write_on(context, &mut self.jobs);
    }

    /// Writes the last changes when the window is closed.
    ///
    /// # Errors
    /// Why the file can't be written, as a sentence.
    pub(in crate::app) fn keep_for_good(&mut self) -> Result<(), String> {
        self.jobs.wait_for(Work::State);
        let Persistence { place, kept, written, .. } = &mut self.persistence;
        let Some(place) = place.as_ref().filter(|_| kept != written) else { return Ok(()) };
        written.clone_from(kept);
        state_file::write(place, kept)
    }

    /// Asks whether something that is saved should be forgotten.
    pub(in crate::app) fn forget_window(&mut self, context: &egui::Context) {
        let Some(forgetting) = self.dialogs.asks_to_forget else { return };
        let (title, text) = match forgetting {
            Forgetting::Everything => (
                "Forget all settings",
                "This forgets settings, theme, window size, recent files and their cameras, and can't be undone. The mesh stays \
                 open.",
            ),
            Forgetting::Bookmarks => {
                ("Forget bookmarks", "This forgets all bookmarks of this file, and can't be undone.")
            }
        };
        let window = egui::Window::new(title).resizable(false).collapsible(false);
        let window = window.anchor(egui::Align2::CENTER_CENTER, egui::Vec2::ZERO);
        let answer = window.show(context, |ui| {
            ui.set_max_width(320.0);
            ui.label(text);
            ui.horizontal(|ui| {
                let forgets = ui.button("Forget them").clicked();
                ui.button("Cancel").clicked().then_some(false).or(forgets.then_some(true))
            })
            .inner
        });
        let Some(forgets) = answer.and_then(|answer| answer.inner).flatten() else { return };
        self.dialogs.asks_to_forget = None;
        match forgetting {
            _ if !forgets => {}
            Forgetting::Everything => self.forget_all(context),
            Forgetting::Bookmarks => self.viewport.bookmarks.clear(),
        }
    }

    /// Goes back to the state of a first start. The mesh stays open, and is framed.
    fn forget_all(&mut self, context: &egui::Context) {
        let frame = WindowGeometry::default();
        // LOD, surface and light before them come back, and are reset as well.
        for (companion, _) in KEPT {
            self.close_companion(companion);
        }
        self.reset_settings();
        self.history = Default::default();
        self.view_history = Default::default();
        self.viewport.bookmarks.clear();
        self.panels.open = OpenSections::default();
        self.viewport.last_split = 0.5;
        self.viewport.frozen = None;
        self.viewport.camera = Camera::framing(&Default::default(), glam::Vec2::ONE);
        self.frame();
        context.set_theme(frame.theme);
        context.set_zoom_factor(frame.zoom);
        context.send_viewport_cmd(ViewportCommand::Maximized(frame.is_maximized));
        context.send_viewport_cmd(ViewportCommand::InnerSize(frame.size.into()));
        self.persistence.kept.files.clear();
    }
}
