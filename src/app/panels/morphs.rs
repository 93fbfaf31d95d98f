//! The list of the file's morph targets, with a slider for the weight of each.

use egui::{Align, Button, Label, Layout, Response, Sense, Slider, SliderClamping, Ui, vec2};

use super::parts::{LONGEST, name_filter};
use crate::app::App;
use crate::app::jobs::job_list::{LeftChoice, Work};
use crate::app::sections::Section;
use crate::app::widgets::{LABEL_WIDTH, list};
use crate::commands::CompanionFile;
use geometry::names::{shortened, shown};
use load::MorphWeights;

impl App {
    /// A slider for each morph target, if the edited half's file has any. The mesh is loaded again with other weights.
    pub(in crate::app) fn morphs_section(&mut self, ui: &mut Ui, is_left: bool) {
        let right = self.preparation().parts.morphs;
        let (from, before) = match self.left_choice().filter(|_| is_left) {
            Some(LeftChoice::Kept(_)) => return,
            Some(LeftChoice::Read(from, morphs)) => (from, morphs),
            None if is_left => Default::default(),
            None => (None, right.clone()),
        };
        let left = self.left_mesh.as_ref().filter(|left| from.as_ref() == Some(&left.content.source));
        let of_left = || left.map(|left| left.content.contents.clone()).unwrap_or_default();
        let contents = if from.is_some() { of_left() } else { self.contents() };
        let targets = &contents.morph_targets;
        if targets.is_empty() || !self.panels.open.title(ui, Section::MorphTargets) {
            return;
        }
        let hover = "Lists the morph targets whose names contain this.";
        let filter = &mut self.panels.morphs_filter;
        let filter = name_filter(ui, "Filter morph targets by name", hover, targets.len(), filter);
        let listed: Vec<_> = targets.iter().filter(|(name, _)| name.to_lowercase().contains(&filter)).collect();
        let mut weights = self.panels.dragged_morphs.take().unwrap_or_else(|| before.clone());
        list(ui, "morph targets", listed.len(), (filter.len(), 0), |ui, row| {
            let (name, rest) = listed[row];
            // The left half has what it doesn't have of its own from the right one.
            let rest = right.get(name).filter(|_| is_left && from.is_none()).unwrap_or(rest);
            morph_row(ui, name, *rest, &mut weights)
        });
        let button = ui.add_enabled(!weights.is_empty(), Button::new("Reset morph targets"));
        if button.on_hover_text("Takes back all weights that were chosen.").clicked() {
            weights.clear();
        }
        // A drag is followed from load to load: if each step stopped the load before it, none would be seen.
        let work = if is_left { Work::Companion(CompanionFile::LeftMesh) } else { Work::Mesh };
        if weights != before && self.jobs.has(work) && ui.ctx().egui_is_using_pointer() {
            self.panels.dragged_morphs = Some(weights);
        } else if !is_left {
            self.prepare(ui.ctx(), |preparation| preparation.parts.morphs = weights);
        } else if weights != before {
            self.read_left(ui.ctx(), from, weights);
        }
    }
}

/// A morph target's row: its name, and its weight, which is `rest` unless another one is chosen.
fn morph_row(ui: &mut Ui, name: &str, rest: f32, weights: &mut MorphWeights) -> Response {
    let hover = format!(
        "{}: its weight where no clip moves it (--morph, --split-morph). A double click on the name resets it to {rest}.",
        shown(name)
    );
    let mut weight = weights.get(name).copied().unwrap_or(rest);
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
        weights.remove(name);
    } else if slider.changed() {
        weights.insert(name.to_owned(), weight);
    }
    // The slider needs the arrow keys for itself.
    label
}
