//! What lasts: settings, the window's size, recent files and their cameras, kept from one window to the next.

mod saved_settings;
mod saved_state;
mod state_file;
#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};

use egui::ViewportCommand;

use crate::app::App;
use crate::app::jobs::background_job::BackgroundJob;
use crate::load::Source;
use crate::render::Camera;
use crate::settings::Settings;
use crate::tessellate::Tessellation;

use saved_state::{MAX_FILES, SavedCamera, SavedFile, SavedState};

pub(super) use saved_state::{LEAST_SIZE, WindowGeometry};
pub(super) use state_file::folder;

/// Files that are offered to be opened again.
const RECENT: usize = 10;
/// How long what changes is left to change on before it is written, in s.
const REST: f64 = 3.0;

/// What is kept, and its writing beside the window.
#[derive(Default)]
pub struct Persistence {
    /// None where nothing is kept.
    place: Option<PathBuf>,
    kept: SavedState,
    /// What the file holds, or will once it is written.
    written: SavedState,
    /// Since when that isn't what is kept, on the window's clock in s.
    changed: Option<f64>,
    writing: Option<BackgroundJob<Result<(), String>>>,
    /// What is wrong with the file; said once.
    said: Option<String>,
    /// The file that is open, among those that are kept.
    open: Option<String>,
}

impl Persistence {
    /// What was kept in a folder; without one nothing was, and nothing will be.
    pub fn read(folder: Option<&Path>) -> Self {
        let Some(folder) = folder else { return Self::default() };
        let state_file::Found { kept, place, said } = state_file::read(folder);
        Self { place, written: kept.clone(), kept, said, ..Self::default() }
    }

    /// What the window opens with.
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

    /// Another mesh is open: where it was last looked at from, if that is known and of use.
    pub(in crate::app) fn opened(&mut self, source: &Source, diagonal: f32) -> Option<Camera> {
        self.open = path_of(source);
        let path = self.open.clone()?;
        let files = &mut self.kept.files;
        let known = files.iter().position(|file| file.path == path);
        let mut file = known.map_or(SavedFile { path, seen: None, is_gone: false }, |index| files.remove(index));
        file.is_gone = false;
        let camera = file.seen.and_then(|seen| seen.camera_for(diagonal));
        files.insert(0, file);
        files.truncate(MAX_FILES);
        camera
    }

    /// A file is there no more: whether it leaves the list by that. Its camera is kept, should it come back.
    pub(in crate::app) fn gone(&mut self, source: &Source) -> bool {
        self.known(source).is_some_and(|file| !std::mem::replace(&mut file.is_gone, true))
    }

    /// A file was loaded again, which may have been gone meanwhile.
    pub(in crate::app) fn is_back(&mut self, source: &Source) {
        if let Some(file) = self.known(source) {
            file.is_gone = false;
        }
    }

    fn known(&mut self, source: &Source) -> Option<&mut SavedFile> {
        let path = path_of(source)?;
        self.kept.files.iter_mut().find(|file| file.path == path)
    }

    /// Takes what the window has by now.
    fn take(&mut self, context: &egui::Context, settings: &Settings, seen: Option<SavedCamera>) {
        self.kept.take_settings(settings);
        self.kept.frame = frame_now(context, &self.kept.frame);
        let open = self.kept.files.iter_mut().find(|file| Some(&file.path) == self.open.as_ref());
        if let Some((file, seen)) = open.zip(seen) {
            file.seen = Some(seen);
        }
    }

    /// Writes what has changed, once it has had time to change on. What went wrong with that is said once.
    fn write_on(&mut self, context: &egui::Context) -> Option<String> {
        let place = self.place.as_ref()?;
        if let Some(ended) = self.writing.as_ref().and_then(BackgroundJob::take) {
            self.writing = None;
            let failed = ended.unwrap_or_else(|stopped| Err(format!("keeping settings {stopped}"))).err();
            if failed.is_some() && self.said.is_none() {
                self.said.clone_from(&failed);
                return failed;
            }
        }
        if self.kept == self.written {
            self.changed = None;
            return None;
        }
        let now = context.input(|input| input.time);
        let since = now - *self.changed.get_or_insert(now);
        if since < REST {
            context.request_repaint_after(std::time::Duration::from_secs_f64(REST - since));
        } else if self.writing.is_none() {
            let (place, kept) = (place.clone(), self.kept.clone());
            self.written = kept.clone();
            self.writing = Some(BackgroundJob::start(context, move || state_file::write(&place, &kept)));
        }
        None
    }

    /// Goes on in another window, by its clock.
    pub(in crate::app) fn go_on_in(&mut self, context: &egui::Context) {
        self.changed = None;
        self.writing = self.writing.take().map(|writing| writing.waking(context));
    }

    /// Writes what is left to be written.
    ///
    /// # Errors
    /// What and why, in a sentence.
    fn finish(&mut self) -> Result<(), String> {
        let Some(place) = &self.place else { return Ok(()) };
        if let Some(writing) = self.writing.take() {
            writing.wait();
        }
        if self.kept == self.written {
            return Ok(());
        }
        self.written = self.kept.clone();
        state_file::write(place, &self.kept)
    }
}

