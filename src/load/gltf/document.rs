//! Parses a document so that the `gltf` crate accepts it.

use ::gltf::Document;
use ::gltf::json::Root;
use ::gltf::json::validation::Error as ValidationError;
use serde_json::{Map, Value, json};

use super::cameras::CameraSources;
use super::extensions::Extensions;
use super::json::objects;
use super::lights::LightSources;
use super::material_lists::MaterialLists;
use super::node_parts::{self, NodeParts};
use super::notes::Notes;
use super::reach::{Beside, Reach};
use super::repair::{self, Faults};
use super::scenes::Scenes;
use super::schema_check::Replaced;
use super::{GltfError, extension_table, glb, json, schema, schema_check, variants};
use crate::memory_budget::Budget;
use crate::selection::Selection;
use geometry::mesh::{Borrowed, MemoryAccount, MemoryRefused};
use geometry::progress::Progress;

/// A validated document, the binary chunk of a `.glb`, and what was left out.
pub(super) struct Parsed {
    pub document: Document,
    pub blob: Option<Vec<u8>>,
    pub extensions: Extensions,
    /// The document's animations as JSON, not yet checked (see [`super::animations`]).
    pub animations: Vec<Value>,
    /// The document's materials and images, not yet checked (see [`super::materials`]).
    pub lists: MaterialLists,
    pub lights: LightSources,
    pub cameras: CameraSources,
    /// The names of the document's material variants.
    pub variants: Vec<String>,
    pub scenes: Scenes,
    pub parts: NodeParts,
    /// What the scene uses.
    pub reach: Reach,
    pub faults: Faults,
    pub notes: Notes,
}

/// Parses and validates a `.gltf` or `.glb`; the first bytes tell which. `selected` says which of its variants and scenes is read,
/// if the document has it.
///
/// # Errors
/// [`GltfError::NotGltf`], [`GltfError::Extension`], [`GltfError::Document`], and [`GltfError::Cancelled`].
pub(super) fn parse(
    bytes: Vec<u8>,
    selected: Selection,
    budget: &Budget,
    progress: &Progress,
) -> Result<Parsed, GltfError> {
    let mut notes = Notes::default();
    let json = Borrowed::from(budget);
    let (mut value, blob) = json_and_blob(bytes, budget, &mut notes, progress)?;
    let Value::Object(root) = &mut value else { return Err(not_gltf("its JSON isn't an object")) };
    check_version(root, &mut notes)?;
    extension_table::check(root, &mut notes)?;
    let requires_draco = extension_table::requires(root, schema::DRACO);
    let animations = take_animations(root);
    let variants = variants::choose(root, selected.variant, &mut notes);
    let scenes = Scenes::choose(root, selected.scene, &mut notes);
    let lists = MaterialLists::take(root, &mut notes);
    let lights = LightSources::take(root, &mut notes);
    let cameras = CameraSources::take(root, &mut notes);
    let show_hidden = selected.import.show_hidden;
    let beside = Beside { animations: &animations, images: &lists.images, requires_draco, show_hidden };
    let mut reach = Reach::of(root, &beside);
    let parts = node_parts::take(root, &reach, selected.hidden, budget)?;
    if parts.is_cut {
        reach = Reach::of(root, &beside);
    }
    let faults = repair::repair(root, &reach, (lists.materials.len(), requires_draco), budget, &mut notes)?;
    let extensions = checked(root, &faults, budget)?;
    let root: Root = serde_json::from_value(value).map_err(not_gltf)?;
    let document = Document::from_json(root).map_err(first_fault)?;
    drop(json);
    let too_large =
        |refused: MemoryRefused| GltfError::Document { pointer: "its JSON".to_owned(), reason: refused.into() };
    budget.hold(lists.bytes() + lights.bytes() + cameras.bytes()).map_err(too_large)?;
    Ok(Parsed {
        document,
        blob,
        extensions,
        animations,
        lists,
        lights,
        cameras,
        variants,
        scenes,
        parts,
        reach,
        faults,
        notes,
    })
}

