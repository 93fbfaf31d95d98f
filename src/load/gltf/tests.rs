mod animations;
mod cameras;
mod compressed;
mod files;
mod lights;
mod materials;
mod packed;
mod parts;
mod scenes;
mod textures;
mod variants;

use base64::prelude::{BASE64_STANDARD, Engine};
use glam::{Vec2, Vec3};
use serde_json::{Value, json};

use super::*;
use crate::Limits;
use crate::selection::Selection;
use geometry::cores::on_threads;
use geometry::mesh::topology::Topology;
use geometry::mesh::{Corner, Mesh, Repairs};

/// A document that is being built: one buffer, with a view and an accessor for each list.
struct Draft {
    root: Value,
    bytes: Vec<u8>,
    /// Another buffer.
    fallback: Option<Value>,
}

impl Draft {
    /// Returns a document with one scene, one node and one mesh, whose primitives are added later.
    fn new() -> Self {
        let root = json!({
            "asset": { "version": "2.0" },
            "scene": 0,
            "scenes": [{ "nodes": [0] }],
            "nodes": [{ "mesh": 0 }],
            "meshes": [{ "name": "thing", "primitives": [] }],
            "buffers": [],
            "bufferViews": [],
            "accessors": [],
        });
        Self { root, bytes: Vec::new(), fallback: None }
    }

    fn push(&mut self, list: &str, value: Value) -> usize {
        let list = self.root[list].as_array_mut().unwrap();
        list.push(value);
        list.len() - 1
    }

    fn view(&mut self, bytes: &[u8]) -> usize {
        while !self.bytes.len().is_multiple_of(4) {
            self.bytes.push(0);
        }
        let offset = self.bytes.len();
        self.bytes.extend(bytes);
        self.push("bufferViews", json!({ "buffer": 0, "byteOffset": offset, "byteLength": bytes.len() }))
    }

    fn accessor(&mut self, bytes: &[u8], component: u32, kind: &str, count: usize) -> usize {
        let view = self.view(bytes);
        let accessor = json!({ "bufferView": view, "componentType": component, "type": kind, "count": count });
        self.push("accessors", accessor)
    }

    fn floats(&mut self, kind: &str, values: &[f32]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        let width = ["SCALAR", "VEC2", "VEC3", "VEC4"].iter().position(|k| *k == kind).map_or(16, |i| i + 1);
        self.accessor(&bytes, 5126, kind, values.len() / width)
    }

    fn vectors(&mut self, values: &[[f32; 3]]) -> usize {
        self.floats("VEC3", values.as_flattened())
    }

    fn indices(&mut self, values: &[u16]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        self.accessor(&bytes, 5123, "SCALAR", values.len())
    }

    fn primitive(&mut self, primitive: Value) {
        self.root["meshes"][0]["primitives"].as_array_mut().unwrap().push(primitive);
    }

    /// Adds a list of vectors, which are zeros but for one of the first 256. Its index and value are in these views.
    fn zeros_but_one(&mut self, count: usize, index: usize, value: usize) -> usize {
        let sparse = one_replaced(index, value);
        self.push("accessors", json!({ "componentType": 5126, "type": "VEC3", "count": count, "sparse": sparse }))
    }

    fn document(&self) -> Value {
        let uri = format!("data:application/octet-stream;base64,{}", BASE64_STANDARD.encode(&self.bytes));
        let mut root = self.root.clone();
        // Unless the test has set this itself.
        let mut buffer = root["buffers"].get(0).cloned().unwrap_or(json!({ "byteLength": self.bytes.len() }));
        buffer["uri"] = json!(uri);
        root["buffers"] = [buffer].into_iter().chain(self.fallback.clone()).collect();
        root
    }

    fn read(&self) -> Result<LoadedMesh, GltfError> {
        read_bytes(self.document().to_string().as_bytes())
    }

    fn glb(&self) -> Vec<u8> {
        let mut root = self.root.clone();
        root["buffers"] =
            [json!({ "byteLength": self.bytes.len() })].into_iter().chain(self.fallback.clone()).collect();
        let mut json = root.to_string().into_bytes();
        json.resize(json.len().next_multiple_of(4), b' ');
        let mut bin = self.bytes.clone();
        bin.resize(bin.len().next_multiple_of(4), 0);
        let length = |bytes: &[u8]| (bytes.len() as u32).to_le_bytes();
        let total = (12 + 8 + json.len() + 8 + bin.len()) as u32;
        let header = [&b"glTF"[..], &2_u32.to_le_bytes(), &total.to_le_bytes()].concat();
        [&header, &length(&json)[..], b"JSON", &json, &length(&bin), b"BIN\0", &bin].concat()
    }
}

