//! The rows for normals, axis and unit, and for the width of the crease band, which load the mesh again.

use super::option_rows::{option_hover, option_row, option_row_with};
use crate::app::App;
use crate::app::text::short;
use crate::app::widgets::{control_row, fixed};
use crate::commands::MADE_IN_CODE;
use geometry::mesh::crease_band::WIDEST;
use inspect::settings::options;
use load::NormalSource;
use load::import::Subdivide;

impl App {
    /// The normals of the mesh, and the crease angle if any are made.
    pub(in crate::app) fn normals_rows(&mut self, ui: &mut egui::Ui) {
        option_row(ui, &options::MESH_NORMALS, &mut self.settings, "");
        let are_made = self.document.as_ref().is_some_and(|document| {
            let repairs = &document.loaded.read.repairs;
            repairs.normals_made > 0 || repairs.normals_replaced > 0
        });
        if are_made || self.settings.import.normals == NormalSource::Made {
            option_row(ui, &options::CREASE_ANGLE, &mut self.settings, "");
        }
    }

    /// Which axis of the file points up, what its unit is, and whether what it hides is loaded.
    pub(in crate::app) fn import_rows(&mut self, ui: &mut egui::Ui) {
        let is_shape = self.source().is_some_and(|source| source.shape().is_some());
        for option in [&options::UP, &options::UNIT] {
            match is_shape {
                true => fixed(ui, option.label, option.unset.as_ref().map_or("", |unset| unset.label), MADE_IN_CODE),
                false => {
                    let hover = format!("{} The camera shows all of it again.", option_hover(option, ""));
                    option_row_with(ui, option, &mut self.settings, &hover);
                }
            }
        }
        if !is_shape {
            option_row(ui, &options::SHOW_HIDDEN, &mut self.settings, "");
            option_row(ui, &options::SUBDIVIDE, &mut self.settings, "");
            if self.settings.import.subdivide != Subdivide::Off {
                option_row(ui, &options::LEVELS, &mut self.settings, "");
                option_row(ui, &options::SUBDIVIDE_UVS, &mut self.settings, "");
            }
        }
    }

    /// The width of the crease band in percent of the bounding diagonal. A new width loads the mesh again once it is no longer dragged.
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
