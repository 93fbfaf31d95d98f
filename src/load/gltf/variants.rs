//! Material variants: a primitive may have another material for each of them.
//!
//! Source: Khronos, `KHR_materials_variants`,
//! <https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Khronos/KHR_materials_variants>.

use serde_json::{Map, Value};

use super::json::objects;
use super::notes::Notes;
use super::scenes;

const VARIANTS: &str = "KHR_materials_variants";

/// Returns the names of the document's variants. If `wanted` is one of them, primitives get the materials that they have for it;
/// one that has none for it keeps its own.
pub(super) fn choose(root: &mut Map<String, Value>, wanted: Option<&str>, notes: &mut Notes) -> Vec<String> {
    let names = names(root, notes);
    let Some(wanted) = wanted.and_then(|wanted| names.iter().position(|name| name == wanted)) else { return names };
    for (_, mesh) in objects(root, "meshes") {
        for (_, primitive) in objects(mesh, "primitives") {
            if let Some(material) = material(primitive, wanted) {
                primitive.insert("material".to_owned(), material);
            }
        }
    }
    names
}

fn names(root: &Map<String, Value>, notes: &mut Notes) -> Vec<String> {
    let Some(extension) = root.get("extensions").and_then(|extensions| extensions.get(VARIANTS)) else {
        return Vec::new();
    };
    let Some(variants) = extension.get("variants").and_then(Value::as_array) else {
        notes.push(format!("/extensions/{VARIANTS}/variants isn't a list; materials have no variants."));
        return Vec::new();
    };
    scenes::names(variants, "variant")
}

/// Returns the index of the material that a primitive has for a variant, as the document has it: it is checked with all others.
fn material(primitive: &Map<String, Value>, variant: usize) -> Option<Value> {
    let mappings = primitive.get("extensions")?.get(VARIANTS)?.get("mappings")?.as_array()?;
    let is_for = |variants: &Value| {
        let variants = variants.as_array().into_iter().flatten();
        variants.filter_map(Value::as_u64).any(|index| index == variant as u64)
    };
    let mapping = mappings.iter().find(|mapping| mapping.get("variants").is_some_and(is_for))?;
    mapping.get("material").cloned()
}
