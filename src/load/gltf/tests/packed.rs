//! Primitives that are compressed with Draco, by the crate's own encoder: both encoding methods, every attribute that
//! is read, and documents that also have uncompressed data.

use draco_core::{
    DataType, EncoderBuffer, EncoderOptions, GeometryAttributeType as Kind, Mesh as DracoExtension, MeshEncoder,
    PointAttribute,
};

use super::*;
use crate::gltf::schema::DRACO;

/// The number of squares along a side of the grid.
const SIDE: u16 = 8;

/// The order of the vertices in the compressed data.
#[derive(Clone, Copy, Debug, PartialEq)]
/// The order before compression.
pub(super) enum Order {
    Kept,
    /// The order in which the encoder visits them, from edge to edge.
    Walked,
}

/// Vertices and triangles to compress.
#[derive(Default)]
pub(super) struct Stream {
    mesh: DracoExtension,
    vertices: usize,
    options: EncoderOptions,
    pub ids: Vec<u32>,
}

impl Stream {
    pub(super) fn new(vertices: usize, triangles: &[[u32; 3]], order: Order) -> Self {
        let (mut mesh, mut options) = (DracoExtension::new(), EncoderOptions::new());
        mesh.set_num_points(vertices);
        mesh.try_set_num_faces(triangles.len()).unwrap();
        triangles.iter().enumerate().for_each(|(i, triangle)| mesh.set_face_from_indices(i, *triangle));
        options.set_encoding_method(if order == Order::Kept { 0 } else { 1 });
        Self { mesh, vertices, options, ids: Vec::new() }
    }

    /// Adds an attribute of `width` numbers a vertex. Floats keep this number of bits, or all of them.
    pub(super) fn attribute(&mut self, kind: Kind, width: u8, data: DataType, bytes: &[u8], bits: Option<i32>) {
        let mut attribute = PointAttribute::new();
        attribute.init(kind, width, data, false, self.vertices);
        attribute.buffer_mut().write(0, bytes);
        let id = self.mesh.add_attribute(attribute);
        if let Some(bits) = bits {
            self.options.set_attribute_quantization(id, bits);
        }
        self.ids.push(self.mesh.attribute(id).unique_id());
    }

    pub(super) fn bytes(&self) -> Vec<u8> {
        let (mut encoder, mut bytes) = (MeshEncoder::new(), EncoderBuffer::new());
        encoder.set_mesh(self.mesh.clone());
        encoder.encode(&self.options, &mut bytes).unwrap();
        bytes.data().to_vec()
    }
}

fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

/// Adds an accessor without data.
fn accessor(draft: &mut Draft, component: u32, kind: &str, count: usize) -> usize {
    draft.push("accessors", json!({ "componentType": component, "type": kind, "count": count }))
}

fn triangles() -> Vec<[u32; 3]> {
    let (side, next) = (u32::from(SIDE), u32::from(SIDE) + 1);
    let squares = (0..side * side).map(|i| i / side * next + i % side);
    squares.flat_map(|a| [[a, a + 1, a + next], [a + 1, a + next + 1, a + next]]).collect()
}

fn corners() -> Vec<[u16; 3]> {
    let next = SIDE + 1;
    (0..next * next).map(|i| [i % next * 100, i / next * 100, i * i % 7]).collect()
}

/// A grid with integer positions, equal normals, and texture coordinates.
pub(super) fn grid(order: Order) -> Draft {
    let (corners, triangles) = (corners(), triangles());
    let mut stream = Stream::new(corners.len(), &triangles, order);
    let whole: Vec<u8> = corners.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
    stream.attribute(Kind::Position, 3, DataType::Uint16, &whole, None);
    stream.attribute(Kind::Normal, 3, DataType::Float32, &floats(&[0.0, 0.6, 0.8].repeat(corners.len())), Some(10));
    let uvs: Vec<f32> = corners.iter().flat_map(|[x, y, _]| [f32::from(*x) / 800.0, f32::from(*y) / 800.0]).collect();
    stream.attribute(Kind::TexCoord, 2, DataType::Float32, &floats(&uvs), Some(12));
    let mut draft = Draft::new();
    let view = draft.view(&stream.bytes());
    let position = accessor(&mut draft, 5123, "VEC3", corners.len());
    let normal = accessor(&mut draft, 5126, "VEC3", corners.len());
    let uv = accessor(&mut draft, 5126, "VEC2", corners.len());
    let indices = accessor(&mut draft, 5123, "SCALAR", triangles.len() * 3);
    let ids = json!({ "POSITION": stream.ids[0], "NORMAL": stream.ids[1], "TEXCOORD_0": stream.ids[2] });
    draft.primitive(json!({
        "attributes": { "POSITION": position, "NORMAL": normal, "TEXCOORD_0": uv }, "indices": indices,
        "extensions": { DRACO: { "bufferView": view, "attributes": ids } },
    }));
    draft.root["extensionsRequired"] = json!([DRACO, "KHR_mesh_quantization"]);
    draft
}

