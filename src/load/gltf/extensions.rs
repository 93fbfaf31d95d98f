//! The data of those extensions that change the shape and are read.

use std::collections::HashMap;

use ::gltf::json::Root;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

use super::json::list;
use super::reach::has_data;
use super::schema::{DRACO, INSTANCING, KHR_MESHOPT, LOD, MESHOPT, VISIBILITY, is_attribute};

/// The data of a document's extensions.
#[derive(Debug, Default)]
pub(crate) struct Extensions {
    /// One for each buffer view.
    pub compressed: Vec<Option<MeshoptExtension>>,
    /// For each buffer, whether it is only a fallback for programs that can't decompress, and may have no data.
    pub fallback: Vec<bool>,
    /// One for each primitive of each mesh.
    pub packed: Vec<Vec<Option<DracoExtension>>>,
    /// By node, the instances of its mesh.
    pub instances: HashMap<usize, InstancingExtension>,
}

/// `EXT_mesh_gpu_instancing` of a node: the accessors of its instances' transforms.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
pub(crate) struct InstancingExtension {
    pub translation: Option<usize>,
    pub rotation: Option<usize>,
    pub scale: Option<usize>,
}

/// `EXT_meshopt_compression` or `KHR_meshopt_compression` of a buffer view.
#[derive(Clone, Debug, Deserialize)]
pub(crate) struct MeshoptExtension {
    /// Which of the two it is.
    #[serde(skip)]
    pub name: &'static str,
    pub buffer: usize,
    #[serde(rename = "byteOffset", default)]
    pub offset: u64,
    #[serde(rename = "byteLength")]
    pub length: u64,
    /// The number of bytes from one decompressed element to the next.
    #[serde(rename = "byteStride")]
    pub stride: usize,
    pub count: u64,
    pub mode: MeshoptMode,
    #[serde(default)]
    pub filter: MeshoptFilter,
}

/// `KHR_draco_mesh_compression` of a primitive that is read from the compressed data.
#[derive(Clone, Debug, Deserialize)]
pub(crate) struct DracoExtension {
    #[serde(rename = "bufferView")]
    pub view: usize,
    /// By name, the ids of attributes. Those of attributes that aren't read may be anything.
    #[serde(rename = "attributes")]
    ids: Map<String, Value>,
}

#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
pub(crate) enum MeshoptMode {
    Attributes,
    Triangles,
    Indices,
}

#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
pub(crate) enum MeshoptFilter {
    #[default]
    None,
    Octahedral,
    Quaternion,
    Exponential,
    Color,
}

impl Extensions {
    /// Reads the extensions of a document that has been [checked](super::schema_check).
    pub(crate) fn new(root: &Map<String, Value>) -> Self {
        let compressed = |view: &Value| {
            let (name, own) = compression(view)?;
            Some(MeshoptExtension { name, ..read(own)? })
        };
        let fallback = |buffer: &Value| compression(buffer)?.1.get("fallback")?.as_bool();
        let packed = |primitive: &Value| read(extension(primitive, DRACO)?);
        let primitives = |mesh: &Value| -> Vec<_> {
            mesh.get("primitives").and_then(Value::as_array).into_iter().flatten().map(packed).collect()
        };
        let instances = |(i, node): (usize, &Value)| Some((i, read(extension(node, INSTANCING)?.get("attributes")?)?));
        Self {
            compressed: list(root, "bufferViews").iter().map(compressed).collect(),
            fallback: list(root, "buffers").iter().map(|buffer| fallback(buffer).unwrap_or(false)).collect(),
            packed: list(root, "meshes").iter().map(primitives).collect(),
            instances: list(root, "nodes").iter().enumerate().filter_map(instances).collect(),
        }
    }

    /// Leaves aside compressed data of primitives that are also there uncompressed, for a document that doesn't require it.
    pub(crate) fn leave_out_packed(&mut self, root: &Root) {
        let primitives = root.meshes.iter().flat_map(|mesh| &mesh.primitives);
        for (packed, primitive) in self.packed.iter_mut().flatten().zip(primitives) {
            *packed = packed.take().filter(|_| !has_data(root, primitive));
        }
    }
}

/// For each node, whether it hides itself and what is below.
pub(super) fn hiding(root: &Map<String, Value>) -> Vec<bool> {
    let is_visible = |node| extension(node, VISIBILITY).and_then(|own| own.get("visible"));
    list(root, "nodes").iter().map(|node| is_visible(node) == Some(&Value::Bool(false))).collect()
}

/// The nodes that have further levels of detail, with the nodes that are these.
pub(super) fn levels(root: &Map<String, Value>) -> Vec<(usize, Vec<usize>)> {
    let levels = |(i, node): (usize, &Value)| Some((i, read(extension(node, LOD)?.get("ids")?)?));
    list(root, "nodes").iter().enumerate().filter_map(levels).collect()
}

/// The extension that compresses a buffer view, or that is about such views on a buffer, with its name.
fn compression(object: &Value) -> Option<(&'static str, &Value)> {
    [KHR_MESHOPT, MESHOPT].into_iter().find_map(|name| Some((name, extension(object, name)?)))
}

fn extension<'a>(object: &'a Value, name: &str) -> Option<&'a Value> {
    object.get("extensions")?.get(name).filter(|own| !own.is_null())
}

fn read<T: DeserializeOwned>(value: &Value) -> Option<T> {
    serde_json::from_value(value.clone()).ok()
}

impl InstancingExtension {
    /// Returns the first accessor, whose number of elements is that of the instances.
    pub(crate) fn first(&self) -> Option<usize> {
        self.translation.or(self.rotation).or(self.scale)
    }
}

impl DracoExtension {
    /// Returns the id of an attribute that is read.
    pub(crate) fn id(&self, name: &str) -> Option<u32> {
        self.ids.get(name).filter(|_| is_attribute(name))?.as_u64()?.try_into().ok()
    }

    /// Returns the number of attributes.
    pub(crate) fn len(&self) -> usize {
        self.ids.len()
    }
}
