//! Where the legend of the colours is.

use egui::accesskit::Role;
use egui::{Key, Modifiers, Theme};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use geometry::mesh::Shape;
use load::Source;
use pnaen::app::App;

use super::BARYCENTRIC;
use crate::editing::press_with;
use crate::{open, press, settle, uniform};

/// Whether the legend lies over the picture. If it does, it must be in a lower corner.
fn legend_is_over_the_picture(harness: &Harness<App>) -> bool {
    let [picture, legend] = ["Viewport", BARYCENTRIC].map(|name| harness.get_by_label(name).rect());
    let is_over = picture.intersects(legend);
    if is_over {
        let aside = (legend.left() - picture.left()).min(picture.right() - legend.right());
        assert!(picture.contains_rect(legend), "{legend} in {picture}");
        assert!((aside - 10.0).abs() < 1.0 && (picture.bottom() - legend.bottom() - 10.0).abs() < 1.0, "{legend}");
    }
    is_over
}

#[test]
fn the_legend_is_beside_a_picture_that_the_mesh_fills_unless_no_measurements_are_shown() {
    let mut harness = uniform(None);
    let places = |harness: &Harness<App>| {
        let title = |name| harness.get_by_role_and_label(Role::DisclosureTriangle, name).rect();
        (harness.get_by_label("No cracks").rect(), ["Patch", "Cracks", "Waste"].map(title))
    };
    let ends = |harness: &Harness<App>| {
        let picture = harness.state().read_picture().expect("a device").expect("a picture");
        [4, picture.width() - 5].map(|x| *picture.get_pixel(x, picture.height() - 5))
    };
    press(&mut harness, Key::Num1);
    let (background, before) = (ends(&harness), places(&harness));
    press(&mut harness, Key::B);
    assert_eq!(places(&harness), before, "nothing moves");
    for _ in 0..5 {
        press(&mut harness, Key::PageUp);
    }
    let filled = ends(&harness);
    assert!(filled[0] != background[0] && filled[1] != background[1], "the mesh reaches both lower corners");
    assert!(!legend_is_over_the_picture(&harness));
    let legend = harness.get_by_label(BARYCENTRIC).rect();
    assert!(harness.ctx.content_rect().contains_rect(legend) && legend.height() > 60.0, "{legend}");
    press_with(&mut harness, Modifiers::COMMAND, Key::B);
    assert!(legend_is_over_the_picture(&harness), "panels are hidden");
    press_with(&mut harness, Modifiers::COMMAND, Key::B);
    assert!(!legend_is_over_the_picture(&harness));
    // Tabs show settings or measurements.
    harness.set_size(egui::vec2(1024.0, 640.0));
    settle(&mut harness);
    assert!(legend_is_over_the_picture(&harness), "settings are shown");
    harness.get_by_role_and_label(Role::Tab, "Measurements").click();
    settle(&mut harness);
    assert!(!legend_is_over_the_picture(&harness));
    // Where both are narrower than the rows, these scroll sideways and the legend doesn't.
    harness.set_size(egui::vec2(490.0, 640.0));
    settle(&mut harness);
    assert!(!legend_is_over_the_picture(&harness));
    let (legend, picture) = (harness.get_by_label(BARYCENTRIC).rect(), harness.get_by_label("Viewport").rect());
    assert!(legend.left() > 0.0 && legend.right() < picture.left(), "{legend} beside {picture}");
    harness.set_size(egui::vec2(420.0, 640.0));
    settle(&mut harness);
    assert!(legend_is_over_the_picture(&harness), "the window is too narrow for panels");
}

#[test]
fn the_legend_takes_a_third_of_a_low_panel_at_most() {
    let mut harness = uniform(None);
    press(&mut harness, Key::B);
    let high = harness.get_by_label(BARYCENTRIC).rect().height();
    harness.set_size(egui::vec2(1200.0, 240.0));
    settle(&mut harness);
    assert!(!legend_is_over_the_picture(&harness));
    // The panel begins under the menus.
    let (legend, top) = (harness.get_by_label(BARYCENTRIC).rect(), harness.get_by_label("File").rect().bottom());
    assert!(legend.height() < high && 3.0 * legend.height() <= legend.bottom() - top, "{legend} below {top}");
}

