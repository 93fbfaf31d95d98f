//! What is shown of a document: its scene, without hidden nodes, with instances, and with vertices of more than four joints.

use super::*;
use crate::{Import, LoadError, Source};
use geometry::mesh::Moment;
use geometry::tessellate::deform;

fn selected(draft: &Draft, scene: Option<&str>) -> LoadedMesh {
    let bytes = draft.document().to_string().into_bytes();
    let selected = Selection { scene, ..Selection::default() };
    read(bytes, &ModelFile { selected, ..ModelFile::from_test("draft", &Progress::new()) }).expect("triangles")
}

/// A document with several scenes, instances that are animated, a hidden node, and vertices that eight joints move.
pub(super) fn of_every_kind() -> Draft {
    let mut draft = triangle();
    let (times, at) = (draft.floats("SCALAR", &[0.0, 1.0]), draft.vectors(&[[0.0, 0.0, 1.0], [0.0, 2.0, 0.0]]));
    let turns = draft.floats("VEC4", &[0.0, 0.0, 0.0, 1.0, 0.6, 0.0, 0.0, 0.8]);
    let primitive = draft.root["meshes"][0]["primitives"][0].clone();
    let skinned = draft.push("meshes", json!({ "primitives": [primitive] }));
    for set in [0, 1] {
        let joints: Vec<u8> = (0..12).map(|i| i % 4 + 4 * set).collect();
        let joints = draft.accessor(&joints, 5121, "VEC4", 3);
        let weights = draft.floats("VEC4", &[[0.1, 0.2, 0.1, 0.1]; 3].concat());
        let attributes = &mut draft.root["meshes"][skinned]["primitives"][0]["attributes"];
        attributes[format!("JOINTS_{set}")] = json!(joints);
        attributes[format!("WEIGHTS_{set}")] = json!(weights);
    }
    let instances = json!({ "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": at, "ROTATION": turns } } });
    let hidden = json!({ "KHR_node_visibility": { "visible": false } });
    draft.root["nodes"] = [
        json!({ "mesh": 0, "extensions": instances, "children": [1] }),
        json!({ "mesh": 0, "extensions": hidden }),
        json!({ "mesh": skinned, "skin": 0, "rotation": [0.6, 0.0, 0.0, 0.8] }),
    ]
    .into_iter()
    .chain((0..8).map(|z| json!({ "translation": [0, 0, z] })))
    .collect();
    draft.root["skins"] = json!([{ "joints": (3..11).collect::<Vec<_>>() }]);
    draft.root["scenes"] =
        json!([{ "nodes": [0], "name": "one" }, { "nodes": (0..11).filter(|i| *i != 1).collect::<Vec<_>>() }]);
    draft.root["scene"] = json!(1);
    draft.root["animations"] = json!([{
        "samplers": [{ "input": times, "output": at }],
        "channels": [{ "sampler": 0, "target": { "node": 0, "path": "translation" } }],
    }]);
    draft
}

/// Three scenes of one triangle each, which lie 0, 1 and 2 above the plane. The second one is the default.
fn three() -> Draft {
    let mut draft = triangle();
    draft.root["nodes"] = (0..3).map(|z| json!({ "mesh": 0, "translation": [0, 0, z] })).collect();
    draft.root["scenes"] = json!([{ "nodes": [0], "name": "hall" }, { "nodes": [1] }, { "nodes": [2], "name": "0" }]);
    draft.root["scene"] = json!(1);
    draft
}

#[test]
fn a_scene_is_chosen_by_name_or_number() {
    let cases =
        [(None, 1), (Some("hall"), 0), (Some("scene 1"), 1), (Some("2"), 2), (Some("0"), 2), (Some("attic"), 1)];
    for (scene, expected) in cases {
        let loaded = selected(&three(), scene);
        assert_eq!((loaded.contents.scene, loaded.bounds().max.z), (Some(expected), expected as f32), "{scene:?}");
        assert_eq!(
            (&loaded.contents.scenes[..], loaded.warnings.len()),
            (&["hall", "scene 1", "0"].map(str::to_owned)[..], 0)
        );
    }
    let mut none = triangle();
    none.root.as_object_mut().unwrap().retain(|key, _| !key.starts_with("scene"));
    let loaded = selected(&none, Some("0"));
    assert_eq!((loaded.contents.scene, loaded.contents.scenes.len(), loaded.triangles.len()), (None, 0, 1));
}

