//! Labels over the picture: the selected patch's corners with their weights, and its edges with their factors.

use egui::{Color32, Pos2, Rect, Vec2};

use super::panel::{note_text, paint_note};
use crate::app::App;
use crate::app::patch_names::letter;
use crate::app::text::factor;
use crate::app::widgets::rgb;
use geometry::tessellate::{factor_side, segments};
use geometry::view::{ScreenView, project};
use inspect::render::layout::FACTOR_COLORS;

/// The smallest extent of a patch on screen, in points, that is labelled.
const LEAST_EXTENT: f32 = 60.0;
/// The distance between a label and the labelled point, and the margin around a label, in points.
const GAP: f32 = 10.0;
const MARGIN: Vec2 = Vec2::new(6.0, 3.0);

impl App {
    /// Labels the selected patch in a picture shown in `rect`, if it is large enough there.
    pub(in crate::app) fn patch_labels(&self, ui: &egui::Ui, rect: Rect) {
        let selected = self.selected_patch().filter(|_| !self.settings.shows_difference());
        let (Some(patch), Some(document)) = (selected, &self.document) else { return };
        let Some(ScreenView { clip_from_object, viewport }) = self.shown_view(rect) else { return };
        let Some((_, topology)) = &document.posed() else { return };
        let at = |position| project(clip_from_object, viewport, position).map(|at| rect.min + Vec2::new(at.x, at.y));
        let [Some(a), Some(b), Some(c)] = topology.patch_positions(patch).map(at) else { return };
        let extent = Rect::from_points(&[a, b, c]).size().max_elem();
        if extent < LEAST_EXTENT {
            return;
        }
        let middle = ((a.to_vec2() + b.to_vec2() + c.to_vec2()) / 3.0).to_pos2();
        let corner = |(k, place)| (place, format!("{k} {}", letter(self.convention(), k)), Color32::from_gray(235));
        let corners: Vec<_> = (0..).zip([a, b, c]).map(corner).collect();
        let edges = (0..).zip(self.patch_edges(topology, patch, self.patch_half())).filter_map(|(i, points)| {
            let [before, after] = [points.get((points.len() - 1) / 2)?, points.get(points.len() / 2)?];
            let place = at((*before + *after) / 2.0)?;
            Some((i, place, self.factor_text(patch, i), rgb(FACTOR_COLORS[i as usize])))
        });
        let edges: Vec<_> = edges.collect();
        // Long names of edges if they don't overlap, else short ones, else none.
        // What a finding leads to is in the middle of its half.
        let free = rect.with_min_x(rect.left() + rect.width() * self.settings.split.unwrap_or(0.0)).center();
        for name in ["TessFactor", ""] {
            let named = edges.iter().map(|(i, place, value, color)| (*place, format!("{name}[{i}]{value}"), *color));
            let labels: Vec<_> = corners.iter().cloned().chain(named).collect();
            if show(ui, rect, middle, free, &labels) {
                return;
            }
        }
        show(ui, rect, middle, free, &corners);
    }

    /// Factor `i` of a patch as LOD gave it, and the number of segments.
    fn factor_text(&self, patch: u32, i: u32) -> String {
        let (Some(document), Some(found)) = (&self.document, self.found(self.patch_half())) else {
            return " = …".into();
        };
        let Some(sides) = found.outlines.patch(&document.loaded.topology, patch) else { return String::new() };
        let asked = sides[factor_side(self.convention(), i) as usize].factor;
        let cut = segments(found.outlines.factors(patch).outside[i as usize]);
        format!(" = {} -> {cut}", factor(f64::from(asked), 2))
    }
}

/// Shows each text beside its position, on the side away from `middle`, if the position is in `rect`. Shows nothing and
/// returns false if two would overlap, or one would cover `free`.
fn show(ui: &egui::Ui, rect: Rect, middle: Pos2, free: Pos2, labels: &[(Pos2, String, Color32)]) -> bool {
    let mut placed: Vec<(Rect, _)> = Vec::new();
    for (place, text, color) in labels.iter().filter(|(place, ..)| rect.contains(*place)) {
        let galley = note_text(ui, text, *color);
        let away = (*place - middle).normalized();
        let half = galley.size() / 2.0 + MARGIN;
        let center = *place + away * (GAP + (away.x * half.x).abs() + (away.y * half.y).abs());
        let room = rect.shrink2(half);
        let own = Rect::from_center_size(if room.is_positive() { room.clamp(center) } else { center }, half * 2.0);
        if own.contains(free) || placed.iter().any(|(other, _)| other.intersects(own)) {
            return false;
        }
        placed.push((own, galley));
    }
    for (own, galley) in placed {
        paint_note(ui, own.shrink2(MARGIN), galley);
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::pos2;

    #[test]
    fn no_labels_are_shown_if_two_would_overlap() {
        let rect = Rect::from_min_max(pos2(0.0, 0.0), pos2(400.0, 300.0));
        let label = |x, y| (pos2(x, y), "TessFactor[0] = 8.00 -> 9".to_owned(), Color32::WHITE);
        egui::__run_test_ui(|ui| {
            let all = |labels: &[_]| show(ui, rect, pos2(200.0, 150.0), pos2(300.0, 150.0), labels);
            assert!(all(&[label(200.0, 50.0), label(200.0, 250.0)]), "above and below");
            assert!(!all(&[label(200.0, 50.0), label(210.0, 52.0)]), "one over the other");
            assert!(!all(&[label(300.0, 150.0)]), "over the place that stays free");
            assert!(all(&[label(200.0, 50.0), label(200.0, -50.0)]), "positions out of sight have no label");
        });
    }
}
