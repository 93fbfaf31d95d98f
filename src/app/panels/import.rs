//! The rows for normals, axis and unit, which load the mesh again.

use super::option_rows::{option_hover, option_row, option_row_with};
use crate::app::App;
use crate::app::widgets::fixed;
use crate::commands::MADE_IN_CODE;
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
}
