//! Takes out of a document what the scene doesn't use, and what may be wrong without changing the shape, so that neither
//! keeps the model from loading. What is left is [checked](super::schema_check).

use serde_json::{Map, Value, json};

use super::GltfError;
use super::json::{PER_OBJECT, PER_READ};
use super::notes::Notes;
use super::reach::{Reach, is_drawn, is_influence, list, packed};
use super::schema::{INSTANCING, is_detail};
use crate::memory_budget::Budget;
use geometry::mesh::MemoryRefused;

/// How far a rotation's length may be from 1 without a warning: quaternions in files are rounded.
const ROUNDING: f64 = 1e-3;

/// Repairs a document. `reach` says what of it is used; `materials` is the number of its materials, and `requires_draco` says whether it
/// requires the extension.
///
/// # Errors
/// [`GltfError::Document`] if what replaces broken parts would take too much memory.
pub(super) fn repair(
    root: &mut Map<String, Value>,
    reach: &Reach,
    materials: usize,
    requires_draco: bool,
    budget: &Budget,
    notes: &mut Notes,
) -> Result<(), GltfError> {
    let too_large =
        |refused: MemoryRefused| GltfError::Document { pointer: "its JSON".to_owned(), reason: refused.into() };
    hold_replacements(root, budget).map_err(too_large)?;
    repair_nodes(root, reach, notes);
    let mut positionless = 0;
    let accessors = list(root, "accessors").len();
    let mut meshes = root.remove("meshes");
    for (i, mesh) in meshes.iter_mut().filter_map(Value::as_array_mut).flatten().enumerate() {
        if !reach.meshes[i] {
            *mesh = json!({ "primitives": [] });
            continue;
        }
        let mut primitives = Primitives { reach, mesh: i, materials, accessors, has_targets: false, notes };
        for (k, primitive) in array(mesh, "primitives").iter_mut().enumerate() {
            if primitive.is_object() && !is_drawn(primitive) {
                let mode = primitive.get("mode").and_then(Value::as_u64).filter(|mode| *mode <= 6).unwrap_or(4);
                positionless += usize::from(mode > 3);
                *primitive = json!({ "mode": mode, "attributes": {} });
                continue;
            }
            let keeps_draco = packed(root, primitive, requires_draco).is_some();
            if let Value::Object(primitive) = primitive {
                primitives.repair(k, primitive, keeps_draco);
            }
        }
        let has_targets = primitives.has_targets;
        if let Some(mesh) = mesh.as_object_mut().filter(|_| !has_targets) {
            mesh.remove("weights");
        }
    }
    root.extend(meshes.map(|meshes| ("meshes".to_owned(), meshes)));
    if positionless > 0 {
        notes.push(format!("primitives without positions, left out: {positionless}."));
    }
    let scene = root.get("scene").and_then(Value::as_u64);
    for (i, other) in elements(root, "scenes").iter_mut().enumerate() {
        if scene != Some(i as u64) {
            *other = json!({ "nodes": [] });
        }
    }
    for (skin, _) in elements(root, "skins").iter_mut().zip(&reach.skins).filter(|(_, is_used)| !**is_used) {
        *skin = json!({ "joints": [] });
    }
    Ok(())
}

/// Counts what may be put in place of elements that aren't objects, or have no members.
fn hold_replacements(root: &Map<String, Value>, budget: &Budget) -> Result<(), MemoryRefused> {
    const LISTS: [&str; 6] = ["scenes", "meshes", "skins", "accessors", "bufferViews", "buffers"];
    let is_small = |value: &&Value| value.as_object().is_none_or(Map::is_empty);
    let elements = || LISTS.into_iter().flat_map(|name| list(root, name));
    let primitives = || list(root, "meshes").iter().filter_map(|mesh| mesh.get("primitives")?.as_array()).flatten();
    let bare = primitives().filter(|primitive| primitive.get("attributes").is_none_or(|inside| is_small(&inside)));
    // Both objects of a primitive, and what is added at the end.
    let small = elements().filter(is_small).count() + 2 * bare.count() + 8;
    let others = elements().chain(list(root, "nodes")).chain(primitives()).filter(|value| !value.is_object()).count();
    budget.borrow(small as u64 * PER_OBJECT)?;
    budget.hold(others as u64 * PER_READ)
}

