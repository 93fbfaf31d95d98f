//! Takes out of a document what the scene doesn't use, and decides which faults keep the model from loading: those of what its shape depends
//! on.

use ::gltf::json::{Node, Root};
use serde_json::{Map, Value, json};

use super::GltfError;
use super::json::{PER_OBJECT, PER_READ, list, objects};
use super::notes::{Notes, counted};
use super::reach::{Reach, has_data};
use super::schema::is_detail;
use super::schema_check::{Fault, Faults};
use crate::memory_budget::Budget;
use geometry::mesh::MemoryRefused;

/// How far a rotation's length may be from 1 without a warning: quaternions in files are rounded.
const ROUNDING: f64 = 1e-3;

/// Repairs a document before it is checked: rotations that aren't unit quaternions, and primitives that aren't triangles, which become empty.
/// Returns what was wrong with the rotations of nodes, as sentences.
///
/// # Errors
/// [`GltfError::Document`] if what replaces broken parts would take too much memory.
pub(super) fn before_check(root: &mut Map<String, Value>, budget: &Budget) -> Result<Vec<(usize, String)>, GltfError> {
    hold_replacements(root, budget).map_err(GltfError::large_json)?;
    for (_, mesh) in objects(root, "meshes") {
        for (_, primitive) in objects(mesh, "primitives").filter(|(_, primitive)| !is_drawn(primitive)) {
            let mode = primitive.remove("mode").filter(|mode| mode.as_u64().is_some_and(|mode| mode <= 6));
            *primitive = Map::from_iter([("attributes".to_owned(), json!({}))]);
            primitive.extend(mode.map(|mode| ("mode".to_owned(), mode)));
        }
    }
    Ok(objects(root, "nodes").filter_map(|(i, node)| Some((i, repair_rotation(node, i)?))).collect())
}

/// Returns whether a primitive has triangles: it has positions, and consists neither of points nor of lines.
fn is_drawn(primitive: &Map<String, Value>) -> bool {
    let positions = primitive.get("attributes").and_then(|attributes| attributes.get("POSITION"));
    positions.is_some_and(|own| !own.is_null()) && !matches!(primitive.get("mode").and_then(Value::as_u64), Some(0..=3))
}

/// What is known of a document after the check.
pub(super) struct Settled<'a> {
    pub reach: &'a Reach,
    pub faults: &'a Faults,
    pub rotations: Vec<(usize, String)>,
    /// The number of the document's materials, and whether it requires Draco.
    pub materials: usize,
    pub requires_draco: bool,
}

/// What a fault does.
enum Verdict {
    /// Nothing, since nothing uses what is wrong.
    Unused,
    /// The model can do without: a sentence.
    LeftOut(String),
    Refused,
}

