//! The members of a document that are read, and the values that each may have. [Animations](super::animations) and
//! [materials](super::material_source) aren't included.
//!
//! Source: glTF 2.0 specification, section 5 (properties reference).

/// A member of an object.
pub(super) struct Field {
    pub name: &'static str,
    pub kind: MemberKind,
    pub required: bool,
}

/// The values that a member may have.
pub(super) enum MemberKind {
    /// An index into one of the document's lists.
    Index(&'static str),
    /// A whole number.
    Whole {
        least: u64,
        most: u64,
    },
    /// A list of numbers that fit an f32, with this length if there is one.
    Numbers(Option<usize>),
    Text,
    /// Text; anything else is ignored.
    Name,
    /// True or false.
    Flag,
    /// One of these numbers.
    Code(&'static [u64]),
    /// One of these words.
    Word(&'static [&'static str]),
    Object(&'static [Field]),
    /// A list of these.
    List(&'static MemberKind),
    /// Objects, of which one that can't be read is replaced by this one.
    Parts(&'static [Field], &'static str),
    /// Indices of accessors by attribute name; the function says which names are read.
    Attributes(fn(&str) -> bool),
    /// Whole numbers of 32 bits by attribute name; the function says which names are read.
    Ids(fn(&str) -> bool),
}

use MemberKind::{Attributes, Code, Flag, Ids, Index, List, Name, Numbers, Object, Parts, Text, Whole, Word};

const fn needed(name: &'static str, kind: MemberKind) -> Field {
    Field { name, kind, required: true }
}

const fn may(name: &'static str, kind: MemberKind) -> Field {
    Field { name, kind, required: false }
}

/// A number of bytes or elements.
const COUNT: MemberKind = Whole { least: 0, most: u64::MAX };

/// The extension that compresses buffer views, by its names; the second one has a filter more. On a buffer it marks one that is only
/// a fallback.
pub(super) const MESHOPT: &str = "EXT_meshopt_compression";
pub(super) const KHR_MESHOPT: &str = "KHR_meshopt_compression";
/// The extension that compresses primitives.
pub(super) const DRACO: &str = "KHR_draco_mesh_compression";
/// The extensions that name another image of a texture.
pub(super) const BASISU: &str = "KHR_texture_basisu";
pub(super) const WEBP: &str = "EXT_texture_webp";
/// The extension that shows a node's mesh several times.
pub(super) const INSTANCING: &str = "EXT_mesh_gpu_instancing";
/// The extension that names the further levels of detail of a node.
pub(super) const LOD: &str = "MSFT_lod";
/// The extension that hides nodes.
pub(super) const VISIBILITY: &str = "KHR_node_visibility";
/// The extension that transforms texture coordinates.
pub(super) const TRANSFORM: &str = "KHR_texture_transform";

pub(super) static DOCUMENT: &[Field] = &[
    needed("asset", Object(&[needed("version", Text)])),
    may("nodes", Parts(NODE, "{}")),
    may("meshes", Parts(MESH, r#"{"primitives":[]}"#)),
    may("skins", Parts(SKIN, r#"{"joints":[]}"#)),
    may("materials", List(&Object(&[]))),
    may("accessors", Parts(ACCESSOR, r#"{"componentType":5126,"count":0,"type":"SCALAR"}"#)),
    may("bufferViews", Parts(VIEW, r#"{"buffer":0,"byteLength":0}"#)),
    may("buffers", Parts(BUFFER, r#"{"byteLength":0}"#)),
    may("scene", Index("scenes")),
    may("scenes", Parts(&[may("nodes", List(&Index("nodes")))], "{}")),
];

static NODE: &[Field] = &[
    may("name", Name),
    may("children", List(&Index("nodes"))),
    may("mesh", Index("meshes")),
    may("skin", Index("skins")),
    may("matrix", Numbers(Some(16))),
    may("translation", Numbers(Some(3))),
    may("rotation", Numbers(Some(4))),
    may("scale", Numbers(Some(3))),
    may("weights", Numbers(None)),
    may("extensions", Object(&[may(INSTANCING, Object(INSTANCES))])),
];

static INSTANCES: &[Field] =
    &[needed("attributes", Attributes(|name| ["TRANSLATION", "ROTATION", "SCALE"].contains(&name)))];

static MESH: &[Field] =
    &[may("name", Name), needed("primitives", List(&Object(PRIMITIVE))), may("weights", Numbers(None))];

static PRIMITIVE: &[Field] = &[
    needed("attributes", Attributes(is_attribute)),
    may("indices", Index("accessors")),
    may("material", Index("materials")),
    may("mode", Code(&[0, 1, 2, 3, 4, 5, 6])),
    may("targets", List(&Attributes(|name| ["POSITION", "NORMAL", "TANGENT"].contains(&name)))),
    may("extensions", Object(&[may(DRACO, Object(PACKED))])),
];

static PACKED: &[Field] = &[needed("bufferView", Index("bufferViews")), needed("attributes", Ids(is_attribute))];

static SKIN: &[Field] = &[needed("joints", List(&Index("nodes"))), may("inverseBindMatrices", Index("accessors"))];

static ACCESSOR: &[Field] = &[
    may("bufferView", Index("bufferViews")),
    may("byteOffset", COUNT),
    needed("componentType", Code(&[5120, 5121, 5122, 5123, 5125, 5126])),
    needed("count", COUNT),
    needed("type", Word(&["SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"])),
    may("normalized", Flag),
    may("sparse", Object(SPARSE)),
];

static SPARSE: &[Field] = &[
    needed("count", COUNT),
    needed("indices", Object(SPARSE_INDICES)),
    needed("values", Object(&[needed("bufferView", Index("bufferViews")), may("byteOffset", COUNT)])),
];

static SPARSE_INDICES: &[Field] = &[
    needed("bufferView", Index("bufferViews")),
    may("byteOffset", COUNT),
    needed("componentType", Code(&[5121, 5123, 5125])),
];

static VIEW: &[Field] = &[
    needed("buffer", Index("buffers")),
    may("byteOffset", COUNT),
    needed("byteLength", COUNT),
    may("byteStride", Whole { least: 4, most: 252 }),
    may("extensions", Object(&[may(MESHOPT, Object(&COMPRESSED)), may(KHR_MESHOPT, Object(&KHR_COMPRESSED))])),
];

static COMPRESSED: [Field; 7] = compressed(&["NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"]);
static KHR_COMPRESSED: [Field; 7] = compressed(&["NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL", "COLOR"]);

const fn compressed(filters: &'static [&'static str]) -> [Field; 7] {
    [
        needed("buffer", Index("buffers")),
        may("byteOffset", COUNT),
        needed("byteLength", COUNT),
        needed("byteStride", Whole { least: 1, most: 256 }),
        needed("count", COUNT),
        needed("mode", Word(&["ATTRIBUTES", "TRIANGLES", "INDICES"])),
        may("filter", Word(filters)),
    ]
}

const FALLBACK: MemberKind = Object(&[may("fallback", Flag)]);

static BUFFER: &[Field] = &[
    needed("byteLength", COUNT),
    may("uri", Text),
    may("extensions", Object(&[may(MESHOPT, FALLBACK), may(KHR_MESHOPT, FALLBACK)])),
];

/// Returns whether an attribute of a primitive is read.
pub(super) fn is_attribute(name: &str) -> bool {
    let is_influence = ["JOINTS_", "WEIGHTS_"].iter().any(|prefix| is_numbered(name, prefix));
    ["POSITION", "NORMAL"].contains(&name) || is_influence || is_detail(name)
}

/// Returns whether an attribute is one that a primitive can do without, since it doesn't change the shape.
pub(super) fn is_detail(name: &str) -> bool {
    ["COLOR_0", "TANGENT"].contains(&name) || is_numbered(name, "TEXCOORD_")
}

fn is_numbered(name: &str, prefix: &str) -> bool {
    name.strip_prefix(prefix).is_some_and(|set| set.parse::<u32>().is_ok())
}
