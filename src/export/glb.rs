//! Writes binary glTF 2.0: positions, normals, uvs, and materials.

mod materials;

use std::borrow::Cow;

use glam::Vec3;
use gltf::json::validation::Checked::Valid;
use gltf::json::validation::USize64;
use gltf::json::{self, Index, Root};

use super::{ExportError, Exported};

use materials::Written;

/// The most bytes of binary data. The length of a GLB file has 32 bits, and its JSON needs room as well.
pub(super) const MAX_BYTES: u64 = u32::MAX as u64 - (1 << 24);

/// Returns the size of a mesh's attributes and indices in bytes.
pub(super) fn bytes(vertices: u64, triangles: u64) -> u64 {
    vertices * 32 + triangles * 12
}

/// Returns the bytes of a file; `path` is for messages.
///
/// # Errors
/// The file would be larger than 4 GiB, or a texture can't be encoded.
pub(super) fn encode(mesh: &Exported, path: &str) -> Result<Vec<u8>, ExportError> {
    let triangles: usize = mesh.triangles.iter().map(Vec::len).sum();
    let bytes = bytes(mesh.positions.len() as u64, triangles as u64);
    if bytes > MAX_BYTES {
        return Err(ExportError::TooLarge { path: path.to_owned(), triangles: triangles as u64 });
    }
    let mut writer = Writer { root: Root::default(), bin: Vec::with_capacity(bytes as usize) };
    let attributes = writer.attributes(mesh);
    let mut primitives = Vec::new();
    let mut written = Written::default();
    for (material, triangles) in mesh.mesh.materials.iter().zip(&mesh.triangles) {
        if triangles.is_empty() {
            continue;
        }
        let material = writer.material(material, &mut written, path)?;
        primitives.push(writer.primitive(attributes.clone(), triangles, material));
    }
    writer.finish(&mesh.mesh.name, primitives).map_err(|reason| ExportError::Texture { path: path.to_owned(), reason })
}

type Attributes = std::collections::BTreeMap<json::validation::Checked<json::mesh::Semantic>, Index<json::Accessor>>;

struct Writer {
    root: Root,
    bin: Vec<u8>,
}

impl Writer {
    /// Appends bytes as a new buffer view, which starts at a multiple of 4.
    fn view(&mut self, bytes: &[u8], target: Option<json::buffer::Target>) -> Index<json::buffer::View> {
        let offset = self.bin.len();
        self.bin.extend_from_slice(bytes);
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        self.root.push(json::buffer::View {
            buffer: Index::new(0),
            byte_length: USize64::from(bytes.len()),
            byte_offset: Some(USize64::from(offset)),
            byte_stride: None,
            name: None,
            target: target.map(Valid),
            extensions: None,
            extras: Default::default(),
        })
    }

    fn accessor(
        &mut self,
        bytes: &[u8],
        count: usize,
        kind: json::accessor::Type,
        component: json::accessor::ComponentType,
        bounds: Option<[Vec3; 2]>,
    ) -> Index<json::Accessor> {
        let target = match component {
            json::accessor::ComponentType::U32 => json::buffer::Target::ElementArrayBuffer,
            _ => json::buffer::Target::ArrayBuffer,
        };
        let view = self.view(bytes, Some(target));
        let value = |v: Vec3| json::Value::from(v.to_array().to_vec());
        self.root.push(json::Accessor {
            buffer_view: Some(view),
            byte_offset: None,
            count: USize64::from(count),
            component_type: Valid(json::accessor::GenericComponentType(component)),
            type_: Valid(kind),
            min: bounds.map(|[min, _]| value(min)),
            max: bounds.map(|[_, max]| value(max)),
            name: None,
            normalized: false,
            sparse: None,
            extensions: None,
            extras: Default::default(),
        })
    }

    fn attributes(&mut self, mesh: &Exported) -> Attributes {
        use json::accessor::{ComponentType::F32, Type};
        let zero = mesh.positions.first().copied().unwrap_or_default();
        let bounds = mesh.positions.iter().fold([zero; 2], |[min, max], p| [min.min(*p), max.max(*p)]);
        let count = mesh.positions.len();
        let positions = bytemuck::cast_slice(&mesh.positions);
        Attributes::from([
            (Valid(json::mesh::Semantic::Positions), self.accessor(positions, count, Type::Vec3, F32, Some(bounds))),
            (
                Valid(json::mesh::Semantic::Normals),
                self.accessor(bytemuck::cast_slice(&mesh.normals), count, Type::Vec3, F32, None),
            ),
            (
                Valid(json::mesh::Semantic::TexCoords(0)),
                self.accessor(bytemuck::cast_slice(&mesh.uvs), count, Type::Vec2, F32, None),
            ),
        ])
    }

    fn primitive(
        &mut self,
        attributes: Attributes,
        triangles: &[[u32; 3]],
        material: Index<json::Material>,
    ) -> json::mesh::Primitive {
        let (bytes, count) = (bytemuck::cast_slice(triangles), triangles.len() * 3);
        let indices =
            self.accessor(bytes, count, json::accessor::Type::Scalar, json::accessor::ComponentType::U32, None);
        json::mesh::Primitive {
            attributes,
            indices: Some(indices),
            material: Some(material),
            mode: Valid(json::mesh::Mode::Triangles),
            targets: None,
            extensions: None,
            extras: Default::default(),
        }
    }

    fn finish(mut self, name: &str, primitives: Vec<json::mesh::Primitive>) -> Result<Vec<u8>, String> {
        // A mesh without primitives is not valid glTF; an empty scene is.
        if !primitives.is_empty() {
            let mesh = self.root.push(json::Mesh {
                name: Some(name.to_owned()),
                primitives,
                weights: None,
                extensions: None,
                extras: Default::default(),
            });
            self.root.push(json::Node { mesh: Some(mesh), ..Default::default() });
        }
        self.root.asset.generator = Some(concat!("pnaen ", env!("CARGO_PKG_VERSION")).to_owned());
        let nodes = (0..self.root.nodes.len() as u32).map(Index::new).collect();
        let scene = self.root.push(json::Scene { name: None, nodes, extensions: None, extras: Default::default() });
        self.root.scene = Some(scene);
        self.root.push(json::Buffer {
            byte_length: USize64::from(self.bin.len()),
            name: None,
            uri: None,
            extensions: None,
            extras: Default::default(),
        });
        let json = self.root.to_vec().map_err(|error| error.to_string())?;
        let glb = gltf::binary::Glb {
            header: gltf::binary::Header { magic: *b"glTF", version: 2, length: 0 },
            json: Cow::Owned(json),
            bin: Some(Cow::Owned(self.bin)),
        };
        glb.to_vec().map_err(|error| error.to_string())
    }
}

#[cfg(test)]
mod tests;
