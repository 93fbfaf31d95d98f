//! The tree of the file's parts, which can be hidden, and the menu of a part, which is over the picture too.

use std::collections::HashSet;
use std::ops::Range;
use std::sync::Arc;

use crate::app::App;
use crate::app::sections::Section;
use crate::app::text::{counted, grouped};
use crate::app::widgets::{list, switch_button};
use crate::commands::{Action, CameraAction, all};
use geometry::choice::Choice;
use geometry::mesh::PartStyle;
use geometry::names::{shortened, shown};
use geometry::tessellate::Surface;
use inspect::render::framed_size;
use inspect::settings::options;
use load::part_tree::{Branch, end, leaves};
use load::selection::{MATERIAL, is_part_of};
use load::{NormalSource, ShownParts};

/// The greatest length of a name in a list, in characters.
pub(super) const LONGEST: usize = 40;

/// Longer lists of names have a filter.
const MANY: usize = 8;

/// How far a part is right of the group that it lies in, in points, and how often at most.
const INDENT: f32 = 12.0;
const MOST_INDENTS: usize = 6;

/// What is done with a part or a group: a place in the tree.
#[derive(Clone, Copy, Debug, PartialEq)]
enum PartAction {
    /// Shows it, or leaves it out.
    Set(usize, bool),
    /// Shows it alone.
    Solo(usize),
    Frame(usize),
    CopyName(usize),
    /// Asks for its height image.
    Displace(usize),
    /// Gives it a style of its own.
    Style(usize, PartStyle),
    ShowAll,
}

/// The details on offer.
const DETAILS: [(f32, &str); 7] =
    [(0.125, "1/8"), (0.25, "1/4"), (0.5, "1/2"), (1.0, "1"), (2.0, "2"), (4.0, "4"), (8.0, "8")];

impl App {
    /// A switch for each part and group, if the file has several. The mesh is loaded again without those that are hidden.
    pub(in crate::app) fn parts_section(&mut self, ui: &mut egui::Ui) {
        let tree = self.part_tree();
        let [shown, all] = [leaves(&tree).filter(|leaf| leaf.shown > 0).count(), leaves(&tree).count()];
        if all <= 1 || !self.panels.open.title(ui, Section::Parts) {
            return;
        }
        let (picked, selected) = (self.picked_part(), self.preparation().parts);
        let hover = "Lists the parts, groups and materials whose paths contain this.";
        let filter = name_filter(ui, "Filter parts by name", hover, all, &mut self.panels.parts_filter);
        let folded = &mut self.panels.folded_groups;
        let listed = listed(&tree, &filter, folded);
        let mut action = None;
        list(ui, "parts", listed.len(), (filter.len(), 0), |ui, row| {
            let at = listed[row];
            let (response, chosen) = part_row(ui, &tree, at, (picked, &selected), folded);
            action = chosen.or(action);
            response.context_menu(|ui| action = part_entries(ui, &tree, at, &selected).or(action));
            response
        });
        let selects = !(selected.hidden.is_empty() && selected.only.is_empty());
        ui.horizontal(|ui| {
            let button = ui.add_enabled(selects, egui::Button::new("Show all parts"));
            if button.on_hover_text("Shows the parts that are hidden.").clicked() {
                action = Some(PartAction::ShowAll);
            }
            ui.weak(format!("{} of {} shown", grouped(shown as u64), grouped(all as u64)));
        });
        action.into_iter().for_each(|action| self.act_on_parts(ui.ctx(), &tree, action));
    }

    fn part_tree(&self) -> Arc<Vec<Branch>> {
        self.document.as_ref().map(|document| document.loaded.part_tree.clone()).unwrap_or_default()
    }

    /// The part of the selected triangle: a place in the list of parts.
    pub(in crate::app) fn picked_part(&self) -> Option<usize> {
        let (document, triangle) = (self.document.as_ref()?, self.selected_triangle()?);
        document.loaded.mesh.part_of(triangle).map(|part| part as usize)
    }

    /// The menu of what was clicked with the right button in the picture.
    pub(in crate::app) fn part_menu(&mut self, ui: &mut egui::Ui) {
        let tree = self.part_tree();
        let picked = self.picked_part().filter(|_| leaves(&tree).count() > 1);
        let picked = picked.and_then(|part| tree.iter().position(|branch| branch.part == Some(part)));
        let action = picked.and_then(|at| part_entries(ui, &tree, at, &self.preparation().parts));
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
        action.into_iter().for_each(|action| self.act_on_parts(ui.ctx(), &tree, action));
    }

