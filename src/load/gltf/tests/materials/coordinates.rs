//! Texture coordinates and sampling of maps, and the colours of vertices.

use super::*;
use geometry::mesh::Sampling;

#[test]
fn maps_know_their_coordinates_and_sampling() {
    let moved = json!({ "KHR_texture_transform": { "offset": [0.5, 0], "scale": [2, 3], "texCoord": 1 } });
    let read = material(json!({
        "pbrMetallicRoughness": {
            "baseColorTexture": { "index": 0 }, "metallicRoughnessTexture": { "index": 1 },
        },
        "occlusionTexture": { "index": 0, "texCoord": 1 },
        "emissiveTexture": { "index": 0, "extensions": moved },
        "emissiveFactor": [1, 1, 1],
    }));
    let map = |slot: Slot| read.look.maps[slot as usize].as_ref();
    let rough = map(Slot::MetallicRoughness).expect("a map");
    assert_eq!(rough.uv, MapUv::Own);
    let expected = Sampling {
        wrap: [Wrap::Clamp, Wrap::Mirror],
        magnify_linear: false,
        minify_linear: true,
        mip_linear: Some(false),
    };
    assert_eq!((rough.sampling, read.sampling), (expected, Sampling::default()));
    assert_eq!(map(Slot::Occlusion).expect("a map").uv, MapUv::Set(1, [1.0, 0.0, 0.0, 0.0, 1.0, 0.0]));
    assert_eq!(map(Slot::Emissive).expect("a map").uv, MapUv::Set(1, [2.0, 0.0, 0.5, 0.0, 3.0, 0.0]));
    assert!(map(Slot::Normal).is_none());
    let image = read.texture.as_ref().expect("a texture");
    assert!(std::sync::Arc::ptr_eq(image, &rough.texture), "one image is read once");
}

#[test]
fn corners_have_the_sets_that_maps_use() {
    let second = json!({ "emissiveFactor": [1, 1, 1], "emissiveTexture": { "index": 0, "texCoord": 1 } });
    let mesh = square(second).read().unwrap();
    for (corner, detail) in mesh.corners.iter().zip(details(&mesh)) {
        assert_eq!(detail.uvs, [Vec2::ZERO, QUARTER.into()], "only what is used");
        assert_eq!(corner.uv, Vec2::new(corner.position.x, 1.0 - corner.position.y));
        assert_eq!((detail.color, detail.tangent), (Vec4::ONE, Vec3::ZERO));
    }
    // A transform of the base colour alone: maps beside it have the coordinates of the file.
    let moved = json!({ "index": 0, "extensions": { "KHR_texture_transform": { "offset": [8, 8] } } });
    let apart = json!({ "pbrMetallicRoughness": { "baseColorTexture": moved }, "occlusionTexture": { "index": 0 } });
    let mesh = square(apart).read().unwrap();
    for (corner, detail) in mesh.corners.iter().zip(details(&mesh)) {
        assert_eq!(corner.uv, detail.uvs[0] + Vec2::splat(8.0));
    }
    let plain = json!({ "pbrMetallicRoughness": { "metallicRoughnessTexture": { "index": 0 } } });
    assert!(square(plain).read().unwrap().details.is_none());
}

#[test]
fn a_set_beyond_the_second_is_replaced_and_told() {
    let mut draft = square(json!({ "name": "m", "occlusionTexture": { "index": 0, "texCoord": 5 } }));
    let mesh = draft.read().unwrap();
    assert!(matches!(mesh.materials[0].look.maps[Slot::Occlusion as usize].as_ref().unwrap().uv, MapUv::Set(0, _)));
    assert!(mesh.warnings[0].contains("occlusion map of material \"m\" has TEXCOORD_5"), "{:?}", mesh.warnings);
    draft.root["materials"][0] = json!({ "occlusionTexture": { "index": 0, "texCoord": 1 } });
    draft.root["meshes"][0]["primitives"][0]["attributes"].as_object_mut().unwrap().remove("TEXCOORD_1");
    let mesh = draft.read().unwrap();
    assert!(mesh.warnings[0].contains("primitives without the texture coordinates of a map"), "{:?}", mesh.warnings);
}

#[test]
fn colours_of_all_types_multiply() {
    let expected = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 1.0]];
    for (component, width) in [(5121, 3), (5121, 4), (5123, 3), (5123, 4), (5126, 3), (5126, 4)] {
        let mut bytes = Vec::new();
        for [r, g, b] in expected {
            for value in &[r, g, b, 0.0][..width] {
                match component {
                    5121 => bytes.push((value * 255.0) as u8),
                    5123 => bytes.extend(((value * 65535.0) as u16).to_le_bytes()),
                    _ => bytes.extend(f32::to_le_bytes(*value)),
                }
            }
        }
        let mut draft = square(json!({}));
        let kind = if width == 3 { "VEC3" } else { "VEC4" };
        let colors = draft.accessor(&bytes, component, kind, 4);
        draft.root["accessors"][colors]["normalized"] = json!(component != 5126);
        attribute(&mut draft, "COLOR_0", colors);
        let mesh = draft.read().unwrap();
        assert!(mesh.warnings.is_empty(), "{component} {width} {:?}", mesh.warnings);
        for (corner, detail) in mesh.corners.iter().zip(details(&mesh)) {
            let place = SQUARE.iter().position(|at| Vec3::from(*at) == corner.position).unwrap();
            let alpha = if width == 3 { 1.0 } else { 0.0 };
            assert_eq!(detail.color, Vec3::from(expected[place]).extend(alpha), "{component} {width}");
        }
    }
}

#[test]
fn corners_that_differ_in_colour_alone_do_not_tear() {
    let mut draft = square(json!({}));
    let plain = draft.read().unwrap();
    // The second triangle once more as a primitive of its own, with colours: its corners lie on the first's.
    let at = draft.root["meshes"][0]["primitives"][0]["attributes"].clone();
    let (first, second) = (draft.indices(&[0, 1, 2]), draft.indices(&[2, 1, 3]));
    let colors = draft.floats("VEC4", &[[1.0, 0.0, 0.0, 1.0]; 4].concat());
    let mut colored = at.clone();
    colored["COLOR_0"] = json!(colors);
    draft.root["meshes"][0]["primitives"] = json!([
        { "attributes": at, "indices": first, "material": 0 }, { "attributes": colored, "indices": second, "material": 0 },
    ]);
    let split = draft.read().unwrap();
    assert_eq!((plain.corners.len(), split.corners.len(), split.triangles.len()), (4, 6, 2));
    let [a, b] = [&plain.mesh, &split.mesh].map(Topology::new);
    assert_eq!((a.points.clone(), a.edge_counts()), (b.points.clone(), b.edge_counts()));
    assert_eq!(b.edge_counts().smooth, 1);
}
