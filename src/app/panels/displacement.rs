//! The rows for displacement: choosing a height map, which loads the mesh again, and its options.

use std::path::PathBuf;

use egui::{Align, Button, DragValue, Label, Layout, Response, Role, Ui, WidgetInfo, vec2};

use super::option_rows::{option_hover, option_row, option_row_with};
use super::parts::LONGEST;
use crate::app::App;
use crate::app::jobs::job_list::Work;
use crate::app::text::short;
use crate::app::widgets::{list, list_row};
use crate::commands::{Action, HEIGHT_IMAGE, Purpose, key_name};
use geometry::mesh::{HeightAmount, HeightMap};
use geometry::names::{shortened, shown, shown_path};
use geometry::tessellate::Displacement;
use inspect::settings::options;
use load::environment_file::is_environment;
use load::{HeightSource, NamedImage, Source};

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

    /// Asks for the height image of a material or a part.
    pub(super) fn ask_for_heights_of(&mut self, context: &egui::Context, part: &str) {
        self.panels.displaced_part = part.to_owned();
        self.ask_for(context, Purpose::PartHeights);
    }

    /// Displaces the part that a height image was asked for. One that it has already gives its amount to the new one.
    pub(in crate::app) fn displace_part(&mut self, context: &egui::Context, path: PathBuf) {
        let (mut images, part) = (self.part_images(), std::mem::take(&mut self.panels.displaced_part));
        match images.iter_mut().find(|image| image.part == part) {
            Some(image) => image.path = path,
            None => images.push(NamedImage { part, path, amount: None }),
        }
        self.displace(context, Some(HeightSource::Each(images)));
    }

    fn part_images(&self) -> Vec<NamedImage> {
        if let Some(HeightSource::Each(images)) = self.preparation().heights { images } else { Vec::new() }
    }

    pub(in crate::app) fn has_heights(&self) -> bool {
        self.document.as_ref().is_some_and(|document| document.loaded.mesh.heights.is_some())
    }

    pub(super) fn height_map_row(&mut self, ui: &mut Ui) {
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

    /// A row for each image that a material or a part was given: its name, scale and midlevel, another image, and none. The mesh is
    /// loaded again with other numbers.
    pub(super) fn part_heights(&mut self, ui: &mut Ui) {
        let before = self.part_images();
        if before.is_empty() {
            return;
        }
        let displacement = &self.settings.tessellation;
        let heights = self.document.as_ref().and_then(|document| document.loaded.mesh.heights.clone());
        let radius = heights.map_or(1.0, |heights| heights.radius);
        let of_all = HeightAmount { scale: displacement.height_scale * radius, midlevel: displacement.midlevel };
        let mut images = self.panels.dragged_heights.take().unwrap_or_else(|| before.clone());
        let (mut asks, mut removed) = (None, None);
        list(ui, "height images", images.len(), (images.len(), 0), |ui, row| {
            image_row(ui, &mut images[row], (of_all, radius), |action| match action {
                ImageAction::Choose => asks = Some(row),
                ImageAction::Remove => removed = Some(row),
            })
        });
        if let Some(row) = asks {
            self.ask_for_heights_of(ui.ctx(), &images[row].part);
        }
        removed.into_iter().for_each(|row| _ = images.remove(row));
        if images != before && self.jobs.has(Work::Mesh) && ui.ctx().egui_is_using_pointer() {
            self.panels.dragged_heights = Some(images);
        } else if images != before {
            self.displace(ui.ctx(), (!images.is_empty()).then_some(HeightSource::Each(images)));
        }
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

    pub(super) fn displacement_rows(&mut self, ui: &mut Ui) {
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

/// What a click in a height image's row asks for.
enum ImageAction {
    Choose,
    Remove,
}

/// The row of a material's or a part's height image, which moves the surface as `of_all` says unless it has an amount of its own.
fn image_row(
    ui: &mut Ui,
    image: &mut NamedImage,
    (of_all, radius): (HeightAmount, f32),
    mut act: impl FnMut(ImageAction),
) -> Response {
    let name = shown(&image.part);
    let HeightAmount { mut scale, mut midlevel } = image.amount.unwrap_or(of_all);
    let mut is_changed = false;
    let size = vec2(ui.available_width(), ui.spacing().interact_size.y);
    let row = ui.allocate_ui_with_layout(size, Layout::right_to_left(Align::Center), |ui| {
        let remove = named_button(ui, "x", &format!("No image of {name}"));
        if remove.on_hover_text("Takes the image away; what the file says is there again.").clicked() {
            act(ImageAction::Remove);
        }
        let choose = named_button(ui, "…", &format!("Another image of {name}"));
        if choose.on_hover_text("Chooses another image.").clicked() {
            act(ImageAction::Choose);
        }
        let mut number = |value: &mut f32, speed: f32, what: &str, hover: &str| {
            let drag = DragValue::new(value).speed(speed).max_decimals(4).update_while_editing(false);
            let drag = ui.add(drag).on_hover_text(hover);
            ui.ctx().accesskit_node_builder(drag.id, |node| node.set_label(format!("{what} of {name}")));
            is_changed |= drag.changed();
            drag
        };
        number(&mut midlevel, 0.005, "Midlevel", "The height that stays where it is: 0 is black and 1 is white.");
        let hover = "How far white is above black, in object units.";
        let first = number(&mut scale, 0.002 * radius, "Height scale", hover);
        ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
            // As in the list of parts.
            let own = name.rsplit('/').find(|own| *own != ".").unwrap_or(&name);
            let label = Label::new(shortened(own, LONGEST)).truncate().show_tooltip_when_elided(false);
            ui.add(label).on_hover_text(format!("{name}: {} (--height)", shown_path(&image.path)));
        });
        first
    });
    if is_changed {
        image.amount = HeightAmount::new(scale, midlevel).or(image.amount);
    }
    row.inner
}

/// A button with a sign, and a name that says what it is about.
fn named_button(ui: &mut Ui, sign: &str, name: &str) -> Response {
    let button = ui.add(Button::new(sign));
    button.widget_info(|| WidgetInfo::labeled(Role::Button, true, name));
    button
}
