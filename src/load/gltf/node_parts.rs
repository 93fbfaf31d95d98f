//! The nodes of a scene that have a mesh, as parts that can be left out.

use std::collections::{HashMap, HashSet};

use ::gltf::Semantic;
use ::gltf::json::mesh::Primitive;
use ::gltf::json::validation::Checked;
use ::gltf::json::{Mesh, Root};
use ::gltf::mesh::Mode;

use super::extensions::InstancingExtension;
use super::nodes::parents;
use super::reach::{Reach, attribute};
use super::{GltfError, primitive};
use crate::memory_budget::Budget;
use crate::parts::{Parts, node_path};
use crate::selection::Selection;
use geometry::casts::to_usize;

/// The parts of a scene.
#[derive(Debug, Default)]
pub(super) struct NodeParts {
    pub list: Parts,
    /// The part of each node that has a mesh.
    pub of_node: HashMap<usize, u32>,
    /// Whether any node lost its mesh.
    pub is_cut: bool,
}

/// Lists the nodes that the scene shows and that have a mesh; a node without a name has that of its mesh. Nodes of the same path are
/// one part. Takes the meshes of the parts that aren't `selected`, as if the file didn't have them: their data isn't looked at.
///
/// # Errors
/// [`GltfError::TooLarge`].
pub(super) fn take(
    root: &mut Root,
    instances: &HashMap<usize, InstancingExtension>,
    reach: &Reach,
    levels: &HashSet<usize>,
    selected: &Selection,
    budget: &Budget,
) -> Result<NodeParts, GltfError> {
    let (mut list, mut of_node, mut cut) = (Parts::new(selected), HashMap::new(), Vec::new());
    let parents = parents(&root.nodes, |_| {});
    for (i, node) in root.nodes.iter().enumerate().filter(|(i, _)| reach.shown[*i]) {
        let Some(mesh) = node.mesh.map(|mesh| &root.meshes[mesh.value()]) else { continue };
        let named = |node: usize| (root.nodes[node].name.as_deref().unwrap_or_default(), levels.contains(&node));
        let own = match named(i) {
            ("", is_level) => (mesh.name.as_deref().unwrap_or_default(), is_level),
            own => own,
        };
        let above = std::iter::successors(parents[i], |&node| parents[node]).map(named);
        let (path, level) = node_path(std::iter::once(own).chain(above));
        list.enter(path.as_bytes(), level, budget).map_err(GltfError::too_large("the list of nodes"))?;
        of_node.extend(list.current().map(|part| (i, part)));
        let first = instances.get(&i).and_then(InstancingExtension::first);
        if list.leave_out(triangles(root, mesh).saturating_mul(first.map_or(1, |first| count(root, first)))) {
            cut.push(i);
        }
    }
    let is_cut = !cut.is_empty();
    for node in cut {
        (root.nodes[node].mesh, root.nodes[node].skin) = (None, None);
    }
    Ok(NodeParts { list, of_node, is_cut })
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
