//! Skins: joints that move vertices, and the bones that they are.

use super::*;
use geometry::mesh::Pose;

#[test]
fn skins_follow_their_joints() {
    let mesh = skinned().read().unwrap();
    assert_rests(&mesh);
    assert_eq!(positions(&mesh), TRIANGLE);
    let bent = posed(&mesh, 1.0);
    // Vertex 2 is half at its own position, and half at this one turned around (1, 0, 0), which is (1, 1, 1).
    let expected = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, 1.0, 0.5]];
    for (own, expected) in positions(&bent).into_iter().zip(expected) {
        assert!(Vec3::from(own).distance(expected.into()) < 1e-6, "{own:?} {expected:?}");
    }
    let normals: Vec<Vec3> = bent.corners.iter().map(|corner| corner.normal).collect();
    assert!(normals[0].distance(Vec3::Z) < 1e-6 && normals[1].distance(Vec3::X) < 1e-6, "{normals:?}");
    assert!(normals[2].distance(Vec3::new(1.0, 0.0, 1.0).normalize()) < 1e-6, "{normals:?}");
    let clip = &rig(&mesh).clips[0];
    assert_eq!((clip.name.as_str(), clip.duration), ("animation 0", 1.0));
    assert_eq!(rig(&mesh).animated_counts(clip), AnimatedCounts { joints: 1, nodes: 0, targets: 0 });
}

/// The places of a mesh's bones, and the bones above them.
fn bones(mesh: &Mesh, pose: Option<&Pose>) -> Vec<([f32; 3], Option<u32>)> {
    mesh.bones_in(pose).iter().map(|bone| (bone.place.to_array(), bone.parent)).collect()
}

#[test]
fn bones_are_the_joints_of_skins_in_any_pose_and_without_clips() {
    let mut draft = skinned();
    draft.move_node(1);
    let mesh = draft.read().unwrap();
    let rest = [([0.0; 3], None), ([1.0, 0.0, 0.0], Some(0))];
    assert_eq!(bones(&mesh, None), rest);
    let pose = rig(&mesh).pose(Moment { clip: 1, time: 1.0 });
    let moved = [([0.0, 0.0, 4.0], None), ([1.0, 0.0, 4.0], Some(0))];
    assert_eq!(bones(&mesh, Some(&pose)), moved);
    // A deformed mesh has no rig, and its bones are where it is.
    assert_eq!(bones(&deform(&mesh, &topology(&mesh), &pose).0, None), moved);
    draft.root.as_object_mut().expect("a document").remove("animations");
    let still = draft.read().unwrap();
    assert!(still.rig.is_none());
    assert_eq!(bones(&still, None), rest);
    // A node between two joints is none itself.
    let nodes = draft.root["nodes"].as_array_mut().expect("nodes");
    nodes[1] = json!({ "children": [3] });
    nodes.push(json!({ "translation": [0, 0, 5], "children": [2] }));
    assert_eq!(bones(&draft.read().unwrap(), None), [([0.0; 3], None), ([1.0, 0.0, 5.0], Some(0))]);
    let (long, mut named) = ("Hip\n".repeat(100), skinned());
    named.root["nodes"][1]["name"] = json!(long);
    let names: Vec<_> = named.read().unwrap().bones.iter().map(|bone| bone.name.to_string()).collect();
    assert_eq!(names, [geometry::names::shown(&long), "node 2".to_owned()]);
    let mut moving = triangle();
    moving.move_node(0);
    assert_eq!(bones(&moving.read().unwrap(), None), [], "a node that a clip moves is no joint");
}

#[test]
fn skins_with_joints_that_are_missing_or_above_themselves_are_refused() {
    let mut missing = skinned();
    missing.root["skins"][0]["joints"] = json!([1, 9]);
    assert!(message(&missing).contains("/skins/0/joints/1"), "{}", message(&missing));
    let mut circle = skinned();
    circle.root["nodes"][2]["children"] = json!([1]);
    assert!(message(&circle).contains("its own ancestor"), "{}", message(&circle));
}

#[test]
fn nodes_that_share_a_mesh_are_each_posed_by_their_own_skin() {
    let mut draft = skinned();
    let other = draft.floats("MAT4", &[glam::Mat4::IDENTITY.to_cols_array(); 2].concat());
    let skins = draft.root["skins"].as_array_mut().expect("skins");
    skins.push(json!({ "joints": [4, 4], "inverseBindMatrices": other }));
    let nodes = draft.root["nodes"].as_array_mut().expect("nodes");
    nodes.extend([json!({ "mesh": 0, "skin": 1 }), json!({ "translation": [0, 0, 7] })]);
    draft.root["scenes"][0]["nodes"] = json!([0, 1, 3, 4]);
    let mesh = draft.read().expect("a document without a fault").mesh;
    let own = positions(&mesh);
    let expected: Vec<_> = TRIANGLE.into_iter().chain(TRIANGLE.map(|[x, y, z]| [x, y, z + 7.0])).collect();
    assert_eq!(own, expected);
    // Only the first one's joint turns.
    assert_eq!(positions(&posed(&mesh, 1.0))[3..], expected[3..]);
}

#[test]
fn computed_normals_turn_too() {
    let mut draft = skinned();
    draft.root["meshes"][0]["primitives"][0]["attributes"].as_object_mut().unwrap().remove("NORMAL");
    draft.root["nodes"][1]["rotation"] = json!([0.5, 0.5, 0.5, 0.5]);
    draft.root["nodes"][1]["scale"] = json!([1.0, -2.0, 3.0]);
    let mesh = draft.read().unwrap();
    assert!(mesh.repairs.normals_made == 3);
    assert_rests(&mesh);
}
