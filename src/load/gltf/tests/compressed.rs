//! Extensions that are read: compressed buffer views in every mode and with every filter, from meshoptimizer's own
//! encoders; quantised attributes; and transformed texture coordinates.

use ::meshopt as encoder;

use super::*;
use crate::gltf::schema::{KHR_MESHOPT, MESHOPT};

/// The number of points along a side of the grid.
const SIDE: u16 = 9;

/// Adds a view that is compressed in buffer 0, with the fallback buffer 1, which has no data.
fn add(draft: &mut Draft, bytes: &[u8], stride: usize, length: usize, mode: &str, filter: &str) -> usize {
    let plain = draft.view(bytes);
    let view = draft.root["bufferViews"].as_array_mut().unwrap().remove(plain);
    let (offset, held) = (view["byteOffset"].clone(), view["byteLength"].clone());
    let extension = json!({
        "buffer": 0, "byteOffset": offset, "byteLength": held, "byteStride": stride, "count": length / stride,
        "mode": mode, "filter": filter,
    });
    let mut view = json!({ "buffer": 1, "byteLength": length, "extensions": { MESHOPT: extension } });
    if mode == "ATTRIBUTES" {
        view["byteStride"] = json!(stride);
    }
    draft.push("bufferViews", view)
}

fn accessor(draft: &mut Draft, view: usize, component: u32, kind: &str, count: usize, normalized: bool) -> usize {
    let accessor = json!({
        "bufferView": view, "componentType": component, "type": kind, "count": count, "normalized": normalized,
    });
    draft.push("accessors", accessor)
}

/// Adds the fallback buffer.
fn finish(draft: &mut Draft) {
    draft.root["extensionsRequired"] = json!([MESHOPT, "KHR_mesh_quantization"]);
    draft.fallback = Some(json!({ "byteLength": 1 << 20, "extensions": { MESHOPT: { "fallback": true } } }));
}

fn corners() -> Vec<[u16; 4]> {
    (0..SIDE * SIDE).map(|i| [i % SIDE * 100, i / SIDE * 100, (i * i) % 7, 0]).collect()
}

fn triangles() -> Vec<u32> {
    let cell = |i: u32| (i / (u32::from(SIDE) - 1), i % (u32::from(SIDE) - 1));
    let squares = (0..(u32::from(SIDE) - 1).pow(2)).map(cell).map(|(y, x)| y * u32::from(SIDE) + x);
    squares.flat_map(|a| [a, a + 1, a + u32::from(SIDE), a + 1, a + u32::from(SIDE) + 1, a + u32::from(SIDE)]).collect()
}

/// A grid with quantised positions, octahedral normals and indices, all compressed.
pub(super) fn grid() -> Draft {
    let (corners, triangles) = (corners(), triangles());
    let mut draft = Draft::new();
    let encoded = encoder::encode_vertex_buffer(&corners).unwrap();
    let at = add(&mut draft, &encoded, 8, corners.len() * 8, "ATTRIBUTES", "NONE");
    let at = accessor(&mut draft, at, 5123, "VEC3", corners.len(), false);
    let normals: Vec<[i8; 4]> = encoder::encode_filter_oct(&vec![[0.0, 0.6, 0.8, 0.0]; corners.len()], 8);
    let encoded = encoder::encode_vertex_buffer(&normals).unwrap();
    let normal = add(&mut draft, &encoded, 4, corners.len() * 4, "ATTRIBUTES", "OCTAHEDRAL");
    let normal = accessor(&mut draft, normal, 5120, "VEC3", corners.len(), true);
    let encoded = encoder::encode_index_buffer(&triangles, corners.len()).unwrap();
    let indices = add(&mut draft, &encoded, 2, triangles.len() * 2, "TRIANGLES", "NONE");
    let indices = accessor(&mut draft, indices, 5123, "SCALAR", triangles.len(), false);
    draft.primitive(json!({ "attributes": { "POSITION": at, "NORMAL": normal }, "indices": indices }));
    finish(&mut draft);
    draft
}

#[test]
fn a_compressed_grid_is_the_plain_one() {
    let mesh = grid().read().unwrap();
    let corner = |i: u32| corners()[i as usize];
    let expected: Vec<_> = triangles().into_iter().map(corner).map(|[x, y, z, _]| [x, y, z].map(f32::from)).collect();
    // The encoder may rotate a triangle's corners, but not flip it.
    let turned = |at: &[[f32; 3]]| -> Vec<[[f32; 3]; 3]> {
        let least = |t: [[f32; 3]; 3]| {
            (0..3).map(|k| [t[k], t[(k + 1) % 3], t[(k + 2) % 3]]).reduce(|a, b| if a < b { a } else { b })
        };
        at.as_chunks::<3>().0.iter().filter_map(|t| least(*t)).collect()
    };
    assert_eq!(turned(&positions(&mesh)), turned(&expected));
    assert!(mesh.corners.iter().all(|corner| corner.normal.distance(Vec3::new(0.0, 0.6, 0.8)) < 0.02));
    assert!(mesh.warnings.iter().all(|said| said.contains("length isn't 1")), "{:?}", mesh.warnings);
    let glb = read_bytes(&grid().glb()).unwrap();
    assert_eq!(glb.corners, mesh.corners);
}

