//! What a rig needs to know of a document's nodes.

use ::gltf::Document;

use super::nodes::{self, Placed};
use crate::load::attachment::{LocalTransform, SceneNodes};

/// Describes the nodes of a document, with the morph targets of those that are shown.
pub(super) fn of(document: &Document, placed: &Placed) -> SceneNodes {
    let local = |node| match nodes::placement(&node) {
        Some(placement) => LocalTransform::Placement(placement),
        None => LocalTransform::Matrix(nodes::local(&node)),
    };
    let all: Vec<_> = document.nodes().collect();
    let morphed = placed.shown.iter().filter_map(|&index| {
        let node = all.get(index)?;
        let targets = nodes::target_count(node);
        let mut rest = super::weights(node).to_vec();
        rest.resize(targets, 0.0);
        (targets > 0).then_some((index, rest))
    });
    SceneNodes {
        parents: placed.parents.clone(),
        order: placed.order.clone(),
        carries: carries_shown(document, placed),
        morphed: morphed.collect(),
        local: all.iter().cloned().map(local).collect(),
    }
}

/// Returns which nodes carry something that is shown, on them or below them: a mesh, or a joint of a mesh's skin.
fn carries_shown(document: &Document, placed: &Placed) -> Vec<bool> {
    let mut carries = vec![false; placed.global.len()];
    let mut seen_skins = vec![false; document.skins().len()];
    for node in placed.shown.iter().filter_map(|&index| document.nodes().nth(index)) {
        if node.mesh().is_none() {
            continue;
        }
        carries[node.index()] = true;
        if let Some(skin) = node.skin().filter(|skin| !std::mem::replace(&mut seen_skins[skin.index()], true)) {
            skin.joints().for_each(|joint| carries[joint.index()] = true);
        }
    }
    // Children before parents.
    for &node in placed.order.iter().rev() {
        if let Some(parent) = placed.parents[node].filter(|_| carries[node]) {
            carries[parent] = true;
        }
    }
    carries
}
