//! Parts that are scaled to nothing at rest.

use super::*;

/// A square of two triangles on node 0, which is scaled to nothing at (1, 2, 3), and below a node that isn't moved. A clip scales it
/// to 4.
fn growing(normals: Option<[f32; 3]>) -> Draft {
    let mut draft = Draft::new();
    let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let (positions, indices) = (draft.vectors(&square), draft.indices(&[0, 1, 2, 0, 2, 3]));
    let mut attributes = json!({ "POSITION": positions });
    if let Some(normal) = normals {
        attributes["NORMAL"] = json!(draft.vectors(&[normal; 4]));
    }
    draft.primitive(json!({ "attributes": attributes, "indices": indices }));
    draft.root["nodes"] = json!([{ "mesh": 0, "translation": [1, 2, 3], "scale": [0, 0, 0] }, { "children": [0] }]);
    draft.root["scenes"][0]["nodes"] = json!([1]);
    draft.animate(0, "scale", "VEC3", &[0.0, 1.0], &[[0.0; 3], [4.0; 3]].concat());
    draft
}

/// Checks that a growing square is at (1, 2, 3) at rest, and whole and as large as its clip says later.
fn assert_grows(draft: &Draft, normal: Vec3) {
    let mesh = draft.read().expect("a document without a fault").mesh;
    let own = topology(&mesh);
    assert_eq!((own.patches.len(), own.degenerate, own.edge_counts().smooth), (2, 0, 1));
    let place = Vec3::new(1.0, 2.0, 3.0);
    assert!(positions(&mesh).into_iter().all(|at| Vec3::from(at) == place), "{:?}", positions(&mesh));
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    for time in [0.0, 0.5, 1.0] {
        let grown = posed(&mesh, time);
        for (at, [x, y]) in positions(&grown).into_iter().zip(square) {
            assert!(
                Vec3::from(at).distance(place + 4.0 * time as f32 * Vec3::new(x, y, 0.0)) < 1e-6,
                "{at:?} at {time} s"
            );
        }
        if time > 0.0 {
            assert!(grown.corners.iter().all(|corner| corner.normal.distance(normal) < 1e-6), "{:?}", grown.corners);
        }
    }
}

#[test]
fn a_part_that_is_scaled_to_nothing_at_rest_grows_in_its_clip() {
    assert_grows(&growing(None), Vec3::Z);
    let tilted = Vec3::new(0.0, 0.6, 0.8);
    assert_grows(&growing(Some(tilted.to_array())), tilted);
    // It hangs below the node that grows.
    let mut below = growing(None);
    below.root["nodes"] = json!([{ "translation": [1, 2, 3], "scale": [0, 0, 0], "children": [1] }, { "mesh": 0, "scale": [0.5, 0.5, 0.5] }]);
    below.root["scenes"][0]["nodes"] = json!([0]);
    below.root["animations"] = json!([]);
    below.animate(0, "scale", "VEC3", &[0.0, 1.0], &[[0.0; 3], [8.0; 3]].concat());
    assert_grows(&below, Vec3::Z);
    // A joint of its skin grows.
    let mut skinned = growing(None);
    let joints = skinned.accessor(&[0; 16], 5121, "VEC4", 4);
    let weights = skinned.floats("VEC4", &[[1.0, 0.0, 0.0, 0.0]; 4].concat());
    let attributes = &mut skinned.root["meshes"][0]["primitives"][0]["attributes"];
    (attributes["JOINTS_0"], attributes["WEIGHTS_0"]) = (json!(joints), json!(weights));
    skinned.root["skins"] = json!([{ "joints": [0] }]);
    skinned.root["nodes"] =
        json!([{ "translation": [1, 2, 3], "scale": [0, 0, 0] }, { "mesh": 0, "skin": 0, "children": [0] }]);
    assert_grows(&skinned, Vec3::Z);
}

#[test]
fn a_part_that_no_clip_grows_stays_where_it_is() {
    let mut still = growing(None);
    still.root["animations"] = json!([]);
    still.move_node(0);
    let mesh = still.read().expect("a document without a fault").mesh;
    assert_eq!(topology(&mesh).degenerate, 2);
}

#[test]
fn a_part_that_is_scaled_to_nothing_stays_so_without_its_animations() {
    let mut draft = growing(None);
    let short = draft.vectors(&[[0.0; 3]; 2]);
    // A second part, whose targets are broken, stands before it and beside it.
    draft.push("meshes", draft.root["meshes"][0].clone());
    draft.root["meshes"][1]["primitives"][0]["targets"] = json!([{ "POSITION": short }]);
    draft.animate(2, "weights", "SCALAR", &[0.0, 1.0], &[0.0, 1.0]);
    draft.push("nodes", json!({ "mesh": 1, "translation": [9, 0, 0] }));
    for roots in [[1, 2], [2, 1]] {
        draft.root["scenes"][0]["nodes"] = json!(roots);
        let mesh = draft.read().unwrap();
        let is_said = mesh.warnings.iter().any(|warning| warning.starts_with("animations are left out: "));
        assert!(is_said && mesh.mesh.rig.is_none(), "{:?}", mesh.warnings);
        let (there, beside): (Vec<_>, Vec<_>) = positions(&mesh.mesh).into_iter().partition(|[x, ..]| *x < 5.0);
        assert_eq!((there, beside.len()), (vec![[1.0, 2.0, 3.0]; 6], 6));
    }
}