    fn act_on_parts(&mut self, context: &egui::Context, tree: &[Branch], action: PartAction) {
        let mut parts = self.preparation().parts;
        match action {
            PartAction::Set(at, is_shown) => parts.set(tree, at, is_shown),
            PartAction::Solo(at) => parts.show_only(vec![tree[at].name.clone()]),
            PartAction::ShowAll => parts.show_only(Vec::new()),
            PartAction::Frame(at) => self.frame_part(tree, at),
            PartAction::Style(at, style) => parts.set_style(&tree[at].name, style),
            PartAction::Displace(at) => self.ask_for_heights_of(context, &tree[at].name),
            PartAction::CopyName(at) => context.copy_text(tree[at].name.clone()),
        }
        self.prepare(context, |preparation| preparation.parts = parts);
    }

    fn frame_part(&mut self, tree: &[Branch], at: usize) {
        let Some(document) = &self.document else { return };
        let (mesh, parts, own) = (document.shown().0, &document.loaded.contents.parts, &tree[at].name);
        let of_parts = mesh.part_ranges.iter().filter(|range| is_part_of(&parts[range.part as usize].name, own));
        let of_materials =
            mesh.materials.iter().filter(|material| is_part_of(&[MATERIAL, &material.name].concat(), own));
        let ranges = of_materials.map(|own| &own.triangles).chain(of_parts.map(|own| &own.triangles));
        if let Some(bounds) = mesh.bounds_of(ranges.flat_map(Range::clone)) {
            let size = framed_size(self.viewport.picture.size(), &self.settings);
            self.viewport.camera.frame(&bounds, size);
        }
    }
}

/// A field that filters `count` things by their names, if they are many. Returns what names must contain, in lower case.
pub(super) fn name_filter(ui: &mut egui::Ui, label: &str, hover: &str, count: usize, filter: &mut String) -> String {
    if count > MANY {
        let field = egui::TextEdit::singleline(filter).hint_text(label).desired_width(f32::INFINITY);
        let field = ui.add(field).on_hover_text(hover);
        ui.ctx().accesskit_node_builder(field.id, |node| node.set_label(label));
    } else {
        filter.clear();
    }
    filter.to_lowercase()
}

/// The places of the rows whose paths contain `filter`. What lies in groups that are folded isn't listed, unless it is searched.
fn listed(tree: &[Branch], filter: &str, folded: &HashSet<String>) -> Vec<usize> {
    let (mut listed, mut at) = (Vec::new(), 0);
    while let Some(branch) = tree.get(at) {
        listed.extend((filter.is_empty() || branch.path.to_lowercase().contains(filter)).then_some(at));
        at = if filter.is_empty() && folded.contains(&branch.path) { end(tree, at) } else { at + 1 };
    }
    listed
}

/// The row of a part or group: a button that folds it, whether it is shown, its triangles, and a button that shows it alone.
/// Returns the switch, and what is to be done.
fn part_row(
    ui: &mut egui::Ui,
    tree: &[Branch],
    at: usize,
    (picked, selected): (Option<usize>, &ShownParts),
    folded: &mut HashSet<String>,
) -> (egui::Response, Option<PartAction>) {
    let branch = &tree[at];
    let (path, is_group) = (shown(&branch.path), branch.part.is_none());
    let hover = format!(
        "{path}: {}{}. What is hidden is left out, as if the file didn't have it (--hide-part). Right-click for more.",
        if is_group { format!("{} parts, ", branch.parts) } else { String::new() },
        counted(branch.triangles, "triangle")
    );
    let is_alone = selected.hidden.is_empty() && selected.only.len() == 1 && selected.only[0] == branch.name;
    let mut is_shown = branch.shown > 0;
    let mut action = None;
    let height = ui.spacing().interact_size.y;
    let from_right = egui::Layout::right_to_left(egui::Align::Center);
    let row = egui::vec2(ui.available_width(), height);
    let response = ui.allocate_ui_with_layout(row, from_right, |ui| {
        let hover_alone = "Shows this alone; a second click shows all (--show-part).";
        if named_switch(ui, is_alone, "Solo", &format!("Show only {path}"), hover_alone) {
            action = Some(if is_alone { PartAction::ShowAll } else { PartAction::Solo(at) });
        }
        ui.weak(grouped(branch.triangles));
        let label = match branch.path.rsplit('/').next() {
            Some(".") | None => "itself",
            Some(own) => own,
        };
        let label = egui::RichText::new(shortened(&shown(label), LONGEST));
        let label = if picked.is_some() && picked == branch.part { label.strong() } else { label };
        let layout = egui::Layout::left_to_right(egui::Align::Center);
        ui.with_layout(layout, |ui| {
            ui.add_space(branch.depth.min(MOST_INDENTS) as f32 * INDENT);
            let is_open = !folded.contains(&branch.path);
            let (sign, hover_fold) = (if is_open { "-" } else { "+" }, "Lists what lies in this group, or not.");
            if is_group
                && named_switch(ui, is_open, sign, &format!("Unfold {path}"), hover_fold)
                && !folded.remove(&branch.path)
            {
                folded.insert(branch.path.clone());
            }
            let is_partly_shown = is_shown && branch.shown < branch.parts;
            let switch = egui::Checkbox::new(&mut is_shown, label).indeterminate(is_partly_shown);
            let switch = ui.add(switch).on_hover_text(hover);
            let style = selected.style(&branch.name);
            if style != PartStyle::default() {
                let marked = ui.label("*").on_hover_text(format!("It has {style} of its own (--part)."));
                marked.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, style.to_string()));
            }
            switch
        })
        .inner
    });
    if response.inner.changed() {
        action = Some(PartAction::Set(at, is_shown));
    }
    (response.inner, action)
}