/// What replaces one element of a list. Its index, below 256, and its value are in these views.
fn one_replaced(index: usize, value: usize) -> Value {
    json!({
        "count": 1,
        "indices": { "bufferView": index, "componentType": 5121 },
        "values": { "bufferView": value },
    })
}

/// Reads a document that names no files.
fn read_bytes(bytes: &[u8]) -> Result<LoadedMesh, GltfError> {
    read(bytes.to_vec(), &ModelFile::from_test("draft", &Progress::new()))
}

const TRIANGLE: [[f32; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

/// One triangle in the xy plane that faces +Z, with normals.
fn triangle() -> Draft {
    let mut draft = Draft::new();
    let (positions, normals) = (draft.vectors(&TRIANGLE), draft.vectors(&[[0.0, 0.0, 1.0]; 3]));
    draft.primitive(json!({ "attributes": { "POSITION": positions, "NORMAL": normals } }));
    draft
}

fn positions(mesh: &Mesh) -> Vec<[f32; 3]> {
    mesh.triangles.as_flattened().iter().map(|&c| mesh.corners[c as usize].position.to_array()).collect()
}

fn face_normal(mesh: &Mesh) -> Vec3 {
    let [a, b, c] = mesh.triangles[0].map(|corner| mesh.corners[corner as usize].position);
    (b - a).cross(c - a).normalize()
}

fn message(draft: &Draft) -> String {
    draft.read().unwrap_err().to_string()
}

#[test]
fn a_triangle_arrives_as_it_is() {
    let mesh = triangle().read().unwrap();
    assert_eq!(positions(&mesh), TRIANGLE);
    assert_eq!((mesh.name.as_str(), mesh.warnings.len()), ("draft", 0));
    assert_eq!((mesh.materials[0].name.as_str(), mesh.materials[0].triangles.clone()), ("default", 0..1));
    assert_eq!(mesh.corners[0].normal, Vec3::Z);
}

#[test]
fn glb_and_gltf_give_the_same() {
    let draft = triangle();
    let mesh = read_bytes(&draft.glb()).unwrap();
    assert_eq!(mesh.corners, draft.read().unwrap().corners);
}

#[test]
fn a_mirrored_node_keeps_outside_outside() {
    let mut draft = triangle();
    draft.root["nodes"][0]["scale"] = json!([-2.0, 1.0, 1.0]);
    let mesh = draft.read().unwrap();
    assert_eq!(face_normal(&mesh), Vec3::Z);
    assert!(mesh.corners.iter().all(|corner| corner.normal == Vec3::Z));
    assert_eq!(mesh.bounds().min.x, -2.0);
}

#[test]
fn transforms_stack_and_normals_stay_perpendicular() {
    let mut draft = Draft::new();
    let slope = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, -1.0]];
    let (at, n) = (draft.vectors(&slope), draft.vectors(&[[0.0, 1.0, 1.0]; 3]));
    draft.primitive(json!({ "attributes": { "POSITION": at, "NORMAL": n } }));
    draft.root["scenes"] = json!([{ "nodes": [1] }]);
    draft.root["nodes"] = json!([
        { "mesh": 0, "scale": [1.0, 4.0, 1.0] },
        { "children": [0], "translation": [0.0, 0.0, 5.0], "rotation": [0.0, 0.0, 1.0, 0.0] },
    ]);
    let mesh = draft.read().unwrap();
    assert!(mesh.corners.iter().all(|c| c.normal.distance(face_normal(&mesh)) < 1e-6));
    assert_eq!(mesh.bounds().max.z, 5.0);
}

#[test]
fn without_scenes_all_roots_are_shown() {
    let mut draft = triangle();
    draft.root.as_object_mut().unwrap().retain(|key, _| !key.starts_with("scene"));
    draft.root["nodes"] = json!([{ "mesh": 0 }, { "mesh": 0, "translation": [0, 0, 1] }]);
    assert_eq!(draft.read().unwrap().triangles.len(), 2);
}

