//! Writes binary glTF 2.0: the attributes of vertices, the materials with their images, and the lights. What other programs draw
//! of it is what this one draws, as far as they know the extensions.

mod lights;
mod materials;

use std::borrow::Cow;
use std::collections::BTreeMap;

use glam::{Vec3, Vec4};
use serde_json::{Value, json};

use super::{ExportError, Exported};
use geometry::mesh::{CornerDetail, Mesh, Texture};

use materials::{UvSet, UvSets};

/// The most bytes of binary data. The length of a GLB file has 32 bits, and its JSON needs room as well.
pub(super) const MAX_BYTES: u64 = u32::MAX as u64 - (1 << 24);

const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;
const TRIANGLES: u32 = 4;

/// What a written vertex has beside position, normal and texture coordinates: only what the mesh's materials need.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Attributes {
    /// The sets of texture coordinates that maps use beside those of the base colour.
    sets: [bool; 2],
    colors: bool,
    tangents: bool,
}

impl Attributes {
    /// What the vertices of a mesh need.
    fn new(mesh: &Mesh) -> Self {
        let Some(details) = &mesh.details else { return Self::default() };
        let looks = || mesh.materials.iter().map(|material| &material.look);
        let sets = [0, 1].map(|set| looks().any(|look| look.uv_sets()[set]));
        let needs_tangents = looks().any(|look| look.tangent_uv().is_some());
        Self {
            sets,
            colors: details.iter().any(|detail| detail.color != Vec4::ONE),
            tangents: needs_tangents && details.iter().any(|detail| detail.tangent != Vec3::ZERO),
        }
    }

    /// Returns how much memory a vertex takes in a .glb file: floats for position, normal and texture coordinates, and for these.
    fn bytes(self) -> u64 {
        let sets = self.sets.iter().filter(|is_used| **is_used).count() as u64;
        32 + 8 * sets + 16 * (u64::from(self.colors) + u64::from(self.tangents))
    }
}

/// Returns the size of the attributes and indices of so many vertices and triangles of a mesh, in bytes.
pub(super) fn bytes(mesh: &Mesh, vertices: u64, triangles: u64) -> u64 {
    vertices * Attributes::new(mesh).bytes() + triangles * 12
}

/// Returns the bytes of a file, and sentences about what is drawn but has no place in it; `path` is for messages.
///
/// # Errors
/// The file would be larger than 4 GiB, or a texture can't be encoded.
pub(super) fn encode(mesh: &Exported, path: &str) -> Result<(Vec<u8>, Vec<String>), ExportError> {
    let triangles: usize = mesh.triangles.iter().map(Vec::len).sum();
    let used = Attributes::new(mesh.mesh);
    let bytes = bytes(mesh.mesh, mesh.positions.len() as u64, triangles as u64);
    if bytes > MAX_BYTES {
        return Err(ExportError::TooLarge { path: path.to_owned(), triangles: triangles as u64 });
    }
    let mut writer = Writer { path: path.to_owned(), bin: Vec::with_capacity(bytes as usize), ..Writer::default() };
    let accessors = writer.vertices(mesh, used);
    let mut primitives = Vec::new();
    for (material, triangles) in mesh.mesh.materials.iter().zip(&mesh.triangles) {
        if triangles.is_empty() {
            continue;
        }
        let sets = UvSets::new(material);
        let index = writer.material(material, &sets)?;
        primitives.push(writer.primitive(accessors.attributes(&sets), triangles, index));
    }
    writer.finish(mesh, primitives).map_err(|reason| ExportError::Texture { path: path.to_owned(), reason })
}

/// A document that is being written, and its binary data.
#[derive(Default)]
struct Writer {
    /// For messages.
    path: String,
    bin: Vec<u8>,
    /// The document's lists by their names; none is empty, which wouldn't be valid glTF.
    lists: BTreeMap<&'static str, Vec<Value>>,
    warnings: Vec<String>,
    /// The images that were written so far, which materials share, in the order of their list.
    written: Vec<*const Texture>,
}

/// Indices of the accessors of all vertices.
struct VertexAccessors {
    /// Those that every primitive has, as its attributes.
    common: Value,
    /// The texture coordinates of the base colour, and the file's sets that are used.
    uv: usize,
    sets: [Option<usize>; 2],
}

impl VertexAccessors {
    /// Returns the attributes of a primitive with these texture coordinates.
    fn attributes(&self, sets: &UvSets) -> Value {
        let mut attributes = self.common.clone();
        for (n, set) in sets.written().enumerate() {
            let accessor = match set {
                UvSet::Own => Some(self.uv),
                UvSet::File(set) => self.sets[set],
            };
            // Without details, maps are drawn at the texture coordinates of the base colour.
            attributes[format!("TEXCOORD_{n}")] = json!(accessor.unwrap_or(self.uv));
        }
        attributes
    }
}

impl Writer {
    /// Appends to one of the document's lists, and returns the index.
    fn push(&mut self, list: &'static str, value: Value) -> usize {
        let list = self.lists.entry(list).or_default();
        list.push(value);
        list.len() - 1
    }

    /// The index of a value in one of the lists, to which it is appended unless it is there.
    fn shared(&mut self, list: &'static str, value: Value) -> usize {
        let known = self.lists.get(list).and_then(|all| all.iter().position(|own| *own == value));
        known.unwrap_or_else(|| self.push(list, value))
    }