#[test]
fn the_legend_beside_the_picture_is_legible_in_both_themes() {
    for theme in [Theme::Dark, Theme::Light] {
        let builder = Harness::builder().with_size([1200.0, 800.0]).with_theme(theme);
        let mut harness = open(builder, Some(Source::Shape(Shape::Torus)), |_, _| ());
        settle(&mut harness);
        press(&mut harness, Key::B);
        let legend = harness.get_by_label(BARYCENTRIC).rect();
        let picture = harness.render().expect("a picture of the window");
        let at = |x: f32, y: f32| {
            let [r, g, b, _] = picture.get_pixel(x as u32, y as u32).0;
            [r, g, b]
        };
        let differ = |a: [u8; 3], b: [u8; 3], by: u8| (0..3).all(|c| a[c].abs_diff(b[c]) > by);
        let (plate, panel) = (at(legend.left() + 4.0, legend.center().y), at(legend.left() - 4.0, legend.center().y));
        assert!((0..3).all(|c| plate[c].abs_diff(panel[c]) < 4), "{theme:?}: {plate:?} on {panel:?}");
        assert_eq!(plate[0] > 128, theme == Theme::Light, "{theme:?}: {plate:?}");
        // The title is in the uppermost 22 points.
        let title = (5..21_u8).flat_map(|y| (10..170_u8).map(move |x| (f32::from(x), f32::from(y))));
        let ink = title.filter(|(x, y)| differ(at(legend.left() + x, legend.top() + y), plate, 90)).count();
        assert!((60..1500).contains(&ink), "{theme:?}: {ink} px");
    }
}

#[test]
fn the_legend_stands_where_the_mesh_is_not_and_stays_there_while_a_button_is_held() {
    let mut harness = uniform(None);
    harness.set_size(egui::vec2(616.0, 960.0));
    press_with(&mut harness, Modifiers::COMMAND, Key::B);
    press(&mut harness, Key::B);
    press(&mut harness, Key::Y);
    let viewport = harness.get_by_label("Viewport").rect();
    let legend = |harness: &Harness<App>| harness.get_by_label(BARYCENTRIC).rect();
    let is_right = |harness: &Harness<App>| legend(harness).center().x > viewport.center().x;
    assert!(is_right(&harness), "the mesh is in the middle");
    // So near that the mesh reaches the lower border.
    press(&mut harness, Key::PageUp);
    press(&mut harness, Key::PageUp);
    let pan = |harness: &mut Harness<App>, key: Key, times: usize| {
        for _ in 0..times {
            harness.key_press_modifiers(Modifiers::SHIFT, key);
            harness.step();
        }
    };
    pan(&mut harness, Key::ArrowRight, 12);
    settle(&mut harness);
    let first = is_right(&harness);
    pan(&mut harness, Key::ArrowLeft, 24);
    settle(&mut harness);
    assert_ne!(is_right(&harness), first, "one way it would be over the mesh");
    // The key that brings the mesh to the right.
    let [key, back] = if first { [Key::ArrowLeft, Key::ArrowRight] } else { [Key::ArrowRight, Key::ArrowLeft] };
    if is_right(&harness) {
        pan(&mut harness, key, 24);
        settle(&mut harness);
    }
    assert!(!is_right(&harness));
    let note = harness.get_by_label_contains("Grid: ").rect();
    assert!(!note.intersects(legend(&harness)) && viewport.contains_rect(note), "notes are above it: {note}");
    let held = viewport.lerp_inside(egui::vec2(0.5, 0.3));
    harness.hover_at(held);
    harness.drag_at(held);
    harness.step();
    pan(&mut harness, back, 24);
    assert!(!is_right(&harness));
    harness.drop_at(held);
    settle(&mut harness);
    assert!(is_right(&harness));
}
