//! The lists of leaks and of patches with folds.

use crate::app::App;
use crate::app::jobs::measure_job::Results;
use crate::app::text::{grouped, short};
use crate::app::widgets::{FoundRow, columns, found_list, list_title};
use inspect::gates::Spot;
use inspect::measure::FoldedPatch;
use inspect::render::Leak;
use inspect::render::layout::FOLD_COLOR;
use inspect::settings::SplitSide;

impl App {
    /// The list of places where one can see into a closed mesh, the largest first. A click frames the cracked edge there.
    pub(in crate::app) fn leak_list(&mut self, ui: &mut egui::Ui) {
        let leaks = self.leaks().filter(|_| self.may_leak()).unwrap_or_default();
        if leaks.is_empty() {
            return;
        }
        let hover = "Places in the picture where one can see into the closed mesh, the largest first. A click frames the cracked edge \
                     there.";
        list_title(ui, None, "Leaks", hover);
        columns(ui, &format!("{:>6}{:>8}{:>15}", "x, px", "y, px", "px that leak"), true)
            .on_hover_text("The pixel in the middle of the leak, from the picture's top left, and the leak's size.");
        let clicked = found_list(ui, "leaks", leaks, leaks[0].px.x as u32, |leak| {
            let [x, y] = leak.px.floor().to_array();
            FoundRow {
                columns: format!("{x:>6.0}{y:>8.0}{:>15}", grouped(leak.pixels.into())),
                is_selected: false,
                hover: "A click selects the cracked edge that comes closest, and frames it.".to_owned(),
            }
        });
        if let Some(leak) = clicked.copied() {
            self.show_leak(&leak);
        }
    }

    /// Shows cracks, and turns the camera to the one that a leak shows.
    pub(in crate::app) fn show_leak(&mut self, leak: &Leak) {
        self.settings.overlays.cracks = true;
        self.keep_view();
        let (Some(document), Some(Results { found, seen, .. })) = (&self.document, self.results()) else { return };
        if let Some(crack) = found.crack_seen_at(&document.shown().1, &seen.view, leak.px) {
            self.select_edge(crack.edge);
        }
    }

    /// The list of patches with folds, the largest area first. A click frames one.
    pub(in crate::app) fn fold_list(&mut self, ui: &mut egui::Ui) {
        let (Some(document), Some(found)) = (&self.document, self.results().map(|results| &results.found)) else {
            return;
        };
        if found.folded.is_empty() {
            return;
        }
        let hover = "Patches with triangles that face away from the side that the patch faces, the largest area first. A click frames one.";
        list_title(ui, Some(FOLD_COLOR), "Folded patches", hover);
        columns(ui, &format!("{:<10}{:>7}{:>12}", "triangle", "folds", "area"), true)
            .on_hover_text("The triangle of the mesh, its folds, and their area in square object units.");
        let (patches, first) = (&document.loaded.topology.patches, &found.folded[0]);
        let which = first.patch ^ (first.area as f32).to_bits();
        let clicked = found_list(ui, "folded patches", &found.folded, which, |folded| {
            let triangle = patches.get(folded.patch as usize).map_or(0, |patch| patch.triangle);
            FoundRow {
                columns: format!("{triangle:<10}{:>7}{:>12}", grouped(folded.folds.into()), short(folded.area)),
                is_selected: self.selected_patch() == Some(folded.patch),
                hover: "A click selects the triangle and frames its largest fold.".to_owned(),
            }
        });
        if let Some(folded) = clicked.copied() {
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
