//! Tangents in poses: they follow joints, nodes and morph targets.

use super::*;

fn tangents(mesh: &Mesh) -> Vec<(Vec3, f32)> {
    let details = mesh.details.as_ref().expect("details");
    details.iter().map(|detail| (detail.tangent, detail.bitangent_sign)).collect()
}

#[test]
fn tangents_follow_their_joints() {
    let mesh = normal_mapped(skinned(), [1.0, 0.0, 0.0, -1.0]).read().unwrap();
    assert!(mesh.warnings.is_empty(), "{:?}", mesh.warnings);
    assert_eq!(tangents(&mesh), [(Vec3::X, -1.0); 3]);
    let bent = tangents(&posed(&mesh, 1.0));
    let half = Vec3::new(1.0, 0.0, -1.0).normalize();
    for ((tangent, sign), expected) in bent.into_iter().zip([Vec3::X, Vec3::NEG_Z, half]) {
        assert!(tangent.distance(expected) < 1e-6 && sign == -1.0, "{tangent} {sign}");
    }
}

#[test]
fn morph_targets_turn_tangents_along_with_normals() {
    let mut draft = normal_mapped(triangle(), [1.0, 0.0, 0.0, -1.0]);
    let still = draft.vectors(&[[0.0; 3]; 3]);
    // From +Z to +X.
    let turn = draft.vectors(&[[1.0, 0.0, -1.0]; 3]);
    draft.root["meshes"][0]["primitives"][0]["targets"] = json!([{ "POSITION": still, "NORMAL": turn }]);
    draft.animate(0, "weights", "SCALAR", &[0.0, 1.0], &[0.0, 1.0]);
    let assert_turned = |mesh: &Mesh, tangent: Vec3| {
        for (own, sign) in tangents(mesh) {
            assert!(own.distance(tangent) < 1e-6 && sign == -1.0, "{own} {sign}, not {tangent}");
        }
    };
    let mesh = draft.read().unwrap();
    assert_turned(&mesh, Vec3::X);
    assert_turned(&posed(&mesh, 0.0), Vec3::X);
    assert_turned(&posed(&mesh, 1.0), Vec3::NEG_Z);
    draft.root["meshes"][0]["weights"] = json!([1.0]);
    let mesh = draft.read().unwrap();
    assert_turned(&mesh, Vec3::NEG_Z);
    assert_turned(&posed(&mesh, 0.0), Vec3::X);
    assert_turned(&posed(&mesh, 1.0), Vec3::NEG_Z);
}

/// A triangle with a normal map and one animated morph target, which moves each point up by its x, so that the normals stay and
/// the tangents, along x at rest, should become (1, weight, 0).
fn sheared() -> Draft {
    let mut draft = normal_mapped(triangle(), [1.0, 0.0, 0.0, 1.0]);
    let moves = draft.vectors(&TRIANGLE.map(|[x, ..]| [0.0, x, 0.0]));
    draft.root["meshes"][0]["primitives"][0]["targets"] = json!([{ "POSITION": moves }]);
    draft.animate(0, "weights", "SCALAR", &[0.0, 1.0], &[0.0, 1.0]);
    draft
}

/// Gives a morph target displacements of tangents.
fn displace_tangents(draft: &mut Draft, target: usize, displacements: &[[f32; 3]]) {
    let list = draft.vectors(displacements);
    draft.root["meshes"][0]["primitives"][0]["targets"][target]["TANGENT"] = json!(list);
}

fn assert_tangents(mesh: &Mesh, expected: [Vec3; 3]) {
    let found = tangents(mesh);
    let are_near = found.iter().zip(expected).all(|((own, _), expected)| own.distance(expected.normalize()) < 1e-6);
    assert!(are_near && found.len() == 3, "{found:?}, not {expected:?}");
}

#[test]
fn morph_targets_displace_tangents_as_they_would_be_made() {
    // What MikkTSpace makes of the sheared triangle itself.
    let mut made = normal_mapped(triangle(), [0.0; 4]);
    let positions = made.vectors(&TRIANGLE.map(|[x, y, z]| [x, y + x, z]));
    let primitive = &mut made.root["meshes"][0]["primitives"][0];
    primitive["attributes"]["POSITION"] = json!(positions);
    primitive["attributes"].as_object_mut().expect("attributes").remove("TANGENT");
    let half = Vec3::new(1.0, 1.0, 0.0);
    assert_tangents(&made.read().unwrap(), [half; 3]);
    for node in [json!({ "mesh": 0 }), json!({ "mesh": 0, "scale": [3.0, 3.0, 3.0] })] {
        let mut draft = sheared();
        displace_tangents(&mut draft, 0, &[[0.0, 1.0, 0.0]; 3]);
        draft.root["nodes"][0] = node;
        for rest in [0.0, 1.0] {
            draft.root["meshes"][0]["weights"] = json!([rest]);
            let mesh = draft.read().unwrap();
            assert!(mesh.warnings.is_empty(), "{:?}", mesh.warnings);
            assert_tangents(&mesh, [Vec3::new(1.0, rest, 0.0); 3]);
            for time in [0.0, 0.5, 1.0] {
                assert_tangents(&posed(&mesh, time), [Vec3::new(1.0, time as f32, 0.0); 3]);
            }
        }
        draft.root.as_object_mut().expect("a document").remove("animations");
        assert_tangents(&draft.read().unwrap(), [half; 3]);
    }
}

