//! The cameras of a file.

use egui::Key;
use egui_kittest::Harness;
use pnaen::app::App;
use pnaen::commands::all;
use pnaen::load::Source;
use pnaen::mesh::Shape;

#[path = "../documents/shot.rs"]
mod shot;

use crate::window_tests::editing::{assert_draws, copied};
use crate::window_tests::{press, settle, uniform, window};
use shot::SHOT;

/// Performs the command of this name.
fn give(harness: &mut Harness<App>, name: &str) {
    let commands = all(&harness.state().availability());
    let command = commands.iter().find(|command| command.name == name).unwrap_or_else(|| panic!("no command {name}"));
    let context = harness.ctx.clone();
    harness.state_mut().give(&context, command);
    settle(harness);
}

#[test]
fn a_camera_of_the_file_is_looked_through_undone_copied_and_left() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let path = folder.path().join("shot.gltf");
    std::fs::write(&path, SHOT).expect("a writable temporary folder");
    let mut harness = uniform(Some(Source::File(path)));
    let before = *harness.state().camera();
    give(&mut harness, "Camera: Close");
    let close = *harness.state().camera();
    assert!((close.field_of_view - 0.5_f32.to_degrees()).abs() < 1e-4, "{close:?}");
    assert!(close.eye().distance(glam::vec3(0.25, 0.25, 2.0)) < 1e-5 && (close.roll - 90.0).abs() < 1e-3, "{close:?}");
    let command = copied(&mut harness);
    assert!(command.contains("--field-of-view 28.6") && command.contains("--roll "), "{command}");
    assert_draws(&harness, &command, "shot-view");
    press(&mut harness, Key::Escape);
    press(&mut harness, Key::OpenBracket);
    assert_eq!(*harness.state().camera(), before);
    press(&mut harness, Key::CloseBracket);
    assert_eq!(*harness.state().camera(), close);
    give(&mut harness, "Camera: camera 1");
    assert!(harness.state().camera().orthographic);
    press(&mut harness, Key::F);
    let framed = *harness.state().camera();
    assert_eq!((framed.field_of_view, framed.roll), (before.field_of_view, 0.0));
}

#[test]
fn a_mesh_without_cameras_has_no_such_commands() {
    let harness = window(Some(Source::Shape(Shape::Torus)));
    assert!(harness.state().availability().file_cameras.is_empty());
}