#[test]
fn a_scene_that_is_not_there_is_an_error_with_the_names() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let path = folder.path().join("three.gltf");
    std::fs::write(&path, three().document().to_string()).expect("a writable temporary folder");
    let load = |source: Source, scene| {
        let selected = Selection { scene: Some(scene), ..Selection::default() };
        source.load_selected(selected, &Limits::default(), &Progress::new())
    };
    assert_eq!(load(Source::File(path.clone()), "hall").expect("a scene").contents.scene, Some(0));
    let error = load(Source::File(path), "3").expect_err("another scene");
    assert!(matches!(error, LoadError::Absent { what: "scene", .. }));
    let said = error.to_string();
    assert!(said.ends_with("three.gltf has no scene 3; choose one of hall, scene 1, 0"), "{said}");
    let said = load("shape:torus".parse().expect("a shape"), "0").expect_err("it has none").to_string();
    assert!(said.ends_with("has no scene 0; it has no scenes, so omit --scene"), "{said}");
}

#[test]
fn what_the_scene_does_not_use_is_not_read() {
    let mut draft = three();
    // The only user of these normals is the mesh of another scene.
    let normals = draft.vectors(&[[0.0, 1.0, 0.0]; 3]);
    let other = json!({ "primitives": [{ "attributes": { "POSITION": 0, "NORMAL": normals } }] });
    let other = draft.push("meshes", other);
    draft.root["nodes"][0]["mesh"] = json!(other);
    draft.root["accessors"][normals]["count"] = json!(2);
    assert_eq!(selected(&draft, None).warnings.len(), 0);
    let bytes = draft.document().to_string().into_bytes();
    let hall = Selection { scene: Some("hall"), ..Selection::default() };
    let hall =
        read(bytes, &ModelFile { selected: hall, ..ModelFile::from_test("draft", &Progress::new()) }).expect("a mesh");
    assert!(hall.warnings[0].contains("has 2 elements for 3 vertices"), "{:?}", hall.warnings);
}

