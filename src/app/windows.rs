//! The small windows over everything, and the desktop's file dialog.

use std::path::PathBuf;

use super::beside::Beside;
use super::menu::KEYS;
use super::typed::{Dialog, Purpose};
use super::{App, desktop};
use crate::cli::CopiedCommand;
use crate::load::{HeightSource, Source};

/// Ends of names of files that hold meshes.
pub(super) const MESHES: [&str; 5] = ["gltf", "glb", "obj", "stl", "ply"];

impl App {
    pub(super) fn open_dialog(&mut self, context: &egui::Context) {
        self.dialog(Purpose::Open, context, || meshes("Open a mesh").pick_file());
    }

    pub(super) fn truth_dialog(&mut self, context: &egui::Context) {
        self.dialog(Purpose::Truth, context, || meshes("Choose what the mesh should have been").pick_file());
    }

    /// The desktop's file dialog, on a thread of its own.
    pub(super) fn dialog(
        &mut self,
        purpose: Purpose,
        context: &egui::Context,
        choose: impl FnOnce() -> Option<PathBuf> + Send + 'static,
    ) {
        if self.dialog.is_none() {
            let job = Beside::start(context, move || desktop::ask(choose));
            let since = context.input(|input| input.time);
            self.dialog = Some(Dialog { purpose, job, since, early: Vec::new() });
        }
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
        self.command_window(context);
        self.palette_window(context);
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
}

impl App {
    /// Copies the command that draws what is shown, and shows it.
    pub(super) fn copy_command(&mut self, context: &egui::Context) {
        let Some(document) = &self.document else { return };
        let moment = self.moment().zip(document.loaded.mesh.rig.as_deref());
        let animation = moment.map(|(moment, rig)| (rig.clip_name(moment.clip), moment.time));
        let source = anywhere(&document.loaded.source);
        let truth = self.truth.as_ref().map(|truth| anywhere(&truth.source));
        let mut preparation = document.loaded.preparation.clone();
        if let Some(HeightSource::File(path)) = &mut preparation.heights {
            *path = std::path::absolute(&*path).unwrap_or_else(|_| path.clone());
        }
        let shown = CopiedCommand {
            source: &source,
            preparation: &preparation,
            settings: &self.settings,
            camera: &self.camera,
            radius: document.scene.bounds.radius(),
            size: self.viewport.size().to_array().map(|side| side as u32),
            animation: animation.as_ref().map(|(name, time)| (&**name, *time)),
            truth: truth.as_ref(),
            triangle: self.selected_triangle(),
        };
        let command = shown.line();
        context.copy_text(command.clone());
        self.command = Some(command);
    }

    fn command_window(&mut self, context: &egui::Context) {
        let Some(command) = &self.command else { return };
        let mut is_open = true;
        let window = egui::Window::new("Copied").open(&mut is_open).resizable(false).collapsible(false);
        window.anchor(egui::Align2::CENTER_TOP, egui::vec2(0.0, 40.0)).default_width(520.0).show(context, |ui| {
            ui.label("This command draws the picture without a window:");
            ui.add(egui::Label::new(egui::RichText::new(command).monospace()).wrap().selectable(true));
            if self.frozen.is_some() {
                ui.weak("Its LOD is for this camera, not for the frozen one.");
            }
        });
        if !is_open {
            self.command = None;
        }
    }
}

/// A source as it is called in every folder.
fn anywhere(source: &Source) -> Source {
    match source {
        Source::File(path) => Source::File(std::path::absolute(path).unwrap_or_else(|_| path.clone())),
        shape => shape.clone(),
    }
}

fn meshes(title: &str) -> rfd::FileDialog {
    rfd::FileDialog::new().set_title(title).add_filter("Meshes", &MESHES)
}
