//! A path that is typed: the window that takes it, and keys that come before its field has the focus.

use std::path::Path;

use egui::text::{CCursor, CCursorRange};
use egui::{Event, Id, Key, TextEdit};

use super::desktop_dialog::Asked;
use crate::app::App;
use crate::app::jobs::background_job::BackgroundJob;
use crate::load::Source;
use crate::names::shown_path;

/// What a path is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Purpose {
    Open,
    Heights,
    Truth,
    SaveChart,
    SavePicture,
    ExportMesh,
}

/// A path that is being typed.
pub(crate) struct TypedPath {
    purpose: Purpose,
    path: String,
    /// Why it is to be typed, if something else was asked for.
    why: Option<&'static str>,
    /// What was typed before the field had the focus; none once it has had it.
    early: Option<Vec<Event>>,
}

/// The desktop's file dialog.
pub(crate) struct PendingDialog {
    pub purpose: Purpose,
    pub job: BackgroundJob<Asked>,
    /// When it was asked for, on the window's clock in s.
    pub since: f64,
    /// What was typed since, for the field that is there if no dialog is.
    pub early: Vec<Event>,
}

/// How soon a dialog that isn't there is known not to be, in s; until then nothing acts on what is typed.
const SOON: f64 = 0.5;

impl PendingDialog {
    pub(crate) fn is_new(&self, context: &egui::Context) -> bool {
        context.input(|input| input.time) - self.since < SOON
    }
}

/// Why a path is typed where a dialog was asked for.
const NO_DIALOG: &str = "This desktop has no file dialog (no portal, no zenity): type the path.";

impl Purpose {
    fn title(self) -> &'static str {
        match self {
            Self::Open => "Open path",
            Self::Heights => "Height image path",
            Self::Truth => "Reference surface path",
            Self::SaveChart => "Save chart",
            Self::SavePicture => "Save picture",
            Self::ExportMesh => "Export mesh",
        }
    }

    /// What may be typed.
    fn takes(self) -> &'static str {
        match self {
            Self::Open => "A .gltf, .glb, .obj, .stl or .ply file, shape:NAME, or a height image (.png, .jpg)",
            Self::Heights => "A .png or .jpg image",
            Self::Truth => "A .gltf, .glb, .obj, .stl or .ply file, shape:NAME",
            Self::SaveChart => "A new .svg, .png or .csv file",
            Self::SavePicture => "A new .png file",
            Self::ExportMesh => "A new .glb or .obj file",
        }
    }

    fn button(self) -> &'static str {
        match self {
            Self::Open | Self::Heights | Self::Truth => "Open",
            Self::SaveChart | Self::SavePicture => "Save",
            Self::ExportMesh => "Export",
        }
    }

    /// What is there before anything is typed.
    fn proposed(self, open: Option<&Source>) -> String {
        let title = open.map_or_else(|| "mesh".to_owned(), Source::title);
        match (self, open) {
            (Self::Open | Self::Truth, Some(Source::File(path))) => path.display().to_string(),
            (Self::Open | Self::Truth | Self::Heights, _) => String::new(),
            (Self::SaveChart, _) => absolute("chart.svg"),
            (Self::SavePicture, _) => absolute(&name_beside(&title, "-view.png")),
            (Self::ExportMesh, _) => absolute(&name_beside(&title, "-tessellated.glb")),
        }
    }
}

/// The path of a name in the working folder.
pub(crate) fn absolute(name: &str) -> String {
    std::path::absolute(name).map_or_else(|_| name.to_owned(), |path| path.display().to_string())
}

/// The name of a file that is made of a mesh of this title: without the title's own ending, and with this one.
pub(crate) fn name_beside(title: &str, ending: &str) -> String {
    let stem = Path::new(title).file_stem().unwrap_or_default().to_string_lossy();
    // A shape's title has a colon, which isn't for file names everywhere.
    stem.replace([':', '@', ' '], "-") + ending
}

