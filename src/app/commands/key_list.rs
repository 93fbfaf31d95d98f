//! Help > Keys: every key and what it does, made from the table of commands.

use crate::app::App;
use crate::commands::{GESTURES, all, shown_key};

/// Points that the list leaves free above and below it, so that its whole window fits on the screen.
const MARGIN: f32 = 120.0;

impl App {
    pub(in crate::app) fn keys_window(&mut self, context: &egui::Context) {
        if !self.commands.shows_keys {
            return;
        }
        let commands = all(&self.availability());
        let height = (context.content_rect().height() - MARGIN).max(100.0);
        let window = egui::Window::new("Keys").open(&mut self.commands.shows_keys).resizable(false).collapsible(false);
        let window = window.anchor(egui::Align2::CENTER_CENTER, egui::Vec2::ZERO);
        window.show(context, |ui| {
            let area = egui::ScrollArea::vertical().min_scrolled_height(height).max_height(height);
            area.auto_shrink([true, true]).show(ui, |ui| {
                egui::Grid::new("keys").num_columns(2).striped(true).show(ui, |ui| {
                    let mut row = |keys: &str, name: &str, text: &str| {
                        ui.strong(keys);
                        ui.label(name).on_hover_text(text);
                        ui.end_row();
                    };
                    GESTURES.iter().for_each(|(gesture, text)| row(gesture, text, text));
                    for command in commands.iter().filter(|command| !command.keys.is_empty()) {
                        let keys: Vec<_> = command.keys.iter().map(|key| shown_key(context, key)).collect();
                        row(&keys.join(", "), &command.name, &command.text);
                    }
                });
            });
        });
    }
}
