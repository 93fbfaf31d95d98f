//! Finds out what the scene that is shown uses of a document: what isn't used may be wrong.

use std::collections::{BTreeSet, HashMap};

use ::gltf::Semantic;
use ::gltf::json::mesh::Primitive;
use ::gltf::json::validation::Checked;
use ::gltf::json::{Mesh, Root};

use super::nodes::{parents, walk};
use super::schema_check::Faults;

/// What the scene uses. The lists are those of the document.
#[derive(Debug, Default)]
pub(super) struct Reach {
    /// The nodes of the scene, the joints of its skins, and the ancestors of both.
    pub nodes: Vec<bool>,
    /// The nodes whose mesh is shown.
    pub shown: Vec<bool>,
    /// The nodes that hide themselves and what is below (KHR_node_visibility).
    pub hiding: Vec<bool>,
    /// How many nodes with a mesh are hidden.
    pub hidden: usize,
    pub skins: Vec<bool>,
    /// For each mesh, whether its vertices say which joints move them.
    pub bound: Vec<bool>,
    /// For each mesh, whether a node that is shown gives it a skin.
    pub skinned: Vec<bool>,
    /// For each mesh that is used, the morph targets that have a weight at rest.
    pub weighed: HashMap<usize, BTreeSet<usize>>,
}

impl Reach {
    /// Follows the scene that the document names, or all nodes if it has no scenes.
    pub(super) fn new(root: &Root, faults: &Faults, hiding: Vec<bool>) -> Self {
        let is_bound = |(m, mesh): (usize, &Mesh)| {
            let has = |k: usize, own: &Primitive, name: Semantic| {
                attribute(own, &name).is_some()
                    || faults.at(format_args!("/meshes/{m}/primitives/{k}/attributes/{}", name.to_string())).is_some()
            };
            let binds = |(k, own)| has(k, own, Semantic::Joints(0)) && has(k, own, Semantic::Weights(0));
            mesh.primitives.iter().enumerate().any(binds)
        };
        let mut reach = Self {
            nodes: vec![root.scene.is_none(); root.nodes.len()],
            shown: vec![false; root.nodes.len()],
            hiding,
            hidden: 0,
            skins: vec![false; root.skins.len()],
            bound: root.meshes.iter().enumerate().map(is_bound).collect(),
            skinned: vec![false; root.meshes.len()],
            weighed: HashMap::new(),
        };
        reach.walk(root, faults);
        reach
    }

    fn walk(&mut self, root: &Root, faults: &Faults) {
        let parents = parents(&root.nodes, |_| {});
        // Without scenes all nodes are shown, also those of a circle, which is refused later.
        let roots: Vec<usize> = match &root.scene {
            Some(scene) => root.scenes[scene.value()].nodes.iter().map(|node| node.value()).collect(),
            None => (0..parents.len()).filter(|&node| parents[node].is_none()).collect(),
        };
        let has_mesh =
            |node: usize| root.nodes[node].mesh.is_some() || faults.at(format_args!("/nodes/{node}/mesh")).is_some();
        let scene = walk(&root.nodes, &parents, &roots, &[]);
        let visible = walk(&root.nodes, &parents, &roots, &self.hiding);
        let count = |nodes: &[usize]| nodes.iter().filter(|&&node| has_mesh(node)).count();
        self.hidden = count(&scene) - count(&visible);
        let mut open = scene;
        open.extend(&roots);
        for node in visible.into_iter().filter(|&node| has_mesh(node)) {
            self.shown[node] = true;
            open.extend(self.look_at_shown(root, node));
        }
        let mut seen = vec![false; root.nodes.len()];
        while let Some(node) = open.pop() {
            self.nodes[node] = true;
            if !std::mem::replace(&mut seen[node], true) {
                open.extend(parents[node]);
            }
        }
    }

    /// Looks at a node whose mesh is shown. Returns the joints that move it.
    fn look_at_shown(&mut self, root: &Root, node: usize) -> Vec<usize> {
        let node = &root.nodes[node];
        let Some(mesh) = node.mesh.map(|mesh| mesh.value()) else { return Vec::new() };
        self.skinned[mesh] |= node.skin.is_some();
        let weights = node.weights.as_ref().or(root.meshes[mesh].weights.as_ref()).into_iter().flatten();
        let weighed = weights.enumerate().filter(|(_, weight)| **weight != 0.0).map(|(target, _)| target);
        self.weighed.entry(mesh).or_default().extend(weighed);
        let skin = node.skin.map(|skin| skin.value()).filter(|skin| self.bound[mesh] && !self.skins[*skin]);
        let Some(skin) = skin else { return Vec::new() };
        self.skins[skin] = true;
        root.skins[skin].joints.iter().map(|joint| joint.value()).collect()
    }
}

/// Returns the accessor of an attribute.
pub(super) fn attribute(primitive: &Primitive, name: &Semantic) -> Option<usize> {
    primitive.attributes.get(&Checked::Valid(name.clone())).map(|accessor| accessor.value())
}

/// Whether a primitive's positions are also there uncompressed.
pub(super) fn has_data(root: &Root, primitive: &Primitive) -> bool {
    let positions = attribute(primitive, &Semantic::Positions).and_then(|index| root.accessors.get(index));
    positions.is_some_and(|positions| positions.buffer_view.is_some())
}