/// Displacements are added before joints turn the sum, and the bitangent's sign stays.
#[test]
fn displaced_tangents_follow_their_joints() {
    let mut draft = normal_mapped(skinned(), [2.0, 0.0, 0.0, -1.0]);
    draft.root["meshes"][0]["primitives"][0]["targets"] = json!([{}]);
    displace_tangents(&mut draft, 0, &[[0.0, 2.0, 0.0]; 3]);
    let (clip, one) = (draft.root["animations"][0].clone(), draft.floats("SCALAR", &[0.0, 1.0]));
    draft.root["animations"] = json!([{
        "samplers": [clip["samplers"][0], { "input": one, "output": one }],
        "channels": [clip["channels"][0], { "sampler": 1, "target": { "node": 0, "path": "weights" } }],
    }]);
    let mesh = draft.read().unwrap();
    assert!(mesh.warnings.is_empty(), "{:?}", mesh.warnings);
    assert_tangents(&mesh, [Vec3::X; 3]);
    let bent = posed(&mesh, 1.0);
    // Half of a quarter turn, which is a mean of matrices, makes (1, 1, 0) this.
    let half_turned = Vec3::new(0.5, 1.0, -0.5);
    assert_tangents(&bent, [Vec3::new(1.0, 1.0, 0.0), Vec3::new(0.0, 1.0, -1.0), half_turned]);
    assert!(tangents(&bent).iter().all(|(_, sign)| *sign == -1.0));
}

/// Two primitives that differ in nothing but which of two targets displaces the tangent of vertex 1, as a sparse list says.
#[test]
fn each_target_displaces_its_own_tangents() {
    let mut draft = sheared();
    let (place, values) = (draft.view(&[1]), draft.view(bytemuck::bytes_of(&[0.0_f32, 2.0, 0.0])));
    let sparse = json!({ "TANGENT": draft.zeros_but_one(3, place, values) });
    let mut other = draft.root["meshes"][0]["primitives"][0].clone();
    other["targets"] = json!([{}, sparse]);
    draft.root["meshes"][0]["primitives"][0]["targets"] = json!([sparse, {}]);
    draft.primitive(other);
    draft.root["animations"] = json!([]);
    draft.animate(0, "weights", "SCALAR", &[0.0, 1.0], &[0.0, 0.0, 1.0, 0.0]);
    draft.animate(0, "weights", "SCALAR", &[0.0, 1.0], &[0.0, 0.0, 0.0, 1.0]);
    let mesh = draft.read().unwrap();
    assert!(mesh.warnings.is_empty(), "{:?}", mesh.warnings);
    let displaced = Vec3::new(1.0, 2.0, 0.0).normalize();
    for clip in 0..2 {
        let posed = deform(&mesh, &topology(&mesh), &rig(&mesh).pose(Moment { clip, time: 1.0 })).0;
        for (primitive, triangle) in mesh.triangles.iter().enumerate() {
            let found = triangle.map(|corner| tangents(&posed)[corner as usize].0);
            let expected = [Vec3::X, if primitive == clip { displaced } else { Vec3::X }, Vec3::X];
            let are_near = found.iter().zip(expected).all(|(own, expected)| own.distance(expected) < 1e-6);
            assert!(are_near, "clip {clip}, primitive {primitive}: {found:?}, not {expected:?}");
        }
    }
}

#[test]
fn displacements_of_tangents_that_are_broken_cost_a_warning() {
    let mut draft = sheared();
    displace_tangents(&mut draft, 0, &[[0.0, 1.0, 0.0]; 2]);
    let mesh = draft.read().unwrap();
    let [warning] = &mesh.warnings[..] else { panic!("{:?}", mesh.warnings) };
    assert!(warning.contains("TANGENT of a morph target of") && warning.ends_with("it is left out."), "{warning}");
    assert_tangents(&posed(&mesh, 1.0), [Vec3::X; 3]);
    // Numbers that aren't finite are 0, as those of positions and normals are.
    displace_tangents(&mut draft, 0, &[[f32::NAN, 1.0, 0.0], [f32::INFINITY; 3], [0.0, 1.0, f32::NEG_INFINITY]]);
    let mesh = draft.read().unwrap();
    let half = Vec3::new(1.0, 1.0, 0.0);
    assert_tangents(&posed(&mesh, 1.0), [half, Vec3::X, half]);
    // A pose whose numbers leave f32 is the pose at rest.
    displace_tangents(&mut draft, 0, &[[0.0, f32::MAX, 0.0]; 3]);
    assert_tangents(&posed(&draft.read().unwrap(), 1.0), [Vec3::X; 3]);
}

#[test]
fn tangents_of_nodes_turn_and_mirror_with_them() {
    let mut draft = normal_mapped(triangle(), [1.0, 0.0, 0.0, 1.0]);
    draft.root["nodes"][0] = json!({ "mesh": 0, "scale": [-2.0, 1.0, 1.0] });
    draft.animate(0, "scale", "VEC3", &[0.0, 1.0], &[-2.0, 1.0, 1.0, 3.0, 1.0, 1.0]);
    let mesh = draft.read().unwrap();
    assert_eq!(tangents(&mesh), [(Vec3::NEG_X, -1.0); 3]);
    assert_eq!(tangents(&posed(&mesh, 0.0)), [(Vec3::NEG_X, -1.0); 3]);
    assert_eq!(tangents(&posed(&mesh, 1.0)), [(Vec3::X, 1.0); 3], "no longer mirrored");
}
