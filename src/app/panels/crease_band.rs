//! The row for the width of the crease band, which loads the mesh again.

use crate::app::App;
use crate::app::text::short;
use crate::app::widgets::control_row;
use geometry::mesh::crease_band::WIDEST;

impl App {
    /// Shows the width in percent of the bounding diagonal. A new width loads the mesh again once it is no longer dragged.
    pub(in crate::app) fn crease_band_row(&mut self, ui: &mut egui::Ui) {
        let Some(document) = &self.document else { return };
        let width = self.preparation().crease_band;
        let mut percent = 100.0 * self.panels.dragged_crease_band.unwrap_or(width);
        let wide = short(f64::from(percent / 100.0 * document.scene.bounds.diagonal()));
        let hover = format!(
            "A band of small triangles along edges with split normals. They share one normal on the crease, so that PN \
             triangles don't tear there (Vlachos et al. 2001; --crease-band). The width is in percent of the bounding \
             diagonal; the band is narrower where triangles are small.{}",
            match document.loaded.crease_band.creases {
                0 => String::new(),
                creases => format!(" Here it is {wide} object units wide, along {creases} creases."),
            }
        );
        let drag =
            egui::DragValue::new(&mut percent).range(0.0..=100.0 * WIDEST).speed(0.02).max_decimals(3).suffix(" %");
        let response = control_row(ui, "Crease band", &hover, drag.update_while_editing(false));
        if response.changed() {
            self.panels.dragged_crease_band = Some(percent / 100.0);
        }
        if let Some(wanted) = self.panels.dragged_crease_band.filter(|_| !response.dragged()) {
            self.panels.dragged_crease_band = None;
            self.prepare(ui.ctx(), |preparation| preparation.crease_band = wanted);
        }
    }
}
