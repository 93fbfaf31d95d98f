//! How the picture is seen: the frozen LOD camera, the standard views and the axes, the ground, and the background.

use egui::accesskit::Role;
use egui::{Key, Modifiers, Theme};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use geometry::mesh::{PartStyle, Shape};
use geometry::tessellate::Surface;
use geometry::view::project;
use inspect::render::layout::{AXIS_COLORS, CRACK_COLOR, LOD_CAMERA_COLOR};
use inspect::render::{Camera, Standpoint};
use inspect::settings::SectionAxis;
use load::Source;
use pnaen::app::App;

use crate::editing::{assert_draws, copied, press_with};
use crate::{
    PATIENCE, choose, click, copy_vase, open, open_all_sections, press, resumed, settle, switch, unfolded, uniform,
    uniform_of, window,
};

/// How many px of the picture have about this sRGB colour.
fn pixels_of(harness: &Harness<App>, color: [u8; 3]) -> usize {
    let picture = harness.state().read_picture().expect("a device").expect("a picture");
    picture.pixels().filter(|pixel| (0..3).all(|c| pixel.0[c].abs_diff(color[c]) <= 4)).count()
}

#[test]
fn a_frozen_camera_is_drawn_copied_and_looked_through() {
    let mut harness = uniform(Some(Source::Shape(Shape::Torus)));
    press(&mut harness, Key::L);
    press(&mut harness, Key::W);
    let frozen = *harness.state().camera();
    press(&mut harness, Key::Z);
    harness.get_by_label("LOD camera frozen");
    assert_eq!(pixels_of(&harness, LOD_CAMERA_COLOR), 0, "through itself it isn't seen");
    let through = harness.state().read_picture().expect("a device");
    for _ in 0..6 {
        press(&mut harness, Key::ArrowRight);
        press(&mut harness, Key::PageDown);
    }
    assert!(pixels_of(&harness, LOD_CAMERA_COLOR) > 200, "its frustum is drawn");
    let command = copied(&mut harness);
    assert!(command.contains("--lod-camera 30,20,"), "{command}");
    assert_draws(&harness, &command, "torus-view");
    press(&mut harness, Key::Escape);
    press_with(&mut harness, Modifiers::SHIFT, Key::Z);
    assert_eq!(*harness.state().camera(), frozen);
    assert_eq!(harness.state().read_picture().expect("a device"), through);
    assert!(!copied(&mut harness).contains("--lod-camera"), "the picture's own camera is the frozen one");
    press(&mut harness, Key::Escape);
    press(&mut harness, Key::Z);
    assert!(harness.query_by_label("LOD camera frozen").is_none());
    press(&mut harness, Key::ArrowRight);
    assert_eq!(pixels_of(&harness, LOD_CAMERA_COLOR), 0);
}

/// Whether a camera looks from a standpoint.
fn looks_from(camera: &Camera, standpoint: Standpoint) -> bool {
    camera.axes()[2].distance(standpoint.direction()) < 0.01
}

#[test]
fn the_axes_and_keys_look_from_six_sides() {
    let mut harness = uniform(Some(Source::Shape(Shape::Torus)));
    let target = harness.state().camera().target;
    let all = [
        ("Look from the front", Standpoint::Front, Modifiers::NONE, Key::Num1),
        ("Look from the back", Standpoint::Back, Modifiers::COMMAND, Key::Num1),
        ("Look from the right", Standpoint::Right, Modifiers::NONE, Key::Num3),
        ("Look from the left", Standpoint::Left, Modifiers::COMMAND, Key::Num3),
        ("Look from the top", Standpoint::Top, Modifiers::NONE, Key::Num7),
        ("Look from the bottom", Standpoint::Bottom, Modifiers::COMMAND, Key::Num7),
    ];
    for (name, standpoint, modifiers, key) in all {
        for by_key in [false, true] {
            // So that no end of an axis is over another.
            let tilt =
                if looks_from(harness.state().camera(), Standpoint::Top) { Key::ArrowDown } else { Key::ArrowUp };
            for key in [tilt, tilt, tilt, Key::ArrowLeft, Key::ArrowLeft, Key::ArrowLeft] {
                harness.key_press(key);
                harness.step();
            }
            settle(&mut harness);
            assert!(!looks_from(harness.state().camera(), standpoint));
            if by_key {
                press_with(&mut harness, modifiers, key);
            } else {
                click(&mut harness, name);
            }
            assert!(looks_from(harness.state().camera(), standpoint), "{name} {:?}", harness.state().camera());
        }
    }
    assert_eq!(harness.state().camera().target, target, "a click on an axis turns the camera and selects nothing");
    assert_eq!(harness.state().selected_triangle(), None);
    // The axes are no part of the picture, and lie beside a legend in it.
    assert_eq!(AXIS_COLORS.map(|color| pixels_of(&harness, color)), [0; 3]);
    press(&mut harness, Key::B);
    press_with(&mut harness, Modifiers::COMMAND, Key::B);
    let legend = harness.get_by_label(BARYCENTRIC).rect();
    let viewport = harness.get_by_label("Viewport").rect();
    for (name, ..) in all {
        let end = harness.get_by_label(name).rect();
        assert!(!end.intersects(legend) && viewport.contains_rect(end), "{name}");
    }
}

