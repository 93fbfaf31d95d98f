//! The rows for functions of the user's own in place of LOD.

use egui::RichText;

use crate::app::App;
use crate::app::dialogs::typed_path::Purpose;

impl App {
    /// Asks for the file with the functions.
    pub(in crate::app) fn lod_shader_dialog(&mut self, context: &egui::Context) {
        self.dialog(Purpose::LodShader, context, || {
            rfd::FileDialog::new().set_title("Choose an LOD shader").add_filter("WGSL", &["wgsl"]).pick_file()
        });
    }

    /// The rows, if a file is open. Returns whether it takes the place of LOD, so that nothing of that can be set.
    pub(super) fn lod_shader_rows(&mut self, ui: &mut egui::Ui) -> bool {
        let Some(open) = &self.lod_shader else { return false };
        ui.label("LOD shader").on_hover_text("Functions of this file compute factors in place of LOD.");
        ui.add(egui::Label::new(open.name()).truncate()).on_hover_text(open.path.display().to_string());
        ui.end_row();
        if let Some(error) = open.error() {
            let stays = if open.is_used() { "The version before it stays." } else { "LOD stays." };
            ui.label("");
            let text = RichText::new(format!("{error}\n{stays}")).color(ui.visuals().error_fg_color);
            ui.add(egui::Label::new(text).wrap());
            ui.end_row();
        }
        ui.label("");
        let hover = "Reads the file again. That happens by itself whenever it changes.";
        let reads = ui.button("Read again").on_hover_text(hover).clicked();
        ui.end_row();
        // The panel is too narrow for both buttons beside each other.
        ui.label("");
        let hover = "Closes the LOD shader. LOD computes factors again.";
        let closes = ui.button("Close the shader").on_hover_text(hover).clicked();
        ui.end_row();
        if reads {
            self.reload_lod_shader(ui.ctx());
        }
        if closes {
            self.forget_lod_shader();
        }
        self.uses_lod_shader()
    }
}
