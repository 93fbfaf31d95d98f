//! The data of those extensions that change the shape and are read.

use std::collections::{BTreeMap, HashMap};

use serde_json::{Map, Value};

use super::reach::{compression, list};
use super::schema::{DRACO, INSTANCING, is_attribute};

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
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct InstancingExtension {
    pub translation: Option<usize>,
    pub rotation: Option<usize>,
    pub scale: Option<usize>,
}

/// `EXT_meshopt_compression` or `KHR_meshopt_compression` of a buffer view.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct MeshoptExtension {
    /// Which of the two it is.
    pub name: &'static str,
    pub buffer: usize,
    pub offset: u64,
    pub length: u64,
    /// The number of bytes from one decompressed element to the next.
    pub stride: usize,
    pub count: u64,
    pub mode: MeshoptMode,
    pub filter: MeshoptFilter,
}

/// `KHR_draco_mesh_compression` of a primitive that is read from the compressed data.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct DracoExtension {
    pub view: usize,
    /// By name, the ids of the attributes that are read.
    pub ids: BTreeMap<String, u32>,
    /// The number of other attributes.
    pub others: usize,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum MeshoptMode {
    Attributes,
    Triangles,
    Indices,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum MeshoptFilter {
    None,
    Octahedral,
    Quaternion,
    Exponential,
    Color,
}

impl Extensions {
    /// Reads the extensions of a document that has been [repaired](super::repair) and [checked](super::schema_check).
    pub(crate) fn of(root: &Map<String, Value>) -> Self {
        let extension = |value: &'_ Value, name: &str| value.get("extensions")?.get(name).cloned();
        let fallback = |buffer| compression(buffer)?.1.get("fallback")?.as_bool();
        let packed = |primitive: &Value| DracoExtension::of(&extension(primitive, DRACO)?);
        let primitives = |mesh: &Value| -> Vec<_> {
            mesh.get("primitives").and_then(Value::as_array).into_iter().flatten().map(packed).collect()
        };
        let instances = |(i, node)| Some((i, InstancingExtension::of(&extension(node, INSTANCING)?)?));
        Self {
            compressed: list(root, "bufferViews")
                .iter()
                .map(|view| compression(view).and_then(|(name, value)| MeshoptExtension::of(name, value)))
                .collect(),
            fallback: list(root, "buffers").iter().map(|buffer| fallback(buffer).unwrap_or(false)).collect(),
            packed: list(root, "meshes").iter().map(primitives).collect(),
            instances: list(root, "nodes").iter().enumerate().filter_map(instances).collect(),
        }
    }
}

impl InstancingExtension {
    fn of(value: &Value) -> Option<Self> {
        let attributes = value.get("attributes")?.as_object()?;
        let accessor = |name| attributes.get(name)?.as_u64().map(|accessor| accessor as usize);
        let [translation, rotation, scale] = ["TRANSLATION", "ROTATION", "SCALE"].map(accessor);
        Some(Self { translation, rotation, scale })
    }
}

impl DracoExtension {
    fn of(value: &Value) -> Option<Self> {
        let attributes = value.get("attributes")?.as_object()?;
        let id = |(name, id): (&String, &Value)| Some((name.clone(), u32::try_from(id.as_u64()?).ok()?));
        let read = attributes.iter().filter(|(name, _)| is_attribute(name));
        let ids: BTreeMap<_, _> = read.filter_map(id).collect();
        let others = attributes.len() - ids.len();
        Some(Self { view: value.get("bufferView")?.as_u64()? as usize, ids, others })
    }
}

impl MeshoptExtension {
    fn of(name: &'static str, value: &Value) -> Option<Self> {
        let number = |name: &str| value.get(name)?.as_u64();
        let word = |name: &str| value.get(name)?.as_str();
        Some(Self {
            name,
            buffer: number("buffer")? as usize,
            offset: number("byteOffset").unwrap_or(0),
            length: number("byteLength")?,
            stride: number("byteStride")? as usize,
            count: number("count")?,
            mode: match word("mode")? {
                "TRIANGLES" => MeshoptMode::Triangles,
                "INDICES" => MeshoptMode::Indices,
                _ => MeshoptMode::Attributes,
            },
            filter: match word("filter") {
                Some("OCTAHEDRAL") => MeshoptFilter::Octahedral,
                Some("QUATERNION") => MeshoptFilter::Quaternion,
                Some("EXPONENTIAL") => MeshoptFilter::Exponential,
                Some("COLOR") => MeshoptFilter::Color,
                _ => MeshoptFilter::None,
            },
        })
    }
}