/// The extension of Khronos has a filter of colours, and another version of the stream.
#[test]
fn colours_are_read_from_the_newer_extension() {
    let mut draft = triangle();
    let colors = [[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0], [0.0, 0.0, 1.0, 0.5]];
    let filtered: Vec<[u8; 4]> = encoder::encode_filter_color(&colors, 8);
    let encoded = encoder::encode_vertex_buffer_level(&filtered, 2, Some(1)).unwrap();
    assert_eq!(encoded[0], 0xa1, "version 1");
    let view = add(&mut draft, &encoded, 4, 12, "ATTRIBUTES", "COLOR");
    let color = accessor(&mut draft, view, 5121, "VEC4", 3, true);
    draft.root["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = json!(color);
    finish(&mut draft);
    let text = |draft: &Draft| draft.document().to_string();
    let newer = text(&draft).replace(MESHOPT, KHR_MESHOPT);
    let mesh = read_bytes(newer.as_bytes()).expect("a document without a fault");
    assert!(mesh.warnings.is_empty(), "{:?}", mesh.warnings);
    let details = mesh.details.as_ref().expect("colours");
    let found: Vec<_> = (0..3).map(|i| details[i].color).collect();
    for color in colors {
        assert!(found.iter().any(|own| own.distance(color.into()) < 0.01), "{found:?}");
    }
    // The other one doesn't have that filter.
    let refused = read_bytes(text(&draft).as_bytes()).map(|mesh| mesh.warnings.clone());
    let said = refused.unwrap_or_else(|error| vec![error.to_string()]);
    assert!(said.iter().any(|said| said.contains("EXT_meshopt_compression/filter")), "{said:?}");
    let grid = text(&grid()).replace(MESHOPT, KHR_MESHOPT);
    assert_eq!(read_bytes(grid.as_bytes()).expect("a grid").triangles.len(), triangles().len() / 3);
}

/// A grid whose compressed positions are broken, and which has a copy of them.
#[test]
fn a_broken_stream_is_read_from_its_copy() {
    let expected = grid().read().expect("a document without a fault");
    let copy: Vec<u8> = corners().iter().flatten().flat_map(|number| number.to_le_bytes()).collect();
    let with_copy = |bytes: &[u8]| {
        let mut draft = grid();
        draft.bytes[0] = 0;
        let uri = format!("data:application/octet-stream;base64,{}", BASE64_STANDARD.encode(bytes));
        let extensions = json!({ MESHOPT: { "fallback": true } });
        draft.fallback = Some(json!({ "byteLength": copy.len(), "uri": uri, "extensions": extensions }));
        draft.read()
    };
    let mesh = with_copy(&copy).expect("a document with a copy");
    assert_eq!((&mesh.corners, &mesh.triangles), (&expected.corners, &expected.triangles));
    let said = "/bufferViews/0/extensions/EXT_meshopt_compression can't be decompressed";
    let warnings: Vec<_> = mesh.warnings.iter().filter(|warning| warning.contains("copy")).collect();
    assert!(matches!(warnings[..], [own] if own.starts_with(said)), "{:?}", mesh.warnings);
    let refused = with_copy(&copy[1..]).map(|_| ()).expect_err("a copy that is too short");
    assert!(refused.to_string().starts_with(said), "{refused}");
}

#[test]
fn sequences_and_exponents_are_read() {
    let mut draft = Draft::new();
    let at: Vec<[f32; 3]> = vec![[0.0, 0.0, 0.0], [1.5, 0.0, 0.0], [0.0, -0.25, 1024.0]];
    let encoded = encoder::encode_filter_exp(&at, 24, encoder::EncodeExpMode::Separate);
    let encoded = encoder::encode_vertex_buffer(&encoded).unwrap();
    let view = add(&mut draft, &encoded, 12, 36, "ATTRIBUTES", "EXPONENTIAL");
    let position = accessor(&mut draft, view, 5126, "VEC3", 3, false);
    let encoded = encoder::encode_index_sequence(&[2, 0, 1], 3).unwrap();
    let view = add(&mut draft, &encoded, 4, 12, "INDICES", "NONE");
    let indices = accessor(&mut draft, view, 5125, "SCALAR", 3, false);
    draft.primitive(json!({ "attributes": { "POSITION": position }, "indices": indices }));
    finish(&mut draft);
    assert_eq!(positions(&draft.read().unwrap()), [at[2], at[0], at[1]]);
}

#[test]
fn compressed_rotations_turn() {
    let mut draft = triangle();
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let turns = encoder::encode_filter_quat(&[[0.0, 0.0, 0.0, 1.0], [0.0, 0.0, half, half]], 16);
    let encoded = encoder::encode_vertex_buffer(&turns).unwrap();
    let view = add(&mut draft, &encoded, 8, 16, "ATTRIBUTES", "QUATERNION");
    let output = accessor(&mut draft, view, 5122, "VEC4", 2, true);
    let input = draft.floats("SCALAR", &[0.0, 1.0]);
    draft.root["animations"] = json!([{
        "channels": [{ "sampler": 0, "target": { "node": 0, "path": "rotation" } }],
        "samplers": [{ "input": input, "output": output }],
    }]);
    finish(&mut draft);
    let mesh = draft.read().unwrap();
    let rig = mesh.mesh.rig.expect("it turns");
    let turned = rig.clips[0].channels[0].keys.rotation(1.0);
    assert!(turned.angle_between(glam::DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2)) < 1e-3, "{turned}");
}

