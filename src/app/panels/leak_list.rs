//! The list of leaks.

use crate::app::App;
use crate::app::text::grouped;
use crate::app::widgets::{FoundRow, columns, found_list, list_title};
use inspect::render::Leak;

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
        let clicked = found_list(ui, "leaks", leaks.len(), leaks[0].px.x as u32, |row| {
            let leak = &leaks[row];
            let [x, y] = leak.px.floor().to_array();
            FoundRow {
                columns: format!("{x:>6.0}{y:>8.0}{:>15}", grouped(leak.pixels.into())),
                is_selected: false,
                hover: "A click selects the cracked edge that comes closest, and frames it.".to_owned(),
            }
        });
        if let Some(leak) = clicked.map(|row| leaks[row]) {
            self.show_leak(&leak);
        }
    }

    /// Shows cracks, and turns the camera to the one that a leak shows.
    pub(in crate::app) fn show_leak(&mut self, leak: &Leak) {
        self.settings.overlays.cracks = true;
        self.keep_view();
        let edge = self.edge_of_leak(leak);
        edge.into_iter().for_each(|edge| self.select_edge(edge));
    }
}
