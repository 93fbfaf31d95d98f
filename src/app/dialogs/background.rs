//! The window that chooses the colour behind the mesh.

use egui::Theme;

use crate::app::App;
use crate::app::widgets::{control_row, swatch};
use inspect::settings::{LIGHT_BACKGROUND, Settings, options};

impl App {
    /// The settings with the colour that is behind the mesh: the chosen one, or the theme's.
    pub(in crate::app) fn settings_in(&self, theme: Theme) -> Settings {
        let own = match theme {
            // Commands draw on this one too, so that copied commands needn't name it.
            Theme::Dark => None,
            Theme::Light => Some(LIGHT_BACKGROUND),
        };
        Settings { background: self.settings.background.or(own), ..self.settings }
    }

    /// The switch that lets the theme choose the colour behind the mesh.
    pub(in crate::app) fn background_switch(&mut self, ui: &mut egui::Ui) {
        let shown = self.settings_in(ui.ctx().theme()).background_color();
        let Some(unset) = &options::BACKGROUND.unset else { return };
        let mut follows = self.settings.background.is_none();
        if ui.checkbox(&mut follows, unset.label).on_hover_text(unset.text).changed() {
            self.settings.background = (!follows).then_some(shown);
        }
    }

    pub(in crate::app) fn background_window(&mut self, context: &egui::Context) {
        if !self.dialogs.chooses_background {
            return;
        }
        let mut is_open = true;
        let window = egui::Window::new("Background colour").open(&mut is_open);
        let window = window.resizable(false).collapsible(false).default_pos(context.content_rect().center());
        let mut is_chosen = false;
        window.show(context, |ui| {
            self.background_switch(ui);
            let mut color = self.settings_in(ui.ctx().theme()).background_color();
            egui::Grid::new("background").num_columns(2).show(ui, |ui| {
                for (name, channel) in ["Red", "Green", "Blue"].into_iter().zip(&mut color) {
                    let slider = egui::Slider::new(channel, 0..=255);
                    is_chosen |= control_row(ui, name, "sRGB, 0 to 255.", slider).changed();
                }
            });
            swatch(ui, color);
            if is_chosen {
                self.settings.background = Some(color);
            }
        });
        self.dialogs.chooses_background &= is_open;
    }
}
