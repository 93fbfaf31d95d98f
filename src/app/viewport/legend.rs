//! The legend in the viewport's lower right corner, which explains colours that stand for numbers.

use egui::{Align2, Color32, Pos2, Rect, Sense, pos2, vec2};

use crate::app::widgets::rgb;
use crate::render::layout::WASTE_COLOR;
use crate::render::{DEVIATION_PX_SCALE, EXCESS_SCALE, FACTOR_SCALE, SIZE_SCALE, Scale};
use crate::settings::{Colors, DeviationUnit};

/// Sizes in points: the bar of the scale at its widest, the block of one colour before it, the margin, and the text.
const BAR: egui::Vec2 = vec2(196.0, 12.0);
const BLOCK_WIDTH: f32 = 42.0;
const MARGIN: f32 = 10.0;
const TEXT: f32 = 11.0;
/// The number of pieces that the bar is painted in.
const PIECES: u16 = 98;

/// The contents of a legend.
struct Legend {
    title: String,
    /// The hover text.
    meaning: String,
    /// The scale and the numbers under it.
    scale: Option<(Scale, Vec<f32>)>,
    /// Whether [`WASTE_COLOR`] is part of the legend.
    waste: bool,
}

/// What is known of the distances to the reference surface.
pub(crate) struct Distances {
    pub unit: DeviationUnit,
    /// None until something is measured.
    pub scale: Option<Scale>,
    /// Whether some of the surface has no colour.
    pub is_partial: bool,
    /// The progress of the measurement, 0 to 1; none if none is under way.
    pub measured: Option<f32>,
}

fn legend_of(colors: Colors, distances: &Distances) -> Option<Legend> {
    let legend = |title: &str, meaning: &str, scale: Option<(Scale, &[f32])>| Legend {
        title: title.to_owned(),
        meaning: meaning.to_owned(),
        scale: scale.map(|(scale, ticks)| (scale, ticks.to_vec())),
        waste: false,
    };
    match colors {
        Colors::Material | Colors::Barycentric => None,
        Colors::Factors => Some(legend(
            "Factor",
            "Colours of tessellation factors, 1 to 64. Each patch shows its inside factor, and along an edge the edge's factor.",
            Some((FACTOR_SCALE, &[1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0])),
        )),
        Colors::TriangleSize => Some(Legend {
            waste: true,
            ..legend(
                "Triangle size, px",
                "Colours of triangles by their size on screen, 3 to 64 px. The size is the side of a square with twice the \
                 triangle's area. All triangles below 3 px have one colour.",
                Some((SIZE_SCALE, &[3.0, 4.0, 8.0, 16.0, 32.0, 64.0])),
            )
        }),
        Colors::LowFactors => Some(Legend {
            waste: true,
            ..legend("Factors below 2", "One colour for patches whose factors are all below 2, edges and inside.", None)
        }),
        Colors::Excess => Some(legend(
            "Triangles, times the own least",
            "Colours of patches by how many times as many triangles they have as their own least, 1 to 16: the fewest with \
             which a patch alone would keep the tolerance of LOD by error.",
            Some((EXCESS_SCALE, &[1.0, 2.0, 4.0, 8.0, 16.0])),
        )),
        Colors::Deviation => Some(deviation_legend(distances)),
    }
}

fn deviation_legend(distances: &Distances) -> Legend {
    let unit = match distances.unit {
        DeviationUnit::Units => "units",
        DeviationUnit::Px => "px",
    };
    let state = match distances.measured {
        Some(part) => format!(" (measuring, {:.0} %)", 100.0 * part),
        None if distances.is_partial => " (not of all triangles)".to_owned(),
        None => String::new(),
    };
    let scale = distances.scale.unwrap_or(DEVIATION_PX_SCALE);
    // The scale has two decades: a tick at each end and one between them.
    let ticks = [scale.least, (scale.least * scale.most).sqrt(), scale.most];
    Legend {
        title: format!("Deviation, {unit}{state}"),
        meaning:
            "Colours of the distance to the reference surface. The scale ends at the largest distance, rounded up, and \
                  begins at a hundredth of that; smaller distances have the first colour. What isn't measured is grey."
                .to_owned(),
        scale: Some((scale, if distances.scale.is_some() { ticks.to_vec() } else { Vec::new() })),
        waste: false,
    }
}

/// The legend of these colours over a picture, if they have one.
pub(crate) fn legend(ui: &mut egui::Ui, picture: Rect, colors: Colors, distances: &Distances) {
    let Some(legend) = legend_of(colors, distances) else { return };
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
    let Some((scale, ticks)) = &legend.scale else {
        let mark = Rect::from_center_size(inner.left_center() + vec2(BAR.y / 2.0, 0.0), egui::Vec2::splat(BAR.y));
        ui.painter().rect_filled(mark, 0.0, rgb(WASTE_COLOR));
        text(ui, mark.right_center() + vec2(8.0, 0.0), Align2::LEFT_CENTER, &legend.title);
        return;
    };
    text(ui, inner.left_top(), Align2::LEFT_TOP, &legend.title);
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
        // Long numbers at the ends are moved inwards, so that they stay on the legend.
        let font = egui::FontId::proportional(TEXT);
        let galley = ui.painter().layout_no_wrap(tick_text(tick), font, Color32::from_gray(235));
        let half = 0.5 * galley.size().x;
        let (first, last) = (rect.left() - 6.0 + half, rect.right() + 6.0 - half);
        let middle = if first < last { x.clamp(first, last) } else { x };
        ui.painter().galley(pos2(middle - half, rect.bottom() + 4.0), galley, Color32::WHITE);
    }
}

/// Formats a tick as shortly as possible. The ends of scales are round numbers.
fn tick_text(tick: f32) -> String {
    if (1e-3..1e5).contains(&tick) {
        let rounded = format!("{tick:.5}");
        rounded.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        let rounded = format!("{tick:.1e}");
        rounded.replace(".0e", "e")
    }
}

fn text(ui: &egui::Ui, at: Pos2, align: Align2, text: &str) {
    ui.painter().text(at, align, text, egui::FontId::proportional(TEXT), Color32::from_gray(235));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_short() {
        let texts = [64.0, 3.0, 0.1, 0.0025, 0.25, 1.5e-4, 2e-7, 150.0].map(tick_text);
        assert_eq!(texts, ["64", "3", "0.1", "0.0025", "0.25", "1.5e-4", "2e-7", "150"]);
    }
}
