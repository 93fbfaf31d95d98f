//! The row for the lit sphere of the matcap overlay: one that is made in code, or that of an image.

use super::option_rows::with_note;
use crate::app::App;
use crate::app::dialogs::typed_path::Purpose;
use crate::app::jobs::matcap::ChosenMatcap;
use crate::commands::MATCAP_IMAGE;
use inspect::settings::{Choice, Matcap, options};

impl App {
    /// Asks for a picture of a lit sphere.
    pub(in crate::app) fn matcap_dialog(&mut self, context: &egui::Context) {
        self.dialog(Purpose::Matcap, context, || {
            let dialog = rfd::FileDialog::new().set_title("Open a matcap");
            dialog.add_filter("Images", &["png", "jpg", "jpeg", "webp"]).pick_file()
        });
    }

    /// The row. It is there while the overlay is on.
    pub(super) fn matcap_row(&mut self, ui: &mut egui::Ui) {
        if (options::MATCAP.no_effect)(&self.settings).is_some() {
            return;
        }
        let label = ui.label(options::MATCAP.label);
        let own = self.settings.matcap;
        let image = self.matcap.as_ref().map(ChosenMatcap::name);
        let shown = image.clone().unwrap_or_else(|| own.label().to_owned());
        let combo = egui::ComboBox::from_id_salt("Lit sphere").selected_text(shown).truncate();
        let combo = combo.show_ui(ui, |ui| {
            for &matcap in Matcap::ALL {
                let is_shown = image.is_none() && own == matcap;
                if ui.selectable_label(is_shown, matcap.label()).on_hover_text(matcap.text()).clicked() {
                    self.settings.matcap = matcap;
                    self.forget_matcap();
                }
            }
            if ui.selectable_label(image.is_some(), "Image file…").on_hover_text(MATCAP_IMAGE).clicked() {
                self.matcap_dialog(ui.ctx());
            }
        });
        combo.response.labelled_by(label.id).on_hover_text(with_note(options::MATCAP.text, "--matcap, --matcap-image"));
        ui.end_row();
    }
}
