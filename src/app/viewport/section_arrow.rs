//! The arrow that moves the section. It stands on the middle of the section's plane, on the side that isn't drawn.

use egui::{CursorIcon, PointerButton, Rect, Ui};
use glam::{Vec2, Vec3, Vec4Swizzles, vec2};

use super::panel::{handle, handle_strokes};
use crate::app::App;
use crate::commands::with_note;
use geometry::view::ScreenView;

/// How long the arrow is, and how far beside it one can grab it, in points.
const LENGTH: f32 = 44.0;
const REACH: f32 = 7.0;
/// A way that looks shorter than the first, in points, is seen from its end. The arrow is then upright, and the way as long as the
/// second.
const END_ON: f32 = 24.0;
const UPRIGHT: f32 = 200.0;

/// The straight way that the middle of the section's plane can go, seen from where it is.
#[derive(Debug)]
struct Way {
    /// The middle of the plane, in points from the upper left corner of the picture.
    middle: Vec2,
    /// The unit vector to larger coordinates.
    along: Vec2,
    /// The length of the whole way in points, if all of it were as far from the eye as the middle.
    length: f32,
    /// How much farther from the eye the end of the way is than its start, relative to the distance of the middle.
    receding: f32,
}

impl Way {
    /// `ends` are where the middle of the plane is at 0 and at 1. None if it is behind the eye at `at`.
    fn new(view: &ScreenView, ends: [Vec3; 2], at: f32) -> Option<Self> {
        let [start, end] = ends.map(|end| view.clip_from_object * end.extend(1.0));
        let (place, step) = (start.lerp(end, at), end - start);
        let (seen, half) = (place.xy() / place.w, 0.5 * vec2(view.viewport.x, -view.viewport.y));
        let middle = half * seen + 0.5 * view.viewport;
        let change = half * (step.xy() - seen * step.w) / place.w;
        let way = match change.length() {
            length if length < END_ON => Self { middle, along: Vec2::NEG_Y, length: UPRIGHT, receding: 0.0 },
            length => Self { middle, along: change / length, length, receding: step.w / place.w },
        };
        (place.w > 0.0).then_some(way)
    }

    /// By how much the section moves, as a part of the way, so that its middle is seen to move by so many points along the way.
    fn moved(&self, points: f32) -> f32 {
        // The way is seen as x / (1 + receding x) times its length.
        let rest = self.length - points * self.receding;
        // Nothing of it is seen beyond its vanishing point.
        if rest > 0.0 { points / rest } else { points.signum() }
    }
}

impl App {
    /// Shows the arrow while there is a section, and moves the section as it is dragged.
    pub(super) fn section_arrow(&mut self, ui: &Ui, picture: Rect) {
        let (Some(axis), Some(document)) = (self.settings.section, &self.document) else { return };
        let Some(view) = self.shown_view(picture) else { return };
        let (bounds, at) = (&document.scene.bounds, self.settings.section_at);
        let ends =
            [bounds.min, bounds.max].map(|end| bounds.center() + (end - bounds.center()) * axis.direction().abs());
        let Some(way) = Way::new(&view, ends, at) else { return };
        let arrow = -LENGTH * axis.direction().element_sum() * way.along;
        let (middle, arrow) = (picture.min + egui::vec2(way.middle.x, way.middle.y), egui::vec2(arrow.x, arrow.y));
        if !picture.contains(middle) && !ui.ctx().egui_is_using_pointer() {
            return;
        }
        let (response, asked) =
            handle(ui, Rect::from_two_pos(middle, middle + arrow).expand(REACH), "Section arrow", at);
        if response.drag_started() {
            ui.data_mut(|data| data.insert_temp(response.id, at));
        }
        let from = ui.data(|data| data.get_temp(response.id)).filter(|_| response.dragged_by(PointerButton::Primary));
        let dragged = from.zip(response.total_drag_delta()).and_then(|(from, dragged)| {
            let way = Way::new(&view, ends, from)?;
            Some((from + way.moved(vec2(dragged.x, dragged.y).dot(way.along))).clamp(0.0, 1.0))
        });
        match dragged.or(asked) {
            Some(to) => self.settings.section_at = to,
            None if from.is_none() => self.move_camera(ui, &response, picture),
            // The place that it is dragged from is behind the eye now.
            None => {}
        }
        for stroke in handle_strokes(&response) {
            ui.painter().circle_filled(middle, 1.5 * stroke.width, stroke.color);
            ui.painter().arrow(middle, arrow, stroke);
        }
        let cursor = if response.dragged() { CursorIcon::Grabbing } else { CursorIcon::Grab };
        response.on_hover_cursor(cursor).on_hover_text(with_note("Drag it to move the section.", "--section-at"));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::mesh::Bounds;
    use geometry::view::project;
    use inspect::render::{Camera, Standpoint};

    const VIEWPORT: Vec2 = vec2(640.0, 480.0);
    const ENDS: [Vec3; 2] = [Vec3::new(-1.0, 0.1, 0.05), Vec3::new(1.0, 0.1, 0.05)];

    fn camera() -> Camera {
        Camera::framing(&Bounds::new([Vec3::NEG_ONE, Vec3::ONE].into_iter()), VIEWPORT)
    }

    fn view(camera: &Camera) -> ScreenView {
        let bounds = Bounds::new([Vec3::NEG_ONE, Vec3::ONE].into_iter());
        ScreenView { clip_from_object: camera.clip_from_object(VIEWPORT, &bounds), viewport: VIEWPORT }
    }

    #[test]
    fn the_middle_of_the_plane_follows_what_drags_it() {
        for orthographic in [false, true] {
            let view = view(&Camera { orthographic, ..camera() });
            let seen =
                |at| project(view.clip_from_object, VIEWPORT, ENDS[0].lerp(ENDS[1], at)).expect("before the eye");
            for from in [0.0, 0.3, 0.9] {
                let way = Way::new(&view, ENDS, from).expect("before the eye");
                assert!(way.middle.distance(seen(from)) < 1e-2 && way.along.x > 0.0, "{way:?}");
                for points in [-60.0, 0.0, 25.0] {
                    let there = seen(from + way.moved(points));
                    assert!(there.distance(seen(from) + points * way.along) < 0.05, "{from}, {points}: {there}");
                }
            }
        }
    }

    #[test]
    fn a_way_seen_from_its_end_is_upright_and_one_behind_the_eye_has_no_arrow() {
        let mut camera = camera();
        camera.look_from(Standpoint::Right);
        let end_on = Way::new(&view(&camera), ENDS, 0.5).expect("before the eye");
        assert_eq!((end_on.along, end_on.moved(0.25 * UPRIGHT)), (Vec2::NEG_Y, 0.25));
        camera.look_from(Standpoint::Left);
        camera.target.x = 50.0;
        assert!(Way::new(&view(&camera), ENDS, 0.5).is_none());
    }

    #[test]
    fn beyond_its_vanishing_point_a_way_is_at_its_end() {
        let way = Way { middle: Vec2::ZERO, along: Vec2::X, length: 100.0, receding: 0.5 };
        assert_eq!(
            [way.moved(100.0), way.moved(200.0), way.moved(-1e6)].map(|by| by.clamp(-1.0, 1.0)),
            [1.0, 1.0, -1.0]
        );
        assert_eq!(Way { receding: -0.5, ..way }.moved(-200.0), -1.0);
    }
}
