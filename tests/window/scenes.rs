//! The choice of scenes.

use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use geometry::mesh::Shape;
use load::Source;
use pnaen::app::App;

use crate::{choose, press, uniform_of, window};
use documents::lamp::LAMP;

fn farthest(harness: &Harness<App>) -> f32 {
    harness.state().loaded().expect("a mesh").mesh.bounds().max.x
}

#[test]
fn a_scene_is_chosen_framed_and_kept() {
    let far = r#""nodes": [{ "mesh": 0 }, { "mesh": 0, "translation": [100, 0, 0] }]"#;
    let scenes = r#""scenes": [{ "nodes": [0], "name": "Near" }, { "nodes": [1], "name": "Far" }]"#;
    let text = LAMP.replace(r#""nodes": [{ "mesh": 0 }]"#, far).replace(r#""scenes": [{ "nodes": [0] }]"#, scenes);
    let (_folder, mut harness) = uniform_of("scenes.gltf", text);
    assert_eq!(farthest(&harness), 1.0);
    choose(&mut harness, "Scene", "Far");
    assert_eq!(farthest(&harness), 101.0);
    let target = harness.state().camera().target;
    assert!((target.x - 100.5).abs() < 1.0, "the camera looks at the other scene, not at {target}");
    // The scene stays when the file is loaded again.
    press(&mut harness, egui::Key::R);
    assert_eq!(farthest(&harness), 101.0);
    choose(&mut harness, "Scene", "Near");
    assert_eq!(farthest(&harness), 1.0);
}

#[test]
fn a_mesh_of_one_scene_has_no_choice() {
    let harness = window(Some(Source::Shape(Shape::Torus)));
    assert_eq!(harness.query_all_by_role_and_label(Role::ComboBox, "Scene").count(), 0);
}