/// Rotates each triangle to its least corner and sorts them: an encoder may rotate triangles but not flip them, and may
/// change their order.
fn sorted(at: &[[f32; 3]]) -> Vec<[[f32; 3]; 3]> {
    let least = |t: &[[f32; 3]; 3]| {
        (0..3).map(|k| [t[k], t[(k + 1) % 3], t[(k + 2) % 3]]).reduce(|a, b| if a < b { a } else { b })
    };
    let mut triangles: Vec<_> = at.as_chunks().0.iter().filter_map(least).collect();
    triangles.sort_by(|a, b| a.partial_cmp(b).unwrap());
    triangles
}

#[test]
fn a_packed_grid_is_the_plain_one() {
    let corner = |i: &u32| corners()[*i as usize].map(f32::from);
    let expected: Vec<_> = triangles().as_flattened().iter().map(corner).collect();
    for order in [Order::Kept, Order::Walked] {
        let mesh = grid(order).read().unwrap();
        assert_eq!(sorted(&positions(&mesh)), sorted(&expected), "{order:?}");
        assert_eq!(mesh.corners.len(), corners().len());
        for corner in &mesh.corners {
            assert!(corner.normal.distance(Vec3::new(0.0, 0.6, 0.8)) < 0.01, "{order:?}: {corner:?}");
            assert!(corner.uv.distance(corner.position.truncate() / 800.0) < 1e-3, "{order:?}: {corner:?}");
        }
        assert_eq!(read_bytes(&grid(order).glb()).unwrap().corners, mesh.corners);
    }
}

#[test]
fn seams_cut_what_is_packed() {
    // Two triangles that share an edge, with different texture coordinates.
    let at = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let uvs = [0.0, 0.0, 0.25, 0.0, 0.0, 0.25, 0.5, 0.5, 0.75, 0.75, 1.0, 1.0];
    let mut stream = Stream::new(6, &[[0, 1, 2], [3, 4, 5]], Order::Walked);
    stream.attribute(Kind::Position, 3, DataType::Float32, &floats(at.as_flattened()), Some(11));
    stream.attribute(Kind::TexCoord, 2, DataType::Float32, &floats(&uvs), Some(12));
    stream.mesh.deduplicate_attribute_values().unwrap();
    let mut draft = Draft::new();
    let view = draft.view(&stream.bytes());
    let (position, uv) = (accessor(&mut draft, 5126, "VEC3", 6), accessor(&mut draft, 5126, "VEC2", 6));
    let indices = accessor(&mut draft, 5123, "SCALAR", 6);
    let ids = json!({ "POSITION": stream.ids[0], "TEXCOORD_0": stream.ids[1] });
    draft.primitive(json!({
        "attributes": { "POSITION": position, "TEXCOORD_0": uv }, "indices": indices,
        "extensions": { DRACO: { "bufferView": view, "attributes": ids } },
    }));
    draft.root["extensionsRequired"] = json!([DRACO]);
    let mesh = draft.read().unwrap();
    assert_eq!(mesh.corners.len(), 6);
    assert_eq!(Topology::build(&mesh, &Progress::new()).unwrap().points.len(), 4);
    for (at, uv) in at.iter().zip(uvs.as_chunks::<2>().0) {
        let close = |corner: &geometry::mesh::Corner| {
            corner.position.distance((*at).into()) < 1e-3 && corner.uv.distance((*uv).into()) < 1e-3
        };
        assert!(mesh.corners.iter().any(close), "{at:?} {uv:?}: {:?}", mesh.corners);
    }
}

/// A cube of side 1 whose texture coordinates differ at every edge, from Google's own encoder (1.5.7, level 10, 11
/// bits).
#[test]
fn data_from_googles_encoder_is_read() {
    let mut draft = Draft::new();
    let view = draft.view(include_bytes!("cube.drc"));
    let (uv, position) = (accessor(&mut draft, 5126, "VEC2", 24), accessor(&mut draft, 5126, "VEC3", 24));
    let indices = accessor(&mut draft, 5123, "SCALAR", 36);
    draft.primitive(json!({
        "attributes": { "POSITION": position, "TEXCOORD_0": uv }, "indices": indices,
        "extensions": { DRACO: { "bufferView": view, "attributes": { "POSITION": 1, "TEXCOORD_0": 0 } } },
    }));
    draft.root["extensionsRequired"] = json!([DRACO]);
    let mesh = draft.read().unwrap();
    let topology = Topology::build(&mesh, &Progress::new()).unwrap();
    assert_eq!((mesh.triangles.len(), mesh.corners.len(), topology.points.len()), (12, 24, 8));
    let at = positions(&mesh);
    let volume = at.as_chunks::<3>().0.iter().map(|t| {
        let [a, b, c] = t.map(Vec3::from);
        a.dot(b.cross(c)) / 6.0
    });
    assert!((volume.sum::<f32>() - 1.0).abs() < 1e-4);
    for corner in &mesh.corners {
        // The sides of the cube are next to each other in the image. This computes which side it is, and where on it.
        let side = (0..6).find(|i| corner.normal[i / 2] == [-1.0, 1.0][i % 2]).expect("a normal along an axis");
        let on = [(side / 2 + 1) % 3, (side / 2 + 2) % 3].map(|axis| corner.position[axis]);
        let uv = Vec2::new(side as f32 / 8.0 + on[0] / 8.0, on[1] / 4.0);
        assert!(corner.uv.distance(uv) < 1e-3, "{corner:?}");
    }
}

