//! What nodes carry besides meshes: lights and cameras. Their faults don't keep the model from loading.

use std::cell::RefCell;

use glam::DMat4;
use serde_json::{Map, Value, json};

use super::json::objects;
use super::lenient::Members;
use super::nodes::Placed;
use super::notes::Notes;

/// The lights or the cameras of a document, and the nodes that have one.
#[derive(Debug)]
pub(super) struct Carried<T> {
    /// None for one that can't be read.
    list: Vec<Option<T>>,
    nodes: Vec<Carrier>,
}

/// A node that has a light or a camera.
#[derive(Debug)]
pub(super) struct Carrier {
    pub node: usize,
    pub name: Option<String>,
    /// What it has, as an index.
    pub index: usize,
}

/// Where a document has lights or cameras.
pub(super) struct Place {
    /// The document's list of them, as a JSON pointer without its first slash.
    pub list: &'static str,
    /// The extension of nodes, if it isn't the nodes themselves, that has the index of one.
    pub extension: Option<&'static str>,
    /// The member that is the index.
    pub member: &'static str,
}

/// How many are shown, and what is said of others.
pub(super) struct Most {
    pub count: usize,
    /// What is said if there are more, after their number.
    pub more: String,
    /// What is said of a node that has one which can't be placed.
    pub unplaced: &'static str,
}

impl<T> Carried<T> {
    /// Reads a list, and takes out of nodes which of its elements they have.
    pub(super) fn take(
        root: &mut Map<String, Value>,
        list: &[Value],
        place: &Place,
        read: impl Fn(&Members) -> Option<T>,
        notes: &RefCell<Notes>,
    ) -> Self {
        let element = |(i, value)| read(&Members::of(value, format!("/{}/{i}", place.list), notes)?);
        let list: Vec<_> = list.iter().enumerate().map(element).collect();
        let mut nodes = Vec::new();
        for (node, object) in objects(root, "nodes").enumerate() {
            let (own, pointer) = match place.extension {
                Some(name) => (take_extension(object, name), format!("/nodes/{node}/extensions/{name}")),
                None => (object.remove(place.member).map(|own| json!({ place.member: own })), format!("/nodes/{node}")),
            };
            let Some(own) = own else { continue };
            let index = Members::of(&own, pointer, notes)
                .and_then(|members| members.index(place.member, place.list, list.len()));
            let name = || object.get("name").and_then(Value::as_str).map(str::to_owned);
            nodes.extend(index.map(|index| Carrier { node, name: name(), index }));
        }
        Self { list, nodes }
    }

    /// The nodes that have one.
    pub(super) fn nodes(&self) -> impl Iterator<Item = usize> {
        self.nodes.iter().map(|own| own.node)
    }

    /// Those of the nodes that the scene shows, each with its node, as `at` puts them where they are at rest.
    pub(super) fn shown<U>(
        &self,
        placed: &Placed,
        most: &Most,
        at: impl Fn(&T, &Carrier, &DMat4) -> Option<U>,
        notes: &mut Notes,
    ) -> Vec<(usize, U)> {
        if self.nodes.is_empty() {
            return Vec::new();
        }
        let is_shown = placed.is_shown();
        let shown = self.nodes.iter().filter(|own| is_shown.get(own.node) == Some(&true));
        let all: Vec<_> = shown.filter_map(|own| Some((own, self.list[own.index].as_ref()?))).collect();
        if all.len() > most.count {
            notes.push(format!("The scene has {} {}", all.len(), most.more));
        }
        let mut found = Vec::new();
        for (own, thing) in all.into_iter().take(most.count) {
            match placed.global.get(own.node).and_then(|global| at(thing, own, global)) {
                Some(thing) => found.push((own.node, thing)),
                None => notes.push(format!("/nodes/{} has {}; it is left out.", own.node, most.unplaced)),
            }
        }
        found
    }
}

/// Removes an extension from an object.
pub(super) fn take_extension(object: &mut Map<String, Value>, name: &str) -> Option<Value> {
    object.get_mut("extensions")?.as_object_mut()?.remove(name)
}
