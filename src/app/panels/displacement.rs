//! The rows for displacement: choosing a height map, which loads the mesh again, and its options.

use std::path::PathBuf;

use super::option_rows::{option_hover, option_row, option_row_with};
use crate::app::App;
use crate::app::text::short;
use crate::app::widgets::list_row;
use crate::commands::{Action, HEIGHT_IMAGE, Purpose, key_name};
use geometry::mesh::{HeightAmount, HeightMap};
use geometry::names::shown;
use geometry::tessellate::Displacement;
use inspect::settings::options;
use load::environment_file::is_environment;
use load::{HeightSource, Source};

impl App {
    /// Opens a mesh. An image displaces the mesh that is open instead, and a panorama lights it.
    pub fn open_path(&mut self, context: &egui::Context, path: PathBuf) {
        let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
        let images = ["png", "jpg", "jpeg", "webp", "tga", "bmp", "ktx2", "tif", "tiff"];
        let is_image = extension.is_some_and(|extension| images.contains(&&*extension));
        if is_environment(&path) {
            self.read_environment(context, path, true);
        } else if is_image && self.document.is_some() {
            self.displace(context, Some(HeightSource::File(path)));
        } else {
            self.open(context, Source::File(path));
        }
    }

    /// Loads the same mesh again with another height map, or without one.
    pub fn displace(&mut self, context: &egui::Context, heights: Option<HeightSource>) {
        self.prepare(context, |preparation| preparation.heights = heights);
    }

    /// Adapts displacement to a mesh that was just loaded: on if it is the first with heights, off without heights.
    pub(in crate::app) fn take_heights(&mut self, had_heights: bool) {
        let has_heights = self.has_heights();
        if !(has_heights && had_heights) {
            self.settings.tessellation.displacement = Displacement::usual(has_heights);
        }
    }

    pub(in crate::app) fn has_heights(&self) -> bool {
        self.document.as_ref().is_some_and(|document| document.loaded.mesh.heights.is_some())
    }

    pub(in crate::app) fn height_rows(&mut self, ui: &mut egui::Ui) {
        let heights = self.preparation().heights;
        let materials = self.document.iter().flat_map(|document| &document.loaded.mesh.materials);
        let has_own = materials.into_iter().any(|material| material.height.is_some());
        let of_file = if has_own { "As the file says" } else { "None" };
        let shown = heights.as_ref().map_or(of_file.to_owned(), HeightSource::title);
        let mut chosen = None;
        let hover = format!(
            "The image that displaces the surface: black is 0 and white is 1. An image that is dropped on the window becomes the \
             height map (--height).{}",
            self.amounts(),
        );
        list_row(ui, "Height map", &hover, &shown, |ui| {
            let mut entry = |text: &str, is_shown: bool, hover: &str| {
                ui.selectable_label(is_shown, text).on_hover_text(hover).clicked()
            };
            if entry(of_file, heights.is_none(), "The height images that the file gives its materials, if any.") {
                chosen = Some(None);
            }
            let is_material = heights == Some(HeightSource::Materials);
            if entry("Base colour brightness", is_material, "The brightness of each material's base colour image.") {
                chosen = Some(Some(HeightSource::Materials));
            }
            let is_file = matches!(heights, Some(HeightSource::File(_)));
            if entry("Image file…", is_file, HEIGHT_IMAGE) {
                self.ask_for(ui.ctx(), Purpose::Heights);
            }
        });
        chosen.into_iter().for_each(|chosen| self.displace(ui.ctx(), chosen));
        self.displacement_rows(ui);
    }

    /// Lists the first few images that say how far they move the surface, by the first material or part that each displaces.
    fn amounts(&self) -> String {
        const NAMED: usize = 8;
        let Some(document) = &self.document else { return String::new() };
        let (mesh, parts) = (&document.loaded.mesh, &document.loaded.contents.parts);
        let Some(heights) = mesh.heights.as_deref() else { return String::new() };
        let line = |(index, map): (u32, &HeightMap)| {
            let HeightAmount { scale, midlevel } = map.amount?;
            let [scale, midlevel] = [scale, midlevel].map(|number| short(f64::from(number)));
            let (range, _) = heights.ranges.iter().find(|(_, own)| *own == index)?;
            let material = mesh.materials.iter().find(|material| material.triangles.contains(&range.start))?;
            let part = mesh.part_of(range.start).filter(|_| material.triangles != *range);
            let name = part.and_then(|part| parts.get(part as usize)).map_or(&material.name, |part| &part.name);
            Some(format!("\n{}: {scale} object units, midlevel {midlevel}", shown(name)))
        };
        (0..).zip(&heights.maps).filter_map(line).take(NAMED).collect()
    }

    pub(in crate::app) fn toggle_displacement(&mut self) {
        if !self.has_heights() {
            return;
        }
        let last = std::mem::replace(&mut self.panels.last_displacement, self.settings.tessellation.displacement);
        let displacement = &mut self.settings.tessellation.displacement;
        *displacement = match (displacement.is_on(), last.is_on()) {
            (false, true) => last,
            (is_on, _) => Displacement::usual(!is_on),
        };
    }

    fn displacement_rows(&mut self, ui: &mut egui::Ui) {
        let Some(document) = &self.document else { return };
        let Some(heights) = document.loaded.mesh.heights.clone() else { return };
        let settings = &mut self.settings;
        option_row(ui, &options::DISPLACEMENT, settings, key_name(&Action::ToggleDisplacement));
        // Otherwise each image has a scale and a midlevel of its own.
        if heights.follow_settings() {
            let units = short(f64::from(settings.tessellation.height_scale * heights.radius));
            let hover = format!("{} Here it is {units} object units.", option_hover(&options::HEIGHT_SCALE, ""));
            option_row_with(ui, &options::HEIGHT_SCALE, settings, &hover);
            option_row(ui, &options::MIDLEVEL, settings, "");
        }
        option_row(ui, &options::NORMAL_MAPS, settings, "");
    }
}
