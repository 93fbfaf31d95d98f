//! `--scene`: a scene of a glTF file.

use serde_json::Value;

use crate::{Folder, output, sentence};
use documents::lamp::LAMP;

#[test]
fn a_scene_is_listed_and_chosen_and_another_name_is_refused() {
    let folder = Folder::new();
    let lamp = folder.path("lamp.gltf");
    let scenes = r#""scenes": [{ "nodes": [0], "name": "Hall" }, { "nodes": [] , "name": "Empty" }]"#;
    std::fs::write(&lamp, LAMP.replace(r#""scenes": [{ "nodes": [0] }]"#, scenes)).expect("a writable folder");
    let json: Value = serde_json::from_str(&output(&["info", &lamp, "--json"])).expect("JSON");
    assert_eq!((&json["scenes"], &json["scene"]), (&serde_json::json!(["Hall", "Empty"]), &serde_json::json!(0)));
    let text = output(&["info", &lamp, "--scene", "0"]);
    assert!(text.contains("scene         Hall, which is shown\nscene         Empty\n"), "{text}");
    sentence(&["info", &lamp, "--scene", "Empty"], &["lamp.gltf", "has no triangles to show"]);
    sentence(&["info", &lamp, "--scene", "2"], &["lamp.gltf", "has no scene 2", "Hall, Empty"]);
    sentence(&["info", "shape:torus", "--scene", "0"], &["has no scenes"]);
}
