//! Documents that are refused, and the sentences that say why.

use proptest::prelude::*;

use super::*;

#[test]
fn a_truncated_glb_is_refused_wherever_it_ends() {
    let glb = triangle().glb();
    for length in 0..glb.len() {
        let problem = read_bytes(&glb[..length]).unwrap_err();
        assert!(matches!(problem, Problem::NotGltf { .. }), "{length}: {problem}");
    }
    let mut lying = glb.clone();
    lying[8] = 3;
    lying[9..12].fill(0);
    assert!(read_bytes(&lying).is_err());
}

#[test]
fn short_data_is_refused_with_both_numbers() {
    let mut draft = triangle();
    draft.root["accessors"][0]["count"] = json!(4);
    draft.root["accessors"][1]["count"] = json!(4);
    let expected = "accessor 0 (POSITION of mesh 0 \"thing\", primitive 0) needs 48 bytes of buffer view 0, which has 36; \
                    export the model again";
    assert_eq!(message(&draft), expected);
    draft.root["accessors"][0]["count"] = json!(u64::MAX);
    draft.root["accessors"][1]["count"] = json!(u64::MAX);
    assert!(message(&draft).contains("needs more than any memory bytes"));
    let mut draft = triangle();
    draft.root["bufferViews"][1]["byteOffset"] = json!(u64::MAX);
    assert!(message(&draft).contains("uses buffer view 1, which takes 36 bytes"));
}

#[test]
fn bad_references_are_refused() {
    let changes: [(&str, Value, &str); 8] = [
        ("/meshes/0/primitives/0/attributes/POSITION", json!(77), "names accessor 77 as its POSITION"),
        ("/meshes/0/primitives/0/attributes/NORMAL", json!(77), "Index out of bounds"),
        ("/accessors/1/count", json!(2), "has 2 elements for 3 vertices"),
        ("/accessors/0/type", json!("VEC2"), "has Vec2 elements where 3 numbers are needed"),
        ("/accessors/0/componentType", json!(1), "Invalid value"),
        ("/nodes/0/mesh", json!(5), "Index out of bounds"),
        ("/bufferViews/0/byteStride", json!(4), "has elements of 12 bytes, 4 bytes apart"),
        ("/asset/version", json!("1.0"), "its asset.version is 1.0"),
    ];
    for (pointer, value, expected) in changes {
        let mut draft = triangle();
        draft.root["bufferViews"][0]["byteStride"] = json!(12);
        *draft.root.pointer_mut(pointer).unwrap() = value;
        let message = message(&draft);
        assert!(message.contains(expected), "{pointer}: {message}");
    }
}

#[test]
fn indices_must_name_vertices() {
    let mut draft = triangle();
    let indices = draft.indices(&[0, 1, 3]);
    draft.root["meshes"][0]["primitives"][0]["indices"] = json!(indices);
    let expected = "mesh 0 \"thing\", primitive 0 uses vertex 3 of 3, at index 2; export the model again";
    assert_eq!(message(&draft), expected);
    draft.root["meshes"][0]["primitives"][0]["indices"] = json!(0);
    assert!(message(&draft).contains("where unsigned integers are needed"));
}

#[test]
fn positions_must_be_finite_and_leave_room_for_sums() {
    for (y, fault) in [
        (f32::INFINITY, "a position that isn't finite"),
        (f32::NAN, "a position that isn't finite"),
        (-1.1e37, "a coordinate beyond 1e37"),
    ] {
        let mut draft = Draft::new();
        let at = draft.vectors(&[[0.0; 3], [1.0, y, 0.0], [0.0; 3]]);
        draft.primitive(json!({ "attributes": { "POSITION": at } }));
        assert!(message(&draft).contains(&format!("primitive 0 has {fault}, at vertex 1")));
    }
}

#[test]
fn unknown_extensions_are_refused_by_name() {
    let mut draft = triangle();
    draft.root["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]);
    assert!(message(&draft).contains("requires the extension KHR_draco_mesh_compression"));
}

#[test]
fn what_is_no_gltf_is_said_to_be_none() {
    for bytes in [&b""[..], b"glTF", b"{", b"[]", b"{}", b"solid cube", b"{\"asset\":{\"version\":2}}"] {
        let problem = read_bytes(bytes).unwrap_err();
        assert!(matches!(problem, Problem::NotGltf { .. }), "{problem}");
    }
}

#[test]
fn scenes_without_triangles_say_what_they_hold() {
    let mut draft = triangle();
    draft.root["meshes"][0]["primitives"][0]["mode"] = json!(1);
    assert!(message(&draft).contains("0 primitives of points and 1 of lines"));
    draft.root["nodes"][0].as_object_mut().unwrap().remove("mesh");
    assert!(message(&draft).contains("no node of its scene has a mesh"));
}

/// A triangle with a skin, a morph target, a strip of indices and sparse values: something of everything.
fn rich() -> Draft {
    let mut draft = triangle();
    let (places, indices) = (draft.view(&[2]), draft.indices(&[0, 1, 2]));
    let joints = draft.accessor(&[0; 12], 5121, "VEC4", 3);
    let weights = draft.floats("VEC4", &[0.25; 12]);
    let binds = draft.floats("MAT4", &glam::Mat4::IDENTITY.to_cols_array());
    let primitive = &mut draft.root["meshes"][0]["primitives"][0];
    primitive["attributes"]["JOINTS_0"] = json!(joints);
    primitive["attributes"]["WEIGHTS_0"] = json!(weights);
    primitive["indices"] = json!(indices);
    primitive["mode"] = json!(5);
    primitive["targets"] = json!([{ "POSITION": 0, "NORMAL": 1 }]);
    draft.root["accessors"][0]["sparse"] = json!({
        "count": 1,
        "indices": { "bufferView": places, "componentType": 5121 },
        "values": { "bufferView": 1 },
    });
    draft.root["meshes"][0]["weights"] = json!([0.5]);
    draft.root["nodes"] = json!([{ "mesh": 0, "skin": 0 }, {}]);
    draft.root["skins"] = json!([{ "joints": [1], "inverseBindMatrices": binds }]);
    draft
}

#[test]
fn the_rich_draft_is_read() {
    assert_eq!(rich().read().unwrap().triangles.len(), 1);
}

proptest! {
    /// Digits of the document and bytes of the buffer changed at random: a mesh or a problem, never a panic.
    #[test]
    fn changed_bytes_never_panic(changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6)) {
        let mut glb = rich().glb();
        let digits: Vec<usize> = (0..glb.len()).filter(|&i| glb[i].is_ascii_digit()).collect();
        for (place, byte) in changes {
            match byte % 4 {
                0 => *place.get_mut(&mut glb) = byte,
                _ => glb[*place.get(&digits)] = b'0' + byte % 10,
            }
        }
        let _ = read_bytes(&glb);
    }
}
