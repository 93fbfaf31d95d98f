//! The rows for how the surface looks: its colours, light, background and section.

use super::option_rows::{option_hover, option_row, shown_option_row};
use crate::app::App;
use crate::app::jobs::companion_files::OpenFile;
use crate::app::widgets::{button_row, file_row, list_row};
use crate::commands::{CLOSE_ENVIRONMENT, CompanionFile, ENVIRONMENT, MATCAP_IMAGE, Purpose, with_note};
use inspect::settings::{Choice, Lighting, Matcap, options};

impl App {
    pub(super) fn look_rows(&mut self, ui: &mut egui::Ui) {
        for option in [
            &options::CURVATURE_KIND,
            &options::CURVATURE_SCALE,
            &options::ZEBRA_STRIPES,
            &options::ZEBRA_DIRECTION,
            &options::CHECKER_SQUARES,
            &options::TEXEL_DENSITY_PER,
        ] {
            shown_option_row(ui, option, &mut self.settings);
        }
        self.matcap_row(ui);
        self.light_rows(ui);
        self.background_row(ui);
        option_row(ui, &options::SECTION, &mut self.settings, "");
        shown_option_row(ui, &options::SECTION_AT, &mut self.settings);
    }

    fn background_row(&mut self, ui: &mut egui::Ui) {
        let label = ui.label(options::BACKGROUND.label);
        ui.horizontal(|ui| {
            let mut color = self.settings_in(ui.ctx().theme()).background_color();
            // Narrow, so that the switch beside it has room in any size of the text.
            ui.spacing_mut().interact_size.x = 36.0;
            let response = ui.color_edit_button_srgb(&mut color).labelled_by(label.id);
            if response.has_focus() {
                let stroke = ui.visuals().selection.stroke;
                ui.painter().rect_stroke(response.rect.expand(2.0), 3.0, stroke, egui::StrokeKind::Outside);
            }
            if response.on_hover_text(option_hover(&options::BACKGROUND, "")).changed() {
                self.settings.background = Some(color);
            }
            self.background_switch(ui);
        });
        ui.end_row();
    }

    /// The row for the lit sphere of the matcap overlay: one that is made in code, or that of an image. It is there while the overlay is on.
    fn matcap_row(&mut self, ui: &mut egui::Ui) {
        if (options::MATCAP.no_effect)(&self.settings).is_some() {
            return;
        }
        let own = self.settings.matcap;
        let image = self.matcap.as_ref().map(OpenFile::name);
        let shown = image.clone().unwrap_or_else(|| own.label().to_owned());
        let hover = with_note(options::MATCAP.text, "--matcap, --matcap-image");
        list_row(ui, options::MATCAP.label, &hover, &shown, |ui| {
            for matcap in Matcap::ALL {
                let is_shown = image.is_none() && own == matcap;
                if ui.selectable_label(is_shown, matcap.label()).on_hover_text(matcap.text()).clicked() {
                    self.settings.matcap = matcap;
                    self.close_companion(CompanionFile::Matcap);
                }
            }
            if ui.selectable_label(image.is_some(), "Image file…").on_hover_text(MATCAP_IMAGE).clicked() {
                self.ask_for(ui.ctx(), Purpose::CompanionFile(CompanionFile::Matcap));
            }
        });
    }

    /// Rows are there only where their options have an effect.
    fn light_rows(&mut self, ui: &mut egui::Ui) {
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
