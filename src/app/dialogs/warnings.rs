//! The list of what was repaired or left out when the mesh was read.

use crate::app::App;

impl App {
    pub(in crate::app) fn warnings_window(&mut self, context: &egui::Context) {
        let Some(document) = self.document.as_ref().filter(|_| self.dialogs.shows_warnings) else { return };
        let warnings = &document.loaded.warnings;
        let mut closed = false;
        let window = egui::Window::new("Warnings").open(&mut self.dialogs.shows_warnings);
        let window = window.resizable(false).collapsible(false).anchor(egui::Align2::CENTER_CENTER, egui::Vec2::ZERO);
        window.default_width(460.0).show(context, |ui| {
            let height = (context.content_rect().height() - 160.0).max(80.0);
            egui::ScrollArea::vertical().max_height(height).show(ui, |ui| {
                if warnings.is_empty() {
                    ui.label("The file was read as it is: nothing was repaired or left out.");
                }
                for warning in warnings {
                    ui.add(egui::Label::new(warning).wrap());
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
        if closed {
            self.dialogs.shows_warnings = false;
        }
    }
}