#[test]
fn members_that_a_document_does_not_have_are_never_named() {
    for (name, value) in [("bufferViews", json!([])), ("bufferViews", json!(null)), ("buffers", json!([]))] {
        let mut draft = triangle();
        draft.root["accessors"] = json!([{ "componentType": 5126, "type": "VEC3", "count": 3 }]);
        draft.root["meshes"][0]["primitives"] = json!([{ "attributes": { "POSITION": 0 } }]);
        draft.root[name] = value;
        let mut document = draft.document();
        document.as_object_mut().unwrap().remove("buffers");
        // All three vertices are at the origin.
        let loaded = read_bytes(document.to_string().as_bytes()).expect("zeros");
        assert_eq!(positions(&loaded), [[0.0; 3]; 3], "{name}");
        document["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(1);
        let said = read_bytes(document.to_string().as_bytes()).unwrap_err().to_string();
        assert!(said.contains("attributes/POSITION is 1, but /accessors has 1") && !said.contains("sparse"), "{said}");
    }
}

#[test]
fn hidden_nodes_are_not_shown_and_still_move_others() {
    let mut draft = three();
    draft.root["scenes"][1] = json!({ "nodes": [1, 2] });
    draft.root["nodes"][2]["extensions"] = json!({ "KHR_node_visibility": { "visible": false } });
    let loaded = draft.read().expect("one triangle");
    assert_eq!((loaded.triangles.len(), loaded.bounds().max.z), (1, 1.0));
    assert_eq!(
        loaded.warnings,
        ["nodes that KHR_node_visibility hides, with meshes that aren't shown (--show-hidden shows them): 1."]
    );
    draft.root["nodes"][2]["extensions"]["KHR_node_visibility"]["visible"] = json!(true);
    assert_eq!(draft.read().expect("two triangles").triangles.len(), 2);
    draft.root["nodes"][2]["extensions"]["KHR_node_visibility"]["visible"] = json!(false);
    let selected = Selection { import: Import { show_hidden: true, ..Import::default() }, ..Selection::default() };
    let bytes = draft.document().to_string().into_bytes();
    let all = read(bytes, &ModelFile { selected, ..ModelFile::from_test("draft", &Progress::new()) });
    let all = all.expect("two triangles");
    assert_eq!((all.triangles.len(), all.warnings.len()), (2, 0), "{:?}", all.warnings);
    // A node that is shown, below one that is hidden.
    draft.root["nodes"][2]["children"] = json!([0]);
    draft.root["nodes"][2]["extensions"]["KHR_node_visibility"]["visible"] = json!(false);
    assert_eq!(draft.read().expect("one triangle").triangles.len(), 1);
    // A hidden joint still moves what is shown.
    let mut skinned = triangle();
    let joints = skinned.accessor(&[0; 12], 5121, "VEC4", 3);
    let weights = skinned.floats("VEC4", &[1.0, 0.0, 0.0, 0.0].repeat(3));
    let attributes = &mut skinned.root["meshes"][0]["primitives"][0]["attributes"];
    (attributes["JOINTS_0"], attributes["WEIGHTS_0"]) = (json!(joints), json!(weights));
    let hidden = json!({ "translation": [0, 0, 5], "extensions": { "KHR_node_visibility": { "visible": false } } });
    skinned.root["nodes"] = json!([{ "mesh": 0, "skin": 0 }, hidden]);
    skinned.root["scenes"] = json!([{ "nodes": [0, 1] }]);
    skinned.root["skins"] = json!([{ "joints": [1] }]);
    assert_eq!(skinned.read().expect("one triangle").bounds().min.z, 5.0);
}

#[test]
fn instances_are_transformed_within_their_node() {
    let mut draft = triangle();
    let at = draft.vectors(&[[1.0, 0.0, 0.0], [0.0, 0.0, 3.0]]);
    // A quarter turn about X, of length 2, and none.
    let turns = draft.floats("VEC4", &[2.0_f32.sqrt(), 0.0, 0.0, 2.0_f32.sqrt(), 0.0, 0.0, 0.0, 1.0]);
    let scales = draft.vectors(&[[1.0, 1.0, 1.0], [2.0, 2.0, -2.0]]);
    let attributes = json!({ "TRANSLATION": at, "ROTATION": turns, "SCALE": scales, "_ID": 99 });
    draft.root["nodes"][0] = json!({
        "mesh": 0, "translation": [0, 10, 0],
        "extensions": { "EXT_mesh_gpu_instancing": { "attributes": attributes } },
    });
    draft.root["extensionsRequired"] = json!(["EXT_mesh_gpu_instancing"]);
    let mesh = draft.read().expect("two triangles");
    let near = |a: [f32; 3], b: [f32; 3]| Vec3::from(a).distance(Vec3::from(b)) < 1e-5;
    let expected =
        [[1.0, 10.0, 0.0], [2.0, 10.0, 0.0], [1.0, 10.0, 1.0], [0.0, 10.0, 3.0], [0.0, 12.0, 3.0], [2.0, 10.0, 3.0]];
    let found = positions(&mesh);
    assert!(found.len() == 6 && found.iter().zip(expected).all(|(a, b)| near(*a, b)), "{found:?}");
    // The second one is mirrored, so that its triangle is wound the other way.
    assert!(mesh.corners.iter().any(|corner| corner.normal.distance(Vec3::NEG_Y) < 1e-5));
    assert_eq!(mesh.warnings.len(), 0, "{:?}", mesh.warnings);
}

#[test]
fn instances_of_an_animated_node_move_with_it() {
    let mut draft = triangle();
    let at = draft.vectors(&[[0.0, 0.0, 1.0], [0.0, 0.0, 2.0]]);
    let own = json!({ "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": at } } });
    draft.root["nodes"][0] = json!({ "mesh": 0, "extensions": own });
    let times = draft.floats("SCALAR", &[0.0, 1.0]);
    let values = draft.vectors(&[[0.0; 3], [0.0, 0.0, 10.0]]);
    draft.root["animations"] = json!([{
        "samplers": [{ "input": times, "output": values }],
        "channels": [{ "sampler": 0, "target": { "node": 0, "path": "translation" } }],
    }]);
    let loaded = draft.read().expect("two triangles");
    let rig = loaded.rig.as_ref().expect("an animation");
    let topology = Topology::build(&loaded.mesh, &Progress::new()).expect("small");
    let moved = deform(&loaded.mesh, &topology, &rig.pose(Moment { clip: 0, time: 1.0 })).0;
    assert_eq!(
        positions(&moved).iter().map(|position| position[2]).collect::<Vec<_>>(),
        [11.0, 11.0, 11.0, 12.0, 12.0, 12.0]
    );
}