#[test]
fn normalised_integers_and_strides() {
    let mut draft = Draft::new();
    // Quantised: positions of 16 bits 8 bytes apart, normals of 8 bits 4 bytes apart, and uvs of 16 bits.
    let shorts = [0_i16, 0, 0, 0, 32767, 0, 0, 0, 0, -32767, 0, 0];
    let bytes: Vec<u8> = shorts.iter().flat_map(|value| value.to_le_bytes()).collect();
    let at = draft.accessor(&bytes, 5122, "VEC3", 3);
    let normals = draft.accessor(&[0, 0, 0x81, 0, 0, 0, 0x81, 0, 0, 0, 0x81, 0], 5120, "VEC3", 3);
    let uvs = draft.accessor(&[0, 0, 255, 255, 0, 0, 0, 0, 255, 255, 255, 255], 5123, "VEC2", 3);
    for (accessor, stride) in [(at, 8), (normals, 4)] {
        draft.root["bufferViews"][accessor]["byteStride"] = json!(stride);
    }
    for accessor in [at, normals, uvs] {
        draft.root["accessors"][accessor]["normalized"] = json!(true);
    }
    draft.root["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    draft.primitive(json!({ "attributes": { "POSITION": at, "NORMAL": normals, "TEXCOORD_0": uvs } }));
    let mesh = draft.read().unwrap();
    assert_eq!(positions(&mesh), [[0.0; 3], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0]]);
    assert!(mesh.corners.iter().all(|corner| corner.normal == Vec3::NEG_Z));
    assert_eq!(mesh.corners[2].uv, Vec2::ONE);
}

#[test]
fn sparse_values_replace_the_base_and_zeros() {
    let mut draft = triangle();
    let (places, values) = (draft.view(&[2]), draft.view(&[0, 0, 0, 0, 0, 0, 64, 64, 0, 0, 0, 0]));
    draft.root["accessors"][0]["sparse"] = one_replaced(places, values);
    assert_eq!(positions(&draft.read().unwrap())[2], [0.0, 3.0, 0.0]);
    // A morph target that moves one vertex only.
    let target = draft.zeros_but_one(3, places, values);
    draft.root["meshes"][0]["primitives"][0]["targets"] = json!([{ "POSITION": target }]);
    draft.root["meshes"][0]["weights"] = json!([2.0]);
    assert_eq!(positions(&draft.read().unwrap())[2], [0.0, 9.0, 0.0]);
    draft.root["nodes"][0]["weights"] = json!([0.0]);
    assert_eq!(positions(&draft.read().unwrap())[2], [0.0, 3.0, 0.0], "the node's weights come first");
    let far = draft.view(&[9]);
    draft.root["accessors"][0]["sparse"] = one_replaced(far, values);
    assert!(
        message(&draft)
            .contains("/accessors/0 (POSITION of /meshes/0/primitives/0 (\"thing\")) replaces element 9 by /sparse/indices, but has 3 elements")
    );
}

#[test]
fn strips_and_fans_keep_their_winding() {
    let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
    for (mode, indices) in [(5, vec![0, 1, 2, 3]), (6, vec![0, 1, 3, 2]), (4, vec![0, 1, 2, 2, 1, 3])] {
        let mut draft = Draft::new();
        let (at, order) = (draft.vectors(&square), draft.indices(&indices));
        draft.primitive(json!({ "attributes": { "POSITION": at }, "indices": order, "mode": mode }));
        let mesh = draft.read().unwrap();
        assert_eq!((mesh.triangles.len(), mesh.corners.len()), (2, 4));
        assert!(mesh.corners.iter().all(|corner| corner.normal == Vec3::Z), "mode {mode}");
        assert_eq!(mesh.warnings.len(), 1, "{:?}", mesh.warnings);
    }
}

