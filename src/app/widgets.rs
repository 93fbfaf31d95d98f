//! Pieces that the panels share.

use egui::RichText;

/// A section's name, and a line under it.
pub fn heading(ui: &mut egui::Ui, text: &str) {
    ui.add_space(8.0);
    ui.label(RichText::new(text).strong());
    ui.separator();
}

/// A row with a name and a list to choose from.
pub fn chooser<T: Copy + PartialEq>(
    ui: &mut egui::Ui,
    name: &str,
    hover: &str,
    value: &mut T,
    choices: &[(T, &str, &str)],
) {
    let label = ui.label(name);
    let shown = choices.iter().find(|(choice, ..)| choice == value).map_or("", |(_, text, _)| text);
    let combo = egui::ComboBox::from_id_salt(name).selected_text(shown).show_ui(ui, |ui| {
        for (choice, text, hover) in choices {
            ui.selectable_value(value, *choice, *text).on_hover_text(*hover);
        }
    });
    combo.response.labelled_by(label.id).on_hover_text(hover);
    ui.end_row();
}

/// A row with a name and a right-aligned number.
pub fn fact(ui: &mut egui::Ui, name: &str, value: &str, hover: &str) {
    ui.label(name).on_hover_text(hover);
    number(ui, value);
    ui.end_row();
}

/// Right-aligned, all digits as wide.
pub fn number(ui: &mut egui::Ui, text: &str) {
    ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| ui.label(RichText::new(text).monospace()));
}

/// A patch of colour, as in a legend.
pub fn swatch(ui: &mut egui::Ui, [r, g, b]: [u8; 3]) {
    let (rect, _) = ui.allocate_exact_size(egui::vec2(14.0, 10.0), egui::Sense::hover());
    ui.painter().rect_filled(rect, 2.0, egui::Color32::from_rgb(r, g, b));
}

/// A field of the status line, of one width whatever it says.
pub fn status(ui: &mut egui::Ui, width: f32, text: impl Into<egui::WidgetText>, hover: &str) {
    let height = ui.spacing().interact_size.y;
    ui.allocate_ui_with_layout(egui::vec2(width, height), egui::Layout::left_to_right(egui::Align::Center), |ui| {
        ui.set_min_width(width);
        ui.label(text).on_hover_text(hover);
    });
    ui.separator();
}
