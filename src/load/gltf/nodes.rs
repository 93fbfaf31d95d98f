//! Places the nodes of a document: their global transforms, and which ones the scene shows.

use ::gltf::scene::Transform;
use ::gltf::{Document, Mesh, Node, json};
use glam::{DMat4, Mat4};

use super::GltfError;
use super::notes::Notes;
use crate::attachment::{LocalTransform, SceneNodes};
use geometry::mesh::rig::Placement;

/// The nodes of a document with their places.
pub(crate) struct Placed {
    /// The transform from each node's own space to the scene's. In f64, so that chains of nodes don't lose the last
    /// bits of an f32.
    pub global: Vec<DMat4>,
    /// The nodes that the scene shows, each once: parents before children, siblings in order.
    pub shown: Vec<usize>,
    pub scene: SceneNodes,
}

impl Placed {
    /// Returns the meshes that the scene shows, each once.
    pub(super) fn meshes<'a>(&self, document: &'a Document) -> impl Iterator<Item = Mesh<'a>> {
        let mut seen = vec![false; document.meshes().len()];
        let shown = self.shown.iter().filter_map(|&node| document.nodes().nth(node)?.mesh());
        shown.filter(move |mesh| !std::mem::replace(&mut seen[mesh.index()], true))
    }

    /// Returns for each node whether the scene shows it.
    pub(super) fn is_shown(&self) -> Vec<bool> {
        let mut is_shown = vec![false; self.global.len()];
        self.shown.iter().for_each(|&node| is_shown[node] = true);
        is_shown
    }
}

/// Places all nodes, and lists those of the scene that the document names, or else all nodes; those that hide themselves, and what
/// is below, are left out. A node that is named several times as a child has its first place, with a note. Doesn't recurse, since
/// chains of nodes may be long.
///
/// # Errors
/// [`GltfError::Document`] for a node that is its own ancestor.
pub(super) fn place(document: &Document, hiding: &[bool], notes: &mut Notes) -> Result<Placed, GltfError> {
    let nodes = &document.as_json().nodes;
    let parents = parents(nodes, |[parent, place, child, first]| {
        notes.push(format!(
            "/nodes/{parent}/children/{place} is {child}, which is already among /nodes/{first}/children; it is placed \
             only there."
        ));
    });
    let roots: Vec<usize> = (0..nodes.len()).filter(|&node| parents[node].is_none()).collect();
    let order = walk(nodes, &parents, &roots, &[]);
    if order.len() < nodes.len() {
        return Err(circle(&parents, &order));
    }
    let roots = document.default_scene().map_or(roots, |scene| scene.nodes().map(|node| node.index()).collect());
    let shown = walk(nodes, &parents, &roots, hiding);
    let local = document.nodes().map(|node| local(&node)).collect();
    let scene = SceneNodes { parents, order, local, ..SceneNodes::default() };
    Ok(Placed { global: scene.global(), shown, scene })
}

/// Returns the first parent of each node. Calls `doubled` with each other one, the place among its children, the child, and its first parent.
pub(super) fn parents(nodes: &[json::Node], mut doubled: impl FnMut([usize; 4])) -> Vec<Option<usize>> {
    let mut parents = vec![None; nodes.len()];
    for (parent, node) in nodes.iter().enumerate() {
        for (place, child) in children(node).enumerate() {
            match parents[child] {
                None => parents[child] = Some(parent),
                Some(first) => doubled([parent, place, child, first]),
            }
        }
    }
    parents
}

fn children(node: &json::Node) -> impl Iterator<Item = usize> {
    node.children.iter().flatten().map(|child| child.value())
}

/// Returns an error that names a node of a cycle, for nodes that can't be reached from a node without a parent.
fn circle(parents: &[Option<usize>], reached: &[usize]) -> GltfError {
    let mut met = vec![false; parents.len()];
    reached.iter().for_each(|&node| met[node] = true);
    let mut node = met.iter().position(|met| !met).unwrap_or(0);
    while !std::mem::replace(&mut met[node], true) {
        node = parents[node].unwrap_or(node);
    }
    let reason = format!("lead back to node {node}, which would be its own ancestor");
    GltfError::Document { pointer: format!("/nodes/{node}/children"), reason }
}

/// Returns nodes and what is below them, without those that are hidden.
pub(super) fn walk(nodes: &[json::Node], parents: &[Option<usize>], roots: &[usize], hiding: &[bool]) -> Vec<usize> {
    let mut seen = vec![false; nodes.len()];
    let mut order = Vec::new();
    let mut open: Vec<usize> = roots.iter().rev().copied().collect();
    while let Some(node) = open.pop() {
        if !std::mem::replace(&mut seen[node], true) && hiding.get(node) != Some(&true) {
            order.push(node);
            let first = open.len();
            open.extend(children(&nodes[node]).filter(|&child| parents[child] == Some(node)));
            open[first..].reverse();
        }
    }
    order
}

/// Returns a node's own transform.
pub(super) fn local(node: &Node) -> LocalTransform {
    match node.transform() {
        Transform::Matrix { matrix } => LocalTransform::Matrix(Mat4::from_cols_array_2d(&matrix).as_dmat4()),
        Transform::Decomposed { translation, rotation, scale } => {
            let [translation, scale] = [translation, scale].map(|v| glam::Vec3::from(v).as_dvec3());
            let rotation = glam::Quat::from_array(rotation).as_dquat();
            LocalTransform::Placement(Placement { translation, rotation, scale })
        }
    }
}

/// Returns the number of morph targets of a node's mesh: the greatest number of a primitive.
pub(super) fn target_count(node: &Node) -> usize {
    let primitives = node.mesh().into_iter().flat_map(|mesh| mesh.primitives());
    primitives.map(|primitive| primitive.morph_targets().count()).max().unwrap_or(0)
}
