//! Finds out what the scene that is shown uses of a document, before anything is checked: what isn't used may be broken.

use std::collections::HashMap;

use serde_json::{Map, Value};

use super::schema::{DRACO, KHR_MESHOPT, MESHOPT, VISIBILITY};

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
    pub meshes: Vec<bool>,
    pub skins: Vec<bool>,
    /// For each mesh, whether its vertices say which joints move them.
    bound: Vec<bool>,
    /// For each mesh, whether a node that is shown gives it a skin.
    skinned: Vec<bool>,
    /// For each mesh, the morph targets that have a weight at rest.
    weighed: HashMap<usize, Vec<bool>>,
}

impl Reach {
    /// Follows the scene that the document names, or all nodes if it has no scenes; `show_hidden` says whether nodes that hide themselves
    /// are shown too. Indices of things that don't exist are left aside here.
    pub(super) fn of(root: &Map<String, Value>, show_hidden: bool) -> Self {
        let count = |name| list(root, name).len();
        let mut reach = Self {
            nodes: vec![false; count("nodes")],
            shown: vec![false; count("nodes")],
            hiding: list(root, "nodes").iter().map(|node| !show_hidden && hides(node)).collect(),
            meshes: vec![false; count("meshes")],
            skins: vec![false; count("skins")],
            bound: list(root, "meshes").iter().map(is_bound).collect(),
            skinned: vec![false; count("meshes")],
            ..Self::default()
        };
        reach.walk(root);
        reach.look_at_meshes(root);
        reach
    }

    /// Returns whether a skin of a node that is shown moves a mesh.
    pub(super) fn is_skinned(&self, mesh: usize) -> bool {
        self.skinned[mesh] && self.bound[mesh]
    }

    /// Returns whether vertices of a mesh say which joints move them.
    pub(super) fn is_bound(&self, mesh: Option<usize>) -> bool {
        mesh.is_some_and(|mesh| self.bound.get(mesh) == Some(&true))
    }

    /// Returns whether a mesh's morph target has a weight at rest.
    pub(super) fn is_weighed(&self, mesh: usize, target: usize) -> bool {
        self.weighed.get(&mesh).and_then(|weighed| weighed.get(target)) == Some(&true)
    }

    /// Finds the nodes of the scene and below, those whose mesh is shown, and the joints of these.
    fn walk(&mut self, root: &Map<String, Value>) {
        let nodes = list(root, "nodes");
        let scene = root.get("scene").and_then(Value::as_u64).and_then(|scene| usize::try_from(scene).ok());
        let scene = scene.and_then(|scene| list(root, "scenes").get(scene));
        let parents = parents(nodes);
        // Without scenes all nodes are shown, also those of a circle, which is refused later.
        let roots: Vec<_> = scene.map_or_else(
            || (0..nodes.len()).filter(|node| parents[*node].is_none()).collect(),
            |scene| indices(scene, "nodes").filter(|node| *node < nodes.len()).collect(),
        );
        let mut below = vec![false; nodes.len()];
        let mut open: Vec<_> = roots.iter().map(|node| (*node, false)).collect();
        let mut hung = Vec::new();
        while let Some((node, hidden)) = open.pop() {
            if std::mem::replace(&mut self.nodes[node], true) {
                continue;
            }
            let hidden = hidden || self.hiding[node];
            let has_mesh = nodes[node].get("mesh").is_some_and(|mesh| !mesh.is_null());
            self.shown[node] = has_mesh && !hidden;
            self.hidden += usize::from(has_mesh && hidden);
            if self.shown[node] {
                hung.extend(self.skin_of(root, node));
            }
            // A node has one place, among the children of its first parent.
            let children = indices(&nodes[node], "children");
            for child in children.filter(|child| parents.get(*child) == Some(&Some(node))) {
                below[child] = true;
                open.push((child, hidden));
            }
        }
        if scene.is_none() {
            self.nodes.fill(true);
        }
        hung.sort_unstable();
        hung.dedup();
        let skins = list(root, "skins");
        let joints = hung.iter().flat_map(|skin| indices(&skins[*skin], "joints"));
        let mut open: Vec<_> = roots.into_iter().chain(joints.filter(|joint| *joint < nodes.len())).collect();
        hung.iter().for_each(|skin| self.skins[*skin] = true);
        while let Some(node) = open.pop() {
            self.nodes[node] = true;
            if !std::mem::replace(&mut below[node], true) {
                open.extend(parents[node]);
            }
        }
    }

    /// Returns the skin that moves a node's mesh.
    fn skin_of(&self, root: &Map<String, Value>, node: usize) -> Option<usize> {
        let node = list(root, "nodes").get(node)?;
        let skin = index(node, "skin").filter(|skin| *skin < self.skins.len())?;
        self.is_bound(index(node, "mesh")).then_some(skin)
    }

