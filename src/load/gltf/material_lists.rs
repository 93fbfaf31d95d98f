//! Takes materials, textures, samplers and images out of a document before it is checked, since their faults don't keep the
//! model from loading.

use serde_json::{Map, Value};

use super::json;
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
    /// Takes the lists, and leaves one of as many materials, which have only their indices.
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
