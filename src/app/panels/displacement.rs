//! Displacement: the image that loads the mesh again, and what is done with it.

use std::path::{Path, PathBuf};

use crate::app::App;
use crate::app::dialogs::typed_path::Purpose;
use crate::app::text::short;
use crate::app::widgets::value_chooser;
use crate::commands::{Action, key_name, value_names};
use crate::load::{HeightSource, Source};
use crate::settings::{HEIGHT_RANGE, MIDLEVEL_RANGE};
use crate::tessellate::Displacement;

/// Whether a path names an image rather than a mesh.
fn is_image(path: &Path) -> bool {
    let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
    matches!(extension.as_deref(), Some("png" | "jpg" | "jpeg"))
}

impl App {
    /// Opens a mesh, or displaces the one that is open by an image.
    pub fn open_path(&mut self, context: &egui::Context, path: PathBuf) {
        if is_image(&path) && self.document.is_some() {
            self.displace(context, Some(HeightSource::File(path)));
        } else {
            self.open(context, Source::File(path));
        }
    }

    /// Asks for an image to displace the mesh by.
    pub(in crate::app) fn height_dialog(&mut self, context: &egui::Context) {
        self.dialog(Purpose::Heights, context, || {
            let dialog = rfd::FileDialog::new().set_title("Open a height image");
            dialog.add_filter("Images", &["png", "jpg", "jpeg"]).pick_file()
        });
    }

    /// Loads the same mesh again with other heights, which displace it once they are there.
    pub fn displace(&mut self, context: &egui::Context, heights: Option<HeightSource>) {
        self.prepare(context, |preparation| preparation.heights = heights);
    }

    /// Another mesh is shown, or the same with other heights: first ones displace it, and without any nothing does.
    pub(in crate::app) fn take_heights(&mut self, before: Option<&HeightSource>) {
        self.settings.displacement = match (self.has_heights(), before) {
            (true, None) => Displacement::On,
            (true, Some(_)) => return,
            (false, _) => Displacement::Off,
        };
        // Nobody set it, so nobody takes it back.
        self.history.displace(self.settings.displacement);
    }

    pub(in crate::app) fn has_heights(&self) -> bool {
        self.document.as_ref().is_some_and(|document| document.loaded.mesh.heights.is_some())
    }

    /// The image's row; and while there is one, what is done with it.
    pub(in crate::app) fn height_rows(&mut self, ui: &mut egui::Ui) {
        let heights = self.preparation().heights;
        let label = ui.label("Heights");
        let shown = heights.as_ref().map_or("None".to_owned(), HeightSource::title);
        let mut chosen = None;
        let combo = egui::ComboBox::from_id_salt("Heights").selected_text(shown).truncate();
        let combo = combo.show_ui(ui, |ui| {
            let mut entry = |text: &str, is_shown: bool, hover: &str| {
                ui.selectable_label(is_shown, text).on_hover_text(hover).clicked()
            };
            if entry("None", heights.is_none(), "The surface isn't displaced.") {
                chosen = Some(None);
            }
            let is_material = heights == Some(HeightSource::Materials);
            if entry("Material", is_material, "The brightness of each material's base colour image.") {
                chosen = Some(Some(HeightSource::Materials));
            }
            let is_file = matches!(heights, Some(HeightSource::File(_)));
            if entry("Image file…", is_file, value_names::HEIGHT_IMAGE) {
                self.height_dialog(ui.ctx());
            }
        });
        combo.response.labelled_by(label.id).on_hover_text(
            "What the surface is displaced by: black is 0 and white is 1. An image that is dropped on the window is taken too \
             (--height).",
        );
        ui.end_row();
        if let Some(chosen) = chosen.filter(|chosen| *chosen != heights) {
            self.displace(ui.ctx(), chosen);
        }
        if self.has_heights() {
            self.displacement_rows(ui);
        }
    }

    pub(in crate::app) fn toggle_displacement(&mut self) {
        if !self.has_heights() {
            return;
        }
        let last = std::mem::replace(&mut self.panels.last_displacement, self.settings.displacement);
        self.settings.displacement = match self.settings.displacement {
            Displacement::Off if last == Displacement::Off => Displacement::On,
            Displacement::Off => last,
            _ => Displacement::Off,
        };
    }

    fn displacement_rows(&mut self, ui: &mut egui::Ui) {
        let heights = self.document.as_ref().and_then(|document| document.loaded.mesh.heights.clone());
        let radius = heights.map_or(0.0, |heights| heights.radius);
        let settings = &mut self.settings;
        let hover = format!(
            "Whether the surface is displaced, and what its patches agree on where they meet ({}; --displacement).",
            key_name(&Action::ToggleDisplacement)
        );
        value_chooser(ui, "Displace", &hover, &mut settings.displacement, &value_names::DISPLACEMENTS);
        let is_on = settings.displacement != Displacement::Off;
        let units = short(f64::from(settings.height_scale * radius));
        let hover =
            format!("How far white is above black, in bounding radii (r) of the mesh at rest: {units} units here.");
        let label = ui.label("Scale").on_hover_text(&hover);
        let slider = egui::Slider::new(&mut settings.height_scale, HEIGHT_RANGE).max_decimals(3).suffix(" r");
        ui.add_enabled(is_on, slider.update_while_editing(false)).labelled_by(label.id).on_hover_text(&hover);
        ui.end_row();
        let hover = "The height that stays where it is, from 0, black, to 1, white.";
        let label = ui.label("Midlevel").on_hover_text(hover);
        let slider = egui::Slider::new(&mut settings.midlevel, MIDLEVEL_RANGE).max_decimals(2);
        ui.add_enabled(is_on, slider.update_while_editing(false)).labelled_by(label.id).on_hover_text(hover);
        ui.end_row();
    }
}
