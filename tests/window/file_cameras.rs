//! The cameras of a file.

use base64::prelude::{BASE64_STANDARD, Engine};
use egui::Key;
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use geometry::mesh::Shape;
use load::Source;
use pnaen::app::App;
use pnaen::commands::all;
use serde_json::{Value, json};

use crate::editing::{assert_draws, copied};
use crate::{press, settle, uniform_of, window};
use documents::shot::SHOT;

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
    let (_folder, mut harness) = uniform_of("shot.gltf", SHOT);
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

/// The document with a clip of a second, in which the camera `Close` moves 2 units away.
fn moving_shot() -> String {
    let mut document: Value = serde_json::from_str(SHOT).expect("JSON");
    let numbers = [0.0, 1.0, 0.25, 0.25, 2.0, 0.25, 0.25, 4.0_f32];
    let bytes: Vec<u8> = numbers.into_iter().flat_map(f32::to_le_bytes).collect();
    let uri = format!("data:application/octet-stream;base64,{}", BASE64_STANDARD.encode(bytes));
    let push = |list: &mut Value, value: Value| list.as_array_mut().expect("a list").push(value);
    push(&mut document["buffers"], json!({ "byteLength": 32, "uri": uri }));
    push(&mut document["bufferViews"], json!({ "buffer": 1, "byteLength": 8 }));
    push(&mut document["bufferViews"], json!({ "buffer": 1, "byteOffset": 8, "byteLength": 24 }));
    let times = json!({ "bufferView": 1, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1] });
    push(&mut document["accessors"], times);
    push(&mut document["accessors"], json!({ "bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC3" }));
    document["animations"] = json!([{
        "channels": [{ "sampler": 0, "target": { "node": 1, "path": "translation" } }],
        "samplers": [{ "input": 1, "output": 2 }],
    }]);
    document.to_string()
}

#[test]
fn the_view_follows_a_camera_of_the_file_through_its_clip_until_it_is_moved() {
    let (_folder, mut harness) = uniform_of("moving-shot.gltf", moving_shot());
    let eye = |harness: &Harness<App>| harness.state().camera().eye();
    let set_time = |harness: &mut Harness<App>, time: f64| {
        harness.get_by_role_and_label(Role::Slider, "Time").scroll_to_me();
        settle(harness);
        harness.get_by_role_and_label(Role::Slider, "Time").set_value_accesskit(time);
        settle(harness);
    };
    give(&mut harness, "Camera: Close");
    harness.state_mut().choose_clip(Some(0));
    settle(&mut harness);
    assert!(eye(&harness).distance(glam::vec3(0.25, 0.25, 2.0)) < 1e-4, "{}", eye(&harness));
    for (time, z) in [(0.5, 3.0), (1.0, 4.0), (0.25, 2.5)] {
        set_time(&mut harness, time);
        assert!(eye(&harness).distance(glam::vec3(0.25, 0.25, z)) < 1e-4, "{time} s: {}", eye(&harness));
    }
    let command = copied(&mut harness);
    assert_draws(&harness, &command, "moving-shot-view");
    press(&mut harness, Key::Escape);
    // It plays, and the view goes along.
    harness.get_by_role_and_label(Role::Button, "Play or pause").click();
    harness.run_steps(6);
    let playing = eye(&harness);
    assert!(harness.state().is_playing() && playing.x == 0.25 && playing.z != 2.5, "{playing}");
    harness.get_by_role_and_label(Role::Button, "Play or pause").click();
    settle(&mut harness);
    // Whoever moves the camera keeps it.
    press(&mut harness, Key::ArrowLeft);
    let own = *harness.state().camera();
    set_time(&mut harness, 0.75);
    assert_eq!(*harness.state().camera(), own);
}

#[test]
fn a_mesh_without_cameras_has_no_such_commands() {
    let harness = window(Some(Source::Shape(Shape::Torus)));
    assert!(harness.state().availability().file_cameras.is_empty());
}
