//! Finds out which animated node each node of a document is attached to: the nearest ancestor that a clip moves.

use ::gltf::Document;
use glam::DMat4;

use super::nodes::{self, Placed};
use crate::mesh::rig::AnimatedNode;

/// The animated node that a node is attached to, and its transform relative to that.
#[derive(Clone, Copy)]
pub(super) struct Attachment {
    /// An index into the animated nodes; none if no clip moves the node.
    pub node: Option<u32>,
    pub below: DMat4,
}

/// Returns which nodes carry something that is shown, on them or below them: a mesh, or a joint of a mesh's skin.
pub(super) fn carries_shown(document: &Document, placed: &Placed) -> Vec<bool> {
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

/// Returns the animated nodes, parents before children, and the attachment of each of the document's nodes.
pub(super) fn attachments(
    document: &Document,
    placed: &Placed,
    moved: &[bool],
) -> (Vec<AnimatedNode>, Vec<Attachment>) {
    let nodes: Vec<_> = document.nodes().collect();
    let mut animated = Vec::new();
    let mut attachments: Vec<Attachment> =
        placed.global.iter().map(|&below| Attachment { node: None, below }).collect();
    for &node in &placed.order {
        let root = Attachment { node: None, below: DMat4::IDENTITY };
        let above = placed.parents[node].map_or(root, |parent| attachments[parent]);
        attachments[node] = match nodes::placement(&nodes[node]).filter(|_| moved[node]) {
            Some(rest) => {
                animated.push(AnimatedNode { parent: above.node, between: above.below, rest, is_joint: false });
                Attachment { node: Some(animated.len() as u32 - 1), below: DMat4::IDENTITY }
            }
            None => Attachment { below: above.below * nodes::local(&nodes[node]), ..above },
        };
    }
    (animated, attachments)
}
