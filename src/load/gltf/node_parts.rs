//! The named nodes of a scene that have a mesh, as parts that can be left out.

use std::collections::HashMap;

use ::gltf::Semantic;
use ::gltf::json::mesh::Primitive;
use ::gltf::json::validation::Checked;
use ::gltf::json::{Mesh, Root};
use ::gltf::mesh::Mode;

use super::extensions::InstancingExtension;
use super::reach::{Reach, attribute};
use super::{GltfError, primitive};
use crate::memory_budget::Budget;
use crate::parts::{Part, Parts};
use crate::selection::Selection;
use geometry::casts::to_usize;

/// The parts of a scene.
#[derive(Debug, Default)]
pub(super) struct NodeParts {
    pub list: Vec<Part>,
    /// The place in the list of each node that is a part.
    pub of_node: HashMap<usize, u32>,
    /// How many nodes aren't parts because there are too many of them.
    pub beyond: usize,
    /// Whether any part was left out.
    pub is_cut: bool,
}

/// Lists the named nodes that the scene shows and that have a mesh; a node without a name has that of its mesh. Nodes of the same name
/// are one part. Takes the meshes of the parts that aren't `selected`, as if the file didn't have them: their data isn't looked at.
///
/// # Errors
/// [`GltfError::TooLarge`].
pub(super) fn take(
    root: &mut Root,
    instances: &HashMap<usize, InstancingExtension>,
    reach: &Reach,
    selected: &Selection,
    budget: &Budget,
) -> Result<NodeParts, GltfError> {
    let mut parts = Parts::new(selected);
    let (mut cut, mut entered) = (Vec::new(), Vec::new());
    for (i, node) in root.nodes.iter().enumerate().filter(|(i, _)| reach.shown[*i]) {
        let Some(mesh) = node.mesh.map(|mesh| &root.meshes[mesh.value()]) else { continue };
        let Some(name) = node.name.as_ref().or(mesh.name.as_ref()).filter(|name| !name.is_empty()) else { continue };
        parts.enter(name.as_bytes(), budget).map_err(GltfError::too_large("the list of named nodes"))?;
        entered.extend(parts.current().map(|part| (i, part)));
        let first = instances.get(&i).and_then(InstancingExtension::first);
        if parts.leave_out(triangles(root, mesh).saturating_mul(first.map_or(1, |first| count(root, first)))) {
            cut.push(i);
        }
    }
    let is_cut = !cut.is_empty();
    for node in cut {
        (root.nodes[node].mesh, root.nodes[node].skin) = (None, None);
    }
    let (list, beyond, places) = parts.into_list();
    let of_node = entered.into_iter().map(|(node, part)| (node, places[part as usize])).collect();
    Ok(NodeParts { list, of_node, beyond, is_cut })
}

/// Returns how many triangles a mesh has, with those of strips that only connect parts.
fn triangles(root: &Root, mesh: &Mesh) -> usize {
    let of = |own: &Primitive| {
        let corners = own.indices.map(|indices| indices.value()).or(attribute(own, &Semantic::Positions));
        match own.mode {
            Checked::Valid(mode @ (Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan)) => {
                primitive::most_triangles(mode, corners.map_or(0, |corners| count(root, corners)))
            }
            _ => 0,
        }
    };
    mesh.primitives.iter().map(of).fold(0, usize::saturating_add)
}

/// Returns how many elements an accessor has.
fn count(root: &Root, accessor: usize) -> usize {
    root.accessors.get(accessor).map_or(0, |own| to_usize(own.count.0))
}
