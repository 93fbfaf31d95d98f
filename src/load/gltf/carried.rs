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

/// A light or a camera: where a document has them, and what is said of them.
pub(super) trait Carriable: Sized {
    /// What it is where its node puts it.
    type Placed;
    /// The document's list of them, as a JSON pointer without its first slash.
    const LIST: &'static str;
    /// The extension of nodes, if it isn't the nodes themselves, that has the index of one.
    const EXTENSION: Option<&'static str>;
    /// The member that is the index.
    const MEMBER: &'static str;
    /// How many are shown, and what is said before and after that number if there are more.
    const MOST: usize;
    const MORE: [&'static str; 2];
    /// What is said of a node that has one which can't be placed.
    const UNPLACED: &'static str;

    fn read(members: &Members) -> Option<Self>;

    /// Returns it with its node's place, none if that isn't finite.
    fn at(&self, carrier: &Carrier, global: &DMat4) -> Option<Self::Placed>;
}

impl<T: Carriable> Carried<T> {
    /// Reads a list, and takes out of nodes which of its elements they have.
    pub(super) fn take(root: &mut Map<String, Value>, list: &[Value], notes: &RefCell<Notes>) -> Self {
        let element = |(i, value)| T::read(&Members::new(value, format!("/{}/{i}", T::LIST), notes)?);
        let list: Vec<_> = list.iter().enumerate().map(element).collect();
        let mut nodes = Vec::new();
        for (node, object) in objects(root, "nodes") {
            let (own, pointer) = match T::EXTENSION {
                Some(name) => (take_extension(object, name), format!("/nodes/{node}/extensions/{name}")),
                None => (object.remove(T::MEMBER).map(|own| json!({ (T::MEMBER): own })), format!("/nodes/{node}")),
            };
            let Some(own) = own else { continue };
            let members = Members::new(&own, pointer, notes);
            let index = members.and_then(|members| members.index(T::MEMBER, T::LIST, list.len()));
            let name = || object.get("name").and_then(Value::as_str).map(str::to_owned);
            nodes.extend(index.map(|index| Carrier { node, name: name(), index }));
        }
        Self { list, nodes }
    }

    /// The nodes that have one.
    pub(super) fn nodes(&self) -> impl Iterator<Item = usize> {
        self.nodes.iter().map(|own| own.node)
    }

    /// Those of the nodes that the scene shows, where they are at rest, each with its node.
    pub(super) fn shown(&self, placed: &Placed, notes: &mut Notes) -> Vec<(usize, T::Placed)> {
        if self.nodes.is_empty() {
            return Vec::new();
        }
        let is_shown = placed.is_shown();
        let shown = self.nodes.iter().filter(|own| is_shown.get(own.node) == Some(&true));
        let all: Vec<_> = shown.filter_map(|own| Some((own, self.list[own.index].as_ref()?))).collect();
        if all.len() > T::MOST {
            let [before, after] = T::MORE;
            notes.push(format!("The scene has {} {before} {} {after}.", all.len(), T::MOST));
        }
        let mut found = Vec::new();
        for (own, thing) in all.into_iter().take(T::MOST) {
            match placed.global.get(own.node).and_then(|global| thing.at(own, global)) {
                Some(thing) => found.push((own.node, thing)),
                None => notes.push(format!("/nodes/{} has {}; it is left out.", own.node, T::UNPLACED)),
            }
        }
        found
    }
}

/// Removes an extension from an object.
pub(super) fn take_extension(object: &mut Map<String, Value>, name: &str) -> Option<Value> {
    object.get_mut("extensions")?.as_object_mut()?.remove(name)
}