#[test]
fn the_four_largest_weights_are_kept() {
    let mut draft = triangle();
    for (set, weights) in [[0.1, 0.3, 0.0, 0.1], [0.2, 0.2, 0.1, 0.0]].into_iter().enumerate() {
        let joints: Vec<u8> = (0..12).map(|i| i % 4 + 4 * set as u8).collect();
        let joints = draft.accessor(&joints, 5121, "VEC4", 3);
        let weights = draft.floats("VEC4", &weights.repeat(3));
        let attributes = &mut draft.root["meshes"][0]["primitives"][0]["attributes"];
        attributes[format!("JOINTS_{set}")] = json!(joints);
        attributes[format!("WEIGHTS_{set}")] = json!(weights);
    }
    // Joint i is moved by 2^i.
    let joints = (0..8).map(|i| json!({ "translation": [0, 0, 1 << i] }));
    draft.root["nodes"] = std::iter::once(json!({ "mesh": 0, "skin": 0 })).chain(joints).collect();
    draft.root["skins"] = json!([{ "joints": [1, 2, 3, 4, 5, 6, 7, 8] }]);
    let loaded = draft.read().expect("a triangle");
    // Joints 1, 4 and 5, and of those of weight 0.1 the first one; 0.2 of 1 is left out.
    let expected = (0.3 * 2.0 + 0.2 * 16.0 + 0.2 * 32.0 + 0.1 * 1.0) / 0.8;
    assert!((loaded.bounds().max.z - expected).abs() < 1e-5, "{}", loaded.bounds().max.z);
    let said = "vertices that more than four joints move, of which the four with the largest weights are kept: 3. At most 20.00 % of a vertex's weights are left out.";
    assert_eq!(loaded.warnings, [said]);
    // Four joints in two sets, and one of them twice.
    let four = draft.floats("VEC4", &[0.0, 0.5, 0.0, 0.0].repeat(3));
    let twice = draft.accessor(&[1; 12], 5121, "VEC4", 3);
    let attributes = &mut draft.root["meshes"][0]["primitives"][0]["attributes"];
    (attributes["WEIGHTS_0"], attributes["JOINTS_1"]) = (json!(four), json!(twice));
    let loaded = draft.read().expect("a triangle");
    assert_eq!((loaded.bounds().max.z, loaded.warnings.len()), (2.0, 0));
    attributes_without(&mut draft, "WEIGHTS_1");
    let said = draft.read().expect("a triangle").warnings;
    assert!(said[0].ends_with("has JOINTS_1 but no WEIGHTS_1; it is left out."), "{said:?}");
}

fn attributes_without(draft: &mut Draft, name: &str) {
    draft.root["meshes"][0]["primitives"][0]["attributes"].as_object_mut().expect("attributes").remove(name);
}

#[test]
fn a_vrm_file_is_a_glb_file() {
    let folder = tempfile::tempdir().expect("a writable temporary folder");
    let mut draft = triangle();
    draft.root["extensionsUsed"] = json!(["VRMC_vrm", "VRMC_materials_mtoon", "VRMC_springBone"]);
    draft.root["extensions"] = json!({ "VRMC_vrm": { "specVersion": "1.0", "humanoid": {} } });
    for name in ["someone.vrm", "someone.VRM"] {
        let path = folder.path().join(name);
        std::fs::write(&path, draft.glb()).expect("a writable temporary folder");
        let loaded = Source::File(path).load(&Limits::default(), &Progress::new()).expect("a triangle");
        assert_eq!((loaded.triangles.len(), loaded.warnings.len()), (1, 0), "{:?}", loaded.warnings);
    }
}

#[test]
fn the_draft_of_every_kind_is_read() {
    let loaded = of_every_kind().read().expect("three triangles");
    assert_eq!((loaded.triangles.len(), loaded.contents.scene), (3, Some(1)));
    assert!(loaded.rig.is_some());
    assert_eq!(loaded.warnings.len(), 2, "{:?}", loaded.warnings);
}
