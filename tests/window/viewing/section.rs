//! The section's arrow, which moves it.

use egui::accesskit::Role;
use egui::{Key, Modifiers, Theme};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use geometry::mesh::Shape;
use inspect::settings::SectionAxis;
use load::Source;
use pnaen::app::App;

use super::extremes_across;
use crate::editing::press_with;
use crate::{choose, press, settle, uniform};

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
        let (least, most) = extremes_across(&mut harness, middle);
        assert!(most - least > 60, "{theme:?}: {least} to {most}");
    }
}
