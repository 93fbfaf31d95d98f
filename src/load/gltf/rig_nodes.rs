//! What a rig needs to know of a document's nodes.

use ::gltf::Document;

use super::nodes::{self, Placed};
use crate::attachment::SceneNodes;
use geometry::mesh::rig::{Clip, Property};

/// Describes the nodes of a document, with the morph targets of those that are shown. `also` are nodes that carry something beside
/// meshes, if they are shown.
pub(super) fn of(document: &Document, placed: &Placed, also: impl Iterator<Item = usize>) -> SceneNodes {
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
        carries: carries_shown(document, placed, also),
        morphed: morphed.collect(),
        local: all.iter().map(nodes::local).collect(),
        grown: Vec::new(),
    }
}

/// Returns whether clips, whose targets are nodes of the document, move or deform a mesh that is shown.
pub(super) fn move_meshes(clips: &[Clip], document: &Document, placed: &Placed) -> bool {
    if clips.is_empty() {
        return false;
    }
    let carries = carries_shown(document, placed, std::iter::empty());
    let mut channels = clips.iter().flat_map(|clip| &clip.channels);
    channels.any(|channel| channel.property == Property::Weights || carries.get(channel.target as usize) == Some(&true))
}

/// Returns which nodes carry something that is shown, on them or below them: a mesh, a joint of a mesh's skin, or what they carry
/// besides.
fn carries_shown(document: &Document, placed: &Placed, also: impl Iterator<Item = usize>) -> Vec<bool> {
    let mut seen_skins = vec![false; document.skins().len()];
    let mut carrying: Vec<usize> = Vec::new();
    for node in placed.shown.iter().filter_map(|&index| document.nodes().nth(index)).filter(|own| own.mesh().is_some())
    {
        carrying.push(node.index());
        if let Some(skin) = node.skin().filter(|skin| !std::mem::replace(&mut seen_skins[skin.index()], true)) {
            carrying.extend(skin.joints().map(|joint| joint.index()));
        }
    }
    let is_shown = placed.is_shown();
    carrying.extend(also.filter(|node| is_shown.get(*node) == Some(&true)));
    SceneNodes::carrying(carrying, &placed.order, &placed.parents)
}
