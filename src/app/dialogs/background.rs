//! The window that chooses the colour behind the mesh.

use egui::color_picker::{Alpha, color_picker_color32};

use crate::app::App;
use crate::app::widgets::rgb;

impl App {
    pub(in crate::app) fn background_window(&mut self, context: &egui::Context) {
        if !self.dialogs.chooses_background {
            return;
        }
        let window = egui::Window::new("Background colour").open(&mut self.dialogs.chooses_background);
        let window = window.resizable(false).collapsible(false).default_pos(context.content_rect().center());
        window.show(context, |ui| {
            let mut color = rgb(self.settings.background);
            if color_picker_color32(ui, &mut color, Alpha::Opaque) {
                let [r, g, b, _] = color.to_array();
                self.settings.background = [r, g, b];
            }
        });
    }
}