const BARYCENTRIC: &str = "Legend: Barycentric, weights in the patch";

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
    let [picture, legend] = ["Viewport", BARYCENTRIC].map(|name| harness.get_by_label(name).rect());
    assert!(legend.height() < high && 3.0 * legend.height() <= picture.height() + 1.0, "{legend} beside {picture}");
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

#[test]
fn the_ground_has_a_note_with_its_spacing_and_is_copied() {
    let mut harness = uniform(Some(Source::Shape(Shape::Torus)));
    assert!(harness.query_by_label_contains("Grid: ").is_none());
    let before = harness.state().read_picture().expect("a device");
    press(&mut harness, Key::Y);
    harness.get_by_label("Grid: 0.2 units");
    assert!(pixels_of(&harness, AXIS_COLORS[1]) > 10, "the axis that points up");
    let command = copied(&mut harness);
    assert!(command.contains("--overlay grid"), "{command}");
    assert_draws(&harness, &command, "torus-view");
    press(&mut harness, Key::Escape);
    press(&mut harness, Key::Y);
    assert!(harness.query_by_label_contains("Grid: ").is_none());
    assert_eq!(harness.state().read_picture().expect("a device"), before);
}

#[test]
fn the_background_follows_the_theme_unless_it_is_set() {
    let builder = Harness::builder().with_size([1000.0, 700.0]).with_theme(Theme::Light);
    let mut harness = unfolded(open(builder, Some(Source::Shape(Shape::Torus)), |_, _| ()));
    let corner = |harness: &Harness<App>| {
        let picture = harness.state().read_picture().expect("a device").expect("a picture");
        picture.get_pixel(3, 3).0[1]
    };
    assert!(corner(&harness) > 200, "light");
    let command = copied(&mut harness);
    assert!(command.contains("--background e"), "{command}");
    assert_draws(&harness, &command, "torus-view");
    press(&mut harness, Key::Escape);
    let set_theme = |harness: &mut Harness<App>, theme| {
        harness.ctx.set_theme(theme);
        settle(harness);
    };
    set_theme(&mut harness, Theme::Dark);
    assert!(corner(&harness) < 60, "dark");
    assert!(!copied(&mut harness).contains("--background"), "commands draw on the same dark grey");
    press(&mut harness, Key::Escape);
    // The colour that is shown is kept when it no longer follows the theme.
    switch(&mut harness, "As the theme");
    set_theme(&mut harness, Theme::Light);
    assert!(corner(&harness) < 60, "it was set");
    assert_eq!(harness.state().settings().background, Some(harness.state().settings().background_color()));
}

#[test]
fn light_is_chosen_where_materials_are_seen() {
    let mut harness = uniform(Some(Source::Shape(Shape::Torus)));
    open_all_sections(&mut harness);
    let has_row = |harness: &Harness<App>, role, name| harness.query_by_role_and_label(role, name).is_some();
    let of_studio = [(Role::Slider, "Exposure"), (Role::ComboBox, "Tone curve"), (Role::Slider, "Turn light")];
    assert!(of_studio.iter().all(|&(role, name)| has_row(&harness, role, name)));
    let studio = harness.state().read_picture().expect("a device");
    harness.get_by_role_and_label(Role::Slider, "Exposure").set_value_accesskit(1.0);
    settle(&mut harness);
    assert_eq!(harness.state().settings().exposure, 1.0);
    assert_ne!(harness.state().read_picture().expect("a device"), studio, "it is brighter");
    let command = copied(&mut harness);
    assert!(command.contains("--exposure 1"), "{command}");
    assert_draws(&harness, &command, "torus-view");
    press(&mut harness, Key::Escape);
    choose(&mut harness, "Lighting", "Camera");
    assert!(
        of_studio.iter().all(|&(role, name)| !has_row(&harness, role, name)),
        "the camera's lights have none of it"
    );
    press_with(&mut harness, Modifiers::SHIFT, Key::C);
    assert!(!has_row(&harness, Role::ComboBox, "Lighting"), "clay has a light of its own");
}