/// A button that stays pressed while something is on, with a name that says what it is about. Returns whether it was clicked.
fn named_switch(ui: &mut egui::Ui, is_on: bool, text: &str, name: &str, hover: &str) -> bool {
    let button = ui.add(switch_button(is_on, text));
    button.widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, true, is_on, name));
    button.on_hover_text(hover).clicked()
}

/// What can be done with a part or a group.
fn part_entries(ui: &mut egui::Ui, tree: &[Branch], at: usize, selected: &ShownParts) -> Option<PartAction> {
    let (branch, are_hidden) = (&tree[at], leaves(tree).any(|leaf| leaf.shown == 0));
    ui.strong(shortened(&shown(&branch.path), LONGEST));
    let (is_shown, what) = (branch.shown > 0, if branch.part.is_some() { "part" } else { "group" });
    let entries = [
        (PartAction::Frame(at), format!("Frame this {what}"), is_shown),
        (PartAction::Solo(at), format!("Show only this {what}"), true),
        (PartAction::Set(at, false), format!("Hide this {what}"), is_shown),
        (PartAction::Set(at, true), format!("Show this {what}"), branch.shown < branch.parts),
        (PartAction::CopyName(at), "Copy its name".to_owned(), true),
        (PartAction::ShowAll, "Show all parts".to_owned(), are_hidden),
    ];
    let chosen = |(action, label, is_possible): (_, String, bool)| {
        ui.add_enabled(is_possible, egui::Button::new(label)).clicked().then_some(action)
    };
    let mut chosen = entries.into_iter().filter_map(chosen).last();
    let style = style_entries(ui, selected.style(&branch.name));
    if ui.add_enabled(is_shown, egui::Button::new("Its height image…")).clicked() {
        chosen = Some(PartAction::Displace(at));
    }
    chosen = style.map(|style| PartAction::Style(at, style)).or(chosen);
    if chosen.is_some() {
        ui.close();
    }
    chosen
}

/// What a part may have of its own. Returns its style, if another is chosen.
fn style_entries(ui: &mut egui::Ui, style: PartStyle) -> Option<PartStyle> {
    let mut chosen = None;
    let mut menu = |title: &str, unset: (PartStyle, &'static str), own: Vec<(PartStyle, String, &'static str)>| {
        ui.menu_button(title, |ui| {
            let unset = (unset.0, "As set for all".to_owned(), unset.1);
            for (own, label, hover) in std::iter::once(unset).chain(own) {
                if ui.radio(own == style, label).on_hover_text(hover).clicked() {
                    chosen = Some(own);
                }
            }
        });
    };
    let own = |own: Surface| (PartStyle { surface: Some(own), ..style }, own.label().to_owned(), own.text());
    let unset = (PartStyle { surface: None, ..style }, "The surface that the settings choose.");
    menu("Its surface", unset, Surface::ALL.map(own).to_vec());
    let hover = "How many times as fine as the rest LOD makes it; an edge between parts gets the finest.";
    let own = |(own, label): (f32, &str)| (PartStyle { detail: Some(own), ..style }, label.to_owned(), hover);
    let unset = (PartStyle { detail: None, ..style }, "As fine as LOD makes the rest.");
    menu("Its detail", unset, DETAILS.map(own).to_vec());
    let own = |own: NormalSource| (PartStyle { normals: Some(own), ..style }, own.label().to_owned(), own.text());
    let unset = (PartStyle { normals: None, ..style }, "The normals that the settings choose.");
    menu("Its normals", unset, NormalSource::ALL.map(own).to_vec());
    let hover = options::CREASE_ANGLE.text;
    let own = |own: f32| (PartStyle { crease_angle: Some(own), ..style }, format!("{own}\u{b0}"), hover);
    let unset = (PartStyle { crease_angle: None, ..style }, hover);
    menu("Its crease angle", unset, [0.0, 30.0, 60.0, 90.0, 180.0].map(own).to_vec());
    chosen
}
