//! The morph targets of a document, whose names most programs write into `extras`.
//!
//! Source: Khronos, glTF 2.0 specification, section 3.7.2.2 (weights, and the note on `targetNames`).

use std::collections::HashMap;

use serde_json::{Map, Value, json};

use super::json::{list, objects};
use crate::selection::{MorphWeights, Selection};
use geometry::casts::to_f32;

/// Returns the weights of all targets at rest. In the document, those that are `selected` get theirs instead. Both take much less
/// memory than the JSON of the targets, which is counted.
pub(super) fn choose(root: &mut Map<String, Value>, selected: &Selection) -> MorphWeights {
    let (mut rest, mut names_of) = (MorphWeights::new(), HashMap::new());
    for (m, mesh) in objects(root, "meshes") {
        let names = names(m, mesh);
        if !names.is_empty() {
            let weights = mesh.entry("weights").or_insert_with(|| json!([]));
            // A target without a weight has 0.
            weights.as_array_mut().into_iter().for_each(|own| own.resize(own.len().max(names.len()), 0.into()));
            weigh(weights, &names, selected, &mut rest);
            names_of.insert(m as u64, names);
        }
    }
    // The weights of a node come before those of its mesh.
    for (_, node) in objects(root, "nodes") {
        let names = node.get("mesh").and_then(Value::as_u64).and_then(|mesh| names_of.get(&mesh));
        if let Some((names, weights)) = names.zip(node.get_mut("weights")) {
            weigh(weights, names, selected, &mut rest);
        }
    }
    rest
}

/// Returns the names of a mesh's targets. One that is missing is made of the mesh's number and the target's.
fn names(m: usize, mesh: &Map<String, Value>) -> Vec<String> {
    let primitives = list(mesh, "primitives");
    let targets = |own: &Value| own.get("targets").and_then(Value::as_array).map_or(0, Vec::len);
    let count = primitives.iter().map(targets).max().unwrap_or(0);
    // Some programs write the names into the primitives.
    let extras = mesh.get("extras").into_iter().chain(primitives.iter().filter_map(|own| own.get("extras")));
    let named = extras.filter_map(|own| own.get("targetNames")).find(|names| names.is_array());
    let name = |target: usize| {
        let name = named.and_then(|names| names.get(target)?.as_str()).filter(|name| !name.is_empty());
        name.map_or_else(|| format!("mesh {m} target {target}"), str::to_owned)
    };
    (0..count).map(name).collect()
}

/// Notes the weights of targets of these names, and replaces those that are selected.
fn weigh(weights: &mut Value, names: &[String], selected: &Selection, rest: &mut MorphWeights) {
    for (name, weight) in names.iter().zip(weights.as_array_mut().into_iter().flatten()) {
        rest.insert(name.clone(), weight.as_f64().map_or(0.0, to_f32));
        selected.morph(name).into_iter().for_each(|chosen| *weight = chosen.into());
    }
}