impl Settled<'_> {
    /// Takes out what isn't used.
    ///
    /// # Errors
    /// The first fault of what the shape depends on. Those of accessors, buffer views and buffers are for what reads them.
    pub(super) fn settle(self, root: &mut Root, notes: &mut Notes) -> Result<(), GltfError> {
        for (pointer, reason) in &self.faults.0 {
            match self.verdict(root, pointer) {
                Verdict::Unused => {}
                Verdict::LeftOut(sentence) => notes.push(sentence),
                Verdict::Refused => {
                    return Err(Fault { pointer: pointer.clone(), reason: reason.clone() }.into());
                }
            }
        }
        let Self { reach, rotations, .. } = self;
        notes.extend(rotations.into_iter().filter(|(node, _)| reach.nodes[*node]).map(|(_, said)| said));
        for (i, node) in root.nodes.iter_mut().enumerate() {
            if !reach.nodes[i] {
                *node = Node::default();
            }
            node.mesh = node.mesh.filter(|_| reach.shown[i]);
            node.skin = node.skin.filter(|_| node.mesh.is_some_and(|mesh| reach.bound[mesh.value()]));
        }
        let said = "nodes that KHR_node_visibility hides, with meshes that aren't shown (--show-hidden shows them)";
        notes.extend(counted([(reach.hidden, said)]));
        Ok(())
    }

    fn verdict(&self, root: &Root, pointer: &str) -> Verdict {
        let mut parts = pointer.split('/').skip(1);
        let list = parts.next().unwrap_or_default();
        // Without a number it is the list itself.
        let Some(i) = parts.next().and_then(|place| place.parse::<usize>().ok()) else { return Verdict::Refused };
        let inside: Vec<&str> = parts.collect();
        let reach = self.reach;
        let used = |is: bool| if is { Verdict::Refused } else { Verdict::Unused };
        match list {
            "accessors" | "bufferViews" | "buffers" => Verdict::Unused,
            "scenes" => used(root.scene.is_some_and(|scene| scene.value() == i)),
            "skins" => used(reach.skins[i]),
            "nodes" => {
                let mesh = root.nodes[i].mesh.filter(|_| reach.shown[i]).map(|mesh| mesh.value());
                used(match inside.first() {
                    Some(&("mesh" | "extensions")) => reach.shown[i],
                    Some(&"skin") => mesh.is_some_and(|mesh| reach.bound[mesh]),
                    Some(&"weights") => mesh.is_some_and(|mesh| has_targets(root, mesh)),
                    _ => reach.nodes[i],
                })
            }
            "meshes" if reach.weighed.contains_key(&i) => self.verdict_of_mesh(root, i, pointer, &inside),
            "meshes" => Verdict::Unused,
            _ => Verdict::Refused,
        }
    }

    fn verdict_of_mesh(&self, root: &Root, mesh: usize, pointer: &str, inside: &[&str]) -> Verdict {
        let used = |is: bool| if is { Verdict::Refused } else { Verdict::Unused };
        let (accessors, materials) = (root.accessors.len(), self.materials);
        let left_out = |is_needed: bool| match is_needed {
            true => Verdict::Refused,
            false => Verdict::LeftOut(format!("{pointer} isn't one of the {accessors} accessors; it is left out.")),
        };
        let primitive = |k: &str| k.parse::<usize>().ok().and_then(|k| root.meshes[mesh].primitives.get(k));
        match inside {
            ["weights", ..] => used(has_targets(root, mesh)),
            ["primitives", _, "material"] => Verdict::LeftOut(format!(
                "{pointer} isn't one of the {materials} materials; the default material is used."
            )),
            ["primitives", k, "extensions", ..] => {
                used(self.requires_draco || !primitive(k).is_some_and(|own| has_data(root, own)))
            }
            ["primitives", _, "attributes", name] if name.starts_with("JOINTS_") || name.starts_with("WEIGHTS_") => {
                used(self.reach.skinned[mesh] && self.reach.bound[mesh])
            }
            ["primitives", _, "attributes", name] => left_out(!is_detail(name)),
            ["primitives", _, "targets", target, name] => {
                let weighed = self.reach.weighed.get(&mesh);
                let is_weighed = weighed.zip(target.parse().ok()).is_some_and(|(all, target)| all.contains(&target));
                left_out(is_weighed && *name != "TANGENT")
            }
            _ => Verdict::Refused,
        }
    }
}

fn has_targets(root: &Root, mesh: usize) -> bool {
    root.meshes[mesh].primitives.iter().any(|primitive| primitive.targets.is_some())
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

/// Gives a rotation that isn't a unit quaternion the length 1. Returns what is said of it if that is more than rounding.
fn repair_rotation(node: &mut Map<String, Value>, i: usize) -> Option<String> {
    let values = node.get("rotation")?.as_array().filter(|values| values.len() == 4)?;
    // What isn't a number is reported later.
    let numbers = values.iter().map(Value::as_f64).collect::<Option<Vec<_>>>()?;
    let largest = numbers.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    if largest == 0.0 {
        node.remove("rotation");
        return Some(format!("/nodes/{i}/rotation is a quaternion of zeros; it is left out."));
    }
    // Divided by the largest number, squares don't overflow.
    let over = numbers.iter().map(|x| (x / largest).powi(2)).sum::<f64>().sqrt();
    let length = largest * over;
    let is_far = (length - 1.0).abs() > ROUNDING;
    if is_far || largest > 1.0 {
        let unit: Vec<_> = numbers.iter().map(|x| x / largest / over).collect();
        node.insert("rotation".to_owned(), json!(unit));
    }
    let length = if length < 1000.0 { format!("{length:.3}") } else { format!("{length:.1e}") };
    is_far.then(|| format!("/nodes/{i}/rotation is a quaternion of length {length}, not 1; it is scaled to 1."))
}
