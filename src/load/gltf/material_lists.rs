//! Takes materials, textures, samplers and images out of a document before it is checked, since their faults don't keep the
//! model from loading.

use serde_json::{Map, Value};

use super::json::{self, objects};
use super::notes::Notes;
use super::schema_check::shown;

/// The document's lists, as they are.
#[derive(Debug, Default)]
pub(super) struct MaterialLists {
    pub materials: Vec<Value>,
    pub textures: Vec<Value>,
    pub samplers: Vec<Value>,
    pub images: Vec<Value>,
}

impl MaterialLists {
    /// Takes the lists, and leaves one of as many materials, which have only their indices. Primitives lose a material, colours
    /// or tangents that don't exist.
    pub(super) fn take(root: &mut Map<String, Value>, notes: &mut Notes) -> Self {
        let mut list = |name: &str| match root.remove(name) {
            Some(Value::Array(values)) => values,
            None | Some(Value::Null) => Vec::new(),
            Some(other) => {
                notes.push(format!("/{name} is {}, not a list; it is left out.", shown(&other)));
                Vec::new()
            }
        };
        let [materials, textures, samplers, images] = ["materials", "textures", "samplers", "images"].map(&mut list);
        let accessors = root.get("accessors").and_then(Value::as_array).map_or(0, Vec::len);
        mend_primitives(root, materials.len(), accessors, notes);
        if !materials.is_empty() {
            root.insert("materials".to_owned(), materials.iter().map(|_| Value::Object(Map::new())).collect());
        }
        Self { materials, textures, samplers, images }
    }

    /// Returns the memory of the lists, in bytes.
    pub(super) fn bytes(&self) -> u64 {
        let lists = [&self.materials, &self.textures, &self.samplers, &self.images];
        lists.into_iter().flatten().map(json::bytes).sum()
    }
}

fn mend_primitives(root: &mut Map<String, Value>, materials: usize, accessors: usize, notes: &mut Notes) {
    for (i, mesh) in objects(root, "meshes").enumerate() {
        for (k, primitive) in objects(mesh, "primitives").enumerate() {
            if drop_index(primitive, "material", materials) {
                notes.push(format!(
                    "/meshes/{i}/primitives/{k}/material isn't one of the {materials} materials; the default material is used."
                ));
            }
            let Some(attributes) = primitive.get_mut("attributes").and_then(Value::as_object_mut) else { continue };
            for name in ["COLOR_0", "TANGENT"] {
                if drop_index(attributes, name, accessors) {
                    let said = format!(
                        "/meshes/{i}/primitives/{k}/attributes/{name} isn't one of the {accessors} accessors; it is left out."
                    );
                    notes.push(said);
                }
            }
        }
    }
}

/// Removes a member that isn't an index below `count`. Returns whether there was one.
fn drop_index(object: &mut Map<String, Value>, name: &str, count: usize) -> bool {
    let is_index = |value: &Value| value.as_u64().is_some_and(|index| index < count as u64);
    match object.get(name) {
        None | Some(Value::Null) => false,
        Some(value) if is_index(value) => false,
        Some(_) => object.remove(name).is_some(),
    }
}