/// What files are known by: their absolute path, if it can be written down.
fn path_of(source: &Source) -> Option<String> {
    let Source::File(path) = source else { return None };
    Some(std::path::absolute(path).ok()?.to_str()?.to_owned())
}

/// The window as it is; while it is maximised it keeps the size that it goes back to.
fn frame_now(context: &egui::Context, before: &WindowGeometry) -> WindowGeometry {
    let (zoom, size) = (context.zoom_factor(), context.viewport_rect().size());
    let window = context.input(|input| {
        let window = input.viewport();
        (window.maximized.unwrap_or(false), window.fullscreen.unwrap_or(false), window.minimized.unwrap_or(false))
    });
    let (is_maximized, is_fullscreen, is_minimized) = window;
    // Whole points, which a window that opens with them has again.
    let sized = [(size.x * zoom).round(), (size.y * zoom).round()];
    let is_large = sized.iter().zip(LEAST_SIZE).all(|(side, least)| *side >= least);
    let is_own = is_large && !(is_maximized || is_fullscreen || is_minimized);
    let theme = context.options(|options| options.theme_preference);
    WindowGeometry { size: if is_own { sized } else { before.size }, is_maximized, theme, zoom }
}

impl App {
    /// Goes on where the last window ended: with its settings, and with the camera of the file that is being opened.
    pub fn resume(&mut self, context: &egui::Context, mut lasting: Persistence) {
        self.settings = *lasting.settings();
        self.viewport.last_split = self.settings.split.unwrap_or(self.viewport.last_split);
        context.set_theme(lasting.kept.frame.theme);
        context.set_zoom_factor(lasting.kept.frame.zoom);
        self.dialogs.error = lasting.said.take().or(self.dialogs.error.take());
        self.persistence = lasting;
    }

    /// Takes the camera that the mesh was last looked at with, where that is known; one that was loaded again keeps the view.
    pub(in crate::app) fn look_as_before(&mut self, keep_view: bool) {
        let Some(document) = &self.document else { return };
        if keep_view {
            return self.persistence.is_back(&document.loaded.source);
        }
        let camera = self.persistence.opened(&document.loaded.source, document.diagonal);
        self.viewport.camera = camera.unwrap_or(self.viewport.camera);
    }

    /// Keeps what the window has by now; called once a frame, when all that it does is done.
    pub(in crate::app) fn keep(&mut self, context: &egui::Context) {
        let diagonal = self.document.as_ref().map(|document| document.diagonal);
        let seen = diagonal.map(|diagonal| SavedCamera { camera: self.viewport.camera, diagonal });
        self.persistence.take(context, &self.settings, seen);
        let failed = self.persistence.write_on(context);
        self.dialogs.error = self.dialogs.error.take().or(failed);
    }

    /// Writes what was changed last, when the window is closed.
    pub(in crate::app) fn keep_for_good(&mut self) -> Result<(), String> {
        self.persistence.finish()
    }

    /// Asks whether everything that is kept is to be forgotten.
    pub(in crate::app) fn forget_window(&mut self, context: &egui::Context) {
        if !self.dialogs.asks_to_forget {
            return;
        }
        let window = egui::Window::new("Forget all settings").resizable(false).collapsible(false);
        let window = window.anchor(egui::Align2::CENTER_CENTER, egui::Vec2::ZERO);
        let answer = window.show(context, |ui| {
            ui.set_max_width(320.0);
            ui.label("Settings, theme, size, recent files and their cameras: there is no way back. The mesh stays.");
            ui.horizontal(|ui| {
                let forgets = ui.button("Forget them").clicked();
                ui.button("Cancel").clicked().then_some(false).or(forgets.then_some(true))
            })
            .inner
        });
        let Some(forgets) = answer.and_then(|answer| answer.inner).flatten() else { return };
        self.dialogs.asks_to_forget = false;
        if forgets {
            self.forget_all(context);
        }
    }

    /// Goes back to how the window first opened; the mesh stays, and is framed.
    fn forget_all(&mut self, context: &egui::Context) {
        let frame = WindowGeometry::default();
        self.settings = Settings::opening().with(Tessellation {
            displacement: self.settings.tessellation.displacement,
            ..Settings::opening().tessellation
        });
        self.history = Default::default();
        self.viewport.last_split = 0.5;
        self.viewport.frozen = None;
        self.viewport.camera = Camera::framing(&Default::default(), glam::Vec2::ONE);
        self.frame();
        context.set_theme(frame.theme);
        context.set_zoom_factor(frame.zoom);
        context.send_viewport_cmd(ViewportCommand::Maximized(frame.is_maximized));
        context.send_viewport_cmd(ViewportCommand::InnerSize(frame.size.into()));
        self.persistence.kept.files.clear();
        self.persistence.open = None;
    }
}