/// What a person does in the window.
enum Answer {
    Accept,
    Cancel,
}

impl TypedPath {
    fn show(&mut self, context: &egui::Context) -> Option<Answer> {
        let window = egui::Window::new(self.purpose.title()).resizable(false).collapsible(false);
        let window = window.anchor(egui::Align2::CENTER_CENTER, egui::Vec2::ZERO);
        window.show(context, |ui| self.rows(ui)).and_then(|shown| shown.inner).flatten()
    }

    fn rows(&mut self, ui: &mut egui::Ui) -> Option<Answer> {
        if let Some(why) = self.why {
            ui.label(why);
        }
        let label = ui.label(self.purpose.takes());
        let edit = TextEdit::singleline(&mut self.path).id(field()).desired_width(420.0);
        let response = ui.add(edit).labelled_by(label.id);
        let is_nowhere = ui.memory(|memory| memory.focused().is_none()) && !response.lost_focus();
        if self.early.is_some() || is_nowhere {
            response.request_focus();
        }
        if self.early.is_some() {
            // What is typed takes the place of what is there.
            let all = CCursorRange::two(CCursor::new(0), CCursor::new(self.path.chars().count()));
            let mut state = TextEdit::load_state(ui.ctx(), response.id).unwrap_or_default();
            state.cursor.set_char_range(Some(all));
            state.store(ui.ctx(), response.id);
        }
        let entered = response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        let is_empty = self.path.trim().is_empty();
        ui.horizontal(|ui| {
            let accepted =
                ui.add_enabled(!is_empty, egui::Button::new(self.purpose.button())).clicked() || (entered && !is_empty);
            let cancelled = ui.button("Cancel").clicked();
            accepted.then_some(Answer::Accept).or(cancelled.then_some(Answer::Cancel))
        })
        .inner
    }
}

impl App {
    /// The window that takes a path, by its title, and why it is there if something else was asked for.
    pub fn path_asked_for(&self) -> Option<(&'static str, Option<&'static str>)> {
        self.dialogs.typed_path.as_ref().map(|typed| (typed.purpose.title(), typed.why))
    }

    /// Opens the window that takes a path, with one to begin with in it.
    pub(in crate::app) fn type_path(&mut self, purpose: Purpose) {
        if self.dialogs.typed_path.as_ref().is_some_and(|typed| typed.purpose == purpose) {
            return;
        }
        let path = purpose.proposed(self.source());
        self.dialogs.typed_path = Some(TypedPath { purpose, path, why: None, early: Some(Vec::new()) });
    }

    /// The same where there is no dialog to choose it in.
    fn type_path_instead(&mut self, purpose: Purpose, early: Vec<Event>) {
        self.type_path(purpose);
        if let Some(typed) = &mut self.dialogs.typed_path {
            typed.why = Some(NO_DIALOG);
            typed.early = Some(early);
        }
    }

    /// What was typed from a place on, after a key that asks for a path, is for the field.
    pub(in crate::app) fn hold_from(&mut self, context: &egui::Context, place: usize) {
        let dialog =
            self.dialogs.pending.as_mut().filter(|dialog| dialog.is_new(context)).map(|dialog| &mut dialog.early);
        let typed = self.dialogs.typed_path.as_mut().and_then(|typed| typed.early.as_mut());
        if let Some(early) = dialog.or(typed) {
            early.extend(take_typing(context, place));
        }
    }

    /// Keeps what is typed until the path's field has the focus, or a dialog is there, so that nothing else acts on it.
    pub(in crate::app) fn hold_typing(&mut self, context: &egui::Context) {
        if let Some(dialog) = self.dialogs.pending.as_mut().filter(|dialog| dialog.is_new(context)) {
            return dialog.early.extend(take_typing(context, 0));
        }
        let Some(typed) = &mut self.dialogs.typed_path else { return };
        let Some(early) = &mut typed.early else { return };
        if context.memory(|memory| memory.has_focus(field())) {
            let early = typed.early.take().unwrap_or_default();
            context.input_mut(|input| drop(input.events.splice(0..0, early)));
        } else {
            early.extend(take_typing(context, 0));
            context.request_repaint();
        }
    }

