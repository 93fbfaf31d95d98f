//! Finds out which animated node each node of a scene is attached to: the nearest ancestor that a clip moves.

use geometry::casts::to_u32;
use glam::{DMat4, DVec3};

use geometry::mesh::rig::{AnimatedNode, Clip, Placement, Property};

/// What a rig needs to know of a scene's nodes, whatever the format.
#[derive(Default)]
pub(super) struct SceneNodes {
    pub parents: Vec<Option<usize>>,
    /// All nodes, parents before children.
    pub order: Vec<usize>,
    /// Each node's own transform.
    pub local: Vec<LocalTransform>,
    /// Which nodes carry something that is shown, on them or below them: a mesh, a joint of a mesh's skin, a light or a camera.
    pub carries: Vec<bool>,
    /// The nodes that are shown and have morph targets, with the targets' weights at rest.
    pub morphed: Vec<(usize, Vec<f32>)>,
    /// The nodes that have [grown](Self::grow), with the placements at rest.
    pub grown: Vec<(usize, Placement)>,
}

/// A scale of less than this part of what it becomes in a clip is one that flattens: corners may get the same coordinates.
const FLAT: f64 = 1e-3;

impl SceneNodes {
    /// Gives the nodes that are scaled to nothing at rest the largest scale that the clips give them. Corners of a part that appears in
    /// a clip must lie apart, so that it has polygons, normals and edges.
    pub(super) fn grow(&mut self, clips: &[Clip]) {
        for channel in clips.iter().flat_map(|clip| &clip.channels).filter(|own| own.property == Property::Scale) {
            let node = channel.target as usize;
            let Some(LocalTransform::Placement(own)) = self.local.get_mut(node) else { continue };
            let (rest, mut largest) = (*own, DVec3::ZERO);
            let larger = |a: f64, b: f64| if b.abs() > a.abs() { b } else { a };
            for &time in &channel.keys.times {
                channel.keys.sample(time.into(), |i, scale| largest[i] = larger(largest[i], scale));
            }
            let is_flat = rest.scale.abs().cmplt(FLAT * largest.abs());
            own.scale = DVec3::select(is_flat, largest, rest.scale);
            if is_flat.any() && self.grown.iter().all(|(known, _)| *known != node) {
                self.grown.push((node, rest));
            }
        }
    }

    /// Marks nodes, and those above them.
    pub(super) fn carrying(&self, nodes: impl IntoIterator<Item = usize>) -> Vec<bool> {
        let mut marked = vec![false; self.parents.len()];
        nodes.into_iter().for_each(|node| marked[node] = true);
        for &node in self.order.iter().rev() {
            if let Some(parent) = self.parents[node].filter(|_| marked[node]) {
                marked[parent] = true;
            }
        }
        marked
    }

    /// Returns the transform from each node's own space to the scene's.
    pub(super) fn global(&self) -> Vec<DMat4> {
        let mut global = vec![DMat4::IDENTITY; self.local.len()];
        for &node in &self.order {
            let above = self.parents[node].map_or(DMat4::IDENTITY, |parent| global[parent]);
            global[node] = below(above, self.local[node].matrix());
        }
        global
    }
}

/// Returns the product of two transforms. Most nodes have none: that is worth a shortcut where there are hundreds of thousands.
pub(super) fn below(above: DMat4, own: DMat4) -> DMat4 {
    if own == DMat4::IDENTITY { above } else { above * own }
}

/// A node's own transform.
#[derive(Clone, Copy)]
pub(super) enum LocalTransform {
    /// One that a clip may move.
    Placement(Placement),
    Matrix(DMat4),
}

impl LocalTransform {
    pub(super) fn matrix(&self) -> DMat4 {
        match self {
            // Most nodes have no transform: that is worth a shortcut where there are hundreds of thousands.
            Self::Placement(placement) if *placement == Placement::default() => DMat4::IDENTITY,
            Self::Placement(placement) => placement.matrix(),
            Self::Matrix(matrix) => *matrix,
        }
    }
}

/// The animated node that a node is attached to, and its transform relative to that.
#[derive(Clone, Copy, Default)]
pub(super) struct Attachment {
    /// An index into the animated nodes; none if no clip moves the node.
    pub node: Option<u32>,
    pub below: DMat4,
}

/// Returns the animated nodes, parents before children, and the attachment of each of the scene's nodes.
pub(super) fn attachments(scene: &SceneNodes, moved: &[bool]) -> (Vec<AnimatedNode>, Vec<Attachment>) {
    let mut animated = Vec::new();
    let mut attachments = vec![Attachment::default(); scene.local.len()];
    for &node in &scene.order {
        let above = scene.parents[node].map_or(Attachment::default(), |parent| attachments[parent]);
        attachments[node] = match scene.local[node] {
            LocalTransform::Placement(rest) if moved[node] => {
                animated.push(AnimatedNode { parent: above.node, between: above.below, rest, is_joint: false });
                Attachment { node: Some(to_u32(animated.len()) - 1), below: DMat4::IDENTITY }
            }
            local => Attachment { below: above.below * local.matrix(), ..above },
        };
    }
    (animated, attachments)
}