/// The JSON of a file, and the binary chunk of a `.glb` file that has one.
///
/// # Errors
/// [`GltfError::NotGltf`], [`GltfError::Document`], and [`GltfError::Cancelled`].
fn json_and_blob(
    mut bytes: Vec<u8>,
    budget: &Budget,
    notes: &mut Notes,
    progress: &Progress,
) -> Result<(Value, Option<Vec<u8>>), GltfError> {
    if !glb::is_glb(&bytes) {
        return Ok((json::parse(&bytes, budget, progress)?, None));
    }
    let parts = glb::parts(&bytes)?;
    notes.extend(parts.warning);
    let value = json::parse(&bytes[parts.json], budget, progress)?;
    let Some(bin) = parts.bin else { return Ok((value, None)) };
    // In place, since a copy would take the file's size once more.
    bytes.truncate(bin.end);
    bytes.drain(..bin.start);
    Ok((value, Some(bytes)))
}

/// Takes the animations, which are read separately, so that an error in one doesn't keep the model from loading.
fn take_animations(root: &mut Map<String, Value>) -> Vec<Value> {
    match root.remove("animations") {
        Some(Value::Array(animations)) => animations,
        _ => Vec::new(),
    }
}

/// Checks a document that was repaired against the schema, and adds what the `gltf` crate asks for and files may lack. Returns what it
/// says about extensions.
///
/// # Errors
/// [`GltfError::Document`].
fn checked(root: &mut Map<String, Value>, faults: &Faults, budget: &Budget) -> Result<Extensions, GltfError> {
    schema_check::check(root, schema::DOCUMENT, &faults.replaced)?;
    let extensions = Extensions::of(root);
    add_spares(root, &faults.replaced);
    complete(root);
    complete_bare(root, budget)?;
    Ok(extensions)
}

fn not_gltf(reason: impl ToString) -> GltfError {
    GltfError::NotGltf { reason: reason.to_string() }
}

/// Returns the first error of the `gltf` crate's own validation, after ours found none. There may be as many errors as
/// members.
fn first_fault(error: ::gltf::Error) -> GltfError {
    let ::gltf::Error::Validation(faults) = error else { return not_gltf(error) };
    let Some((path, fault)) = faults.first() else { return not_gltf("it is invalid") };
    let pointer = format!("/{}", path.as_str().replace(['.', '['], "/").replace([']', '"'], ""));
    let reason = match fault {
        ValidationError::IndexOutOfBounds => "is an index of something that doesn't exist",
        ValidationError::Invalid => "has a value that isn't allowed",
        ValidationError::Missing => "is missing",
        ValidationError::Oversize => "is too large for any memory",
        ValidationError::Unsupported => "isn't supported",
    };
    GltfError::Document { pointer, reason: reason.to_owned() }
}

/// Checks that the document is one of glTF 2.0, and needs no later version.
fn check_version(root: &mut Map<String, Value>, notes: &mut Notes) -> Result<(), GltfError> {
    let asset = root.get("asset");
    let version = |name| asset.and_then(|asset| asset.get(name)).and_then(Value::as_str);
    let own = match (version("version"), asset.and_then(|asset| asset.get("version")).and_then(Value::as_f64)) {
        (Some(own), _) => own.to_owned(),
        (None, Some(number)) => {
            notes.push(format!("/asset/version is the number {number}, not text; it is read as {number:.1}."));
            format!("{number:.1}")
        }
        (None, None) => return Err(not_gltf("it has no /asset/version")),
    };
    let said = |own: &str| format!("{:?}", crate::uri::shown(own));
    if !own.starts_with("2.") {
        return Err(not_gltf(format!("its /asset/version is {}", said(&own))));
    }
    // A later 2.x can be read as far as it is 2.0, unless the document says that it can't.
    if let Some(least) = version("minVersion").filter(|least| !is_known(least)) {
        return Err(not_gltf(format!("its /asset/minVersion is {}, but 2.0 is read", said(least))));
    }
    root.insert("asset".to_owned(), json!({ "version": "2.0" }));
    Ok(())
}