fn repair_nodes(root: &mut Map<String, Value>, reach: &Reach, notes: &mut Notes) {
    let has_targets: Vec<_> = list(root, "meshes").iter().map(has_targets).collect();
    for (i, value) in elements(root, "nodes").iter_mut().enumerate() {
        if !reach.nodes[i] {
            *value = Value::Object(Map::new());
            continue;
        }
        let Value::Object(node) = value else { continue };
        repair_rotation(node, i, notes);
        let mesh = node.get("mesh").and_then(Value::as_u64).and_then(|mesh| usize::try_from(mesh).ok());
        if !reach.shown[i] {
            ["mesh", "skin", "weights", "extensions"].into_iter().for_each(|name| drop(node.remove(name)));
        }
        if !reach.is_bound(mesh) {
            node.remove("skin");
        }
        if mesh.is_none_or(|mesh| has_targets.get(mesh) == Some(&false)) {
            node.remove("weights");
        }
        let own = node.remove("extensions").and_then(|mut all| all.as_object_mut()?.remove(INSTANCING));
        if let Some(own) = own {
            node.insert("extensions".to_owned(), json!({ INSTANCING: own }));
        }
    }
    if reach.hidden > 0 {
        let said = "nodes that KHR_node_visibility hides, with meshes that aren't shown (--show-hidden shows them)";
        notes.push(format!("{said}: {}.", reach.hidden));
    }
}

fn has_targets(mesh: &Value) -> bool {
    let primitives = mesh.get("primitives").and_then(Value::as_array);
    primitives.into_iter().flatten().any(|primitive| is_drawn(primitive) && primitive.get("targets").is_some())
}

/// Gives a rotation that isn't a unit quaternion the length 1. Says so if it is more than rounding.
fn repair_rotation(node: &mut Map<String, Value>, i: usize, notes: &mut Notes) {
    let Some(values) = node.get("rotation").and_then(Value::as_array).filter(|values| values.len() == 4) else {
        return;
    };
    // What isn't a number is reported later.
    let Some(numbers) = values.iter().map(Value::as_f64).collect::<Option<Vec<_>>>() else { return };
    let largest = numbers.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    if largest == 0.0 {
        node.remove("rotation");
        notes.push(format!("/nodes/{i}/rotation is a quaternion of zeros; it is left out."));
        return;
    }
    // Divided by the largest number, squares don't overflow.
    let over = numbers.iter().map(|x| (x / largest).powi(2)).sum::<f64>().sqrt();
    let length = largest * over;
    let is_far = (length - 1.0).abs() > ROUNDING;
    if is_far {
        let length = if length < 1000.0 { format!("{length:.3}") } else { format!("{length:.1e}") };
        notes.push(format!("/nodes/{i}/rotation is a quaternion of length {length}, not 1; it is scaled to 1."));
    }
    if is_far || largest > 1.0 {
        let unit: Vec<_> = numbers.iter().map(|x| x / largest / over).collect();
        node.insert("rotation".to_owned(), json!(unit));
    }
}

/// The primitives of a mesh that is used.
struct Primitives<'a> {
    reach: &'a Reach,
    mesh: usize,
    /// How many materials and accessors the document has.
    materials: usize,
    accessors: usize,
    has_targets: bool,
    notes: &'a mut Notes,
}

impl Primitives<'_> {
    /// Takes out what is wrong with a primitive's looks, and what isn't used.
    fn repair(&mut self, k: usize, primitive: &mut Map<String, Value>, keeps_draco: bool) {
        let place = format!("/meshes/{}/primitives/{k}", self.mesh);
        if drop_index(primitive, "material", self.materials) {
            let said = format!("{place}/material isn't one of the {} materials", self.materials);
            self.notes.push(format!("{said}; the default material is used."));
        }
        let own = primitive.remove("extensions").filter(|_| keeps_draco);
        if let Some(own) = own {
            primitive.insert("extensions".to_owned(), own);
        }
        if let Some(attributes) = primitive.get_mut("attributes").and_then(Value::as_object_mut) {
            attributes.retain(|name, _| !is_influence(name) || self.reach.is_skinned(self.mesh));
            let details: Vec<_> = attributes.keys().filter(|name| is_detail(name)).cloned().collect();
            for name in details {
                self.drop_accessor(attributes, &name, &format!("{place}/attributes"));
            }
        }
        let targets = primitive.get_mut("targets").and_then(Value::as_array_mut).into_iter().flatten();
        for (t, target) in targets.enumerate() {
            let Value::Object(target) = target else { continue };
            let shapes: &[_] = if self.reach.is_weighed(self.mesh, t) { &[] } else { &["POSITION", "NORMAL"] };
            for name in shapes.iter().chain(&["TANGENT"]) {
                self.drop_accessor(target, name, &format!("{place}/targets/{t}"));
            }
        }
        self.has_targets |= primitive.contains_key("targets");
    }

    fn drop_accessor(&mut self, object: &mut Map<String, Value>, name: &str, place: &str) {
        if drop_index(object, name, self.accessors) {
            let said = format!("{place}/{name} isn't one of the {} accessors; it is left out.", self.accessors);
            self.notes.push(said);
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

fn elements<'a>(root: &'a mut Map<String, Value>, name: &str) -> &'a mut [Value] {
    root.get_mut(name).and_then(Value::as_array_mut).map_or(&mut [], Vec::as_mut_slice)
}

fn array<'a>(object: &'a mut Value, name: &str) -> &'a mut [Value] {
    object.get_mut(name).and_then(Value::as_array_mut).map_or(&mut [], Vec::as_mut_slice)
}
