//! The named nodes of a scene that have a mesh, as parts that can be left out.

use serde_json::{Map, Value};

use super::GltfError;
use super::reach::{Reach, list};
use super::schema::INSTANCING;
use crate::memory_budget::Budget;
use crate::parts::{Part, Parts};
use geometry::mesh::MemoryRefused;

/// The parts of a scene.
#[derive(Debug, Default)]
pub(super) struct NodeParts {
    pub list: Vec<Part>,
    /// How many nodes aren't parts because there are too many of them.
    pub beyond: usize,
    /// Whether any part was left out.
    pub is_cut: bool,
}

/// Lists the named nodes that the scene shows and that have a mesh; a node without a name has that of its mesh. Nodes of the same name
/// are one part. Takes the meshes of the parts that are `hidden`, as if the file didn't have them: their data isn't looked at.
///
/// # Errors
/// [`GltfError::TooLarge`].
pub(super) fn take(
    root: &mut Map<String, Value>,
    reach: &Reach,
    hidden: &[String],
    budget: &Budget,
) -> Result<NodeParts, GltfError> {
    let mut parts = Parts::hiding(hidden);
    let mut cut = Vec::new();
    for (i, node) in list(root, "nodes").iter().enumerate().filter(|(i, _)| reach.shown[*i]) {
        let mesh = node.get("mesh").and_then(Value::as_u64).and_then(|mesh| list(root, "meshes").get(mesh as usize));
        let name = |value: &Value| value.get("name").and_then(Value::as_str).map(str::to_owned);
        let name = name(node).or_else(|| name(mesh?)).filter(|name| !name.is_empty());
        let (Some(mesh), Some(name)) = (mesh, name) else { continue };
        let too_large = |refused: MemoryRefused| GltfError::TooLarge {
            what: "the list of named nodes".to_owned(),
            reason: refused.into(),
        };
        parts.enter(name.as_bytes(), budget).map_err(too_large)?;
        if parts.leave_out(triangles(root, mesh).saturating_mul(instances(root, node))) {
            cut.push(i);
        }
    }
    let nodes = root.get_mut("nodes").and_then(Value::as_array_mut).map_or(&mut [][..], Vec::as_mut_slice);
    for &i in &cut {
        if let Some(node) = nodes.get_mut(i).and_then(Value::as_object_mut) {
            ["mesh", "skin", "weights"].iter().for_each(|member| _ = node.remove(*member));
        }
    }
    let (list, beyond) = parts.into_list();
    Ok(NodeParts { list, beyond, is_cut: !cut.is_empty() })
}

/// Returns how many triangles a mesh has, with those of strips that only connect parts.
fn triangles(root: &Map<String, Value>, mesh: &Value) -> usize {
    let primitives = mesh.get("primitives").and_then(Value::as_array).into_iter().flatten();
    let of = |primitive: &Value| {
        let positions = primitive.get("attributes").and_then(|attributes| attributes.get("POSITION"));
        let corners = count(root, primitive.get("indices").or(positions));
        match primitive.get("mode").and_then(Value::as_u64).unwrap_or(4) {
            4 => corners / 3,
            5 | 6 => corners.saturating_sub(2),
            _ => 0,
        }
    };
    primitives.map(of).fold(0, usize::saturating_add)
}

/// Returns how often a node's mesh is shown.
fn instances(root: &Map<String, Value>, node: &Value) -> usize {
    let of = || node.get("extensions")?.get(INSTANCING)?.get("attributes")?.as_object()?.values().next();
    of().map_or(1, |accessor| count(root, Some(accessor)))
}

/// Returns how many elements an accessor has; 0 if there is none. A whole number may be written as 4.0.
fn count(root: &Map<String, Value>, accessor: Option<&Value>) -> usize {
    let own = accessor.and_then(Value::as_f64).and_then(|accessor| list(root, "accessors").get(accessor as usize));
    own.and_then(|own| own.get("count")?.as_f64()).map_or(0, |count| count as usize)
}
