//! The axes in the viewport's upper right corner. A click on an end looks at the mesh from there.

use egui::{Align2, Color32, FontId, Pos2, Rect, Sense, Stroke, Ui, Vec2, WidgetInfo, vec2};
use glam::Vec3;

use crate::app::App;
use crate::app::widgets::rgb;
use crate::commands::{CameraAction, with_key};
use inspect::render::Standpoint;
use inspect::render::layout::AXIS_COLORS;
use inspect::settings::Choice;

/// Sizes in points: the space that the axes take, the distance of their ends from the middle, and the radii of positive and
/// negative ends.
pub(super) const SIZE: f32 = 84.0;
const REACH: f32 = 29.0;
const RADII: [f32; 2] = [9.0, 7.0];
/// The smallest picture, in points, that has room for the axes.
const LEAST_PICTURE: Vec2 = vec2(230.0, 200.0);
/// What the title of a split's right half takes at most, in points: it stands between the divider and the axes, or above them.
const TITLE: Vec2 = vec2(110.0, 26.0);

struct End {
    standpoint: Standpoint,
    /// 0 x, 1 y, 2 z.
    axis: usize,
    is_positive: bool,
    at: Pos2,
    /// Towards the eye, -1 to 1.
    depth: f32,
}

/// Where the axes are in a picture with this split, if it has room for them.
pub(super) fn axes_place(picture: Rect, split: Option<f32>) -> Option<Rect> {
    let has_room = picture.width() >= LEAST_PICTURE.x && picture.height() >= LEAST_PICTURE.y;
    let place = Align2::RIGHT_TOP.align_size_within_rect(Vec2::splat(SIZE), picture.shrink(4.0));
    let divider = split.map(|split| picture.left() + split * picture.width());
    // The title of a right half that ends there needs the room above.
    let is_narrow = divider.is_some_and(|divider| place.left() - divider < TITLE.x && divider < picture.right());
    let place = if is_narrow { place.translate(vec2(0.0, TITLE.y)) } else { place };
    has_room.then_some(place)
}

/// The ends, those behind first.
fn ends(middle: Pos2, [right, up, back]: [Vec3; 3]) -> [End; 6] {
    let mut ends = Standpoint::ALL.map(|standpoint| {
        let direction = standpoint.direction();
        let (axis, is_positive) = (direction.abs().max_position(), direction.max_element() > 0.0);
        let at = middle + vec2(direction.dot(right), -direction.dot(up)) * REACH;
        End { standpoint, axis, is_positive, at, depth: direction.dot(back) }
    });
    ends.sort_by(|a, b| a.depth.total_cmp(&b.depth));
    ends
}

impl App {
    /// Shows the axes as the camera sees them, and looks from where one is clicked.
    pub(in crate::app) fn axis_gizmo(&mut self, ui: &Ui, picture: Rect) {
        let Some(place) = axes_place(picture, self.settings.split).filter(|_| self.document.is_some()) else { return };
        for end in &ends(place.center(), self.viewport.camera.axes()) {
            if end_button(ui, place.center(), end) {
                self.viewport.camera.look_from(end.standpoint);
            }
        }
    }
}

/// Shows an end with its half of the axis. Returns whether it was clicked.
fn end_button(ui: &Ui, middle: Pos2, end: &End) -> bool {
    let radius = RADII[usize::from(!end.is_positive)];
    let (name, action) = (format!("Look from the {}", end.standpoint.name()), CameraAction::LookFrom(end.standpoint));
    let id = ui.scope_id().with(("axis", &name));
    let response = ui.interact(Rect::from_center_size(end.at, Vec2::splat(2.0 * radius)), id, Sense::click());
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Button, true, &name));
    // What is behind is paler, so that one sees which way an axis points.
    let lit = 0.7 + 0.3 * end.depth;
    let far = Color32::from_gray(if ui.visuals().dark_mode { 50 } else { 190 });
    let color = rgb(AXIS_COLORS[end.axis]).lerp_to_gamma(far, 0.5 * (1.0 - lit));
    let is_marked = response.hovered() || response.has_focus();
    let painter = ui.painter();
    if end.is_positive {
        painter.line_segment([middle, end.at], Stroke::new(2.0, color));
        painter.circle_filled(end.at, radius, color);
        let letter = ["X", "Y", "Z"][end.axis];
        painter.text(end.at, Align2::CENTER_CENTER, letter, FontId::proportional(11.0), Color32::from_gray(20));
    } else {
        painter.circle(end.at, radius, color.lerp_to_gamma(far, 0.65), Stroke::new(1.5, color));
    }
    if is_marked {
        painter.circle_stroke(end.at, radius + 1.5, Stroke::new(2.0, ui.visuals().strong_text_color()));
    }
    let response = response.on_hover_cursor(egui::CursorIcon::PointingHand);
    response.on_hover_text(with_key(&format!("{name}."), &action.into())).clicked()
}

#[cfg(test)]
mod tests {
    use glam::Vec2 as Size;

    use super::*;
    use geometry::mesh::Bounds;
    use inspect::render::Camera;

    #[test]
    fn ends_lie_where_the_camera_sees_their_axes() {
        let mut camera = Camera::framing(&Bounds::default(), Size::ONE);
        let at = |camera: &Camera, standpoint| {
            let ends = ends(Pos2::ZERO, camera.axes());
            let end = ends.into_iter().find(|end| end.standpoint == standpoint).expect("six ends");
            (end.at, end.axis, end.is_positive)
        };
        camera.look_from(Standpoint::Front);
        let near = |a: Pos2, b: Vec2| a.distance(b.to_pos2()) < 0.1;
        let (right, axis, is_positive) = at(&camera, Standpoint::Right);
        assert!(near(right, vec2(REACH, 0.0)) && (axis, is_positive) == (0, true));
        let (bottom, axis, is_positive) = at(&camera, Standpoint::Bottom);
        assert!(near(bottom, vec2(0.0, REACH)) && (axis, is_positive) == (1, false), "down is down on screen");
        let last = ends(Pos2::ZERO, camera.axes()).into_iter().next_back().map(|end| end.standpoint);
        assert_eq!(last, Some(Standpoint::Front), "what faces the eye is in front");
        camera.look_from(Standpoint::Back);
        assert!(near(at(&camera, Standpoint::Right).0, vec2(-REACH, 0.0)), "from behind, right is left");
    }

    #[test]
    fn a_small_picture_has_no_axes() {
        let of = |width, height| axes_place(Rect::from_min_size(Pos2::ZERO, vec2(width, height)), None);
        assert_eq!((of(200.0, 600.0), of(600.0, 150.0)), (None, None));
        let picture = Rect::from_min_size(Pos2::ZERO, vec2(600.0, 400.0));
        assert!(of(600.0, 400.0).is_some_and(|place| picture.contains_rect(place)));
    }

    #[test]
    fn axes_are_beside_the_title_of_a_wide_half_and_under_that_of_a_narrow_one() {
        let of = |width, split| axes_place(Rect::from_min_size(Pos2::ZERO, vec2(width, 400.0)), split);
        assert_eq!(of(600.0, Some(0.5)), of(600.0, None));
        let (narrow, whole) = (of(270.0, Some(0.5)).expect("room"), of(270.0, None).expect("room"));
        assert_eq!(narrow, whole.translate(vec2(0.0, TITLE.y)));
    }
}
