//! The window in which a path is typed. Keys that are pressed before its text field has the focus are kept for it.

use std::path::Path;

use egui::text::{CCursor, CCursorRange};
use egui::{Event, Id, Key, TextEdit};

use super::desktop_dialog::Asked;
use super::typed_text::{Completion, completion, path_of};
use crate::app::App;
use crate::app::jobs::background_job::BackgroundJob;
use geometry::names::shown_path;
use load::format::known_extensions;
use load::{FileError, Source};

/// What a path is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Purpose {
    Open,
    Heights,
    Truth,
    Factors,
    LodShader,
    SurfaceShader,
    /// A picture of a lit sphere.
    Matcap,
    Environment,
    SaveChart,
    SavePicture,
    /// A turntable as PNG files.
    SaveFolder,
    SaveGif,
    SaveFactors,
    SaveAdjacency,
    SaveStats,
    ExportMesh,
}

/// A path that is being typed.
pub(crate) struct TypedPath {
    purpose: Purpose,
    path: String,
    /// The path that the completion is about.
    completion: (String, Completion),
    /// Whether it is said which names begin like the path, since Tab can't choose one of them. Then Tab leaves the field.
    lists_names: bool,
    /// Why the path must be typed, if a dialog was asked for.
    why: Option<&'static str>,
    /// Events of keys that were pressed before the field had the focus; none once it has had the focus.
    early: Option<Vec<Event>>,
}

/// The most names that are listed under a path.
const MOST_NAMES: usize = 8;

/// The desktop's file dialog.
pub(crate) struct PendingDialog {
    pub purpose: Purpose,
    pub job: BackgroundJob<Asked>,
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

impl Purpose {
    fn title(self) -> &'static str {
        match self {
            Self::Open => "Open path",
            Self::Heights => "Height image path",
            Self::Truth => "Reference surface path",
            Self::Factors => "Factors path",
            Self::LodShader => "LOD shader path",
            Self::SurfaceShader => "Surface shader path",
            Self::Matcap => "Matcap path",
            Self::Environment => "Environment path",
            Self::SaveChart => "Save chart",
            Self::SavePicture => "Save picture",
            Self::SaveFolder | Self::SaveGif => "Save turntable",
            Self::SaveFactors => "Save factors",
            Self::SaveAdjacency => "Save adjacency",
            Self::SaveStats => "Save stats",
            Self::ExportMesh => "Export mesh",
        }
    }

    /// Whether the path is that of a file to write.
    fn is_written(self) -> bool {
        let is_read = matches!(
            self,
            Self::Open
                | Self::Heights
                | Self::Truth
                | Self::Factors
                | Self::LodShader
                | Self::SurfaceShader
                | Self::Matcap
                | Self::Environment
        );
        !is_read
    }

    /// The kinds of file that can be typed.
    fn takes(self) -> String {
        match self {
            Self::Open => format!(
                "A {} file, shape:NAME, a height image (.png, .jpg, .webp), or an environment (.hdr, .exr)",
                known_extensions()
            ),
            Self::Heights | Self::Matcap => "A .png, .jpg or .webp image".to_owned(),
            Self::Truth => format!("A {} file, or shape:NAME", known_extensions()),
            Self::Factors => "A .csv file with the factors of every triangle".to_owned(),
            Self::LodShader => "A .wgsl file with the function edge_factor".to_owned(),
            Self::SurfaceShader => "A .wgsl file with the function edge_points".to_owned(),
            Self::Environment => "A .hdr or .exr panorama".to_owned(),
            Self::SaveChart => "A new .svg, .png or .csv file".to_owned(),
            Self::SavePicture => "A new .png file".to_owned(),
            Self::SaveFolder => "A new folder".to_owned(),
            Self::SaveGif => "A new .gif file".to_owned(),
            Self::SaveFactors => "A new .csv file".to_owned(),
            Self::SaveAdjacency => "A new .json or .bin file".to_owned(),
            Self::SaveStats => "A new .json file".to_owned(),
            Self::ExportMesh => "A new .glb or .obj file".to_owned(),
        }
    }

