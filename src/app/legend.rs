//! In the viewport's lower right corner: what the surface's colours mean, where they are numbers or marks.

use egui::{Align2, Color32, Pos2, Rect, Sense, pos2, vec2};

use super::widgets::rgb;
use crate::render::layout::WASTE_COLOR;
use crate::render::{FACTOR_SCALE, SIZE_SCALE, Scale};
use crate::settings::Colors;

/// Points: the scale's bar at its widest, a block of one colour before it, and what lies around them.
const BAR: egui::Vec2 = vec2(196.0, 12.0);
const BLOCK_WIDTH: f32 = 42.0;
const MARGIN: f32 = 10.0;
const TEXT: f32 = 11.0;
/// Pieces that the bar is painted in.
const PIECES: u16 = 98;

/// What a legend says.
struct Legend {
    title: &'static str,
    /// For a screen reader, and on hover.
    meaning: &'static str,
    /// With the numbers that are written under it.
    scale: Option<(&'static Scale, &'static [f32])>,
    /// Whether [`WASTE_COLOR`] means something.
    waste: bool,
}

fn legend_of(colors: Colors) -> Option<Legend> {
    match colors {
        Colors::Material | Colors::Barycentric => None,
        Colors::Factors => Some(Legend {
            title: "Factor",
            meaning: "Colours of tessellation factors, 1 to 64: inside each patch its inside factor, along each edge that \
                      edge's.",
            scale: Some((&FACTOR_SCALE, &[1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0])),
            waste: false,
        }),
        Colors::TriangleSize => Some(Legend {
            title: "Triangle size, px",
            meaning: "Colours of triangles by their size on screen, 3 to 64 px: the side of the square that a triangle is \
                      half of. One colour below 3 px.",
            scale: Some((&SIZE_SCALE, &[3.0, 4.0, 8.0, 16.0, 32.0, 64.0])),
            waste: true,
        }),
        Colors::LowFactors => Some(Legend {
            title: "Factors below 2",
            meaning: "One colour for patches whose factors are all below 2, edges and inside.",
            scale: None,
            waste: true,
        }),
    }
}

/// The legend of these colours over a picture, if they have one.
pub fn legend(ui: &mut egui::Ui, picture: Rect, colors: Colors) {
    let Some(legend) = legend_of(colors) else { return };
    let before = if legend.waste { BLOCK_WIDTH + 10.0 } else { 0.0 };
    // A narrow view gets a short bar.
    let bar_width = (picture.width() - before - 4.0 * MARGIN).min(BAR.x);
    let inner = if legend.scale.is_some() { vec2(before + bar_width, 52.0) } else { vec2(106.0, 14.0) };
    let size = inner + vec2(2.0 * MARGIN, 12.0);
    let place = Rect::from_min_size(picture.right_bottom() - size - vec2(MARGIN, MARGIN), size);
    let response = ui.interact(place, ui.scope_id().with("legend"), Sense::hover());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, format!("Legend: {}", legend.title)));
    response.on_hover_text(legend.meaning);
    ui.painter().rect_filled(place, 4.0, Color32::from_black_alpha(190));
    let inner = Rect::from_center_size(place.center(), inner);
    let Some((scale, ticks)) = legend.scale else {
        let mark = Rect::from_center_size(inner.left_center() + vec2(BAR.y / 2.0, 0.0), egui::Vec2::splat(BAR.y));
        ui.painter().rect_filled(mark, 0.0, rgb(WASTE_COLOR));
        text(ui, mark.right_center() + vec2(8.0, 0.0), Align2::LEFT_CENTER, legend.title);
        return;
    };
    text(ui, inner.left_top(), Align2::LEFT_TOP, legend.title);
    let top = inner.top() + 20.0;
    bar(ui, Rect::from_min_size(pos2(inner.left() + before, top), vec2(bar_width, BAR.y)), scale, ticks);
    if legend.waste {
        let block = Rect::from_min_size(pos2(inner.left(), top), vec2(BLOCK_WIDTH, BAR.y));
        ui.painter().rect_filled(block, 0.0, rgb(WASTE_COLOR));
        text(ui, block.center_bottom() + vec2(0.0, 4.0), Align2::CENTER_TOP, &format!("below {}", scale.least));
    }
}

fn bar(ui: &egui::Ui, rect: Rect, scale: &Scale, ticks: &[f32]) {
    let at = |place: f32| rect.left() + place * rect.width();
    for piece in 0..PIECES {
        let [from, to] = [piece, piece + 1].map(|end| f32::from(end) / f32::from(PIECES));
        let part = Rect::from_x_y_ranges(at(from)..=at(to), rect.y_range());
        ui.painter().rect_filled(part, 0.0, rgb(scale.color(0.5 * (from + to))));
    }
    for &tick in ticks {
        let x = at(scale.place(tick));
        let stroke = egui::Stroke::new(1.0, Color32::from_gray(235));
        ui.painter().vline(x, rect.bottom()..=rect.bottom() + 3.0, stroke);
        text(ui, pos2(x, rect.bottom() + 4.0), Align2::CENTER_TOP, &tick.to_string());
    }
}

fn text(ui: &egui::Ui, at: Pos2, align: Align2, text: &str) {
    ui.painter().text(at, align, text, egui::FontId::proportional(TEXT), Color32::from_gray(235));
}
