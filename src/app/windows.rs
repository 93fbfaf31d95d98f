//! The small windows over everything, and the desktop's file dialog.

use egui::Key;
use egui::text::CCursor;

use super::App;
use super::beside::Beside;
use super::menu::KEYS;
use crate::mesh::Source;

/// Ends of names of files that hold meshes.
pub(super) const MESHES: [&str; 5] = ["gltf", "glb", "obj", "stl", "ply"];

impl App {
    /// Opens the window that takes a path, with that of the open file in it.
    pub(super) fn type_path(&mut self) {
        let path = match self.source() {
            Some(Source::File(path)) => path.display().to_string(),
            _ => String::new(),
        };
        self.asks_for_truth = false;
        self.typed_path.get_or_insert(path);
    }

    pub(super) fn open_dialog(&mut self, context: &egui::Context) {
        if self.dialog.is_none() {
            self.asks_for_truth = false;
        }
        self.dialog("Open a mesh", "Meshes", &MESHES, context);
    }

    /// The desktop's file dialog, on a thread of its own.
    pub(super) fn dialog(
        &mut self,
        title: &'static str,
        kind: &'static str,
        extensions: &'static [&str],
        context: &egui::Context,
    ) {
        if self.dialog.is_some() {
            return;
        }
        let choose = move || rfd::FileDialog::new().set_title(title).add_filter(kind, extensions).pick_file();
        self.dialog = Some(Beside::start(context, choose));
    }

    /// What lies over everything: typing a path, the keys, an error.
    pub(super) fn windows(&mut self, context: &egui::Context) {
        self.path_window(context);
        let mut open = self.shows_keys;
        egui::Window::new("Keys").open(&mut open).resizable(false).collapsible(false).show(context, |ui| {
            egui::Grid::new("keys").num_columns(2).striped(true).show(ui, |ui| {
                for (key, does) in KEYS {
                    ui.strong(key);
                    ui.label(does);
                    ui.end_row();
                }
            });
        });
        self.shows_keys = open;
        let Some(error) = &self.error else { return };
        let mut closed = false;
        let anchor = (egui::Align2::CENTER_TOP, egui::vec2(0.0, 40.0));
        let window = egui::Window::new("Problem").resizable(false).collapsible(false).anchor(anchor.0, anchor.1);
        window.default_width(420.0).show(context, |ui| {
            ui.label(error);
            closed = ui.button("Close").clicked();
        });
        if closed {
            self.error = None;
        }
    }

    fn path_window(&mut self, context: &egui::Context) {
        let Some(path) = &mut self.typed_path else { return };
        let (mut accepted, mut cancelled) = (false, false);
        let asks = if self.asks_for_truth { "Truth path" } else { "Open path" };
        let kinds = if self.asks_for_truth { "" } else { ", or a height image (.png, .jpg)" };
        let window = egui::Window::new(asks).resizable(false).collapsible(false);
        window.anchor(egui::Align2::CENTER_CENTER, egui::Vec2::ZERO).show(context, |ui| {
            let label = ui.label(format!("A .gltf, .glb, .obj, .stl or .ply file, shape:NAME{kinds}"));
            let edit = egui::TextEdit::singleline(path).desired_width(420.0).hint_text("model.glb");
            let response = ui.add(edit).labelled_by(label.id);
            if !response.has_focus() && !response.lost_focus() {
                response.request_focus();
                // What is typed takes the place of what is there.
                let all = egui::text::CCursorRange::two(CCursor::new(0), CCursor::new(path.chars().count()));
                let mut state = egui::TextEdit::load_state(ui.ctx(), response.id).unwrap_or_default();
                state.cursor.set_char_range(Some(all));
                state.store(ui.ctx(), response.id);
            }
            accepted = response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
            ui.horizontal(|ui| {
                let button = egui::Button::new("Open");
                accepted |= ui.add_enabled(!path.trim().is_empty(), button).clicked();
                cancelled = ui.button("Cancel").clicked();
            });
        });
        if accepted && !path.trim().is_empty() {
            match path.trim().parse::<Source>() {
                Ok(source) => {
                    self.typed_path = None;
                    match source {
                        source if std::mem::take(&mut self.asks_for_truth) => self.open_truth(context, source),
                        Source::File(path) => self.open_path(context, path),
                        Source::Shape(_) | Source::FineShape(..) => self.open(context, source),
                    }
                }
                Err(error) => self.error = Some(error.to_string()),
            }
        } else if cancelled {
            self.typed_path = None;
        }
    }
}