#[test]
fn the_exposures_slider_is_fine_and_more_can_be_typed() {
    let mut harness = window(Some(Source::Shape(Shape::Torus)));
    let slider = harness.get_by_role_and_label(Role::Slider, "Exposure");
    slider.scroll_to_me();
    settle(&mut harness);
    let slider = harness.get_by_role_and_label(Role::Slider, "Exposure");
    let node = slider.accesskit_node();
    assert_eq!((node.min_numeric_value(), node.max_numeric_value()), (Some(-5.0), Some(5.0)));
    let middle = slider.rect().center().y;
    for (typed, taken) in [("8.5", 8.5), ("80", 10.0)] {
        let number = harness.query_all_by_role(Role::SpinButton);
        let number = number.filter(|number| (number.rect().center().y - middle).abs() < 3.0).collect::<Vec<_>>();
        number.first().expect("the slider's number").click();
        drop(number);
        settle(&mut harness);
        harness.event(egui::Event::Text(typed.into()));
        press(&mut harness, Key::Enter);
        assert_eq!(harness.state().settings().exposure, taken, "up to the option's own end");
    }
}

#[test]
fn a_gap_is_seen_between_the_lines_of_its_sides() {
    let mut harness = uniform(Some(Source::Shape(Shape::CubeSplit)));
    choose(&mut harness, "Surface", "PN");
    press(&mut harness, Key::C);
    let widest = harness.state().cracks().expect("measured").edges[0];
    harness.state_mut().select_edge(widest.edge);
    press(&mut harness, Key::Escape);
    assert_eq!(harness.state().selected_edge(), None);
    let bounds = harness.state().loaded().expect("a mesh").mesh.bounds();
    // The gap in the picture, in px, and whether a line covers all of its middle.
    let seen = |harness: &Harness<App>| {
        let picture = harness.state().read_picture().expect("a device").expect("a picture");
        let viewport = glam::vec2(picture.width() as f32, picture.height() as f32);
        let clip_from_object = harness.state().camera().clip_from_object(viewport, &bounds);
        let [a, b] = widest.widest;
        let middle = project(clip_from_object, viewport, 0.5 * (a + b)).expect("in front of the eye");
        let [x, y] = [middle.x as u32, middle.y as u32];
        let mut around = (x - 1..=x + 1).flat_map(|x| (y - 1..=y + 1).map(move |y| (x, y)));
        let is_line = |(x, y)| (0..3).all(|c| picture.get_pixel(x, y).0[c].abs_diff(CRACK_COLOR[c]) < 60);
        (widest.gap_px(clip_from_object, viewport), around.all(is_line))
    };
    while seen(&harness).0 > 3.4 {
        press(&mut harness, Key::PageDown);
    }
    let (gap, is_covered) = seen(&harness);
    assert!(gap > 2.7 && !is_covered, "a gap of {gap} px");
}

#[test]
fn the_divider_is_seen_on_a_light_background() {
    let mut harness = window(None);
    harness.ctx.set_theme(Theme::Light);
    settle(&mut harness);
    press(&mut harness, Key::S);
    let divider = harness.get_by_label("Split divider").rect();
    let picture = harness.render().expect("a picture of the window");
    let row = (divider.center().x as u32 - 4..=divider.center().x as u32 + 4)
        .map(|x| picture.get_pixel(x, divider.bottom() as u32 - 6).0[0]);
    let (least, most) = row.fold((255, 0), |(least, most), value: u8| (least.min(value), most.max(value)));
    assert!(most - least > 60, "{least} to {most}");
}