    /// Looks at the nodes whose meshes are shown: their meshes, and weights of morph targets.
    fn look_at_meshes(&mut self, root: &Map<String, Value>) {
        let meshes = list(root, "meshes");
        // The meshes whose own weights are used.
        let mut own_weights = vec![false; meshes.len()];
        for (_, node) in list(root, "nodes").iter().enumerate().filter(|(i, _)| self.shown[*i]) {
            let Some(mesh) = index(node, "mesh").filter(|mesh| *mesh < meshes.len()) else { continue };
            self.meshes[mesh] = true;
            self.skinned[mesh] |= node.get("skin").is_some_and(|skin| !skin.is_null());
            let weights = match node.get("weights").filter(|weights| !weights.is_null()) {
                Some(_) => values(node, "weights"),
                None if std::mem::replace(&mut own_weights[mesh], true) => &[],
                None => values(&meshes[mesh], "weights"),
            };
            let weighed = self.weighed.entry(mesh).or_default();
            weighed.resize(weighed.len().max(weights.len()), false);
            weighed.iter_mut().zip(weights).for_each(|(weighed, weight)| *weighed |= weight.as_f64() != Some(0.0));
        }
    }
}

/// Returns the first parent of each node.
fn parents(nodes: &[Value]) -> Vec<Option<usize>> {
    let mut parents = vec![None; nodes.len()];
    for (parent, node) in nodes.iter().enumerate() {
        for child in indices(node, "children") {
            if let Some(known) = parents.get_mut(child) {
                known.get_or_insert(parent);
            }
        }
    }
    parents
}

fn hides(node: &Value) -> bool {
    extension(node, VISIBILITY).and_then(|own| own.get("visible")) == Some(&Value::Bool(false))
}

/// Returns whether a primitive has triangles: it has positions, and consists neither of points nor of lines.
pub(super) fn is_drawn(primitive: &Value) -> bool {
    attribute(primitive, "POSITION").is_some() && !matches!(primitive.get("mode").and_then(Value::as_u64), Some(0..=3))
}

/// Returns whether vertices of a mesh say which joints move them.
fn is_bound(mesh: &Value) -> bool {
    let binds = |primitive: &Value| {
        is_drawn(primitive) && ["JOINTS_0", "WEIGHTS_0"].iter().all(|name| attribute(primitive, name).is_some())
    };
    values(mesh, "primitives").iter().any(binds)
}

/// Returns whether an attribute says how joints move vertices.
pub(super) fn is_influence(name: &str) -> bool {
    name.starts_with("JOINTS_") || name.starts_with("WEIGHTS_")
}

/// Returns the Draco data that a primitive is read from. If the document doesn't require Draco, a primitive that also has
/// uncompressed data is read from that.
pub(super) fn packed<'a>(root: &Map<String, Value>, primitive: &'a Value, requires_draco: bool) -> Option<&'a Value> {
    let position = attribute(primitive, "POSITION").and_then(whole);
    let position = position.and_then(|position| list(root, "accessors").get(position));
    let is_beside = position.and_then(|position| position.get("bufferView")).is_some_and(|view| !view.is_null());
    extension(primitive, DRACO).filter(|_| requires_draco || !is_beside)
}

/// Returns one of the document's lists; an empty one if it is missing or no list.
pub(super) fn list<'a>(root: &'a Map<String, Value>, name: &str) -> &'a [Value] {
    root.get(name).and_then(Value::as_array).map_or(&[], Vec::as_slice)
}

fn values<'a>(object: &'a Value, name: &str) -> &'a [Value] {
    object.get(name).and_then(Value::as_array).map_or(&[], Vec::as_slice)
}

/// The extension that compresses a buffer view, or that is about such views on a buffer, with its name.
pub(super) fn compression(object: &Value) -> Option<(&'static str, &Value)> {
    [KHR_MESHOPT, MESHOPT].into_iter().find_map(|name| Some((name, extension(object, name)?)))
}

pub(super) fn extension<'a>(object: &'a Value, name: &str) -> Option<&'a Value> {
    object.get("extensions")?.get(name).filter(|own| !own.is_null())
}

fn attribute<'a>(object: &'a Value, name: &str) -> Option<&'a Value> {
    object.get("attributes")?.get(name).filter(|value| !value.is_null())
}

fn whole(value: &Value) -> Option<usize> {
    value.as_u64().and_then(|value| usize::try_from(value).ok())
}

fn index(object: &Value, name: &str) -> Option<usize> {
    object.get(name).and_then(whole)
}

fn indices<'a>(object: &'a Value, name: &str) -> impl Iterator<Item = usize> + 'a {
    values(object, name).iter().filter_map(whole)
}
