//! The row for the lit sphere of the matcap overlay: one that is made in code, or that of an image.

use crate::app::App;
use crate::app::jobs::companion_files::OpenFile;
use crate::app::widgets::list_row;
use crate::commands::{CompanionFile, MATCAP_IMAGE, Purpose, with_note};
use inspect::settings::{Choice, Matcap, options};

impl App {
    /// The row. It is there while the overlay is on.
    pub(super) fn matcap_row(&mut self, ui: &mut egui::Ui) {
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
}