/// Where the section's arrow is.
fn arrow(harness: &Harness<App>) -> egui::Rect {
    harness.get_by_role_and_label(Role::Slider, "Section arrow").rect()
}

/// Drags from a place by so many points, in three steps.
fn drag(harness: &mut Harness<App>, from: egui::Pos2, by: egui::Vec2) {
    harness.hover_at(from);
    harness.run_steps(1);
    harness.drag_at(from);
    for part in [0.3, 0.6, 1.0] {
        harness.run_steps(2);
        harness.hover_at(from + part * by);
    }
    harness.run_steps(2);
    harness.drop_at(from + by);
    settle(harness);
}

#[test]
fn the_section_follows_its_arrow_in_one_step_and_the_camera_stays() {
    let mut harness = uniform(Some(Source::Shape(Shape::Icosphere)));
    assert!(harness.query_by_label("Section arrow").is_none(), "there is no section");
    choose(&mut harness, "Section", "-Y");
    let (settings, camera) = (*harness.state().settings(), *harness.state().camera());
    assert_eq!((settings.section, settings.section_at), (Some(SectionAxis::NegY), 0.5));
    let picture = harness.state().read_picture().expect("a device");
    let before = arrow(&harness);
    assert!(before.height() > before.width() && before.width() < 20.0, "upright: {before}");
    // What is across the arrow doesn't count.
    drag(&mut harness, before.center(), egui::vec2(-20.0, -30.0));
    let at = harness.state().settings().section_at;
    assert!(at > 0.52 && at < 0.7, "{at}");
    let moved = arrow(&harness).center() - before.center();
    assert!((moved - egui::vec2(0.0, -30.0)).length() < 1.5, "{moved}");
    assert_eq!((*harness.state().camera(), harness.state().selected_triangle()), (camera, None));
    assert_ne!(harness.state().read_picture().expect("a device"), picture);
    press_with(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(*harness.state().settings(), settings, "a drag is one step");
    // The slider moves the same, and the arrow goes no farther than it.
    harness.get_by_role_and_label(Role::Slider, "Section at").set_value_accesskit(0.25);
    settle(&mut harness);
    assert!(arrow(&harness).center().y > before.center().y + 30.0, "it stands lower");
    let from = arrow(&harness).center();
    drag(&mut harness, from, egui::vec2(0.0, 2000.0));
    assert_eq!((harness.state().settings().section_at, *harness.state().camera()), (0.0, camera));
    harness.get_by_role_and_label(Role::Slider, "Section arrow").set_value_accesskit(75.0);
    settle(&mut harness);
    assert_eq!(harness.state().settings().section_at, 0.75, "screen readers ask for it in percent");
    // The wheel zooms as it does beside the arrow.
    harness.hover_at(arrow(&harness).center());
    harness.event(egui::Event::MouseWheel {
        unit: egui::MouseWheelUnit::Line,
        delta: egui::vec2(0.0, 2.0),
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Wheel,
        modifiers: Modifiers::NONE,
    });
    settle(&mut harness);
    harness.run_steps(10);
    settle(&mut harness);
    assert!(harness.state().camera().distance < camera.distance);
}

#[test]
fn an_arrow_that_is_seen_from_its_end_is_upright_and_drags() {
    let mut harness = uniform(Some(Source::Shape(Shape::Icosphere)));
    choose(&mut harness, "Section", "-X");
    let oblique = arrow(&harness);
    assert!(oblique.width() > oblique.height(), "to the right: {oblique}");
    press(&mut harness, Key::Num3);
    let upright = arrow(&harness);
    assert!(upright.height() > upright.width());
    drag(&mut harness, upright.center(), egui::vec2(0.0, -50.0));
    let at = harness.state().settings().section_at;
    assert!((at - 0.75).abs() < 0.01, "{at}");
}

#[test]
fn a_drag_of_the_sections_arrow_from_a_place_that_comes_behind_the_eye_leaves_the_camera() {
    let mut harness = uniform(Some(Source::Shape(Shape::Icosphere)));
    choose(&mut harness, "Section", "-Z");
    harness.get_by_role_and_label(Role::Slider, "Section at").set_value_accesskit(0.9);
    settle(&mut harness);
    press(&mut harness, Key::Num1);
    let from = arrow(&harness).center();
    harness.hover_at(from);
    harness.run_steps(1);
    harness.drag_at(from);
    for points in [50.0, 100.0, 150.0] {
        harness.run_steps(2);
        harness.hover_at(from + egui::vec2(0.0, points));
    }
    settle(&mut harness);
    let at = harness.state().settings().section_at;
    assert!((at - 0.15).abs() < 0.01, "{at}");
    // The start of the drag is 0.8 before the middle of the sphere.
    for _ in 0..10 {
        press(&mut harness, Key::PageUp);
    }
    let camera = *harness.state().camera();
    assert!(camera.distance < 0.75, "{}", camera.distance);
    harness.hover_at(from + egui::vec2(60.0, 190.0));
    harness.run_steps(2);
    assert_eq!((*harness.state().camera(), harness.state().settings().section_at), (camera, at));
}

#[test]
fn the_sections_arrow_is_seen_in_both_themes() {
    for theme in [Theme::Dark, Theme::Light] {
        let mut harness = uniform(Some(Source::Shape(Shape::Icosphere)));
        harness.ctx.set_theme(theme);
        choose(&mut harness, "Section", "-Y");
        let middle = arrow(&harness).center();
        let picture = harness.render().expect("a picture of the window");
        let row = (middle.x as u32 - 4..=middle.x as u32 + 4).map(|x| picture.get_pixel(x, middle.y as u32).0[0]);
        let (least, most) = row.fold((255, 0), |(least, most), value: u8| (least.min(value), most.max(value)));
        assert!(most - least > 60, "{theme:?}: {least} to {most}");
    }
}

/// Presses a key and runs frames until a preview is shown.
fn move_until_previewed(harness: &mut Harness<App>, key: Key) {
    let (start, before) = (std::time::Instant::now(), harness.state().previews());
    while harness.state().previews() == before || !harness.state().shows_preview() {
        assert!(start.elapsed() < PATIENCE, "no preview is shown");
        harness.key_press(key);
        harness.step();
    }
}

#[test]
fn a_preview_is_shown_while_the_camera_moves_and_the_full_picture_follows() {
    let mut harness = uniform(Some(Source::Shape(Shape::Torus)));
    // A million triangles are late on any driver for software.
    harness.get_by_role_and_label(Role::Slider, "Factor").set_value_accesskit(64.0);
    settle(&mut harness);
    let (totals, pictures) = (harness.state().totals(), harness.state().pictures());
    assert!(!harness.state().shows_preview());
    move_until_previewed(&mut harness, Key::ArrowRight);
    harness.get_by_label_contains("Preview: factor ");
    assert_eq!(harness.state().totals(), totals, "nothing is counted in a preview");
    assert_eq!(harness.state().pictures(), pictures, "the full picture waits until the camera rests");
    settle(&mut harness);
    assert!(!harness.state().shows_preview() && harness.state().pictures() > pictures);
    assert!(harness.query_by_label_contains("Preview: ").is_none());
    assert_eq!(harness.state().totals(), totals);
    let command = copied(&mut harness);
    assert_draws(&harness, &command, "torus-view");
    press(&mut harness, Key::Escape);
    // Somebody who judges LOD in motion switches previews off.
    harness.get_by_role_and_label(Role::Button, "View").click();
    settle(&mut harness);
    harness.get_by_label_contains("Preview while the camera moves").click();
    settle(&mut harness);
    let previews = harness.state().previews();
    press(&mut harness, Key::ArrowRight);
    assert_eq!(harness.state().previews(), previews);
}

#[test]
fn a_part_keeps_its_own_surface_in_previews() {
    // More triangles than previews on a driver for software draw as they are.
    const SIDE: usize = 60;
    let points = (0..=SIDE).flat_map(|y| (0..=SIDE).map(move |x| format!("v {x} {y} 0\n")));
    let faces = (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| 1 + y * (SIDE + 1) + x));
    let faces = faces.map(|first| format!("f {first} {} {} {}\n", first + 1, first + SIDE + 2, first + SIDE + 1));
    let sheet: String = points.chain(faces).collect();
    let (_folder, mut harness) = uniform_of("sheet.obj", format!("o sheet\n{sheet}"));
    harness.get_by_role_and_label(Role::Slider, "Factor").set_value_accesskit(16.0);
    let (context, style) = (harness.ctx.clone(), PartStyle { surface: Some(Surface::Flat), ..PartStyle::default() });
    harness.state_mut().prepare(&context, |own| own.parts.set_style("sheet", style));
    settle(&mut harness);
    // A simplified mesh would be made in the meantime.
    for _ in 0..2 {
        move_until_previewed(&mut harness, Key::ArrowRight);
        assert!(harness.query_by_label_contains("Preview: a simplified mesh").is_none());
        settle(&mut harness);
        std::thread::sleep(std::time::Duration::from_millis(500));
    }
}

