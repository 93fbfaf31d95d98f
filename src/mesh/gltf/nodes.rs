//! Where nodes stand: the scene's nodes and everybody's global transform.

use ::gltf::{Document, Node};
use glam::{DMat4, Mat4};

/// The nodes of a document in place.
pub struct Placed {
    /// Each node's own space to the scene's. In f64, so that chains of nodes don't lose the last bits of an f32.
    pub global: Vec<DMat4>,
    /// The nodes that the scene shows: parents before children, siblings in order, each once.
    pub shown: Vec<usize>,
}

/// Places all nodes and lists those of the default scene: the one that the document names, else its first, else all
/// nodes without a parent. No recursion: chains may be as long as the file.
pub fn place(document: &Document, warnings: &mut Vec<String>) -> Placed {
    let nodes: Vec<Node> = document.nodes().collect();
    let parents = parents(&nodes, warnings);
    let roots: Vec<usize> = (0..nodes.len()).filter(|&node| parents[node].is_none()).collect();
    let mut global = vec![DMat4::IDENTITY; nodes.len()];
    for node in walk(&nodes, &roots) {
        let above = parents[node].map_or(DMat4::IDENTITY, |parent| global[parent]);
        global[node] = above * local(&nodes[node]);
    }
    let scene = document.default_scene().or_else(|| document.scenes().next());
    let roots = scene.map_or(roots, |scene| scene.nodes().map(|node| node.index()).collect());
    Placed { global, shown: walk(&nodes, &roots) }
}

/// The parent of each node; of several, the first.
fn parents(nodes: &[Node], warnings: &mut Vec<String>) -> Vec<Option<usize>> {
    let mut parents = vec![None; nodes.len()];
    for node in nodes {
        for child in node.children() {
            let (child, parent) = (child.index(), node.index());
            match parents[child] {
                Some(first) => warnings.push(format!(
                    "node {child} hangs below node {first} and node {parent}; it is shown once, below the first."
                )),
                None => parents[child] = Some(parent),
            }
        }
    }
    parents
}

fn walk(nodes: &[Node], roots: &[usize]) -> Vec<usize> {
    let mut seen = vec![false; nodes.len()];
    let mut order = Vec::new();
    let mut open: Vec<usize> = roots.iter().rev().copied().collect();
    while let Some(node) = open.pop() {
        if !std::mem::replace(&mut seen[node], true) {
            order.push(node);
            let first = open.len();
            open.extend(nodes[node].children().map(|child| child.index()));
            open[first..].reverse();
        }
    }
    order
}

fn local(node: &Node) -> DMat4 {
    use ::gltf::scene::Transform;
    match node.transform() {
        Transform::Matrix { matrix } => Mat4::from_cols_array_2d(&matrix).as_dmat4(),
        Transform::Decomposed { translation, rotation, scale } => {
            // Normalised, because f32 quaternions are of unit length only roughly; a zero one turns nothing.
            let rotation = glam::Quat::from_array(rotation).as_dquat();
            let rotation = if rotation.length_squared() > 0.0 { rotation.normalize() } else { glam::DQuat::IDENTITY };
            let [translation, scale] = [translation, scale].map(|v| glam::Vec3::from(v).as_dvec3());
            DMat4::from_scale_rotation_translation(scale, rotation, translation)
        }
    }
}
