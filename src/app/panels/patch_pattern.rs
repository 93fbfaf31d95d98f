//! The domain pattern of one patch: the points and triangles that the tessellator makes of its factors.

use egui::{Color32, Pos2, Rect, Response, Sense, Shape, Stroke, Ui, Vec2, vec2};

use crate::app::widgets::rgb;
use geometry::casts::to_f32;
use geometry::tessellate::{DomainKind, FIXED_ONE, PatchFactors};
use inspect::render::layout::FACTOR_COLORS;

/// Width and height of the plot, in points.
const SIZE: Vec2 = vec2(250.0, 244.0);
/// Points around the triangle, for the letters of its corners.
const MARGIN: Vec2 = vec2(14.0, 26.0);
/// The greatest number of points that are numbered; more numbers would overlap.
const NUMBERED: usize = 60;
/// How close the pointer must be to a domain point to show its weights, in points of the screen.
const REACH: f32 = 8.0;

/// A point's weights in 16.16 fixed point, and as decimals.
pub(super) fn weights_text([u, v]: [u32; 2]) -> [String; 2] {
    let weights = [u, v, FIXED_ONE - u - v];
    let decimals = weights.map(|weight| format!("{:>9.5}", f64::from(weight) / f64::from(FIXED_ONE)));
    [weights.map(|weight| format!("{weight:>9}")).concat(), decimals.concat()]
}

/// Draws the pattern, or an empty one until the factors are known. `letters` are written where u, v and w are 1. Triangle
/// `hit` is filled. `empty` is the text that is shown if there are no points.
pub(super) fn pattern_plot(
    ui: &mut Ui,
    factors: Option<PatchFactors>,
    hit: Option<u32>,
    letters: [String; 3],
    empty: &str,
) -> Response {
    let (rect, response) = ui.allocate_exact_size(SIZE, Sense::hover());
    let (points, triangles) = factors.map(|own| (own.points(), own.triangles())).unwrap_or_default();
    let places: Vec<Pos2> = points.iter().map(|&point| place(rect, point)).collect();
    draw_triangles(ui, &triangles, &places, hit);
    draw_outline(ui, rect, letters);
    let named = match factors {
        None => "Domain pattern, measuring".to_owned(),
        Some(_) if points.is_empty() => format!("Domain pattern, {empty}"),
        Some(_) => format!("Domain pattern, {} points, {} triangles", points.len(), triangles.len()),
    };
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, &named));
    if points.is_empty() {
        text(ui, rect.center(), empty, ui.visuals().weak_text_color());
        return response;
    }
    draw_points(ui, &places);
    hover(ui, response, &points, &places)
}

/// The position of a domain point in the plot: u is 1 at the top, v at the left and w at the right.
fn place(rect: Rect, point: [u32; 2]) -> Pos2 {
    rect.shrink2(MARGIN).lerp_inside(Vec2::from(DomainKind::Tri.place(point).map(to_f32)))
}

fn draw_triangles(ui: &Ui, triangles: &[[u32; 3]], points: &[Pos2], hit: Option<u32>) {
    let painter = ui.painter();
    let at = |i: u32| points[i as usize];
    if let Some(hit) = hit.and_then(|hit| triangles.get(hit as usize)) {
        painter.add(Shape::convex_polygon(hit.map(at).to_vec(), ui.visuals().selection.bg_fill, Stroke::NONE));
    }
    let stroke = Stroke::new(if points.len() > 600 { 0.5 } else { 1.0 }, ui.visuals().weak_text_color());
    let edges = triangles.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]);
    // Two triangles share each inner edge in opposite directions, so each is drawn once. The outline is drawn separately.
    let lines = edges.filter(|(a, b)| a < b).map(|(a, b)| Shape::line_segment([at(a), at(b)], stroke));
    painter.extend(lines);
}

/// The edges on which u, v and w are 0, in the colours of their factors, and the corners' letters.
fn draw_outline(ui: &Ui, rect: Rect, letters: [String; 3]) {
    let corners = [[FIXED_ONE, 0], [0, FIXED_ONE], [0, 0]].map(|uv| place(rect, uv));
    for (i, color) in FACTOR_COLORS.into_iter().enumerate() {
        let ends = [corners[(i + 1) % 3], corners[(i + 2) % 3]];
        ui.painter().line_segment(ends, Stroke::new(2.0, rgb(color)));
    }
    let color = ui.visuals().text_color();
    for (corner, (letter, below)) in corners.into_iter().zip(letters.into_iter().zip([-19.0, 14.0, 14.0])) {
        text(ui, corner + vec2(0.0, below), &letter, color);
    }
}

fn draw_points(ui: &Ui, points: &[Pos2]) {
    if points.len() > NUMBERED {
        return;
    }
    let (font, color) = (egui::FontId::proportional(9.5), ui.visuals().strong_text_color());
    for (i, &point) in points.iter().enumerate() {
        ui.painter().circle_filled(point, 1.75, color);
        let beside = point + vec2(3.0, 1.0);
        ui.painter().text(beside, egui::Align2::LEFT_BOTTOM, i.to_string(), font.clone(), color);
    }
}

/// Shows the number and the weights of the point under the pointer.
fn hover(ui: &Ui, response: Response, points: &[[u32; 2]], places: &[Pos2]) -> Response {
    let Some(pointer) = response.hover_pos() else { return response };
    let near = places.iter().enumerate().map(|(i, place)| (i, place.distance(pointer)));
    let Some((i, distance)) = near.min_by(|a, b| a.1.total_cmp(&b.1)) else { return response };
    if distance > REACH {
        return response;
    }
    ui.painter().circle_stroke(places[i], 4.0, ui.visuals().selection.stroke);
    let [fixed, decimals] = weights_text(points[i]);
    response.on_hover_ui_at_pointer(|ui| {
        ui.label(format!("Point {i}"));
        for text in [format!("{:>9}{:>9}{:>9}", "u", "v", "w"), fixed, decimals] {
            ui.monospace(text);
        }
    })
}

fn text(ui: &Ui, center: Pos2, text: &str, color: Color32) {
    let font = egui::TextStyle::Body.resolve(ui.style());
    ui.painter().text(center, egui::Align2::CENTER_CENTER, text, font, color);
}
