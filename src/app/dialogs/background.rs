//! The window that chooses the colour behind the mesh.

use crate::app::App;
use crate::app::widgets::swatch;

impl App {
    pub(in crate::app) fn background_window(&mut self, context: &egui::Context) {
        if !self.dialogs.chooses_background {
            return;
        }
        let window = egui::Window::new("Background colour").open(&mut self.dialogs.chooses_background);
        let window = window.resizable(false).collapsible(false).default_pos(context.content_rect().center());
        window.show(context, |ui| {
            egui::Grid::new("background").num_columns(2).show(ui, |ui| {
                for (name, channel) in ["Red", "Green", "Blue"].into_iter().zip(&mut self.settings.background) {
                    let label = ui.label(name).on_hover_text("sRGB, 0 to 255.");
                    ui.add(egui::Slider::new(channel, 0..=255)).labelled_by(label.id);
                    ui.end_row();
                }
            });
            swatch(ui, self.settings.background);
        });
    }
}
