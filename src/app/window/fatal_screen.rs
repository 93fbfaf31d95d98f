//! The screen that replaces the window if its device was lost again: it says what happened and offers to save the mesh.

use std::path::{Path, PathBuf};

use crate::app::App;
use crate::app::dialogs::purpose::name_beside;
use crate::app::jobs::background_job::BackgroundJob;
use crate::app::jobs::companion_files::absolute_path;
use crate::commands::{Action, FileAction, QUIT, with_key};
use geometry::mesh::Moment;
use geometry::tessellate::{Inputs, tessellate, totals};
use gpu::Gpu;
use inspect::engine::Loaded;
use inspect::export::Exported;

pub(crate) struct FatalScreen {
    /// The device that this screen alone is drawn with.
    pub gpu: Gpu,
    pub why: String,
    /// The path that is typed for saving the mesh.
    path: Option<String>,
    saving: Option<BackgroundJob<Result<String, String>>>,
    said: Option<String>,
    pub tries_again: bool,
}

impl FatalScreen {
    pub(crate) fn new(gpu: Gpu, why: String) -> Self {
        Self { gpu, why, path: None, saving: None, said: None, tries_again: false }
    }
}

impl App {
    /// Handles the window's key to quit.
    pub(in crate::app) fn fatal_screen_keys(&self, context: &egui::Context) {
        if context.input_mut(|input| input.consume_shortcut(&QUIT)) {
            context.send_viewport_cmd(egui::ViewportCommand::Close);
        }
    }

    pub(in crate::app) fn show_fatal_screen(&mut self, ui: &mut egui::Ui) {
        let Some(mut screen) = self.window.fatal_screen.take() else { return };
        if let Some(ended) = screen.saving.as_ref().and_then(BackgroundJob::take) {
            screen.saving = None;
            screen.said = Some(match ended {
                Ok(Ok(said) | Err(said)) => said,
                Err(stopped) => format!("saving the mesh {stopped}"),
            });
        }
        egui::CentralPanel::default().show(ui, |ui| {
            ui.add_space(ui.available_height() * 0.2);
            ui.vertical_centered(|ui| {
                ui.set_max_width(560.0);
                ui.with_layout(egui::Layout::top_down(egui::Align::Min), |ui| self.offers(ui, &mut screen));
            });
        });
        self.window.fatal_screen = Some(screen);
    }

    fn offers(&mut self, ui: &mut egui::Ui, screen: &mut FatalScreen) {
        ui.heading("Nothing can be drawn");
        ui.label(&screen.why);
        ui.label(
            "The window doesn't try another device by itself, because a driver that loses its device twice usually loses it \
             again. Settings, recent files and their cameras are saved.",
        );
        if self.document.is_some() {
            ui.add_space(12.0);
            self.save_row(ui, screen);
        }
        if let Some(said) = &screen.said {
            ui.label(said);
        }
        ui.add_space(12.0);
        ui.horizontal(|ui| {
            let hover = "Opens the window with a new device and the same mesh, settings and camera.";
            if ui.button("Try again").on_hover_text(hover).clicked() {
                screen.tries_again = true;
                ui.ctx().send_viewport_cmd(egui::ViewportCommand::Close);
            }
            let hover = with_key("Closes the window.", &Action::File(FileAction::Quit));
            if ui.button("Quit").on_hover_text(hover).clicked() {
                ui.ctx().send_viewport_cmd(egui::ViewportCommand::Close);
            }
        });
    }

    fn save_row(&mut self, ui: &mut egui::Ui, screen: &mut FatalScreen) {
        let Some(document) = &self.document else { return };
        let label = ui.label("Tessellated mesh, a .glb or .obj file");
        ui.horizontal(|ui| {
            let name = || name_beside(&document.loaded.source.title(), "-tessellated.obj");
            let path = screen.path.get_or_insert_with(|| absolute_path(name().into()).display().to_string());
            ui.add(egui::TextEdit::singleline(path).desired_width(420.0)).labelled_by(label.id);
            let is_free = screen.saving.is_none() && !path.trim().is_empty();
            let text = if screen.saving.is_some() { "Saving…" } else { "Save mesh" };
            let hover = "Tessellates the mesh on the CPU with these settings, for this camera, and writes it.";
            if ui.add_enabled(is_free, egui::Button::new(text)).on_hover_text(hover).clicked() {
                let path = PathBuf::from(path.trim());
                let view = self.viewport.camera.lod_view(self.viewport.picture.size(), &document.scene.bounds);
                let inputs = self.settings.inputs(self.viewport.frozen.map_or(view, |frozen| frozen.view));
                let (loaded, moment) = (document.loaded.clone(), self.moment());
                screen.said = None;
                screen.saving = Some(BackgroundJob::start(ui.ctx(), move || save(&loaded, moment, &inputs, &path)));
            }
        });
    }
}

/// Writes the mesh. Returns a sentence: what was written, or as an error why it wasn't.
fn save(loaded: &Loaded, moment: Option<Moment>, inputs: &Inputs, path: &Path) -> Result<String, String> {
    if path.exists() {
        return Err(format!("{} exists already: choose another name", path.display()));
    }
    let posed = loaded.posed(moment);
    let (mesh, topology) = (&posed.mesh, &posed.topology);
    let (vertices, triangles) = totals(mesh, topology, inputs);
    let write = || {
        Exported::check(path, mesh, vertices, triangles)?;
        let tessellated = tessellate(mesh, topology, inputs, None);
        Exported::new(mesh, topology, &tessellated).write(path)
    };
    let said = |warnings: Vec<String>| [vec![format!("{} is written.", path.display())], warnings].concat().join("\n");
    write().map(said).map_err(|error| error.to_string())
}
