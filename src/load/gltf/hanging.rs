//! What hangs on what: the nodes that clips move, and all others by the nearest of those above them.

use ::gltf::Document;
use glam::DMat4;

use super::nodes::{self, Placed};
use crate::mesh::rig::Mover;

/// What moves a node, and how the node stands beneath that.
#[derive(Clone, Copy)]
pub struct Hang {
    /// None if no clip does.
    pub mover: Option<u32>,
    pub below: DMat4,
}

/// Which nodes have something shown on them or below them: a mesh, or a joint of the skin of one.
pub fn carries_shown(document: &Document, placed: &Placed) -> Vec<bool> {
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

/// The nodes that are moved, parents before children, and what each of the document's nodes hangs on.
pub fn hang(document: &Document, placed: &Placed, moved: &[bool]) -> (Vec<Mover>, Vec<Hang>) {
    let nodes: Vec<_> = document.nodes().collect();
    let mut movers = Vec::new();
    let mut hangs: Vec<Hang> = placed.global.iter().map(|&below| Hang { mover: None, below }).collect();
    for &node in &placed.order {
        let root = Hang { mover: None, below: DMat4::IDENTITY };
        let above = placed.parents[node].map_or(root, |parent| hangs[parent]);
        hangs[node] = match nodes::placement(&nodes[node]).filter(|_| moved[node]) {
            Some(rest) => {
                movers.push(Mover { parent: above.mover, between: above.below, rest, is_joint: false });
                Hang { mover: Some(movers.len() as u32 - 1), below: DMat4::IDENTITY }
            }
            None => Hang { below: above.below * nodes::local(&nodes[node]), ..above },
        };
    }
    (movers, hangs)
}
