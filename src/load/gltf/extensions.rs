//! Extensions: which ones a document may require, and the data of those that are read.

use std::collections::BTreeMap;

use serde_json::{Map, Value};

use super::GltfError;
use super::schema::{BASISU, DRACO, MESHOPT, TRANSFORM, WEBP, is_attribute};

/// Extensions that a document may require: those that are read, and others that can be ignored, since they don't change the
/// shape.
const KNOWN: [&str; 20] = [
    "KHR_mesh_quantization",
    DRACO,
    MESHOPT,
    TRANSFORM,
    BASISU,
    WEBP,
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
];

/// The data of a document's extensions.
#[derive(Debug, Default)]
pub(crate) struct Extensions {
    /// One for each buffer view.
    pub compressed: Vec<Option<MeshoptExtension>>,
    /// For each buffer, whether it is only a fallback for programs that can't decompress, and may have no data.
    pub fallback: Vec<bool>,
    /// One for each primitive of each mesh.
    pub packed: Vec<Vec<Option<DracoExtension>>>,
}

/// `EXT_meshopt_compression` of a buffer view.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct MeshoptExtension {
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
}

/// Checks that all required extensions are known.
/// # Errors
/// [`GltfError::Extension`] for the first that isn't.
pub(super) fn check_required(root: &Map<String, Value>) -> Result<(), GltfError> {
    let required = root.get("extensionsRequired").and_then(Value::as_array).into_iter().flatten();
    let names = required.enumerate().filter_map(|(i, name)| Some((i, name.as_str()?)));
    let Some((place, name)) = names.into_iter().find(|(_, name)| !KNOWN.contains(name)) else { return Ok(()) };
    Err(GltfError::Extension { place, name: crate::load::uri::shown(name) })
}

/// Returns whether a document requires this extension.
pub(super) fn requires(root: &Map<String, Value>, extension: &str) -> bool {
    let required = root.get("extensionsRequired").and_then(Value::as_array);
    required.is_some_and(|names| names.iter().any(|name| name == extension))
}

impl Extensions {
    /// Reads the extensions of a document that has been [checked](super::schema_check). If the document doesn't require
    /// Draco, primitives that also have uncompressed data are read from that.
    pub(crate) fn of(root: &Map<String, Value>, requires_draco: bool) -> Self {
        let list = |name: &str| root.get(name).and_then(Value::as_array).into_iter().flatten();
        let extension = |value: &'_ Value, name: &str| value.get("extensions")?.get(name).cloned();
        let fallback = |buffer| extension(buffer, MESHOPT)?.get("fallback")?.as_bool();
        let is_beside = |primitive: &Value| {
            let position = primitive.pointer("/attributes/POSITION")?.as_u64()?;
            root.get("accessors")?.get(usize::try_from(position).ok()?)?.get("bufferView")
        };
        let packed = |primitive: &Value| {
            let extension = extension(primitive, DRACO).filter(|_| requires_draco || is_beside(primitive).is_none())?;
            DracoExtension::of(&extension)
        };
        let primitives = |mesh: &Value| -> Vec<_> {
            mesh.get("primitives").and_then(Value::as_array).into_iter().flatten().map(packed).collect()
        };
        Self {
            compressed: list("bufferViews").map(|view| MeshoptExtension::of(&extension(view, MESHOPT)?)).collect(),
            fallback: list("buffers").map(|buffer| fallback(buffer).unwrap_or(false)).collect(),
            packed: list("meshes").map(primitives).collect(),
        }
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
    fn of(value: &Value) -> Option<Self> {
        let number = |name: &str| value.get(name)?.as_u64();
        let word = |name: &str| value.get(name)?.as_str();
        Some(Self {
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
                _ => MeshoptFilter::None,
            },
        })
    }
}
