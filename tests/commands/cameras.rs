//! `--file-camera`: views through the cameras of a glTF file.

use serde_json::{Value, json};

use crate::{Folder, SIMPLE_LIGHT, failure, output, sentence};
use documents::shot::SHOT;

#[test]
fn cameras_of_a_file_are_listed_and_looked_through_and_others_are_refused() {
    let folder = Folder::new();
    let shot = folder.write("shot.gltf", SHOT);
    let info: Value = serde_json::from_str(&output(&["info", &shot, "--json"])).expect("JSON");
    let named = |key: &str| info["cameras"].as_array().expect("a list").iter().map(|own| own[key].clone()).collect();
    let names: Vec<Value> = named("name");
    assert_eq!(names, [json!("Close"), json!("camera 1")]);
    let heights: Vec<Value> = named("height");
    assert_eq!(heights, [Value::Null, json!(3.0)]);
    assert_eq!(info["cameras"][1]["direction"], json!([0.0, 0.0, -1.0]));
    let text = output(&["info", &shot]);
    assert!(text.contains("camera        camera 1: orthographic, 3 high, at 0 0 3, towards 0 0 -1\n"), "{text}");
    let picture = |name: &str, options: &[&str]| {
        let out = folder.path(name);
        let usual = ["render", &shot, "-o", &out, "--size", "160x120", "--factor", "1"];
        output(&[&usual[..], &SIMPLE_LIGHT, options].concat());
        image::open(&out).expect("a picture").into_rgba8()
    };
    let by_name = picture("name.png", &["--file-camera", "Close"]);
    assert_eq!(by_name, picture("number.png", &["--file-camera", "0"]));
    assert_ne!(by_name, picture("other.png", &["--file-camera", "camera 1"]));
    // The same view in numbers. The bounding radius is half the diagonal of a unit square.
    let radii = (2.0 / 0.5_f32.sqrt()).to_string();
    let camera = format!("--camera=0,0,{radii}");
    let angle = 0.5_f32.to_degrees().to_string();
    let numbers = [&camera, "--target", "0.25,0.25,0", "--field-of-view", &angle, "--roll", "90"];
    let by_numbers = picture("numbers.png", &numbers);
    let differing = by_name.pixels().zip(by_numbers.pixels()).filter(|(a, b)| a != b).count();
    assert!(differing < 20, "{differing} px");
    // A warning about normals comes before.
    let said = failure(&["render", &shot, "-o", &folder.path("no.png"), "--file-camera", "Far"], 1);
    assert!(said.contains("pnaen: shot has no camera Far; choose one of Close, camera 1\n"), "{said}");
    sentence(&["render", "shape:torus", "-o", &folder.path("no.png"), "--file-camera", "0"], &["no cameras"]);
}
