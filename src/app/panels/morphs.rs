//! The list of the file's morph targets, with a slider for the weight of each.

use std::sync::Arc;

use egui::{Align, Button, Label, Layout, Response, Sense, Slider, SliderClamping, Ui, vec2};

use super::parts::{LONGEST, filtered};
use crate::app::App;
use crate::app::sections::Section;
use crate::app::widgets::{LABEL_WIDTH, list};
use geometry::names::{shortened, shown};
use load::ShownParts;

impl App {
    /// A slider for each morph target, if the file has any. The mesh is loaded again with other weights.
    pub(in crate::app) fn morphs_section(&mut self, ui: &mut Ui) {
        let contents = self.contents();
        let targets: Vec<_> = contents.morph_targets.iter().collect();
        if targets.is_empty() || !self.panels.open.title(ui, Section::MorphTargets) {
            return;
        }
        let names = targets.iter().map(|(name, _)| name.as_str());
        let listed = filtered(ui, "morph targets", &mut self.panels.morphs_filter, names);
        list(ui, "morph targets", listed.len(), 0, |ui, row| {
            let (name, rest) = targets[listed[row]];
            morph_row(ui, name, *rest, &mut self.parts)
        });
        let button = ui.add_enabled(!self.parts.morphs.is_empty(), Button::new("Reset morph targets"));
        if button.on_hover_text("Gives all morph targets the weights that the file says.").clicked() {
            Arc::make_mut(&mut self.parts).morphs.clear();
        }
    }
}

/// A morph target's row: its name, and its weight, which is `rest` in the file.
fn morph_row(ui: &mut Ui, name: &str, rest: f32, parts: &mut Arc<ShownParts>) -> Response {
    let hover = format!(
        "{}: its weight where no clip moves it (--morph). A double click on the name gives it that of the file: {rest}.",
        shown(name)
    );
    let mut weight = parts.morphs.get(name).copied().unwrap_or(rest);
    let row = ui.horizontal(|ui| {
        let size = vec2(LABEL_WIDTH, ui.spacing().interact_size.y);
        let label = ui.allocate_ui_with_layout(size, Layout::left_to_right(Align::Center), |ui| {
            ui.set_min_width(LABEL_WIDTH);
            ui.add(Label::new(shortened(&shown(name), LONGEST)).truncate().sense(Sense::click()))
        });
        let label = label.inner.on_hover_text(&hover);
        let number = ui.spacing().interact_size.x + ui.spacing().item_spacing.x;
        ui.spacing_mut().slider_width = (ui.available_width() - number).max(number);
        let slider = Slider::new(&mut weight, 0.0..=1.0).clamping(SliderClamping::Never).max_decimals(2);
        let slider = ui.add(slider.update_while_editing(false)).labelled_by(label.id).on_hover_text(&hover);
        (label, slider)
    });
    let (label, slider) = row.inner;
    if label.double_clicked() {
        Arc::make_mut(parts).morphs.remove(name);
    } else if slider.changed() {
        Arc::make_mut(parts).morphs.insert(name.to_owned(), weight);
    }
    // The slider needs the arrow keys for itself.
    label
}
