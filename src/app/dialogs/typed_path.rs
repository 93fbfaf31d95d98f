//! The window in which a path is typed. Keys that are pressed before its text field has the focus are kept for it.

use std::path::Path;

use egui::text::{CCursor, CCursorRange};
use egui::{Event, Id, Key, TextEdit};

use super::desktop_dialog::{Asked, ask};
use super::purpose::{self, AskedFile, proposed, proposed_name};
use super::typed_text::{Completion, completion, path_of};
use crate::app::App;
use crate::app::jobs::background_job::Stopped;
use crate::app::jobs::job_list::Work;
use crate::commands::{CompanionFile, Purpose};
use geometry::names::shown_path;
use load::{FileError, Source};

pub(crate) struct TypedPath {
    pub purpose: Purpose,
    path: String,
    completion: (String, Completion),
    /// Whether it is said which names begin like the path, since Tab can't choose one of them. Then Tab leaves the field.
    lists_names: bool,
    /// Why the path must be typed, if a dialog was asked for.
    pub why: Option<&'static str>,
    /// Events of keys that were pressed before the field had the focus; none once it has had the focus.
    early: Option<Vec<Event>>,
}

const MOST_NAMES: usize = 8;

pub(crate) struct PendingDialog {
    /// When it was asked for, on the window's clock in s.
    pub since: f64,
    /// Events of keys that were pressed since, for the text field that replaces a missing dialog.
    pub early: Vec<Event>,
}

/// How long it takes at most to know that there is no dialog, in s. Until then, keys are kept back.
const SOON: f64 = 0.5;

impl PendingDialog {
    pub(crate) fn is_new(&self, context: &egui::Context) -> bool {
        context.input(|input| input.time) - self.since < SOON
    }
}

/// Why a path is typed where a dialog was asked for.
const NO_DIALOG: &str = "This desktop has no file dialog (neither a portal nor zenity). Type the path instead.";

impl TypedPath {
    /// Shows the window's content. Returns true if the path is accepted, and false if the window is closed.
    fn rows(&mut self, ui: &mut egui::Ui) -> Option<bool> {
        if let Some(why) = self.why {
            ui.label(why);
        }
        let label = ui.label(AskedFile::new(self.purpose).takes);
        self.complete(ui);
        let takes_tab = self.takes_tab();
        let edit = TextEdit::singleline(&mut self.path).id(field()).desired_width(420.0);
        let response = ui.add(edit.lock_focus(takes_tab)).labelled_by(label.id);
        if self.lists_names {
            ui.add(egui::Label::new(self.candidates()).wrap());
        }
        let is_nowhere = ui.memory(|memory| memory.focused().is_none()) && !response.lost_focus();
        if self.early.is_some() || is_nowhere {
            response.request_focus();
        }
        if self.early.is_some() {
            // Everything is selected, so that typing replaces it.
            self.select_from(ui, 0);
        }
        // Taken, so that it doesn't close the message about this path as well.
        let takes_enter = |input: &mut egui::InputState| input.consume_key(egui::Modifiers::NONE, Key::Enter);
        let entered = response.lost_focus() && ui.input_mut(takes_enter);
        let is_empty = self.path.trim().is_empty();
        ui.horizontal(|ui| {
            let accepted = ui.add_enabled(!is_empty, egui::Button::new(purpose::button(self.purpose))).clicked()
                || (entered && !is_empty);
            let cancelled = ui.button("Cancel").clicked();
            accepted.then_some(true).or(cancelled.then_some(false))
        })
        .inner
    }

    /// Whether Tab does something in the field: it completes the path, or says which names begin like it.
    fn takes_tab(&self) -> bool {
        let (of, Completion { text, names }) = &self.completion;
        let is_whole = names.len() == 1 && text.is_none();
        let is_shape = of.starts_with("shape:");
        !of.is_empty() && !is_whole && !is_shape && !self.lists_names
    }