    fn button(self) -> &'static str {
        match self {
            _ if !self.is_written() => "Open",
            Self::ExportMesh => "Export",
            _ => "Save",
        }
    }

    /// The path that the text field starts with. `folder` is where a file was written last.
    fn proposed(self, open: Option<&Source>, folder: Option<&Path>) -> String {
        let written = |name: &str| {
            unused(folder.map_or_else(|| absolute(name), |folder| folder.join(name).display().to_string()))
        };
        let title = open.map_or_else(|| "mesh".to_owned(), Source::title);
        match (self, open) {
            (Self::Open | Self::Truth, Some(Source::File(path))) => path.display().to_string(),
            (Self::Open | Self::Truth | Self::Heights, _) => String::new(),
            (Self::Factors | Self::LodShader | Self::SurfaceShader, _) => String::new(),
            (Self::Matcap | Self::Environment, _) => String::new(),
            (Self::SaveChart, _) => written("chart.svg"),
            (Self::SavePicture, _) => written(&name_beside(&title, "-view.png")),
            (Self::SaveFolder, _) => written(&name_beside(&title, "-turntable")),
            (Self::SaveGif, _) => written(&name_beside(&title, "-turntable.gif")),
            (Self::SaveFactors, _) => written(&name_beside(&title, "-factors.csv")),
            (Self::SaveAdjacency, _) => written(&name_beside(&title, "-adjacency.json")),
            (Self::SaveStats, _) => written(&name_beside(&title, "-stats.json")),
            (Self::ExportMesh, _) => written(&name_beside(&title, "-tessellated.glb")),
        }
    }
}

/// The path itself, or if there is such a file, one whose name ends with the first number from 2 on that is free.
fn unused(path: String) -> String {
    let (stem, ending) = match path.rsplit_once('.') {
        Some((stem, ending)) if !ending.contains(['/', '\\']) => (stem, format!(".{ending}")),
        _ => (path.as_str(), String::new()),
    };
    let numbered = (2..).map(|number| format!("{stem}-{number}{ending}"));
    std::iter::once(path.clone()).chain(numbered).find(|path| !Path::new(path).exists()).unwrap_or(path.clone())
}

/// The path of a name in the working folder.
pub(crate) fn absolute(name: &str) -> String {
    std::path::absolute(name).map_or_else(|_| name.to_owned(), |path| path.display().to_string())
}

/// The name of a file that is made from a mesh with this title: the title's ending is replaced by `ending`.
pub(crate) fn name_beside(title: &str, ending: &str) -> String {
    let stem = Path::new(title).file_stem().unwrap_or_default().to_string_lossy();
    // A shape's title has a colon, which some systems forbid in file names.
    stem.replace([':', '@', ' '], "-") + ending
}