    /// Appends bytes as a new buffer view, which starts at a multiple of 4.
    fn view(&mut self, bytes: &[u8], target: Option<u32>) -> usize {
        let offset = self.bin.len();
        self.bin.extend_from_slice(bytes);
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        let mut view = json!({ "buffer": 0, "byteOffset": offset, "byteLength": bytes.len() });
        if let Some(target) = target {
            view["target"] = json!(target);
        }
        self.push("bufferViews", view)
    }

    /// Appends vectors of floats, one for each vertex.
    fn floats<const N: usize>(&mut self, values: &[[f32; N]]) -> usize {
        let view = self.view(bytemuck::cast_slice(values.as_flattened()), Some(ARRAY_BUFFER));
        let (kind, count) = (format!("VEC{N}"), values.len());
        self.push("accessors", json!({ "bufferView": view, "componentType": FLOAT, "count": count, "type": kind }))
    }

    fn vertices(&mut self, mesh: &Exported, used: Attributes) -> VertexAccessors {
        let zero = mesh.positions.first().copied().unwrap_or_default();
        let [min, max] = mesh.positions.iter().fold([zero; 2], |[min, max], p| [min.min(*p), max.max(*p)]);
        let position = self.floats::<3>(bytemuck::cast_slice(&mesh.positions));
        let accessor = &mut self.lists.entry("accessors").or_default()[position];
        (accessor["min"], accessor["max"]) = (json!(min.to_array()), json!(max.to_array()));
        let normal = self.floats::<3>(bytemuck::cast_slice(&mesh.normals));
        let uv = self.floats::<2>(bytemuck::cast_slice(&mesh.uvs));
        let mut common = json!({ "POSITION": position, "NORMAL": normal });
        let (details, mut sets) = (&mesh.details, [None; 2]);
        for set in (0..2).filter(|&set| used.sets[set]) {
            let uvs: Vec<_> = details.iter().map(|detail| detail.uvs[set].to_array()).collect();
            sets[set] = Some(self.floats(&uvs));
        }
        if used.colors {
            let colors: Vec<_> = details.iter().map(|detail| detail.color.to_array()).collect();
            common["COLOR_0"] = json!(self.floats(&colors));
        }
        if used.tangents {
            let tangents = details.iter().zip(&mesh.normals).map(|(detail, normal)| tangent(detail, *normal));
            common["TANGENT"] = json!(self.floats(&tangents.collect::<Vec<_>>()));
        }
        VertexAccessors { common, uv, sets }
    }

    fn primitive(&mut self, attributes: Value, triangles: &[[u32; 3]], material: usize) -> Value {
        let view = self.view(bytemuck::cast_slice(triangles), Some(ELEMENT_ARRAY_BUFFER));
        let count = triangles.len() * 3;
        let accessor = json!({ "bufferView": view, "componentType": UNSIGNED_INT, "count": count, "type": "SCALAR" });
        let indices = self.push("accessors", accessor);
        json!({ "attributes": attributes, "indices": indices, "material": material, "mode": TRIANGLES })
    }

    /// Adds an extension to an object, and names it in the document.
    fn extend(&mut self, object: &mut Value, name: &'static str, members: Value) {
        object["extensions"][name] = members;
        self.shared("extensionsUsed", json!(name));
    }

    fn finish(mut self, mesh: &Exported, primitives: Vec<Value>) -> Result<(Vec<u8>, Vec<String>), String> {
        let mut root = json!({
            "asset": { "version": "2.0", "generator": concat!("pnaen ", env!("CARGO_PKG_VERSION")) },
        });
        // A mesh without primitives is not valid glTF; an empty scene is.
        if !primitives.is_empty() {
            root["meshes"] = json!([{ "name": mesh.mesh.name, "primitives": primitives }]);
            self.push("nodes", json!({ "mesh": 0 }));
        }
        self.lights(&mesh.mesh.lights, &mut root);
        root["scene"] = json!(0);
        root["scenes"] = json!([{}]);
        if let Some(nodes) = self.lists.get("nodes") {
            root["scenes"][0]["nodes"] = (0..nodes.len()).collect();
        }
        if !self.bin.is_empty() {
            root["buffers"] = json!([{ "byteLength": self.bin.len() }]);
        }
        for (name, list) in self.lists {
            root[name] = Value::Array(list);
        }
        let json = serde_json::to_vec(&root).map_err(|error| error.to_string())?;
        let glb = gltf::binary::Glb {
            header: gltf::binary::Header { magic: *b"glTF", version: 2, length: 0 },
            json: Cow::Owned(json),
            bin: (!self.bin.is_empty()).then_some(Cow::Owned(self.bin)),
        };
        Ok((glb.to_vec().map_err(|error| error.to_string())?, self.warnings))
    }
}

/// Returns the tangent of a vertex as glTF has it: of unit length, also where none is known.
fn tangent(detail: &CornerDetail, normal: Vec3) -> [f32; 4] {
    let known = detail.tangent.try_normalize();
    let tangent = known.unwrap_or_else(|| normal.try_normalize().unwrap_or(Vec3::Z).any_orthonormal_vector());
    Vec4::from((tangent, detail.bitangent_sign)).to_array()
}

#[cfg(test)]
mod tests;
