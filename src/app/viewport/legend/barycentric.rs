//! The legend of the barycentric colours: a patch in these colours, and which corner each colour belongs to.

use egui::{Align2, Color32, Mesh, Pos2, Rect, Rgba, Shape, Vec2, pos2, vec2};

use super::text;
use inspect::render::BARYCENTRIC_TITLE;

/// The size inside the legend's margins, in points.
pub(super) const SIZE: Vec2 = vec2(164.0, 78.0);
pub(super) const MEANING: &str = "Each place has the weights u, v and w of its patch's corners as red, green and blue. A corner, where its weight is 1 and the \
     others are 0, has one pure colour; along an edge the colour of the opposite corner is missing; in the middle all are equal.";

/// Sizes in points: the patch, a block of colour, and a row of the list.
const PATCH: Vec2 = vec2(66.0, 56.0);
const BLOCK: f32 = 10.0;
const ROW: f32 = 17.0;
/// How many pieces the patch's edges are painted in. Colours between corners are mixed in linear light, but egui mixes sRGB.
const PIECES: u32 = 8;

/// Paints the legend into a rectangle of [`SIZE`].
pub(super) fn paint(ui: &egui::Ui, inner: Rect) {
    text(ui, inner.left_top(), Align2::LEFT_TOP, BARYCENTRIC_TITLE);
    let patch =
        Rect::from_min_max(pos2(inner.left(), inner.bottom() - PATCH.y), pos2(inner.left() + PATCH.x, inner.bottom()));
    ui.painter().add(Shape::mesh(colored_patch([patch.left_bottom(), patch.right_bottom(), patch.center_top()])));
    let rows = [("u", [1.0, 0.0, 0.0]), ("v", [0.0, 1.0, 0.0]), ("w", [0.0, 0.0, 1.0])];
    let left = patch.right() + 14.0;
    for (corner, (weight, color)) in rows.into_iter().enumerate() {
        let middle = pos2(left + BLOCK / 2.0, patch.top() + ROW * (corner as f32 + 0.5) + 2.5);
        ui.painter().rect_filled(Rect::from_center_size(middle, Vec2::splat(BLOCK)), 0.0, linear_color(color));
        let label = format!("{weight}: corner {corner}");
        text(ui, middle + vec2(BLOCK / 2.0 + 7.0, 0.0), Align2::LEFT_CENTER, &label);
    }
}

fn linear_color([r, g, b]: [f32; 3]) -> Color32 {
    Rgba::from_rgb(r, g, b).into()
}

/// A triangle in its barycentric colours.
fn colored_patch(corners: [Pos2; 3]) -> Mesh {
    let mut mesh = Mesh::default();
    // Row i has the vertices with the weight i / PIECES at the last corner.
    let first = |i: u32| i * (PIECES + 1) - (i * i - i) / 2;
    for i in 0..=PIECES {
        for j in 0..=PIECES - i {
            let [v, w] = [j, i].map(|weight| weight as f32 / PIECES as f32);
            let weights = [1.0 - v - w, v, w];
            let place =
                corners.iter().zip(weights).fold(Vec2::ZERO, |sum, (corner, weight)| sum + corner.to_vec2() * weight);
            mesh.colored_vertex(place.to_pos2(), linear_color(weights));
        }
    }
    for i in 0..PIECES {
        for j in 0..PIECES - i {
            let (here, above) = (first(i) + j, first(i + 1) + j);
            mesh.add_triangle(here, here + 1, above);
            if j + 1 < PIECES - i {
                mesh.add_triangle(here + 1, above + 1, above);
            }
        }
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_patch_is_covered_once_and_its_corners_have_their_own_colours() {
        let corners = [pos2(0.0, 0.0), pos2(8.0, 0.0), pos2(0.0, 8.0)];
        let mesh = colored_patch(corners);
        let area = |triangle: &[u32]| {
            let [a, b, c] = [0, 1, 2].map(|k| mesh.vertices[triangle[k] as usize].pos);
            0.5 * ((b - a).x * (c - a).y - (b - a).y * (c - a).x)
        };
        let areas: Vec<f32> = mesh.indices.chunks(3).map(area).collect();
        assert!(areas.iter().all(|area| (area - 0.5).abs() < 1e-5), "{areas:?}");
        assert_eq!(areas.len(), 64);
        for (corner, color) in corners.into_iter().zip([Color32::RED, Color32::GREEN, Color32::BLUE]) {
            let vertex = mesh.vertices.iter().find(|vertex| vertex.pos.distance(corner) < 1e-4);
            assert_eq!(vertex.map(|vertex| vertex.color), Some(color));
        }
    }
}
