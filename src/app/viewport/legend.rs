//! The legend of the surface's colours: under the measurements, or without these in a lower corner of the picture.

use egui::emath::GuiRounding;
use egui::{Align2, Rect, Role, Sense, TextureHandle, Vec2, WidgetInfo, vec2};

use crate::app::App;
use inspect::render::{Legend, legend_of, legend_side};
use inspect::shot::legend::{Inks, legend_picture};

/// The distance from the picture's borders, in points.
const MARGIN: f32 = 10.0;

/// A legend that was painted, in which colours and with how many px a point.
pub(crate) struct PaintedLegend {
    legend: Legend,
    inks: Inks,
    point: f32,
    texture: TextureHandle,
}

impl PaintedLegend {
    /// None if the font can't be used.
    fn new(context: &egui::Context, legend: Legend, inks: Inks, point: f32) -> Option<Self> {
        let picture = legend_picture(&legend, point.into(), inks).ok()?;
        let size = [picture.width() as usize, picture.height() as usize];
        let image = egui::ColorImage::from_rgba_unmultiplied(size, picture.as_raw());
        let texture = context.load_texture("legend", image, egui::TextureOptions::LINEAR);
        Some(Self { legend, inks, point, texture })
    }

    /// Its size in points. It is smaller where it has too little room.
    fn size_in(&self, room: Vec2) -> Vec2 {
        let size = self.texture.size_vec2() / self.point;
        size * (room / size).min_elem().clamp(0.0, 1.0)
    }

    fn show(&self, ui: &egui::Ui, place: Rect) {
        // Between px, letters would be blurred.
        let place = place.round_to_pixels(ui.pixels_per_point());
        let response = ui.interact(place, ui.scope_id().with("legend"), Sense::hover());
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, format!("Legend: {}", self.legend.spoken())));
        response.on_hover_text(&self.legend.meaning);
        egui::Image::new(&self.texture).paint_at(ui, place);
    }
}

impl App {
    /// Shows the legend of the colours, if they have one, at the lower end of a panel, of which it takes a third at most.
    pub(in crate::app) fn legend_panel(&mut self, ui: &mut egui::Ui) {
        self.paint_legend(ui);
        // What comes after it keeps its id, and with it the focus.
        let Some(painted) = &self.viewport.legend else { return ui.skip_ahead_auto_ids(1) };
        let size = painted.size_in(ui.available_size() / vec2(1.0, 3.0));
        let panel = egui::Panel::bottom("legend").frame(egui::Frame::NONE).resizable(false).exact_size(size.y);
        panel.show(ui, |ui| painted.show(ui, Align2::LEFT_BOTTOM.align_size_within_rect(size, ui.max_rect())));
    }

    /// Shows it in the lower corner of a picture where it covers less of the mesh, and returns its place.
    pub(super) fn legend_in_corner(&mut self, ui: &egui::Ui, picture: Rect) -> Option<Rect> {
        self.paint_legend(ui);
        let (painted, document) = (self.viewport.legend.as_ref()?, self.document.as_ref()?);
        let size = painted.size_in(picture.shrink(MARGIN).size());
        // It keeps its side while a clip plays or a button of the pointer is held.
        if !self.is_playing() && !ui.input(|input| input.pointer.any_down()) {
            let sizes = [picture.size(), size + Vec2::splat(2.0 * MARGIN)].map(|size| size * painted.point);
            let sizes = sizes.map(|size| [size.x as u32, size.y as u32]);
            self.viewport.legend_side = legend_side(&document.scene, &self.viewport.camera, &self.settings, sizes);
        }
        let corner = [Align2::LEFT_BOTTOM, Align2::RIGHT_BOTTOM][self.viewport.legend_side as usize];
        let place = corner.align_size_within_rect(size, picture.shrink(MARGIN));
        painted.show(ui, place);
        Some(place)
    }

    /// Paints the legend in the colours of the theme, unless it is painted already.
    fn paint_legend(&mut self, ui: &egui::Ui) {
        let usual = self.document.as_ref().map(|document| document.scene.usual());
        let distances = self.legend_distances();
        let of_half = |own| usual.and_then(|usual| legend_of(&own, &usual, &distances));
        let Some(legend) = self.settings.halves().rev().find_map(of_half) else { return self.viewport.legend = None };
        let point = ui.ctx().pixels_per_point();
        let inks = [ui.visuals().panel_fill, ui.visuals().strong_text_color()];
        let inks = inks.map(|color| [color.r(), color.g(), color.b()]);
        let known = self.viewport.legend.take();
        let known = known.filter(|known| (&known.legend, known.inks, known.point) == (&legend, inks, point));
        self.viewport.legend = known.or_else(|| PaintedLegend::new(ui.ctx(), legend, inks, point));
    }
}
