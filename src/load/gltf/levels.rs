//! Levels of detail (MSFT_lod): a node that has the extension is the first, and names the nodes that are the others.

use std::collections::HashSet;

use ::gltf::json::{Index, Root};

use super::nodes::{parents, walk};
use geometry::casts::to_u32;

/// Places the other levels of nodes that the scene shows beside the first one, unless the scene shows them somewhere. Returns them.
pub(super) fn place(root: &mut Root, levels: &[(usize, Vec<usize>)]) -> HashSet<usize> {
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