#[test]
fn a_view_must_be_as_long_as_what_it_holds() {
    let mut draft = grid();
    draft.root["bufferViews"][0]["byteLength"] = json!(647);
    let expected = "/bufferViews/0/extensions/EXT_meshopt_compression has 81 elements of 8 bytes, which are 648 bytes, but its view's \
                    byteLength is 647; export the model again";
    assert_eq!(message(&draft), expected);
}

#[test]
fn texture_coordinates_are_transformed() {
    let mut draft = triangle();
    let uvs = draft.floats("VEC2", &[0.0, 0.0, 1.0, 0.0, 0.0, 1.0]);
    let others = draft.floats("VEC2", &[0.5, 0.5, 0.5, 0.5, 0.5, 0.5]);
    let primitive = &mut draft.root["meshes"][0]["primitives"][0];
    primitive["attributes"]["TEXCOORD_0"] = json!(others);
    primitive["attributes"]["TEXCOORD_2"] = json!(uvs);
    primitive["material"] = json!(0);
    let transform =
        json!({ "offset": [0.5, 0.25], "rotation": std::f32::consts::FRAC_PI_2, "scale": [2.0, 3.0], "texCoord": 2 });
    let info = json!({ "index": 0, "texCoord": 0, "extensions": { "KHR_texture_transform": transform } });
    draft.root["materials"] = json!([{ "pbrMetallicRoughness": { "baseColorTexture": info } }]);
    draft.root["textures"] = json!([{ "source": 0 }]);
    draft.root["images"] = json!([{}]);
    draft.root["extensionsRequired"] = json!(["KHR_texture_transform"]);
    let mesh = draft.read().unwrap();
    let expected = [[0.5, 0.25], [0.5, -1.75], [3.5, 0.25]].map(Vec2::from);
    assert!(
        mesh.corners.iter().zip(expected).all(|(corner, uv)| corner.uv.abs_diff_eq(uv, 1e-6)),
        "{:?}",
        mesh.corners
    );
}

#[test]
fn every_quantised_type_is_read() {
    let little = |values: &[i32], size: usize| -> Vec<u8> {
        values.iter().flat_map(|value| value.to_le_bytes()[..size].to_vec()).collect()
    };
    let types = [(5120, 1, 127), (5121, 1, 255), (5122, 2, 32767), (5123, 2, 65535)];
    for (component, size, most) in types {
        let is_signed = component % 2 == 0;
        for normalized in [false, true] {
            let least = if is_signed { -most } else { 0 };
            let one = if normalized { most as f32 } else { 1.0 };
            let mut draft = Draft::new();
            let mut add = |values: &[i32], kind: &str| {
                let accessor = draft.accessor(&little(values, size), component, kind, 3);
                draft.root["accessors"][accessor]["normalized"] = json!(normalized);
                accessor
            };
            let at = add(&[least, 0, 0, most, 0, 0, 0, most, 0], "VEC3");
            let uv = add(&[least, 0, most, 0, 0, most], "VEC2");
            let normal = add(&[0, 0, most, 0, 0, most, 0, 0, most], "VEC3");
            let mut attributes = json!({ "POSITION": at, "TEXCOORD_0": uv });
            // Normals are signed and normalised.
            if is_signed && normalized {
                attributes["NORMAL"] = json!(normal);
            }
            draft.primitive(json!({ "attributes": attributes, "targets": [{ "POSITION": at }] }));
            draft.root["meshes"][0]["weights"] = json!([1.0]);
            draft.root["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
            let mesh = draft.read().unwrap();
            let (low, high) = (least as f32 / one, most as f32 / one);
            let twice = [[low, 0.0, 0.0], [high, 0.0, 0.0], [0.0, high, 0.0]].map(|at| at.map(|x| 2.0 * x));
            assert_eq!(positions(&mesh), twice, "{component} {normalized}");
            let uvs: Vec<_> = mesh.corners.iter().map(|corner| corner.uv.to_array()).collect();
            assert_eq!(uvs, [[low, 0.0], [high, 0.0], [0.0, high]], "{component} {normalized}");
            assert!(mesh.corners.iter().all(|corner| corner.normal == Vec3::Z), "{component} {normalized}");
            assert_eq!(mesh.warnings.is_empty(), is_signed && normalized, "{:?}", mesh.warnings);
        }
    }
}