#[test]
fn views_are_undone_apart_from_settings() {
    let mut harness = uniform(Some(Source::Shape(Shape::Torus)));
    let camera = |harness: &Harness<App>| *harness.state().camera();
    let first = camera(&harness);
    press(&mut harness, Key::Num1);
    let front = camera(&harness);
    std::thread::sleep(std::time::Duration::from_millis(600));
    press(&mut harness, Key::W);
    press(&mut harness, Key::Num7);
    let top = camera(&harness);
    assert!(first != front && front != top);
    press_with(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!((camera(&harness), harness.state().settings().overlays.wireframe), (top, false), "undo leaves the view");
    press(&mut harness, Key::OpenBracket);
    assert_eq!((camera(&harness), harness.state().settings().overlays.wireframe), (front, false));
    press(&mut harness, Key::OpenBracket);
    assert_eq!(camera(&harness), first);
    press(&mut harness, Key::CloseBracket);
    assert_eq!(camera(&harness), front);
}

fn open_bookmarks(harness: &mut Harness<App>) {
    harness.get_by_role_and_label(Role::Button, "View").click();
    settle(harness);
    harness.get_by_label_contains("Bookmarks").click();
    settle(harness);
}

#[test]
fn bookmarks_are_kept_with_the_file() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let file = copy_vase(&folder, "vase.glb");
    let opened = || resumed(folder.path(), [1000.0, 700.0], Some(Source::File(file.clone())));
    let mut harness = opened();
    press(&mut harness, Key::Num3);
    let right = *harness.state().camera();
    press_with(&mut harness, Modifiers::COMMAND, Key::D);
    harness.get_by_label("Bookmark 1");
    press(&mut harness, Key::Num7);
    assert!(harness.query_by_label("Bookmark 1").is_none(), "another view");
    press_with(&mut harness, Modifiers::COMMAND, Key::D);
    press_with(&mut harness, Modifiers::ALT, Key::Num1);
    assert_eq!(*harness.state().camera(), right);
    press_with(&mut harness, Modifiers::COMMAND, Key::D);
    open_bookmarks(&mut harness);
    assert!(harness.query_by_label_contains("Bookmark 3").is_none(), "this view is the first one already");
    press(&mut harness, Key::Escape);
    press(&mut harness, Key::Num1);
    eframe::App::on_exit(harness.state_mut());
    drop(harness);
    let mut harness = opened();
    press_with(&mut harness, Modifiers::ALT, Key::Num1);
    assert_eq!(*harness.state().camera(), right, "the next window knows it");
    open_bookmarks(&mut harness);
    harness.get_by_label_contains("Bookmark 2");
    click(&mut harness, "Forget bookmarks");
    click(&mut harness, "Cancel");
    open_bookmarks(&mut harness);
    harness.get_by_label_contains("Bookmark 2");
    click(&mut harness, "Forget bookmarks");
    click(&mut harness, "Forget them");
    press_with(&mut harness, Modifiers::ALT, Key::Num1);
    open_bookmarks(&mut harness);
    assert!(harness.query_by_label_contains("Bookmark 2").is_none());
}

#[test]
fn tab_hides_the_panels_until_a_control_has_the_focus() {
    let mut harness = uniform(Some(Source::Shape(Shape::Torus)));
    let is_shown = |harness: &Harness<App>| harness.query_by_role_and_label(Role::ComboBox, "Surface").is_some();
    press(&mut harness, Key::Tab);
    assert!(!is_shown(&harness));
    press(&mut harness, Key::Tab);
    assert!(is_shown(&harness));
    press(&mut harness, Key::F6);
    press(&mut harness, Key::Tab);
    assert!(is_shown(&harness), "Tab goes from control to control");
    press(&mut harness, Key::Escape);
    press(&mut harness, Key::Tab);
    assert!(!is_shown(&harness), "Escape gave the keyboard back to the picture");
}