    /// Lets Tab complete the path where there is more of it, or say which names begin like it.
    fn complete(&mut self, ui: &egui::Ui) {
        if self.completion.0 != self.path {
            self.completion = (self.path.clone(), completion(&self.path));
            self.lists_names = false;
        }
        let is_here = ui.memory(|memory| memory.has_focus(field()));
        let takes_tab = self.takes_tab() && is_here;
        if !(takes_tab && ui.input_mut(|input| input.consume_key(egui::Modifiers::NONE, Key::Tab))) {
            return;
        }
        match self.completion.1.text.clone() {
            Some(completed) => {
                self.path = completed;
                self.select_from(ui, self.path.chars().count());
            }
            None => self.lists_names = true,
        }
    }

    /// Says which names begin like the path.
    fn candidates(&self) -> String {
        let names = &self.completion.1.names;
        match names.len() {
            0 => "No file or folder there has a name that begins like this.".to_owned(),
            count if count > MOST_NAMES => {
                format!("{} and {} more begin like this.", names[..MOST_NAMES].join(", "), count - MOST_NAMES)
            }
            _ => format!("These begin like this: {}.", names.join(", ")),
        }
    }

    /// Selects the path from a character on, in whose place the cursor is.
    fn select_from(&self, ui: &egui::Ui, first: usize) {
        let range = CCursorRange::two(CCursor::new(first), CCursor::new(self.path.chars().count()));
        let mut state = TextEdit::load_state(ui.ctx(), field()).unwrap_or_default();
        state.cursor.set_char_range(Some(range));
        state.store(ui.ctx(), field());
    }
}

impl App {
    /// Opens the window in which a path is typed, with a proposed path.
    pub(in crate::app) fn type_path(&mut self, purpose: Purpose) {
        if self.dialogs.typed_path.as_ref().is_some_and(|typed| typed.purpose == purpose) {
            return;
        }
        let typed = self.dialogs.typed.as_ref().filter(|(of, _)| *of == purpose).map(|(_, path)| path.clone());
        let path = typed.unwrap_or_else(|| proposed(purpose, self.source(), self.dialogs.folder.as_deref()));
        let (completion, early) = Default::default();
        let (why, lists_names) = (None, false);
        self.dialogs.typed_path = Some(TypedPath { purpose, path, completion, lists_names, why, early: Some(early) });
    }

    /// Keeps the keys of this frame from event `place` on for the text field: they were pressed after the key that opened it.
    pub(in crate::app) fn hold_from(&mut self, context: &egui::Context, place: usize) {
        let dialog =
            self.dialogs.pending.as_mut().filter(|dialog| dialog.is_new(context)).map(|dialog| &mut dialog.early);
        let typed = self.dialogs.typed_path.as_mut().and_then(|typed| typed.early.as_mut());
        if let Some(early) = dialog.or(typed) {
            early.extend(take_typing(context, place));
        }
    }