#[test]
fn skinned_meshes_stand_at_rest() {
    let mut draft = triangle();
    let joints = draft.accessor(&[0, 1, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0], 5121, "VEC4", 3);
    let weights = draft.floats("VEC4", &[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.5, 0.5, 0.0, 0.0]);
    let identity = glam::Mat4::IDENTITY.to_cols_array();
    let binds = draft.floats("MAT4", &[identity, identity].concat());
    let attributes = &mut draft.root["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = json!(joints);
    attributes["WEIGHTS_0"] = json!(weights);
    draft.root["skins"] = json!([{ "joints": [1, 2], "inverseBindMatrices": binds }]);
    // The translation of the skinned node must have no effect.
    draft.root["nodes"] = json!([
        { "mesh": 0, "skin": 0, "translation": [100.0, 0.0, 0.0] },
        { "children": [2], "translation": [0.0, 0.0, 1.0] },
        { "translation": [0.0, 0.0, 2.0] },
    ]);
    let mesh = draft.read().unwrap();
    assert_eq!(positions(&mesh), [[0.0, 0.0, 1.0], [1.0, 0.0, 3.0], [0.0, 1.0, 2.0]]);
    draft.root["skins"][0]["joints"] = json!([1, 2, 2]);
    assert!(message(&draft).contains("has 2 matrices for 3 joints"));
}

#[test]
fn bad_normals_are_made_and_counted() {
    let mut draft = Draft::new();
    let at = draft.vectors(&TRIANGLE);
    let normals = draft.vectors(&[[0.0; 3], [0.0, 0.0, 9.0], [f32::NAN, 0.0, 0.0]]);
    draft.primitive(json!({ "attributes": { "POSITION": at, "NORMAL": normals } }));
    let mesh = draft.read().unwrap();
    assert!(mesh.corners.iter().all(|corner| corner.normal == Vec3::Z));
    let replaced = "normals without a direction, replaced by ones that are smooth within 60 degrees: 2.";
    assert_eq!(mesh.warnings, [replaced, "normals whose length wasn't 1, scaled to it: 1."]);
    assert_eq!(mesh.repairs, Repairs { normals_replaced: 2, normals_rescaled: 1, ..Repairs::default() });
    // A transform makes no difference.
    draft.root["nodes"][0]["scale"] = json!([1.0, 3.0, -1.0]);
    let turned = draft.read().unwrap();
    assert_eq!((turned.repairs, turned.warnings), (mesh.repairs, mesh.warnings));
    // A transform that leaves no direction: each normal counts only once.
    draft.root["nodes"][0]["scale"] = json!([0.0, 0.0, 1.0]);
    assert_eq!(draft.read().unwrap().repairs, Repairs { normals_replaced: 3, ..Repairs::default() });
}

#[test]
fn repairs_are_counted_in_corners() {
    let mut draft = Draft::new();
    let at = draft.vectors(&[[0.0, 1e-40, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]]);
    let normals = draft.vectors(&[[0.0, 0.0, 1.0], [0.0, 0.0, 1e-30], [0.0, 0.0, 1e30], [0.0; 3]]);
    let indices = draft.indices(&[0, 1, 2, 2, 1, 3, 0, 1, 2]);
    draft.primitive(json!({ "attributes": { "POSITION": at, "NORMAL": normals }, "indices": indices }));
    let unlit = draft.vectors(&TRIANGLE);
    draft.primitive(json!({ "attributes": { "POSITION": unlit } }));
    let mesh = draft.read().unwrap();
    let expected = Repairs { normals_made: 3, normals_replaced: 1, normals_rescaled: 6, denormals: 2 };
    assert_eq!((mesh.repairs, mesh.warnings.len()), (expected, 4), "{:?}", mesh.warnings);
    assert!(mesh.corners.iter().all(|corner| corner.normal == Vec3::Z));
    assert_eq!(mesh.corners[0].position, Vec3::ZERO);
}

#[test]
fn morphed_normals_are_not_counted_as_rescaled() {
    let mut draft = triangle();
    let target = draft.vectors(&[[0.0, 3.0, 3.0]; 3]);
    draft.root["meshes"][0]["primitives"][0]["targets"] = json!([{ "NORMAL": target }]);
    draft.root["meshes"][0]["weights"] = json!([1.0]);
    let mesh = draft.read().unwrap();
    assert!(mesh.corners.iter().all(|corner| corner.normal.distance(Vec3::new(0.0, 0.6, 0.8)) < 1e-7));
    assert_eq!((mesh.repairs, mesh.warnings.len()), (Repairs::default(), 0));
}

#[test]
fn primitives_merge_by_material_and_weld() {
    let mut draft = Draft::new();
    let (at, n) = (draft.vectors(&TRIANGLE), draft.vectors(&[[0.0, 0.0, 1.0]; 3]));
    let mirrored = draft.vectors(&[[0.0, -0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]]);
    draft.root["materials"] = json!([
        { "name": "unused" },
        { "name": "red", "pbrMetallicRoughness": { "baseColorFactor": [1.0, 0.0, 0.0, 1.0] }, "doubleSided": true },
    ]);
    for (at, material) in [(at, 1), (mirrored, 1)] {
        draft.primitive(json!({ "attributes": { "POSITION": at, "NORMAL": n, "_HEAT": at }, "material": material }));
    }
    draft.primitive(json!({ "attributes": { "POSITION": at, "NORMAL": n } }));
    let mesh = draft.read().unwrap();
    let materials: Vec<_> = mesh.materials.iter().map(|m| (m.name.as_str(), m.triangles.clone())).collect();
    assert_eq!(materials, [("red", 0..2), ("default", 2..3)]);
    assert_eq!(mesh.materials[0].base_color, [1.0, 0.0, 0.0, 1.0]);
    assert_eq!(mesh.corners.len(), 4);
    assert_eq!(Topology::build(&mesh, &Progress::new()).unwrap().points.len(), 4);
}

/// Many vertices, in a few of which something is wrong, and some of which nothing uses.
fn large() -> Draft {
    let (count, side) = (150_000_u32, 300);
    let mut draft = Draft::new();
    let place = |i: u32| [(i % side) as f32, (i / side) as f32, if i % 50_021 == 77 { f32::NAN } else { 0.0 }];
    let normal = |i: u32| [0.0, (i % 5) as f32, if i.is_multiple_of(3) { 1.0 } else { 0.9 }];
    let uv = |i: u32| [i as f32, if i.is_multiple_of(40_009) { f32::INFINITY } else { 0.5 }];
    let places: Vec<_> = (0..count).map(place).collect();
    let normals: Vec<_> = (0..count).map(normal).collect();
    let uvs: Vec<_> = (0..count).flat_map(uv).collect();
    let (places, normals, uvs) = (draft.vectors(&places), draft.vectors(&normals), draft.floats("VEC2", &uvs));
    let squares = (0..count - side - 1).rev().filter(|i| i % side + 1 < side && i % 1009 > 20);
    let indices: Vec<u8> = squares
        .flat_map(|i| [i, i + 1, i + side, i + side, i + 1, i + side + 1])
        .chain([3])
        .flat_map(u32::to_le_bytes)
        .collect();
    let indices = draft.accessor(&indices, 5125, "SCALAR", indices.len() / 4);
    let attributes = json!({ "POSITION": places, "NORMAL": normals, "TEXCOORD_0": uvs });
    draft.primitive(json!({ "attributes": attributes.clone(), "indices": indices }));
    draft.primitive(json!({ "attributes": attributes, "mode": 5 }));
    draft.root["nodes"][0]["scale"] = json!([-2.0, 1.0, 3.0]);
    draft
}

#[test]
fn any_number_of_cores_reads_the_same_mesh() {
    let glb = large().glb();
    let [one, many] = [1, 7].map(|cores| on_threads(cores, || read_bytes(&glb)).expect("threads").unwrap());
    let corner = |own: &Corner| (own.position, own.normal, own.uv);
    assert!(one.mesh.corners.iter().map(corner).eq(many.mesh.corners.iter().map(corner)));
    assert!(one.mesh.triangles == many.mesh.triangles);
    assert_eq!((one.mesh.repairs, &one.warnings), (many.mesh.repairs, &many.warnings));
    let said = one.warnings.join(" ");
    for kind in ["uvs that aren't finite", "no whole triangle", "isn't a number", "length"] {
        assert!(said.contains(kind), "{kind}: {said}");
    }
}

#[test]
fn the_first_index_that_is_no_vertex_is_named_by_any_number_of_cores() {
    let mut draft = Draft::new();
    let places = draft.vectors(&TRIANGLE);
    let indices: Vec<u8> = (0..90_000_u32).flat_map(|i| (if i > 20_000 { i } else { i % 3 }).to_le_bytes()).collect();
    let indices = draft.accessor(&indices, 5125, "SCALAR", 90_000);
    draft.primitive(json!({ "attributes": { "POSITION": places }, "indices": indices }));
    for cores in [1, 7] {
        let said = on_threads(cores, || message(&draft)).expect("threads");
        assert!(said.contains("uses vertex 20001 at index 20001, but has 3 vertices"), "{said}");
    }
}
