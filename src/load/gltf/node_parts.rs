//! The nodes of a scene that have a mesh, as parts that can be left out, and the nodes that are levels of detail (MSFT_lod): one
//! that has the extension is the first, and names the others.

use std::collections::{HashMap, HashSet};

use ::gltf::Semantic;
use ::gltf::json::mesh::Primitive;
use ::gltf::json::validation::Checked;
use ::gltf::json::{Index, Mesh, Root};
use ::gltf::mesh::Mode;

use super::extensions::InstancingExtension;
use super::nodes::{parents, walk};
use super::reach::{Reach, attribute};
use super::{GltfError, primitive};
use crate::memory_budget::Budget;
use crate::parts::{Parts, node_path};
use crate::selection::Selection;
use geometry::casts::{to_u32, to_usize};

/// The parts of a scene.
#[derive(Debug, Default)]
pub(super) struct NodeParts {
    pub list: Parts,
    /// The part of each node that has a mesh.
    pub of_node: HashMap<usize, u32>,
    /// Whether any node lost its mesh.
    pub is_cut: bool,
}

/// Lists the nodes that the scene shows and that have a mesh; a node without a name has that of its mesh. Nodes of one path are
/// one part. Takes the meshes of parts that aren't `selected`, as if the file didn't have them: their data isn't looked at.
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

/// Places the other levels of nodes that the scene shows beside the first, unless the scene shows them. Returns them.
pub(super) fn place_levels(root: &mut Root, levels: &[(usize, Vec<usize>)]) -> HashSet<usize> {
    let mut others = HashSet::new();
    let Some(scene) = root.scene.map(|scene| scene.value()).filter(|_| !levels.is_empty()) else { return others };
    let parents = parents(&root.nodes, |_| {});
    let roots: Vec<usize> = root.scenes[scene].nodes.iter().map(|node| node.value()).collect();
    let shown: HashSet<usize> = walk(&root.nodes, &parents, &roots, &[]).into_iter().collect();
    for (node, ids) in levels.iter().filter(|(node, _)| shown.contains(node)) {
        for &id in ids.iter().filter(|id| **id < parents.len() && *id != node) {
            if !others.insert(id) || shown.contains(&id) || parents[id].is_some() {
                continue;
            }
            // What the scene doesn't show can't hold the node that it is placed below.
            match parents[*node] {
                Some(parent) => root.nodes[parent].children.get_or_insert_default().push(Index::new(to_u32(id))),
                None => root.scenes[scene].nodes.push(Index::new(to_u32(id))),
            }
        }
    }
    others
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
