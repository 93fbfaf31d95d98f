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

/// The greatest length of a name in a list, in characters.
pub(super) const LONGEST: usize = 40;

/// Longer lists of names have a filter.
const MANY: usize = 8;

impl App {
    /// A switch for each part, if the file has several. The mesh is loaded again without those that are hidden.
    pub(in crate::app) fn parts_section(&mut self, ui: &mut egui::Ui) {
        let contents = self.contents();
        let parts = &contents.parts;
        if parts.len() <= 1 || !self.panels.open.title(ui, Section::Parts) {
            return;
        }
        let picked = self.picked_part();
        let names = parts.iter().map(|part| part.name.as_str());
        let listed = filtered(ui, "parts", &mut self.panels.parts_filter, names);
        let mut framed = None;
        list(ui, "parts", listed.len(), 0, |ui, row| {
            let part = listed[row];
            let response = part_row(ui, parts, part, picked == Some(part), &mut self.parts);
            response.context_menu(|ui| {
                let is_framed = part_entries(ui, parts, part, &mut self.parts);
                framed = is_framed.then_some(part).or(framed);
            });
            response
        });
        let hidden = parts.iter().filter(|part| part.is_hidden).count();
        ui.horizontal(|ui| {
            let button = ui.add_enabled(hidden > 0, egui::Button::new("Show all parts"));
            if button.on_hover_text("Shows the parts that are hidden.").clicked() {
                Arc::make_mut(&mut self.parts).show_only(Vec::new());
            }
            let [shown, all] = [parts.len() - hidden, parts.len()].map(|count| grouped(count as u64));
            ui.weak(format!("{shown} of {all} shown"));
        });
        framed.into_iter().for_each(|part| self.frame_part(part));
    }

    /// The part of the selected triangle: a place in the list of parts.
    pub(in crate::app) fn picked_part(&self) -> Option<usize> {
        let (document, triangle) = (self.document.as_ref()?, self.selected_triangle()?);
        document.loaded.mesh.part_of(triangle).map(|part| part as usize)
    }

    /// The menu of what was clicked with the right button in the picture.
    pub(in crate::app) fn part_menu(&mut self, ui: &mut egui::Ui) {
        let contents = self.contents();
        let parts = &contents.parts;
        if let Some(part) = self.picked_part().filter(|_| parts.len() > 1) {
            ui.strong(shortened(&shown(&parts[part].name), LONGEST));
            if part_entries(ui, parts, part, &mut self.parts) {
                self.frame_part(part);
            }
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
    }

    fn frame_part(&mut self, part: usize) {
        let Some(document) = &self.document else { return };
        if let Some(bounds) = document.shown().0.part_bounds(part as u32) {
            let size = framed_size(self.viewport.picture.size(), &self.settings);
            self.viewport.camera.frame(&bounds, size);
        }
    }
}

/// A field that filters names of some things, if there are many. Returns the places of those that contain what was typed.
pub(super) fn filtered<'a>(
    ui: &mut egui::Ui,
    what: &str,
    filter: &mut String,
    names: impl ExactSizeIterator<Item = &'a str>,
) -> Vec<usize> {
    if names.len() > MANY {
        let label = format!("Filter {what} by name");
        let field = egui::TextEdit::singleline(filter).hint_text(&label).desired_width(f32::INFINITY);
        let field = ui.add(field).on_hover_text(format!("Lists the {what} whose names contain this."));
        ui.ctx().accesskit_node_builder(field.id, |node| node.set_label(label));
    } else {
        filter.clear();
    }
    let filter = filter.to_lowercase();
    names.enumerate().filter(|(_, name)| name.to_lowercase().contains(&filter)).map(|(place, _)| place).collect()
}

/// A part's row: whether it is shown, and a button that shows it alone. Returns the switch.
fn part_row(
    ui: &mut egui::Ui,
    parts: &[Part],
    number: usize,
    is_picked: bool,
    chosen: &mut Arc<ShownParts>,
) -> egui::Response {
    let part = &parts[number];
    let hover = format!(
        "{}: {}. A part that is hidden is left out, as if the file didn't have it (--hide-part). Right-click for more.",
        shown(&part.name),
        counted(part.triangles.into(), "triangle")
    );
    let is_alone = !part.is_hidden && parts.iter().filter(|part| !part.is_hidden).count() == 1;
    let mut is_shown = !part.is_hidden;
    let height = ui.spacing().interact_size.y;
    let from_right = egui::Layout::right_to_left(egui::Align::Center);
    let row = egui::vec2(ui.available_width(), height);
    let switch = ui.allocate_ui_with_layout(row, from_right, |ui| {
        let alone = ui.add(switch_button(is_alone, "Solo"));
        let name = format!("Show only {}", shown(&part.name));
        alone.widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, true, is_alone, &name));
        if alone.on_hover_text("Shows this part alone; a second click shows all (--show-part).").clicked() {
            Arc::make_mut(chosen).show_only(if is_alone { Vec::new() } else { vec![part.name.clone()] });
        }
        let name = shortened(&shown(&part.name), LONGEST);
        let name = if is_picked { egui::RichText::new(name).strong() } else { egui::RichText::new(name) };
        let layout = egui::Layout::left_to_right(egui::Align::Center);
        ui.with_layout(layout, |ui| ui.checkbox(&mut is_shown, name).on_hover_text(hover)).inner
    });
    if switch.inner.changed() {
        Arc::make_mut(chosen).set(&part.name, is_shown);
    }
    switch.inner
}

/// What can be done with a part. Returns whether it is to be framed.
fn part_entries(ui: &mut egui::Ui, parts: &[Part], part: usize, chosen: &mut Arc<ShownParts>) -> bool {
    let Part { name, is_hidden, .. } = &parts[part];
    let mut clicked = |label, is_possible| {
        let is_clicked = ui.add_enabled(is_possible, egui::Button::new(label)).clicked();
        if is_clicked {
            ui.close();
        }
        is_clicked
    };
    let is_framed = clicked("Frame this part", !is_hidden);
    if clicked("Show only this part", true) {
        Arc::make_mut(chosen).show_only(vec![name.clone()]);
    }
    if clicked("Hide this part", !is_hidden) || clicked("Show this part", *is_hidden) {
        Arc::make_mut(chosen).set(name, *is_hidden);
    }
    if clicked("Show all parts", parts.iter().any(|part| part.is_hidden)) {
        Arc::make_mut(chosen).show_only(Vec::new());
    }
    is_framed
}
