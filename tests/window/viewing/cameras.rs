//! Cameras: the frozen one of LOD, the standard views and the axes, the views before, and bookmarks.

use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use geometry::mesh::Shape;
use inspect::render::layout::{AXIS_COLORS, LOD_CAMERA_COLOR};
use inspect::render::{Camera, Standpoint};
use load::Source;
use pnaen::app::App;

use super::{BARYCENTRIC, pixels_of};
use crate::editing::{assert_draws, copied, press_with};
use crate::{click, copy_vase, press, resumed, settle, uniform};

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