/// The button that was pressed.
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
            let accepted =
                ui.add_enabled(!is_empty, egui::Button::new(self.purpose.button())).clicked() || (entered && !is_empty);
            let cancelled = ui.button("Cancel").clicked();
            accepted.then_some(Answer::Accept).or(cancelled.then_some(Answer::Cancel))
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
    /// The title of the window in which a path is typed, and why it is shown if a dialog was asked for.
    pub fn path_asked_for(&self) -> Option<(&'static str, Option<&'static str>)> {
        self.dialogs.typed_path.as_ref().map(|typed| (typed.purpose.title(), typed.why))
    }

    /// Opens the window in which a path is typed, with a proposed path.
    pub(in crate::app) fn type_path(&mut self, purpose: Purpose) {
        if self.dialogs.typed_path.as_ref().is_some_and(|typed| typed.purpose == purpose) {
            return;
        }
        let typed = self.dialogs.typed.as_ref().filter(|(of, _)| *of == purpose).map(|(_, path)| path.clone());
        let path = typed.unwrap_or_else(|| purpose.proposed(self.source(), self.dialogs.folder.as_deref()));
        let (completion, early) = Default::default();
        let (why, lists_names) = (None, false);
        self.dialogs.typed_path = Some(TypedPath { purpose, path, completion, lists_names, why, early: Some(early) });
    }

    /// The same, if the desktop has no dialog.
    fn type_path_instead(&mut self, purpose: Purpose, early: Vec<Event>) {
        self.type_path(purpose);
        if let Some(typed) = &mut self.dialogs.typed_path {
            typed.why = Some(NO_DIALOG);
            typed.early = Some(early);
        }
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
        match self.dialogs.typed_path.as_mut().and_then(|typed| typed.show(context)) {
            Some(Answer::Accept) => self.take_typed(context),
            Some(Answer::Cancel) => self.dialogs.typed_path = None,
            None => {}
        }
    }

    fn take_typed(&mut self, context: &egui::Context) {
        let Some(TypedPath { purpose, path, .. }) = &self.dialogs.typed_path else { return };
        let (purpose, typed, path) = (*purpose, path.clone(), path_of(path));
        let path = path.as_str();
        let taken = match purpose {
            // This window doesn't ask before it replaces a file, so it never does.
            _ if purpose.is_written() && Path::new(path).exists() => {
                Err(format!("{} exists already: choose another name", shown_path(Path::new(path))))
            }
            _ if purpose.is_written()
                || matches!(
                    purpose,
                    Purpose::Factors
                        | Purpose::LodShader
                        | Purpose::SurfaceShader
                        | Purpose::Matcap
                        | Purpose::Environment
                ) =>
            {
                let source = Source::File(path.into());
                let is_there = if purpose.is_written() { Ok(()) } else { exists(&source) };
                is_there.and_then(|()| self.take_source(context, purpose, source))
            }
            _ => match path.parse::<Source>() {
                Ok(source) => exists(&source).and_then(|()| self.take_source(context, purpose, source)),
                Err(error) => Err(error.to_string()),
            },
        };
        match taken {
            Ok(()) if purpose.is_written() => {
                self.dialogs.folder = Path::new(path).parent().map(Path::to_owned);
                self.dialogs.typed_path = None;
            }
            Ok(()) => {
                self.dialogs.typed = Some((purpose, typed));
                self.dialogs.typed_path = None;
            }
            Err(why) => self.dialogs.error = Some(why),
        }
    }

    /// Opens or writes the file that was chosen.
    ///
    /// # Errors
    /// Why the file can't be written, in a sentence.
    fn take_source(&mut self, context: &egui::Context, purpose: Purpose, source: Source) -> Result<(), String> {
        match (purpose, source) {
            (Purpose::Truth, source) => self.open_truth(context, source),
            (Purpose::Factors, Source::File(path)) => self.open_factors(context, path),
            (Purpose::LodShader, Source::File(path)) => self.open_lod_shader(context, path),
            (Purpose::SurfaceShader, Source::File(path)) => self.open_surface_shader(context, path),
            (Purpose::Matcap, Source::File(path)) => self.open_matcap(context, path),
            (Purpose::Environment, Source::File(path)) => self.open_environment(context, path),
            (Purpose::SaveChart, Source::File(path)) => self.save_chart_beside(context, path),
            (Purpose::SavePicture, Source::File(path)) => self.save_picture(context, path)?,
            (Purpose::SaveFolder | Purpose::SaveGif, Source::File(path)) => self.save_turntable(context, path)?,
            (Purpose::SaveFactors, Source::File(path)) => self.save_factors(context, path)?,
            (Purpose::SaveAdjacency, Source::File(path)) => self.save_adjacency(context, path)?,
            (Purpose::SaveStats, Source::File(path)) => self.save_stats(context, path)?,
            (Purpose::ExportMesh, Source::File(path)) => self.export_mesh(context, path)?,
            (Purpose::Open | Purpose::Heights, Source::File(path)) => self.open_path(context, path),
            (_, source) => self.open(context, source),
        }
        Ok(())
    }

    /// Takes the answer of the desktop's dialog, or opens the window to type a path if there is no dialog.
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

/// Whether a file that was typed is there. If not, the window stays open, so that the path can be mended.
///
/// # Errors
/// Why it can't be read, in a sentence.
fn exists(source: &Source) -> Result<(), String> {
    let Source::File(path) = source else { return Ok(()) };
    let refused = |source| FileError::Io { path: path.clone(), source }.to_string();
    std::fs::metadata(path).map(|_| ()).map_err(refused)
}

/// The id of the text field.
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
