//! Animations that are left out, and what is said about them.

use super::*;

#[test]
fn bad_animations_are_left_out_with_a_warning() {
    let changes: [(&str, Value, &str); 14] = [
        ("/samplers/0/input", json!(77), "channel 0 names accessor 77, but /accessors has 4"),
        ("/samplers/0/input", json!("no"), "it can't be read (invalid type: string \"no\", expected usize)"),
        ("/samplers/0/interpolation", json!("CUBIC"), "channel 0 has the unknown interpolation \"CUBIC\""),
        ("/samplers/0/interpolation", json!("CUBICSPLINE"), "channel 0 has 6 numbers for 2 key frames of 9"),
        ("/channels/0/sampler", json!(3), "channel 0 uses sampler 3, but the animation has 1"),
        ("/channels/0/target/node", json!(9), "channel 0 moves node 9, but /nodes has 1"),
        (
            "/channels/0/target/path",
            json!("rotation"),
            "channel 0 has values in /accessors/3, which has Vec3 elements, but 4 numbers an element are needed",
        ),
        (
            "/channels/0/target/path",
            json!("weights"),
            "channel 0 changes weights of morph targets of node 0, which has none",
        ),
        ("/accessors/2/count", json!(1), "channel 0 has 6 numbers for 1 key frames of 3"),
        ("/accessors/2/count", json!(4), "which needs 16 bytes of /bufferViews/2, which has 8"),
        ("/accessors/3/count", json!(1u64 << 60), "above the limit of 67108864 animated numbers"),
        ("/nodes/0/matrix", json!(glam::Mat4::IDENTITY.to_cols_array()), "moves node 0, whose transform is a matrix"),
        ("/times", json!([2.0, 2.0]), "channel 0 has times that are negative or don't increase"),
        ("/times", json!([-1.0, 2.0]), "channel 0 has times that are negative or don't increase"),
    ];
    for (pointer, value, expected) in changes {
        let mut draft = triangle();
        draft.move_node(0);
        if pointer == "/times" {
            let times: Vec<f32> = serde_json::from_value(value).unwrap();
            let input = draft.floats("SCALAR", &times);
            draft.root["animations"][0]["samplers"][0]["input"] = json!(input);
        } else {
            let is_own = pointer.starts_with("/samplers") || pointer.starts_with("/channels");
            let (parent, key) = pointer.rsplit_once('/').unwrap();
            let parent = if is_own { format!("/animations/0{parent}") } else { parent.to_owned() };
            draft.root.pointer_mut(&parent).unwrap()[key] = value;
        }
        let mesh = draft.read().unwrap();
        assert!(mesh.rig.is_none(), "{pointer}");
        let [warning] = &mesh.warnings[..] else { panic!("{pointer}: {:?}", mesh.warnings) };
        assert!(warning.starts_with("animation 0 is left out: "), "{warning}");
        assert!(warning.contains(expected), "{pointer}: {warning}");
    }
}

#[test]
fn of_many_faults_a_hundred_are_named_and_the_others_counted_before_the_repairs() {
    let mut draft = triangle();
    let normals = draft.vectors(&[[0.0, 0.0, 9.0], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]]);
    draft.root["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = json!(normals);
    (0..130).for_each(|_| draft.animate(0, "translation", "VEC3", &[0.0], &[0.0, f32::NAN, 0.0]));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("faults.gltf");
    std::fs::write(&path, draft.document().to_string()).unwrap();
    let warnings = crate::mesh_file::load(&path, &Limits::default(), &Progress::new()).unwrap().warnings;
    assert!(warnings[..100].iter().zip(0..).all(|(said, i)| said.starts_with(&format!("animation {i} is left out: "))));
    let rest = ["30 more such sentences are left out.", "normals whose length wasn't 1, scaled to it: 1."];
    assert_eq!(warnings[100..], rest);
}

#[test]
fn values_that_are_no_numbers_are_left_out() {
    let mut draft = triangle();
    draft.animate(0, "translation", "VEC3", &[0.0], &[0.0, f32::NAN, 0.0]);
    draft.root["animations"][0]["name"] = json!("Walk\n\u{1b}on");
    let expected = ["animation 0 \"Walk  on\" is left out: channel 0 has values that aren't finite."];
    assert_eq!(draft.read().unwrap().warnings, expected);
}

#[test]
fn animations_of_hidden_nodes_are_left_out() {
    let mut draft = triangle();
    draft.push("nodes", json!({ "name": "camera" }));
    draft.move_node(1);
    let mesh = draft.read().unwrap();
    assert_eq!(mesh.warnings, ["animation \"animation 0\" moves nothing that is shown; it is left out."]);
    assert!(mesh.rig.is_none());
    draft.move_node(0);
    let mesh = draft.read().unwrap();
    let names: Vec<_> = rig(&mesh).clips.iter().map(|clip| clip.name.as_str()).collect();
    assert_eq!(names, ["animation 1"], "it keeps its number");
}

#[test]
fn channels_of_extensions_are_passed_over() {
    let mut draft = triangle();
    draft.move_node(0);
    let channels = draft.root["animations"][0]["channels"].as_array_mut().unwrap();
    channels
        .push(json!({ "sampler": 0, "target": { "path": "pointer", "extensions": { "KHR_animation_pointer": {} } } }));
    channels.push(json!({ "sampler": 0, "target": { "node": 0, "path": "shine" } }));
    let mesh = draft.read().unwrap();
    let said = "animation 0 has 1 channels of KHR_animation_pointer, which aren't read; the others are played.";
    assert_eq!((rig(&mesh).clips[0].channels.len(), &mesh.warnings[..]), (1, &[said.to_owned()][..]));
}