    pub(in crate::app) fn path_window(&mut self, context: &egui::Context) {
        match self.dialogs.typed_path.as_mut().and_then(|typed| typed.show(context)) {
            Some(Answer::Accept) => self.take_typed(context),
            Some(Answer::Cancel) => self.dialogs.typed_path = None,
            None => {}
        }
    }

    fn take_typed(&mut self, context: &egui::Context) {
        let Some(TypedPath { purpose, path, .. }) = &self.dialogs.typed_path else { return };
        let (purpose, path) = (*purpose, path.trim());
        let taken = match purpose {
            // Nobody was asked whether a file that is there is to be replaced.
            Purpose::SaveChart | Purpose::SavePicture | Purpose::ExportMesh if Path::new(path).exists() => {
                Err(format!("{} is there already: choose another name", shown_path(Path::new(path))))
            }
            Purpose::SaveChart | Purpose::SavePicture | Purpose::ExportMesh => {
                self.take_source(context, purpose, Source::File(path.into()))
            }
            Purpose::Open | Purpose::Heights | Purpose::Truth => match path.parse() {
                Ok(source) => self.take_source(context, purpose, source),
                Err(error) => Err(error.to_string()),
            },
        };
        match taken {
            Ok(()) => self.dialogs.typed_path = None,
            Err(why) => self.dialogs.error = Some(why),
        }
    }

    /// Does what the path was asked for.
    ///
    /// # Errors
    /// No such file can be written, in a sentence.
    fn take_source(&mut self, context: &egui::Context, purpose: Purpose, source: Source) -> Result<(), String> {
        match (purpose, source) {
            (Purpose::Truth, source) => self.open_truth(context, source),
            (Purpose::SaveChart, Source::File(path)) => self.save_chart_beside(context, path),
            (Purpose::SavePicture, Source::File(path)) => self.save_picture(context, path)?,
            (Purpose::ExportMesh, Source::File(path)) => self.export_mesh(context, path)?,
            (Purpose::Open | Purpose::Heights, Source::File(path)) => self.open_path(context, path),
            (_, source) => self.open(context, source),
        }
        Ok(())
    }

    /// Takes what was chosen in the desktop's dialog, or asks for it to be typed where there is none.
    pub(in crate::app) fn take_dialog(&mut self, context: &egui::Context) {
        let Some(ended) = self.dialogs.pending.as_ref().and_then(|dialog| dialog.job.take()) else { return };
        let Some(PendingDialog { purpose, early, .. }) = self.dialogs.pending.take() else { return };
        match ended {
            Ok(Asked::Chosen(path)) => {
                let taken = self.take_source(context, purpose, Source::File(path));
                self.dialogs.error = taken.err().or(self.dialogs.error.take());
            }
            Ok(Asked::Cancelled) => {}
            Ok(Asked::NoDialog) => self.type_path_instead(purpose, early),
            Err(stopped) => {
                self.dialogs.error =
                    Some(format!("the desktop's file dialog {stopped}; type a path instead with File > Open path…"));
            }
        }
    }
}

/// The field, wherever it is shown.
fn field() -> Id {
    Id::unique("typed path")
}

/// Takes keys and text out of what comes in this frame, from a place on.
fn take_typing(context: &egui::Context, from: usize) -> Vec<Event> {
    let is_typing =
        |event: &Event| matches!(event, Event::Text(_) | Event::Key { .. } | Event::Paste(_) | Event::Ime(_));
    context.input_mut(|input| {
        let (typing, other): (_, Vec<_>) = input.events.split_off(from).into_iter().partition(is_typing);
        input.events.extend(other);
        typing
    })
}
