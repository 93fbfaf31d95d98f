//! Where nodes stand: the scene's nodes and everybody's global transform.

use ::gltf::scene::Transform;
use ::gltf::{Document, Node};
use glam::{DMat4, Mat4};

use super::Problem;
use crate::mesh::rig::Placement;

/// The nodes of a document in place.
pub struct Placed {
    /// Each node's own space to the scene's. In f64, so that chains of nodes don't lose the last bits of an f32.
    pub global: Vec<DMat4>,
    /// The nodes that the scene shows: parents before children, siblings in order, each once.
    pub shown: Vec<usize>,
    pub parents: Vec<Option<usize>>,
    /// All nodes, parents before children.
    pub order: Vec<usize>,
}

/// Places all nodes and lists those of the default scene: the one that the document names, else its first, else all
/// nodes without a parent. No recursion: chains may be as long as the file.
///
/// # Errors
/// [`Problem::Document`] for nodes with two parents and for those that are their own ancestors.
pub fn place(document: &Document) -> Result<Placed, Problem> {
    let nodes: Vec<Node> = document.nodes().collect();
    let parents = parents(&nodes)?;
    let roots: Vec<usize> = (0..nodes.len()).filter(|&node| parents[node].is_none()).collect();
    let mut global = vec![DMat4::IDENTITY; nodes.len()];
    let order = walk(&nodes, &roots);
    if order.len() < nodes.len() {
        return Err(circle(&parents, &order));
    }
    for &node in &order {
        let above = parents[node].map_or(DMat4::IDENTITY, |parent| global[parent]);
        global[node] = above * local(&nodes[node]);
    }
    let scene = document.default_scene().or_else(|| document.scenes().next());
    let roots = scene.map_or(roots, |scene| scene.nodes().map(|node| node.index()).collect());
    Ok(Placed { global, shown: walk(&nodes, &roots), parents, order })
}

/// The parent of each node.
fn parents(nodes: &[Node]) -> Result<Vec<Option<usize>>, Problem> {
    let mut parents = vec![None; nodes.len()];
    for node in nodes {
        for (place, child) in node.children().enumerate() {
            let (child, parent) = (child.index(), node.index());
            if let Some(first) = parents[child].replace(parent) {
                let pointer = format!("/nodes/{parent}/children/{place}");
                let reason = format!("is {child}, which is among /nodes/{first}/children already");
                return Err(Problem::Document { pointer, reason });
            }
        }
    }
    Ok(parents)
}

/// Says which nodes go round in a circle, if not all were reached from one without a parent.
fn circle(parents: &[Option<usize>], reached: &[usize]) -> Problem {
    let mut met = vec![false; parents.len()];
    reached.iter().for_each(|&node| met[node] = true);
    let mut node = met.iter().position(|met| !met).unwrap_or(0);
    while !std::mem::replace(&mut met[node], true) {
        node = parents[node].unwrap_or(node);
    }
    let reason = format!("lead back to node {node}, which would be its own ancestor");
    Problem::Document { pointer: format!("/nodes/{node}/children"), reason }
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

/// A node's own transform.
pub fn local(node: &Node) -> DMat4 {
    match node.transform() {
        Transform::Matrix { matrix } => Mat4::from_cols_array_2d(&matrix).as_dmat4(),
        Transform::Decomposed { .. } => placement(node).unwrap_or_default().matrix(),
    }
}

/// The same in parts; none if the file has it as a matrix.
pub fn placement(node: &Node) -> Option<Placement> {
    let Transform::Decomposed { translation, rotation, scale } = node.transform() else { return None };
    let [translation, scale] = [translation, scale].map(|v| glam::Vec3::from(v).as_dvec3());
    Some(Placement { translation, rotation: glam::Quat::from_array(rotation).as_dquat(), scale })
}

/// How many morph targets a node's mesh has: those of the primitive with most.
pub fn target_count(node: &Node) -> usize {
    let primitives = node.mesh().into_iter().flat_map(|mesh| mesh.primitives());
    primitives.map(|primitive| primitive.morph_targets().count()).max().unwrap_or(0)
}
