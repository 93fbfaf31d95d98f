//! Tangents, of the file and computed.

use super::*;

#[test]
fn tangents_of_the_file_are_used() {
    let normal = json!({ "normalTexture": { "index": 0 } });
    let mut draft = square(normal.clone());
    let tangents = draft.floats("VEC4", &[[0.0, 2.0, 0.0, -1.0]; 4].concat());
    attribute(&mut draft, "TANGENT", tangents);
    let all = |draft: &Draft| {
        let mesh = draft.read().unwrap();
        assert!(mesh.warnings.is_empty(), "{:?}", mesh.warnings);
        details(&mesh).iter().map(|detail| (detail.tangent, detail.bitangent_sign)).collect::<Vec<_>>()
    };
    assert_eq!(all(&draft), [(Vec3::Y, -1.0); 4]);
    // A quarter turn about z, and a mirror: the bitangent is a cross product, which a mirror turns around.
    draft.root["nodes"][0]["rotation"] =
        json!([0.0, 0.0, std::f32::consts::FRAC_1_SQRT_2, std::f32::consts::FRAC_1_SQRT_2]);
    let turned = all(&draft);
    assert!(turned.iter().all(|(tangent, sign)| tangent.distance(Vec3::NEG_X) < 1e-6 && *sign == -1.0), "{turned:?}");
    draft.root["nodes"][0] = json!({ "mesh": 0, "scale": [1, -3, 1] });
    assert_eq!(all(&draft), [(Vec3::NEG_Y, 1.0); 4]);
    // Without normals in the file, its tangents don't fit the normals that are made.
    let mut without = square(normal);
    let tangents = without.floats("VEC4", &[[0.0, 2.0, 0.0, -1.0]; 4].concat());
    attribute(&mut without, "TANGENT", tangents);
    without.root["meshes"][0]["primitives"][0]["attributes"].as_object_mut().unwrap().remove("NORMAL");
    let mesh = without.read().unwrap();
    assert!(details(&mesh).iter().all(|detail| detail.tangent.distance(Vec3::X) < 1e-6));
}

/// In the square u grows along x, and v along -y: the image stands upright, and the bitangent points up.
#[test]
fn tangents_are_computed_as_files_have_them() {
    let normal = json!({ "normalTexture": { "index": 0 } });
    let mesh = square(normal.clone()).read().unwrap();
    assert!(mesh.warnings.is_empty(), "{:?}", mesh.warnings);
    for detail in details(&mesh) {
        assert!(detail.tangent.distance(Vec3::X) < 1e-6 && detail.bitangent_sign == 1.0, "{detail:?}");
    }
    // Mirrored: u grows along -x, and the image is seen from behind.
    let mut mirrored = square(normal.clone());
    mirrored.root["nodes"][0]["scale"] = json!([-1, 1, 1]);
    for detail in details(&mirrored.read().unwrap()) {
        assert!(detail.tangent.distance(Vec3::NEG_X) < 1e-6 && detail.bitangent_sign == -1.0, "{detail:?}");
    }
    // On the normal map's own coordinates: turned by a quarter in the image, u grows along y.
    let quarter = json!({ "KHR_texture_transform": { "rotation": std::f32::consts::FRAC_PI_2 } });
    let turned = json!({ "normalTexture": { "index": 0, "extensions": quarter } });
    for detail in details(&square(turned).read().unwrap()) {
        assert!(detail.tangent.distance(Vec3::NEG_Y) < 1e-6 && detail.bitangent_sign == 1.0, "{detail:?}");
    }
}

/// A roof whose image is mirrored at the ridge: the corners there have two tangents, and become two each.
#[test]
fn corners_with_two_tangents_are_split_but_do_not_tear() {
    let roof = [[-1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 1.0], [-1.0, 1.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]];
    let mut draft = square(json!({ "normalTexture": { "index": 0 } }));
    let (at, normals) = (draft.vectors(&roof), draft.vectors(&[[0.0, 0.0, 1.0]; 6]));
    let uvs = draft.floats("VEC2", &[0.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
    let indices = draft.indices(&[0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2]);
    let attributes = json!({ "POSITION": at, "NORMAL": normals, "TEXCOORD_0": uvs });
    draft.root["meshes"][0]["primitives"] = json!([{ "attributes": attributes, "indices": indices, "material": 0 }]);
    let mesh = draft.read().unwrap();
    assert_eq!((mesh.corners.len(), details(&mesh).len()), (8, 8));
    for (triangle, left) in mesh.triangles.iter().zip([true, true, false, false]) {
        for detail in triangle.map(|corner| details(&mesh)[corner as usize]) {
            let (tangent, sign) = (detail.tangent, detail.bitangent_sign);
            assert_eq!((tangent.x > 0.0, sign), (left, if left { 1.0 } else { -1.0 }), "{detail:?}");
        }
    }
    let topology = Topology::new(&mesh);
    assert_eq!((topology.points.len(), topology.edge_counts().boundary), (6, 6));
    assert_eq!((topology.edge_counts().smooth, topology.edge_counts().split), (3, 0));
}
