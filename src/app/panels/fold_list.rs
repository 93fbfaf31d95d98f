//! The list of patches with folds.

use egui::RichText;

use crate::app::App;
use crate::app::text::{grouped, short};
use crate::app::widgets::{columns, list, swatch};
use inspect::gates::Spot;
use inspect::measure::FoldedPatch;
use inspect::render::layout::FOLD_COLOR;
use inspect::settings::SplitSide;

impl App {
    /// The list of patches with folds, the largest area first. A click frames one.
    pub(in crate::app) fn fold_list(&mut self, ui: &mut egui::Ui) {
        let (Some(document), Some(found)) = (&self.document, self.results().map(|results| &results.found)) else {
            return;
        };
        if found.folded.is_empty() {
            return;
        }
        ui.add_space(4.0);
        ui.horizontal(|ui| {
            swatch(ui, FOLD_COLOR);
            ui.label("Folded patches").on_hover_text(
                "Patches with triangles that face away from the side that the patch faces, the largest area first. A click \
                 frames one.",
            );
        });
        columns(ui, &format!("{:<10}{:>7}{:>12}", "triangle", "folds", "area"), true)
            .on_hover_text("The triangle of the mesh, its folds, and their area in square object units.");
        let patches = &document.loaded.topology.patches;
        let mut clicked = None;
        list(
            ui,
            "folded patches",
            (found.folded.len(), found.folded[0].patch ^ (found.folded[0].area as f32).to_bits()),
            |ui, row| {
                let folded = &found.folded[row];
                let triangle = patches.get(folded.patch as usize).map_or(0, |patch| patch.triangle);
                let text = format!("{triangle:<10}{:>7}{:>12}", grouped(folded.folds.into()), short(folded.area));
                let is_selected = self.selected_patch() == Some(folded.patch);
                let response = ui.selectable_label(is_selected, RichText::new(text).monospace());
                let response = response.on_hover_text("A click selects the triangle and frames its largest fold.");
                if response.clicked() {
                    clicked = Some(*folded);
                }
                response
            },
        );
        if let Some(folded) = clicked {
            self.show_fold(&folded);
        }
    }

    /// Shows folds, and turns the camera to the largest one of a patch.
    pub(in crate::app) fn show_fold(&mut self, folded: &FoldedPatch) {
        let Some(document) = &self.document else { return };
        let Some(patch) = document.loaded.topology.patches.get(folded.patch as usize) else { return };
        let triangle = patch.triangle;
        self.settings.overlays.folds = true;
        self.select_triangle(Some(triangle));
        self.show_place(SplitSide::Right, &Spot::fold(folded), None);
    }
}
