//! The legend in the viewport's lower right corner, which explains what the surface's colours mean.

mod barycentric;

use egui::{Align2, Color32, Pos2, Rect, Sense, pos2, vec2};

use crate::app::widgets::{rgb, text_width_in};
use inspect::render::layout::WASTE_COLOR;
use inspect::render::{BARYCENTRIC_TITLE, COLUMNS, Distances, Scale, Shown, legend_of, tick_text};
use inspect::settings::{Colors, Settings};

/// Sizes in points: the bar of the scale at its widest, the block of one colour before it, the margin, and the text.
const BAR: egui::Vec2 = vec2(196.0, 12.0);
const BLOCK_WIDTH: f32 = 42.0;
const MARGIN: f32 = 10.0;
const TEXT: f32 = 11.0;
/// A row of named colours, in points.
const ROW: f32 = 17.0;
/// The number of pieces that the bar is painted in.
const PIECES: u16 = 98;

/// The legend of the colours over a picture, if they have one. `radius` is the mesh's bounding radius in object units.
pub(crate) fn legend(ui: &mut egui::Ui, picture: Rect, settings: &Settings, radius: f32, distances: &Distances) {
    if settings.overlays.colors == Colors::Barycentric {
        let inner = plate(ui, picture, barycentric::SIZE, BARYCENTRIC_TITLE, barycentric::MEANING);
        return barycentric::paint(ui, inner);
    }
    let Some(legend) = legend_of(settings, radius, distances) else { return };
    let spoken = match &legend.shown {
        Shown::Rows(rows) => {
            let rows: Vec<_> = rows.iter().map(|(_, text)| text.as_str()).collect();
            format!("{}: {}", legend.title, rows.join(", "))
        }
        _ => legend.title.clone(),
    };
    let plate = |size| plate(ui, picture, size, &spoken, &legend.meaning);
    match &legend.shown {
        Shown::Title => {
            let inner = plate(vec2(text_width_in(ui, &legend.title, egui::FontId::proportional(TEXT)), 14.0));
            text(ui, inner.left_center(), Align2::LEFT_CENTER, &legend.title);
        }
        Shown::Waste => named(ui, plate(vec2(106.0, 14.0)).left_center(), WASTE_COLOR, &legend.title),
        Shown::Scale { scale, ticks, waste } => {
            let before = if *waste { BLOCK_WIDTH + 10.0 } else { 0.0 };
            // A narrow view gets a short bar.
            let bar_width = (picture.width() - before - 4.0 * MARGIN).min(BAR.x);
            let inner = plate(vec2(before + bar_width, 52.0));
            text(ui, inner.left_top(), Align2::LEFT_TOP, &legend.title);
            let top = inner.top() + 20.0;
            bar(ui, Rect::from_min_size(pos2(inner.left() + before, top), vec2(bar_width, BAR.y)), scale, ticks);
            if *waste {
                waste_block(ui, pos2(inner.left(), top), scale.least);
            }
        }
        Shown::Colors(colors) => {
            let rows = colors.len().div_ceil(COLUMNS);
            let inner = plate(vec2(BAR.x, 18.0 + ROW * rows as f32));
            text(ui, inner.left_top(), Align2::LEFT_TOP, &legend.title);
            for (index, &(color, name)) in colors.iter().enumerate() {
                let [column, row] = [index % COLUMNS, index / COLUMNS].map(|place| place as f32);
                let place = vec2(column * BAR.x / COLUMNS as f32, 18.0 + ROW * (row + 0.5));
                named(ui, inner.left_top() + place, color, name);
            }
        }
        Shown::Rows(rows) => {
            let inner = plate(vec2(BAR.x, 18.0 + ROW * rows.len() as f32));
            text(ui, inner.left_top(), Align2::LEFT_TOP, &legend.title);
            let mut middle = inner.left_top() + vec2(0.0, 18.0 + 0.5 * ROW);
            for (color, name) in rows {
                named(ui, middle, *color, name);
                middle.y += ROW;
            }
        }
    }
}

/// A block of one colour, its left side in the middle at a place, and the colour's name.
fn named(ui: &egui::Ui, at: Pos2, color: [u8; 3], name: &str) {
    let mark = Rect::from_center_size(at + vec2(BAR.y / 2.0, 0.0), egui::Vec2::splat(BAR.y));
    ui.painter().rect_filled(mark, 0.0, rgb(color));
    text(ui, mark.right_center() + vec2(8.0, 0.0), Align2::LEFT_CENTER, name);
}

/// The block of what is below the least number of a scale.
fn waste_block(ui: &egui::Ui, at: Pos2, least: f32) {
    let block = Rect::from_min_size(at, vec2(BLOCK_WIDTH, BAR.y));
    ui.painter().rect_filled(block, 0.0, rgb(WASTE_COLOR));
    text(ui, block.center_bottom() + vec2(0.0, 4.0), Align2::CENTER_TOP, &format!("below {least}"));
}

/// Shows the dark plate of a legend of this size inside, and returns where that is.
fn plate(ui: &egui::Ui, picture: Rect, inner: egui::Vec2, title: &str, meaning: &str) -> Rect {
    let size = inner + vec2(2.0 * MARGIN, 12.0);
    let place = Rect::from_min_size(picture.right_bottom() - size - vec2(MARGIN, MARGIN), size);
    let response = ui.interact(place, ui.scope_id().with("legend"), Sense::hover());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, format!("Legend: {title}")));
    response.on_hover_text(meaning);
    ui.painter().rect_filled(place, 4.0, Color32::from_black_alpha(190));
    Rect::from_center_size(place.center(), inner)
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
        // Long numbers at the ends are moved inwards, so that they stay on the legend.
        let font = egui::FontId::proportional(TEXT);
        let galley = ui.painter().layout_no_wrap(tick_text(tick), font, Color32::from_gray(235));
        let half = 0.5 * galley.size().x;
        let (first, last) = (rect.left() - 6.0 + half, rect.right() + 6.0 - half);
        let middle = if first < last { x.clamp(first, last) } else { x };
        ui.painter().galley(pos2(middle - half, rect.bottom() + 4.0), galley, Color32::WHITE);
    }
}

fn text(ui: &egui::Ui, at: Pos2, align: Align2, text: &str) {
    ui.painter().text(at, align, text, egui::FontId::proportional(TEXT), Color32::from_gray(235));
}
