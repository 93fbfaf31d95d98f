//! `--variant`: the materials of a variant of a glTF file.

use serde_json::Value;

use crate::{Folder, output, sentence};
use documents::lamp::LAMP;

#[test]
fn a_variant_is_listed_chosen_and_exported_and_another_name_is_refused() {
    let folder = Folder::new();
    let lamp = folder.write("lamp.gltf", LAMP);
    let json: Value = serde_json::from_str(&output(&["info", &lamp, "--json"])).expect("JSON");
    assert_eq!(json["variants"], serde_json::json!(["Night"]));
    for (variant, material) in [(&[][..], "red"), (&["--variant", "Night"], "blue")] {
        let out = folder.path(&format!("{material}.glb"));
        output(&[&["tessellate", &lamp, "-o", &out, "--device", "cpu", "--factor", "1"], variant].concat());
        let json: Value = serde_json::from_str(&output(&["info", &out, "--json"])).expect("JSON");
        assert_eq!(json["materials"][0]["name"], material);
    }
    sentence(&["info", &lamp, "--variant", "Day"], &["lamp.gltf", "Day", "Night"]);
    sentence(&["info", "shape:torus", "--variant", "Day"], &["Day"]);
}