/// A triangle that a joint lifts by one, compressed with its joints and weights. Its morph target isn't compressed.
pub(super) fn skinned() -> Draft {
    let mut stream = Stream::new(3, &[[0, 1, 2]], Order::Kept);
    stream.attribute(Kind::Position, 3, DataType::Float32, &floats(TRIANGLE.as_flattened()), None);
    // With more bits than the accessor says, as some exporters write them.
    let joints: Vec<u8> = [1_u16, 0, 0, 0].repeat(3).into_iter().flat_map(u16::to_le_bytes).collect();
    stream.attribute(Kind::Generic, 4, DataType::Uint16, &joints, None);
    let weights = [255_u8, 0, 0, 0].repeat(3);
    stream.attribute(Kind::Generic, 4, DataType::Uint8, &weights, None);
    let mut draft = Draft::new();
    let view = draft.view(&stream.bytes());
    let position = accessor(&mut draft, 5126, "VEC3", 3);
    let (joints, weights) = (accessor(&mut draft, 5121, "VEC4", 3), accessor(&mut draft, 5121, "VEC4", 3));
    draft.root["accessors"][weights]["normalized"] = json!(true);
    let indices = accessor(&mut draft, 5121, "SCALAR", 3);
    let target = draft.vectors(&[[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 0.0, 0.0]]);
    let ids = json!({ "POSITION": stream.ids[0], "JOINTS_0": stream.ids[1], "WEIGHTS_0": stream.ids[2] });
    draft.primitive(json!({
        "attributes": { "POSITION": position, "JOINTS_0": joints, "WEIGHTS_0": weights }, "indices": indices,
        "targets": [{ "POSITION": target }],
        "extensions": { DRACO: { "bufferView": view, "attributes": ids } },
    }));
    draft.root["meshes"][0]["weights"] = json!([1.0]);
    draft.root["skins"] = json!([{ "joints": [1, 2] }]);
    draft.root["nodes"] = json!([{ "mesh": 0, "skin": 0 }, {}, { "translation": [0.0, 0.0, 1.0] }]);
    draft.root["extensionsRequired"] = json!([DRACO]);
    draft
}

#[test]
fn joints_and_weights_are_packed_and_targets_beside() {
    let mesh = skinned().read().unwrap();
    assert_eq!(positions(&mesh), [[0.0, 0.0, 1.0], [3.0, 0.0, 1.0], [0.0, 1.0, 1.0]]);
}

#[test]
fn data_beside_are_read_unless_draco_is_required() {
    let mut draft = triangle();
    let nothing = draft.view(b"no Draco data");
    let indices = draft.indices(&[0, 1, 2]);
    let primitive = &mut draft.root["meshes"][0]["primitives"][0];
    primitive["indices"] = json!(indices);
    primitive["extensions"] = json!({ DRACO: { "bufferView": nothing, "attributes": { "POSITION": 0 } } });
    draft.root["extensionsUsed"] = json!([DRACO]);
    assert_eq!(positions(&draft.read().unwrap()), TRIANGLE);
    draft.root["extensionsRequired"] = json!([DRACO]);
    let expected = "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression has data that doesn't begin with DRACO; \
                    export the model again";
    assert_eq!(message(&draft), expected);
}

#[test]
fn one_mesh_on_many_nodes_and_a_hidden_one() {
    let mut draft = grid(Order::Walked);
    let mut broken = draft.root["meshes"][0].clone();
    broken["primitives"][0]["extensions"][DRACO]["attributes"] = json!({});
    draft.push("meshes", broken);
    draft.root["nodes"] = json!([{ "mesh": 0 }, { "mesh": 0, "translation": [0, 0, 50] }, { "mesh": 1 }]);
    draft.root["scenes"] = json!([{ "nodes": [0, 1] }]);
    assert_eq!(draft.read().unwrap().triangles.len(), 2 * triangles().len());
    draft.root["scenes"] = json!([{ "nodes": [2] }]);
    assert!(message(&draft).contains("names no POSITION among its attributes"), "{}", message(&draft));
}
