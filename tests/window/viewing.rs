//! How the picture is seen: the ground, the background, the light, and what is drawn over it.

mod cameras;
mod legend;
mod previews;
mod section;

use egui::accesskit::Role;
use egui::{Key, Modifiers, Theme};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use geometry::mesh::Shape;
use geometry::view::project;
use inspect::render::layout::{AXIS_COLORS, CRACK_COLOR};
use load::Source;
use pnaen::app::App;

use crate::editing::{assert_draws, copied, press_with};
use crate::{choose, open, open_all_sections, press, settle, switch, unfolded, uniform, window};

/// How many px of the picture have about this sRGB colour.
fn pixels_of(harness: &Harness<App>, color: [u8; 3]) -> usize {
    let picture = harness.state().read_picture().expect("a device").expect("a picture");
    picture.pixels().filter(|pixel| (0..3).all(|c| pixel.0[c].abs_diff(color[c]) <= 4)).count()
}

/// The least and the most red in the window's picture within four points to the left and right of a place.
fn extremes_across(harness: &mut Harness<App>, at: egui::Pos2) -> (u8, u8) {
    let picture = harness.render().expect("a picture of the window");
    let row = (at.x as u32 - 4..=at.x as u32 + 4).map(|x| picture.get_pixel(x, at.y as u32).0[0]);
    row.fold((255, 0), |(least, most), value| (least.min(value), most.max(value)))
}

const BARYCENTRIC: &str = "Legend: Barycentric, weights in the patch";

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
    let (least, most) = extremes_across(&mut harness, egui::pos2(divider.center().x, divider.bottom() - 6.0));
    assert!(most - least > 60, "{least} to {most}");
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
