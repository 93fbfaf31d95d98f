//! Morph targets: their weights, and what they do to the mesh at rest.

use super::*;
use crate::selection::{MorphWeights, ShownParts};

#[test]
fn morph_targets_follow_their_weights() {
    let mut draft = triangle();
    let (move_up, turn) = (draft.vectors(&[[0.0, 0.0, 2.0]; 3]), draft.vectors(&[[3.0, 0.0, 0.0]; 3]));
    draft.root["meshes"][0]["primitives"][0]["targets"] = json!([{ "POSITION": move_up }, { "NORMAL": turn }]);
    draft.root["meshes"][0]["weights"] = json!([0.5, 0.0]);
    draft.root["nodes"][0]["scale"] = json!([1.0, 1.0, 2.0]);
    draft.animate(0, "weights", "SCALAR", &[0.0, 1.0], &[0.0, 0.0, 1.0, 1.0]);
    let mesh = draft.read().unwrap();
    assert_rests(&mesh);
    assert!(positions(&mesh).iter().all(|[_, _, z]| *z == 2.0), "half of the target, and the node");
    let bent = posed(&mesh, 1.0);
    assert!(positions(&bent).iter().all(|[_, _, z]| *z == 4.0));
    // (3, 0, 1) transformed by the inverse of the scale.
    let expected = Vec3::new(3.0, 0.0, 0.5).normalize();
    assert!(bent.corners.iter().all(|corner| corner.normal.distance(expected) < 1e-6));
    assert_eq!(rig(&mesh).animated_counts(&rig(&mesh).clips[0]), AnimatedCounts { joints: 0, nodes: 0, targets: 2 });
}

#[test]
fn chosen_weights_take_the_place_of_those_at_rest() {
    let mut draft = triangle();
    let (move_up, turn) = (draft.vectors(&[[0.0, 0.0, 2.0]; 3]), draft.vectors(&[[3.0, 0.0, 0.0]; 3]));
    let primitive = &mut draft.root["meshes"][0]["primitives"][0];
    primitive["targets"] = json!([{ "POSITION": move_up }, { "NORMAL": turn }]);
    primitive["extras"] = json!({ "targetNames": ["Up"] });
    draft.root["meshes"][0]["weights"] = json!([0.5]);
    let chosen = MorphWeights::from([("Up".to_owned(), 0.25)]);
    fn read_as(draft: &Draft, morphs: &MorphWeights) -> LoadedMesh {
        let (bytes, progress) = (draft.document().to_string().into_bytes(), Progress::new());
        let shown = ShownParts { morphs: morphs.clone(), ..ShownParts::default() };
        let selected = Selection { parts: Some(&shown), ..Selection::default() };
        read(bytes, &ModelFile { selected, ..ModelFile::from_test("draft", &progress) }).expect("no fault")
    }
    let all_at = |mesh: &Mesh, height: f32| positions(mesh).iter().all(|[_, _, z]| *z == height);
    let (own, still) = (read_as(&draft, &MorphWeights::new()), read_as(&draft, &chosen));
    assert!(all_at(&own, 1.0) && all_at(&still, 0.5) && still.rig.is_none());
    let listed = MorphWeights::from([("Up".to_owned(), 0.5), ("mesh 0 target 1".to_owned(), 0.0)]);
    assert_eq!((&own.contents.morph_targets, &still.contents.morph_targets), (&listed, &listed));
    draft.animate(0, "weights", "SCALAR", &[0.0, 1.0], &[0.0, 0.0, 1.0, 1.0]);
    let moving = read_as(&draft, &chosen);
    assert_rests(&moving);
    assert!(all_at(&moving, 0.5));
    assert!(all_at(&posed(&moving, 1.0), 2.0), "the clip moves the target");
    // A node's own weights come before those of its mesh, which are two nodes' then.
    draft.root["nodes"] = json!([{ "mesh": 0, "weights": [1.0, 0.0] }, { "mesh": 0 }]);
    draft.root["scenes"] = json!([{ "nodes": [0, 1] }]);
    draft.root["meshes"][0]["weights"] = json!([2.0]);
    let heights: Vec<f32> = positions(&read_as(&draft, &MorphWeights::new())).iter().map(|[_, _, z]| *z).collect();
    assert_eq!(heights, [2.0, 2.0, 2.0, 4.0, 4.0, 4.0]);
    let node_first = read_as(&draft, &chosen);
    assert_eq!(node_first.contents.morph_targets["Up"], 1.0);
    assert!(all_at(&node_first, 0.5), "both nodes");
}

#[test]
fn morph_targets_that_part_an_edge_part_its_points() {
    let mut draft = touching();
    let second = draft.root["meshes"][1]["primitives"][0].clone();
    draft.primitive(second);
    draft.root["scenes"] = json!([{ "nodes": [0] }]);
    let (still, apart) = (draft.vectors(&[[0.0; 3]; 3]), draft.vectors(&[[0.0, 0.0, 1.0], [0.0; 3], [0.0; 3]]));
    draft.animate(0, "weights", "SCALAR", &[0.0, 1.0], &[0.0, 1.0]);
    for (target, points) in [(still, 4), (apart, 5)] {
        draft.root["meshes"][0]["primitives"][0]["targets"] = json!([{ "POSITION": still }]);
        draft.root["meshes"][0]["primitives"][1]["targets"] = json!([{ "POSITION": target }]);
        assert_eq!(topology(&draft.read().unwrap()).points.len(), points);
    }
}

#[test]
fn bad_morph_targets_leave_the_mesh_at_rest() {
    let mut draft = triangle();
    let short = draft.vectors(&[[0.0; 3]; 2]);
    draft.root["meshes"][0]["primitives"][0]["targets"] = json!([{ "POSITION": short }]);
    draft.animate(0, "weights", "SCALAR", &[0.0, 1.0], &[0.0, 1.0]);
    let mesh = draft.read().unwrap();
    let [warning] = &mesh.warnings[..] else { panic!("{:?}", mesh.warnings) };
    assert!(warning.starts_with("animations are left out: /accessors/2 (POSITION of a morph target of"), "{warning}");
    assert!(mesh.rig.is_none());
}

#[test]
fn targets_without_end_take_no_memory() {
    let mut draft = triangle();
    // Many targets with one long list of zeros, which takes no bytes in the file except for one value.
    let (places, values) = (draft.view(&[0]), draft.view(&[0; 12]));
    let zeros = draft.zeros_but_one(1 << 18, places, values);
    let targets: Vec<Value> = (0..1025).map(|_| json!({ "POSITION": zeros })).collect();
    draft.root["meshes"][0]["primitives"][0] = json!({ "attributes": { "POSITION": zeros }, "targets": targets });
    let indices = draft.indices(&[0, 1, 2]);
    draft.root["meshes"][0]["primitives"][0]["indices"] = json!(indices);
    draft.animate(0, "weights", "SCALAR", &[0.0], &[0.0; 1025]);
    let mesh = draft.read().unwrap();
    assert!(mesh.rig.is_none());
    assert!(
        mesh.warnings.iter().any(|warning| warning.contains("morph targets have more than")),
        "{:?}",
        mesh.warnings
    );
}
