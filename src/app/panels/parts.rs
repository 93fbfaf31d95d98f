//! The list of the file's parts, which can be hidden.

use std::sync::Arc;

use crate::app::App;
use crate::app::sections::Section;
use crate::app::text::counted;
use crate::app::widgets::list;
use geometry::names::{shortened, shown};

/// The greatest length of a name in the list, in characters.
const LONGEST: usize = 40;

impl App {
    /// A switch for each part, if the file has several. The mesh is loaded again without those that are hidden.
    pub(in crate::app) fn parts_section(&mut self, ui: &mut egui::Ui) {
        let Some(document) = self.document.as_ref().filter(|document| document.loaded.parts.len() > 1) else { return };
        let parts = document.loaded.parts.clone();
        if !self.panels.open.title(ui, Section::Parts) {
            return;
        }
        let mut clicked = None;
        list(ui, "parts", parts.len(), 0, |ui, row| {
            let part = &parts[row];
            let mut is_shown = !part.is_hidden;
            let hover = format!(
                "{}: {}. A part that is hidden is left out, as if the file didn't have it (--hide-part).",
                shown(&part.name),
                counted(part.triangles.into(), "triangle")
            );
            let name = shortened(&shown(&part.name), LONGEST);
            let response = ui.checkbox(&mut is_shown, name).on_hover_text(hover);
            if response.changed() {
                clicked = Some(row);
            }
            response
        });
        let are_hidden = parts.iter().any(|part| part.is_hidden);
        if are_hidden && ui.button("Show all parts").on_hover_text("Shows the parts that are hidden.").clicked() {
            self.hidden = Arc::default();
        }
        if let Some(row) = clicked {
            toggle(Arc::make_mut(&mut self.hidden), &parts[row].name);
        }
    }
}

fn toggle(hidden: &mut Vec<String>, name: &str) {
    match hidden.iter().position(|other| other == name) {
        Some(index) => drop(hidden.remove(index)),
        None => hidden.push(name.to_owned()),
    }
}
