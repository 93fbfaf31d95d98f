//! The legend in a lower corner of the viewport, which explains what the surface's colours mean: the same as in saved pictures.

use egui::{Align2, Rect, Sense, TextureHandle};

use crate::app::App;
use inspect::render::{Legend, legend_of, legend_side};
use inspect::shot::legend::legend_picture;

/// The distance from the picture's borders, in points.
const MARGIN: f32 = 10.0;

/// A legend that was painted, and for which size of the picture in px and of a point.
pub(crate) struct PaintedLegend {
    legend: Legend,
    room: [u32; 2],
    point: f32,
    texture: TextureHandle,
}

impl PaintedLegend {
    /// None if the font can't be used.
    fn new(context: &egui::Context, legend: Legend, room: [u32; 2], point: f32) -> Option<Self> {
        let picture = legend_picture(&legend, room, point.into()).ok()?;
        let size = [picture.width() as usize, picture.height() as usize];
        let image = egui::ColorImage::from_rgba_unmultiplied(size, picture.as_raw());
        let texture = context.load_texture("legend", image, egui::TextureOptions::LINEAR);
        Some(Self { legend, room, point, texture })
    }

    /// How far up from the lower border it reaches, in points.
    pub(super) fn height(&self) -> f32 {
        self.texture.size_vec2().y / self.point + MARGIN
    }
}

impl App {
    /// Shows the legend of the colours over a picture, if they have one. It is painted anew only if it changes.
    pub(super) fn legend(&mut self, ui: &egui::Ui, picture: Rect) {
        let usual = self.document.as_ref().map(|document| document.scene.usual());
        let distances = self.legend_distances();
        let of_half = |own| usual.and_then(|usual| legend_of(&own, &usual, &distances));
        let legend = self.settings.halves().rev().find_map(of_half);
        let Some(legend) = legend else { return self.viewport.legend = None };
        let point = ui.ctx().pixels_per_point();
        let room = [picture.width(), picture.height()].map(|side| (side * point).max(1.0) as u32);
        let known = self.viewport.legend.take();
        let known = known.filter(|known| (&known.legend, known.room, known.point) == (&legend, room, point));
        self.viewport.legend = known.or_else(|| PaintedLegend::new(ui.ctx(), legend, room, point));
        let Some(PaintedLegend { legend, texture, .. }) = &self.viewport.legend else { return };
        let size = texture.size_vec2() / point;
        // It keeps its side while a clip plays or a button of the pointer is held.
        let rests = !self.is_playing() && !ui.input(|input| input.pointer.any_down());
        if let Some(document) = self.document.as_ref().filter(|_| rests) {
            let taken = texture.size().map(|side| side as u32 + (2.0 * MARGIN * point) as u32);
            self.viewport.legend_side =
                legend_side(&document.scene, &self.viewport.camera, &self.settings, [room, taken]);
        }
        let corners = [Align2::LEFT_BOTTOM, Align2::RIGHT_BOTTOM];
        let place = corners[self.viewport.legend_side as usize].align_size_within_rect(size, picture.shrink(MARGIN));
        let response = ui.interact(place, ui.scope_id().with("legend"), Sense::hover());
        let spoken = format!("Legend: {}", legend.spoken());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, &spoken));
        response.on_hover_text(&legend.meaning);
        let whole = Rect::from_min_max(egui::pos2(0.0, 0.0), egui::pos2(1.0, 1.0));
        ui.painter().image(texture.id(), place, whole, egui::Color32::WHITE);
    }
}