    /// Keeps keys back until the text field has the focus or a dialog is shown, so that nothing else acts on them.
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
        let Some(typed) = &mut self.dialogs.typed_path else { return };
        let window = egui::Window::new(AskedFile::new(typed.purpose).title).resizable(false).collapsible(false);
        let window = window.anchor(egui::Align2::CENTER_CENTER, egui::Vec2::ZERO);
        match window.show(context, |ui| typed.rows(ui)).and_then(|shown| shown.inner).flatten() {
            Some(true) => self.take_typed(context),
            Some(false) => self.dialogs.typed_path = None,
            None => {}
        }
    }

    fn take_typed(&mut self, context: &egui::Context) {
        let Some(TypedPath { purpose, path, .. }) = &self.dialogs.typed_path else { return };
        let (purpose, typed, path) = (*purpose, path.clone(), path_of(path));
        let path = path.as_str();
        let source = match purpose {
            // This window doesn't ask before it replaces a file, so it never does.
            Purpose::Write(_) if Path::new(path).exists() => {
                Err(format!("{} exists already: choose another name", shown_path(Path::new(path))))
            }
            Purpose::Write(_) => Ok(Source::File(path.into())),
            Purpose::CompanionFile(beside)
                if !matches!(beside, CompanionFile::ReferenceShape | CompanionFile::LeftMesh) =>
            {
                found(Source::File(path.into()))
            }
            Purpose::PartHeights => found(Source::File(path.into())),
            _ => path.parse::<Source>().map_err(|error| error.to_string()).and_then(found),
        };
        match source.and_then(|source| self.take_source(context, purpose, source)) {
            Ok(()) if matches!(purpose, Purpose::Write(_)) => {
                self.dialogs.folder = Path::new(path).parent().map(Path::to_owned)
            }
            Ok(()) => self.dialogs.typed = Some((purpose, typed)),
            Err(why) => return self.dialogs.error = Some(why),
        }
        self.dialogs.typed_path = None;
    }

    /// Opens or writes the file that was chosen.
    ///
    /// # Errors
    /// Why the file can't be written, in a sentence.
    fn take_source(&mut self, context: &egui::Context, purpose: Purpose, source: Source) -> Result<(), String> {
        match (purpose, source) {
            (Purpose::Write(written), Source::File(path)) => return self.write_as(context, written, path),
            (Purpose::CompanionFile(beside), source) => {
                if beside == CompanionFile::LeftMesh {
                    self.settings.split.get_or_insert(self.viewport.last_split);
                }
                self.open_companion(context, beside, source);
            }
            (Purpose::PartHeights, Source::File(path)) => self.displace_part(context, path),
            (_, Source::File(path)) => self.open_path(context, path),
            (_, source) => self.open(context, source),
        }
        Ok(())
    }

    /// Asks for a file with the desktop's dialog.
    pub(in crate::app) fn ask_for(&mut self, context: &egui::Context, purpose: Purpose) {
        if self.jobs.has(Work::Dialog) {
            return;
        }
        let name = proposed_name(purpose, self.source());
        let choose = move || {
            let AskedFile { title, kinds, .. } = AskedFile::new(purpose);
            let dialog = rfd::FileDialog::new().set_title(title.trim_end_matches(" path"));
            let kinds = kinds.into_iter();
            let dialog = kinds.fold(dialog, |dialog, (name, endings)| dialog.add_filter(name, &endings));
            match name {
                Some(name) => dialog.set_file_name(name).save_file(),
                None => dialog.pick_file(),
            }
        };
        let land = move |app: &mut Self, context: &_, ended| app.take_answer(context, purpose, ended);
        self.jobs.start(context, Work::Dialog, String::new(), move |_| ask(choose), land);
        self.dialogs.pending = Some(PendingDialog { since: context.input(|input| input.time), early: Vec::new() });
    }

    /// Takes the answer of the desktop's dialog, or opens the window to type a path if there is no dialog.
    fn take_answer(&mut self, context: &egui::Context, purpose: Purpose, ended: Result<Asked, Stopped>) {
        let early = self.dialogs.pending.take().map(|dialog| dialog.early).unwrap_or_default();
        match ended {
            Ok(Asked::Chosen(path)) => {
                let taken = self.take_source(context, purpose, Source::File(path));
                self.dialogs.error = taken.err().or(self.dialogs.error.take());
            }
            Ok(Asked::Cancelled) => {}
            Ok(Asked::NoDialog) => {
                self.type_path(purpose);
                if let Some(typed) = &mut self.dialogs.typed_path {
                    (typed.why, typed.early) = (Some(NO_DIALOG), Some(early));
                }
            }
            Err(stopped) => {
                self.dialogs.error =
                    Some(format!("the desktop's file dialog {stopped}; type a path instead with File > Open path…"));
            }
        }
    }
}

/// Returns what was typed if it is there. If not, the window stays open, so that the path can be mended.
///
/// # Errors
/// Why it can't be read, in a sentence.
fn found(source: Source) -> Result<Source, String> {
    if let Source::File(path) = &source {
        let refused = |source| FileError::Io { path: path.clone(), source }.to_string();
        std::fs::metadata(path).map_err(refused)?;
    }
    Ok(source)
}

fn field() -> Id {
    Id::unique("typed path")
}

/// Removes keys and text from this frame's events, from an index on, and returns them.
fn take_typing(context: &egui::Context, from: usize) -> Vec<Event> {
    let is_typing =
        |event: &Event| matches!(event, Event::Text(_) | Event::Key { .. } | Event::Paste(_) | Event::Ime(_));
    context.input_mut(|input| {
        let from = from.min(input.events.len());
        let (typing, other): (_, Vec<_>) = input.events.split_off(from).into_iter().partition(is_typing);
        input.events.extend(other);
        typing
    })
}
