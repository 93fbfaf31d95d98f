//! The rows for the light that the mesh's own materials are seen in.

use super::option_rows::{option_hover, option_row};
use crate::app::App;
use crate::app::widgets::{button_row, file_row};
use crate::commands::{CLOSE_ENVIRONMENT, CompanionFile, ENVIRONMENT, Purpose};
use inspect::settings::{Lighting, options};

impl App {
    /// Rows are there only where their options have an effect.
    pub(in crate::app) fn light_rows(&mut self, ui: &mut egui::Ui) {
        if (options::LIGHTING.no_effect)(&self.settings).is_some() {
            return;
        }
        self.lighting_row(ui);
        if !self.settings.shows_materials() {
            return;
        }
        self.environment_row(ui);
        let has_lights = self.document.as_ref().is_some_and(|document| !document.loaded.mesh.lights.is_empty());
        let settings = &mut self.settings;
        if has_lights {
            option_row(ui, &options::LIGHTS, settings, "");
        }
        for option in
            [&options::ENVIRONMENT_BRIGHTNESS, &options::EXPOSURE, &options::TONE_CURVE, &options::LIGHT_ROTATION]
        {
            option_row(ui, option, settings, "");
        }
        ui.label("");
        let option = &options::ENVIRONMENT_BACKGROUND;
        ui.checkbox(&mut settings.environment_background, option.label).on_hover_text(option_hover(option, ""));
        ui.end_row();
    }

    /// The choice of the light. That of a file needs a file, so without one it asks for it.
    fn lighting_row(&mut self, ui: &mut egui::Ui) {
        let before = self.settings.lighting;
        option_row(ui, &options::LIGHTING, &mut self.settings, "");
        let is_new = self.settings.lighting == Lighting::Environment && before != Lighting::Environment;
        if is_new && self.environment.is_none() {
            self.settings.lighting = before;
            self.ask_for(ui.ctx(), Purpose::CompanionFile(CompanionFile::Environment));
        }
    }

    /// The file of light that is open, and a button that closes it or opens one.
    fn environment_row(&mut self, ui: &mut egui::Ui) {
        if let Some(open) = &self.environment {
            file_row(ui, "Panorama", "The file of light that is open (--environment).", &open.from);
            if button_row(ui, "Close environment", CLOSE_ENVIRONMENT) {
                self.close_companion(CompanionFile::Environment);
            }
        } else if button_row(ui, "Open environment…", ENVIRONMENT) {
            self.ask_for(ui.ctx(), Purpose::CompanionFile(CompanionFile::Environment));
        }
    }
}
