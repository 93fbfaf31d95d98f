//! The small windows over everything, and the desktop's file dialog.

use std::path::PathBuf;

use super::desktop_dialog;
use super::typed_path::{PendingDialog, Purpose};
use crate::app::App;
use crate::app::commands::menu_bar::KEYS;
use crate::app::jobs::background_job::BackgroundJob;
use crate::app::jobs::loading::MESHES;
use crate::cli::Shown;
use crate::load::{HeightSource, Source};

impl App {
    pub(in crate::app) fn open_dialog(&mut self, context: &egui::Context) {
        self.dialog(Purpose::Open, context, || meshes("Open a mesh").pick_file());
    }

    pub(in crate::app) fn truth_dialog(&mut self, context: &egui::Context) {
        self.dialog(Purpose::Truth, context, || meshes("Choose what the mesh should have been").pick_file());
    }

    /// The desktop's file dialog, on a thread of its own.
    pub(in crate::app) fn dialog(
        &mut self,
        purpose: Purpose,
        context: &egui::Context,
        choose: impl FnOnce() -> Option<PathBuf> + Send + 'static,
    ) {
        if self.dialogs.pending.is_none() {
            let job = BackgroundJob::start(context, move || desktop_dialog::ask(choose));
            let since = context.input(|input| input.time);
            self.dialogs.pending = Some(PendingDialog { purpose, job, since, early: Vec::new() });
        }
    }

    /// What lies over everything: typing a path, the keys, an error.
    pub(in crate::app) fn windows(&mut self, context: &egui::Context) {
        self.path_window(context);
        let mut open = self.commands.shows_keys;
        egui::Window::new("Keys").open(&mut open).resizable(false).collapsible(false).show(context, |ui| {
            egui::Grid::new("keys").num_columns(2).striped(true).show(ui, |ui| {
                for (key, does) in KEYS {
                    ui.strong(key);
                    ui.label(does);
                    ui.end_row();
                }
            });
        });
        self.commands.shows_keys = open;
        self.command_window(context);
        self.palette_window(context);
        let Some(error) = &self.dialogs.error else { return };
        let mut closed = false;
        let anchor = (egui::Align2::CENTER_TOP, egui::vec2(0.0, 40.0));
        let window = egui::Window::new("Problem").resizable(false).collapsible(false).anchor(anchor.0, anchor.1);
        window.default_width(420.0).show(context, |ui| {
            ui.label(error);
            closed = ui.button("Close").clicked();
        });
        if closed {
            self.dialogs.error = None;
        }
    }
}

impl App {
    /// Copies the command that draws what is shown, and shows it.
    pub(in crate::app) fn copy_command(&mut self, context: &egui::Context) {
        let Some(document) = &self.document else { return };
        let moment = self.moment().zip(document.loaded.mesh.rig.as_deref());
        let animation = moment.map(|(moment, rig)| (rig.clip_name(moment.clip), moment.time));
        let source = anywhere(&document.loaded.source);
        let truth = self.truth.as_ref().map(|truth| anywhere(&truth.source));
        let mut preparation = document.loaded.preparation.clone();
        if let Some(HeightSource::File(path)) = &mut preparation.heights {
            *path = std::path::absolute(&*path).unwrap_or_else(|_| path.clone());
        }
        let shown = Shown {
            source: &source,
            preparation: &preparation,
            settings: &self.settings,
            camera: &self.viewport.camera,
            radius: document.scene.bounds.radius(),
            size: self.viewport.picture.size().to_array().map(|side| side as u32),
            animation: animation.as_ref().map(|(name, time)| (&**name, *time)),
            truth: truth.as_ref(),
            triangle: self.selected_triangle(),
        };
        let command = shown.command();
        context.copy_text(command.clone());
        self.commands.copied = Some(command);
    }

    fn command_window(&mut self, context: &egui::Context) {
        let Some(command) = &self.commands.copied else { return };
        let mut is_open = true;
        let window = egui::Window::new("Copied").open(&mut is_open).resizable(false).collapsible(false);
        window.anchor(egui::Align2::CENTER_TOP, egui::vec2(0.0, 40.0)).default_width(520.0).show(context, |ui| {
            ui.label("This command draws the picture without a window:");
            ui.add(egui::Label::new(egui::RichText::new(command).monospace()).wrap().selectable(true));
            if self.viewport.frozen.is_some() {
                ui.weak("Its LOD is for this camera, not for the frozen one.");
            }
        });
        if !is_open {
            self.commands.copied = None;
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
