//! Parses a document for the `gltf` crate. Our schema is the only check: it holds whatever the crate takes for granted.

use std::cell::RefCell;

use ::gltf::Document;
use ::gltf::json::Root;
use serde_json::{Map, Value, json};

use super::cameras::{self, CameraSource};
use super::carried::Carried;
use super::extensions::Extensions;
use super::json::{list, objects};
use super::lenient::take_list;
use super::lights;
use super::node_parts::{self, NodeParts};
use super::notes::Notes;
use super::reach::Reach;
use super::repair::Settled;
use super::schema_check::Faults;
use super::texture_source::MaterialLists;
use super::{
    GltfError, extension_table, extensions, glb, json, morph_targets, repair, scenes, schema, schema_check, variants,
};
use crate::loaded_mesh::Contents;
use crate::memory_budget::Budget;
use crate::selection::Selection;
use geometry::mesh::{Borrowed, Light};
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
    pub lights: Carried<Light>,
    pub cameras: Carried<CameraSource>,
    /// What the document offers, still without its parts.
    pub contents: Contents,
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
    let mut notes = RefCell::default();
    let json = Borrowed::from(budget);
    let (mut value, blob) = json_and_blob(bytes, budget, notes.get_mut(), progress)?;
    let Value::Object(root) = &mut value else { return Err(not_gltf("its JSON isn't an object")) };
    check_version(root, notes.get_mut())?;
    extension_table::check(root, notes.get_mut())?;
    let requires_draco = extension_table::requires(root, schema::DRACO);
    // They are read separately, so that an error in one doesn't keep the model from loading.
    let animations = take_list(root, "animations", "there are no animations", &notes);
    let variants = variants::choose(root, selected.variant, notes.get_mut());
    let (scenes, scene) = scenes::choose(root, selected.scene, notes.get_mut());
    let morph_targets = morph_targets::choose(root, &selected);
    let contents = Contents { variants, scenes, scene, morph_targets, parts: Vec::new() };
    let lists = MaterialLists::take(root, &notes);
    let lights = lights::take(root, &notes);
    let cameras = cameras::take(root, &notes);
    let hiding = if selected.import.show_hidden { Vec::new() } else { extensions::hiding(root) };
    let levels = extensions::levels(root);
    let rotations = repair::before_check(root, budget)?;
    // The `gltf` crate takes nothing for granted that this doesn't check.
    let faults = schema_check::check(root, schema::DOCUMENT)?;
    // Empty views refer to a buffer.
    if list(root, "buffers").is_empty() && !list(root, "bufferViews").is_empty() {
        root.insert("buffers".to_owned(), json!([{ "byteLength": 0 }]));
    }
    let mut extensions = Extensions::new(root);
    for (_, scene) in objects(root, "scenes") {
        scene.entry("nodes").or_insert_with(|| json!([]));
    }
    let mut root: Root = serde_json::from_value(value).map_err(not_gltf)?;
    if !requires_draco {
        extensions.leave_out_packed(&root);
    }
    let levels = node_parts::place_levels(&mut root, &levels);
    let mut reach = Reach::new(&root, &faults, hiding);
    let parts = node_parts::take(&mut root, &extensions.instances, &reach, &levels, &selected, budget)?;
    if parts.is_cut {
        reach = Reach::new(&root, &faults, reach.hiding);
    }
    let materials = lists.materials.len();
    let settled = Settled { reach: &reach, faults: &faults, rotations, materials, requires_draco };
    settled.settle(&mut root, notes.get_mut())?;
    let document = Document::from_json_without_validation(root);
    drop(json);
    budget.hold(lists.bytes()).map_err(GltfError::large_json)?;
    Ok(Parsed {
        document,
        blob,
        extensions,
        animations,
        lists,
        lights,
        cameras,
        contents,
        parts,
        reach,
        faults,
        notes: notes.into_inner(),
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
    if !bytes.starts_with(b"glTF") {
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

fn not_gltf(reason: impl ToString) -> GltfError {
    GltfError::NotGltf { reason: reason.to_string() }
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
