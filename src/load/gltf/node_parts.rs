//! The nodes of a scene that have a mesh, as parts that can be left out, and the nodes that are levels of detail (MSFT_lod): one
//! that has the extension is the first, and names the others.

use std::collections::{BTreeMap, HashMap, HashSet};

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
use crate::parts::{MOST_ABOVE, Parts, level_names, node_path};
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
/// one part. `levels` are the other levels of detail with their names. Takes the meshes of parts that aren't `selected`, as if the file didn't have them: their data isn't looked at.
///
/// # Errors
/// [`GltfError::TooLarge`].
pub(super) fn take(
    root: &mut Root,
    instances: &HashMap<usize, InstancingExtension>,
    reach: &Reach,
    levels: &HashMap<usize, String>,
    selected: &Selection,
    budget: &Budget,
) -> Result<NodeParts, GltfError> {
    let (mut list, mut of_node, mut cut) = (Parts::new(selected), HashMap::new(), Vec::new());
    let parents = parents(&root.nodes, |_| {});
    for (i, node) in root.nodes.iter().enumerate().filter(|(i, _)| reach.shown[*i]) {
        let Some(mesh) = node.mesh.map(|mesh| &root.meshes[mesh.value()]) else { continue };
        let own = |node: usize, name| levels.get(&node).map_or((name, false), |level| (level.as_str(), true));
        let named = |node: usize| own(node, root.nodes[node].name.as_deref().unwrap_or_default());
        let above = std::iter::successors(parents[i], |&node| parents[node]).map(named);
        let (path, level) = node_path(std::iter::once(own(i, own_name(root, i))).chain(above));
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

/// A node's name, or else that of its mesh.
fn own_name(root: &Root, node: usize) -> &str {
    let node = &root.nodes[node];
    let mesh = || node.mesh.and_then(|mesh| root.meshes.get(mesh.value())?.name.as_deref());
    node.name.as_deref().filter(|name| !name.is_empty()).or_else(mesh).unwrap_or_default()
}

/// Places the other levels of nodes that the scene shows beside the first, unless the scene shows them. Returns them with their names.
/// What is a first level itself, or holds that of which it would be a level, is none.
pub(super) fn place_levels(root: &mut Root, levels: &[(usize, Vec<usize>)]) -> HashMap<usize, String> {
    if levels.is_empty() {
        return HashMap::new();
    }
    let parents = parents(&root.nodes, |_| {});
    let scene = root.scene.map(|scene| scene.value());
    let roots: Vec<usize> = match scene {
        Some(scene) => root.scenes[scene].nodes.iter().map(|node| node.value()).collect(),
        None => (0..parents.len()).filter(|node| parents[*node].is_none()).collect(),
    };
    let shown: HashSet<usize> = walk(&root.nodes, &parents, &roots, &[]).into_iter().collect();
    let levels = || levels.iter().filter(|(node, ids)| shown.contains(node) && !ids.is_empty());
    let firsts: HashSet<usize> = levels().map(|(node, _)| *node).collect();
    let mut others = BTreeMap::new();
    for (node, ids) in levels() {
        let above = || std::iter::successors(parents[*node], |&above| parents[above]).take(MOST_ABOVE);
        for (number, &id) in (1..).zip(ids).filter(|(_, id)| **id < parents.len() && !firsts.contains(id)) {
            if others.contains_key(&id) || above().any(|above| above == id) {
                continue;
            }
            others.insert(id, number);
            let is_placed = shown.contains(&id) || parents[id].is_some();
            // What the scene doesn't show can't hold the node that it is placed below. Without scenes it shows all.
            match (parents[*node], scene) {
                _ if is_placed => {}
                (Some(parent), _) => root.nodes[parent].children.get_or_insert_default().push(Index::new(to_u32(id))),
                (None, Some(scene)) => root.scenes[scene].nodes.push(Index::new(to_u32(id))),
                (None, None) => {}
            }
        }
    }
    let named = (0..parents.len()).filter(|node| shown.contains(node) || others.contains_key(node));
    level_names(&others, named.map(|node| (node, own_name(root, node))))
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
