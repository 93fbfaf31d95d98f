//! The list of the file's parts, which can be hidden, and the menu of a part, which is over the picture too.

use std::sync::Arc;

use crate::app::App;
use crate::app::sections::Section;
use crate::app::text::{counted, grouped};
use crate::app::widgets::{list, switch_button};
use crate::commands::{Action, CameraAction, all};
use geometry::names::{shortened, shown};
use inspect::render::framed_size;
use load::ShownParts;
use load::parts::Part;

/// The greatest length of a name in the list, in characters.
const LONGEST: usize = 40;

/// So many parts have a filter.
const MANY: usize = 8;

/// What is done with a part: a place in the list of parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum PartAction {
    /// Shows it, or hides it.
    Set(usize, bool),
    /// Shows it alone.
    Solo(usize),
    Frame(usize),
    ShowAll,
}

impl App {
    /// A switch for each part, if the file has several. The mesh is loaded again without those that are hidden.
    pub(in crate::app) fn parts_section(&mut self, ui: &mut egui::Ui) {
        let Some(document) = self.document.as_ref().filter(|document| document.loaded.parts.len() > 1) else { return };
        let parts = document.loaded.parts.clone();
        if !self.panels.open.title(ui, Section::Parts) {
            return;
        }
        let picked = self.picked_part();
        let filter = &mut self.panels.parts_filter;
        if parts.len() > MANY {
            let field =
                egui::TextEdit::singleline(filter).hint_text("Filter parts by name").desired_width(f32::INFINITY);
            let field = ui.add(field).on_hover_text("Lists the parts whose names contain this.");
            ui.ctx().accesskit_node_builder(field.id, |node| node.set_label("Filter parts by name"));
        } else {
            filter.clear();
        }
        let filter = filter.to_lowercase();
        let listed: Vec<usize> =
            (0..parts.len()).filter(|&part| parts[part].name.to_lowercase().contains(&filter)).collect();
        let mut action = None;
        list(ui, "parts", listed.len(), 0, |ui, row| {
            let part = listed[row];
            let (response, chosen) = part_row(ui, &parts, part, picked == Some(part));
            action = chosen.or(action);
            response.context_menu(|ui| action = part_entries(ui, &parts, part).or(action));
            response
        });
        let hidden = parts.iter().filter(|part| part.is_hidden).count();
        ui.horizontal(|ui| {
            let button = ui.add_enabled(hidden > 0, egui::Button::new("Show all parts"));
            if button.on_hover_text("Shows the parts that are hidden.").clicked() {
                action = Some(PartAction::ShowAll);
            }
            let [shown, all] = [parts.len() - hidden, parts.len()].map(|count| grouped(count as u64));
            ui.weak(format!("{shown} of {all} shown"));
        });
        action.into_iter().for_each(|action| self.act_on_parts(&parts, action));
    }

    /// The part of the selected triangle: a place in the list of parts.
    pub(in crate::app) fn picked_part(&self) -> Option<usize> {
        let (document, triangle) = (self.document.as_ref()?, self.selected_triangle()?);
        document.loaded.mesh.part_of(triangle).map(|part| part as usize)
    }

    /// The menu of what was clicked with the right button in the picture.
    pub(in crate::app) fn part_menu(&mut self, ui: &mut egui::Ui) {
        let parts = self.document.as_ref().map(|document| document.loaded.parts.clone()).unwrap_or_default();
        let picked = self.picked_part().filter(|_| parts.len() > 1);
        let action = picked.and_then(|part| {
            ui.strong(shortened(&shown(&parts[part].name), LONGEST));
            part_entries(ui, &parts, part)
        });
        if picked.is_some() {
            ui.separator();
        }
        let now = self.availability();
        let commands = all(&now);
        for (action, label) in [
            (Action::Camera(CameraAction::FramePatch), "Frame patch"),
            (Action::Camera(CameraAction::Frame), "Frame all"),
            (Action::Deselect, "Deselect"),
        ] {
            self.command_button(ui, &commands, &now, &action, [label; 2]);
        }
        action.into_iter().for_each(|action| self.act_on_parts(&parts, action));
    }

    fn act_on_parts(&mut self, parts: &[Part], action: PartAction) {
        match action {
            PartAction::Set(part, is_shown) => Arc::make_mut(&mut self.parts).set(&parts[part].name, is_shown),
            PartAction::Solo(part) => {
                self.parts = Arc::new(ShownParts::alone(&parts[part].name).styled_as(&self.parts));
            }
            PartAction::Frame(part) => self.frame_part(part as u32),
            PartAction::ShowAll => self.parts = Arc::new(ShownParts::default().styled_as(&self.parts)),
        }
    }

    fn frame_part(&mut self, part: u32) {
        let Some(document) = &self.document else { return };
        if let Some(bounds) = document.shown().0.part_bounds(part) {
            let size = framed_size(self.viewport.picture.size(), &self.settings);
            self.viewport.camera.frame(&bounds, size);
        }
    }
}

/// A part's row: whether it is shown, and a button that shows it alone. Returns the switch, and what is to be done.
fn part_row(ui: &mut egui::Ui, parts: &[Part], number: usize, is_picked: bool) -> (egui::Response, Option<PartAction>) {
    let part = &parts[number];
    let hover = format!(
        "{}: {}. A part that is hidden is left out, as if the file didn't have it (--hide-part). Right-click for more.",
        shown(&part.name),
        counted(part.triangles.into(), "triangle")
    );
    let is_alone = !part.is_hidden && parts.iter().filter(|part| !part.is_hidden).count() == 1;
    let mut is_shown = !part.is_hidden;
    let mut action = None;
    let height = ui.spacing().interact_size.y;
    let from_right = egui::Layout::right_to_left(egui::Align::Center);
    let row = egui::vec2(ui.available_width(), height);
    let response = ui.allocate_ui_with_layout(row, from_right, |ui| {
        let alone = ui.add(switch_button(is_alone, "Solo"));
        let name = format!("Show only {}", shown(&part.name));
        alone.widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, true, is_alone, &name));
        if alone.on_hover_text("Shows this part alone; a second click shows all (--show-part).").clicked() {
            action = Some(if is_alone { PartAction::ShowAll } else { PartAction::Solo(number) });
        }
        let name = shortened(&shown(&part.name), LONGEST);
        let name = if is_picked { egui::RichText::new(name).strong() } else { egui::RichText::new(name) };
        let layout = egui::Layout::left_to_right(egui::Align::Center);
        ui.with_layout(layout, |ui| ui.checkbox(&mut is_shown, name).on_hover_text(hover)).inner
    });
    if response.inner.changed() {
        action = Some(PartAction::Set(number, is_shown));
    }
    (response.inner, action)
}

/// What can be done with a part.
fn part_entries(ui: &mut egui::Ui, parts: &[Part], part: usize) -> Option<PartAction> {
    let (is_hidden, are_hidden) = (parts[part].is_hidden, parts.iter().any(|part| part.is_hidden));
    let entries = [
        (PartAction::Frame(part), "Frame this part", !is_hidden),
        (PartAction::Solo(part), "Show only this part", true),
        (PartAction::Set(part, false), "Hide this part", !is_hidden),
        (PartAction::Set(part, true), "Show this part", is_hidden),
        (PartAction::ShowAll, "Show all parts", are_hidden),
    ];
    let chosen = |(action, label, is_possible): (_, &str, bool)| {
        ui.add_enabled(is_possible, egui::Button::new(label)).clicked().then_some(action)
    };
    let chosen = entries.into_iter().filter_map(chosen).last();
    if chosen.is_some() {
        ui.close();
    }
    chosen
}
