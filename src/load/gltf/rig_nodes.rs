//! What a rig needs to know of a document's nodes.

use ::gltf::{Document, Node};

use super::nodes::{self, Placed};
use geometry::mesh::rig::{Clip, Property};

/// Finds out which nodes carry something that is shown, and which morph targets nodes have that are. `also` are nodes that carry
/// something beside meshes, if they are shown.
pub(super) fn complete(placed: &mut Placed, document: &Document, also: impl Iterator<Item = usize>) {
    placed.scene.carries = carries_shown(document, placed, also);
    let morphed = placed.shown.iter().filter_map(|&index| {
        let node = document.nodes().nth(index)?;
        let targets = nodes::target_count(&node);
        let mut rest = super::weights(&node).to_vec();
        rest.resize(targets, 0.0);
        (targets > 0).then_some((index, rest))
    });
    placed.scene.morphed = morphed.collect();
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
    let is_shown = placed.is_shown();
    let also = also.filter(|node| is_shown.get(*node) == Some(&true));
    let meshes = with_mesh(document, placed).map(|node| node.index());
    placed.scene.carrying(meshes.chain(joints(document, placed)).chain(also))
}

/// Returns the joints of the skins of meshes that are shown.
pub(super) fn joints(document: &Document, placed: &Placed) -> impl Iterator<Item = usize> {
    let mut seen = vec![false; document.skins().len()];
    let skins = with_mesh(document, placed).filter_map(|node| node.skin());
    let skins = skins.filter(move |skin| !std::mem::replace(&mut seen[skin.index()], true));
    skins.flat_map(|skin| skin.joints()).map(|joint| joint.index())
}

/// Returns the nodes that are shown and have a mesh.
fn with_mesh<'a>(document: &'a Document, placed: &Placed) -> impl Iterator<Item = Node<'a>> {
    let shown = placed.shown.iter().filter_map(|&index| document.nodes().nth(index));
    shown.filter(|node| node.mesh().is_some())
}
