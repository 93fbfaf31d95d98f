//! Takes materials, textures, samplers and images out of a document before it is checked, since their faults don't keep the
//! model from loading.

use std::cell::RefCell;

use serde_json::{Map, Value};

use super::json;
use super::lenient::take_list;
use super::notes::Notes;

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
    pub(super) fn take(root: &mut Map<String, Value>, notes: &RefCell<Notes>) -> Self {
        let list = |name| take_list(root, name, "it is left out", notes);
        let [materials, textures, samplers, images] = ["materials", "textures", "samplers", "images"].map(list);
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
