//! The list of what was repaired or left out when files were read.

use crate::app::App;

impl App {
    /// What was repaired or left out of the mesh's files and of the file of light.
    pub(in crate::app) fn warnings(&self) -> impl Iterator<Item = &str> {
        let of_mesh = self.document.iter().flat_map(|document| &document.loaded.warnings);
        of_mesh.chain(self.environment.iter().flat_map(|open| &open.content.warnings)).map(String::as_str)
    }

    pub(in crate::app) fn warnings_window(&mut self, context: &egui::Context) {
        if !self.dialogs.shows_warnings {
            return;
        }
        let warnings: Vec<&str> = self.warnings().collect();
        let mut closed = false;
        let mut is_open = true;
        let window = egui::Window::new("Warnings").open(&mut is_open);
        let window = window.resizable(false).collapsible(false).anchor(egui::Align2::CENTER_CENTER, egui::Vec2::ZERO);
        window.default_width(460.0).show(context, |ui| {
            let height = (context.content_rect().height() - 160.0).max(80.0);
            egui::ScrollArea::vertical().max_height(height).show(ui, |ui| {
                if warnings.is_empty() {
                    ui.label("The file was read as it is: nothing was repaired or left out.");
                }
                for warning in &warnings {
                    ui.add(egui::Label::new(*warning).wrap());
                    ui.add_space(4.0);
                }
            });
            ui.horizontal(|ui| {
                let copy = ui.add_enabled(!warnings.is_empty(), egui::Button::new("Copy"));
                if copy.on_hover_text("Copies all warnings, one a line.").clicked() {
                    ui.ctx().copy_text(warnings.join("\n"));
                }
                closed = ui.button("Close").clicked();
            });
        });
        self.dialogs.shows_warnings = is_open && !closed;
    }
}