/// Returns whether a minimum version is at most 2.0. One that is no version number is left aside.
fn is_known(least: &str) -> bool {
    let parts = least.split_once('.').map(|(major, minor)| (major.parse::<u64>(), minor.parse::<u64>()));
    !matches!(parts, Some((Ok(major), Ok(minor))) if (major, minor) > (2, 0))
}

/// Adds what empty elements refer to. A primitive without positions is never read, but the crate requires them.
fn add_spares(root: &mut Map<String, Value>, replaced: &Replaced) {
    let accessors = root.get("accessors").and_then(Value::as_array).map_or(0, Vec::len);
    let mut is_bare = false;
    for mesh in objects(root, "meshes") {
        for primitive in objects(mesh, "primitives") {
            let Some(Value::Object(attributes)) = primitive.get_mut("attributes") else { continue };
            attributes.entry("POSITION").or_insert_with(|| {
                is_bare = true;
                accessors.into()
            });
        }
    }
    let list = |root: &mut Map<String, Value>, name: &str, spare: Value| {
        if let Value::Array(values) = root.entry(name).or_insert_with(|| json!([])) {
            values.push(spare);
        }
    };
    if is_bare {
        list(root, "accessors", json!({ "componentType": 5126, "count": 0, "type": "VEC3" }));
    }
    let is_empty =
        |root: &Map<String, Value>, name: &str| root.get(name).and_then(Value::as_array).is_none_or(Vec::is_empty);
    let needs_view = is_bare || !replaced.accessors.is_empty();
    if is_empty(root, "bufferViews") && needs_view {
        list(root, "bufferViews", json!({ "buffer": 0, "byteLength": 0 }));
    }
    if is_empty(root, "buffers") && !is_empty(root, "bufferViews") {
        list(root, "buffers", json!({ "byteLength": 0, "uri": "" }));
    }
}

/// Adds members that the crate's validation requires.
fn complete(root: &mut Map<String, Value>) {
    for scene in objects(root, "scenes") {
        // A scene may be empty, but the crate requires the member.
        scene.entry("nodes").or_insert_with(|| json!([]));
    }
    let mut positions = Vec::new();
    for mesh in objects(root, "meshes") {
        let primitives = mesh.get("primitives").and_then(Value::as_array).into_iter().flatten();
        let position = |primitive: &Value| primitive.get("attributes")?.get("POSITION")?.as_u64();
        positions.extend(primitives.filter_map(position));
    }
    positions.sort_unstable();
    positions.dedup();
    let mut accessors: Vec<_> = objects(root, "accessors").collect();
    for index in positions {
        if let Some(accessor) = usize::try_from(index).ok().and_then(|index| accessors.get_mut(index)) {
            // The specification requires these, but some exporters leave them out, and they aren't used here.
            accessor.insert("min".to_owned(), json!([0.0, 0.0, 0.0]));
            accessor.insert("max".to_owned(), json!([0.0, 0.0, 0.0]));
        }
    }
}

/// Adds sparse values, none of them, to accessors without a buffer view: such an accessor is all zeros (glTF 2.0,
/// section 3.6.2) or compressed by Draco, but the crate requires a view or sparse values.
fn complete_bare(root: &mut Map<String, Value>, budget: &Budget) -> Result<(), GltfError> {
    let is_bare =
        |accessor: &&mut Map<String, Value>| ["bufferView", "sparse"].iter().all(|name| !accessor.contains_key(*name));
    let count = objects(root, "accessors").filter(is_bare).count();
    let too_large = |reason| GltfError::Document { pointer: "its JSON".to_owned(), reason };
    budget.borrow(count as u64 * 3 * json::PER_OBJECT).map_err(|refused| too_large(refused.into()))?;
    for accessor in objects(root, "accessors").filter(is_bare) {
        let (indices, values) = (json!({ "bufferView": 0, "componentType": 5121 }), json!({ "bufferView": 0 }));
        accessor.insert("sparse".to_owned(), json!({ "count": 0, "indices": indices, "values": values }));
    }
    Ok(())
}
