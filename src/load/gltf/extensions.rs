//! Extensions: which ones a document may require, and the data of those that are read.

use std::collections::BTreeMap;

use glam::Vec2;
use serde_json::{Map, Value};

use super::GltfError;
use super::schema::{DRACO, MESHOPT, TRANSFORM, is_attribute};

/// Extensions that a document may require: those that are read, and others that can be ignored, since they change
/// neither shape nor base colour.
const KNOWN: [&str; 17] = [
    "KHR_mesh_quantization",
    DRACO,
    MESHOPT,
    TRANSFORM,
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
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
    /// One for each of the document's materials.
    pub transforms: Vec<Option<UvTransform>>,
    /// One for each buffer view.
    pub compressed: Vec<Option<MeshoptExtension>>,
    /// For each buffer, whether it is only a fallback for programs that can't decompress, and may have no data.
    pub fallback: Vec<bool>,
    /// One for each primitive of each mesh.
    pub packed: Vec<Vec<Option<DracoExtension>>>,
}

/// `KHR_texture_transform` of a material's base colour texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct UvTransform {
    pub offset: Vec2,
    /// In radians.
    pub rotation: f32,
    pub scale: Vec2,
    /// The n of TEXCOORD_n, which replaces the texture's own.
    pub uv_set: Option<u32>,
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
        let info = |material: &Value| material.pointer("/pbrMetallicRoughness/baseColorTexture").cloned();
        let transform = |material| UvTransform::of(&extension(&info(material)?, TRANSFORM)?);
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
            transforms: list("materials").map(transform).collect(),
            compressed: list("bufferViews").map(|view| MeshoptExtension::of(&extension(view, MESHOPT)?)).collect(),
            fallback: list("buffers").map(|buffer| fallback(buffer).unwrap_or(false)).collect(),
            packed: list("meshes").map(primitives).collect(),
        }
    }
}

impl UvTransform {
    fn of(value: &Value) -> Option<Self> {
        let number = |value: &Value| Some(value.as_f64()? as f32);
        let pair = |name: &str| {
            let pair = value.get(name)?;
            Some(Vec2::new(number(pair.get(0)?)?, number(pair.get(1)?)?))
        };
        Some(Self {
            offset: pair("offset").unwrap_or(Vec2::ZERO),
            rotation: value.get("rotation").and_then(number).unwrap_or(0.0),
            scale: pair("scale").unwrap_or(Vec2::ONE),
            uv_set: value.get("texCoord").and_then(Value::as_u64).map(|set| set as u32),
        })
    }

    /// Applies scale, then a counter-clockwise rotation as seen in the image, whose v points down, then the offset.
    pub(crate) fn apply(&self, uv: Vec2) -> Vec2 {
        let (sin, cos) = self.rotation.sin_cos();
        let Vec2 { x, y } = uv * self.scale;
        Vec2::new(x * cos + y * sin, y * cos - x * sin) + self.offset
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn transforms_scale_then_turn_then_move() {
        let quarter = std::f32::consts::FRAC_PI_2;
        let (offset, scale) = (Vec2::new(0.5, 0.25), Vec2::new(2.0, 3.0));
        let transform = UvTransform { offset, rotation: quarter, scale, uv_set: None };
        // One to the right becomes two to the right, and then two upwards, where v is less.
        assert!(transform.apply(Vec2::X).abs_diff_eq(Vec2::new(0.5, -1.75), 1e-6), "{}", transform.apply(Vec2::X));
        assert!(transform.apply(Vec2::Y).abs_diff_eq(Vec2::new(3.5, 0.25), 1e-6), "{}", transform.apply(Vec2::Y));
        let none = UvTransform { offset: Vec2::ZERO, rotation: 0.0, scale: Vec2::ONE, uv_set: None };
        assert_eq!(none.apply(Vec2::new(0.3, 0.7)), Vec2::new(0.3, 0.7));
    }
}
