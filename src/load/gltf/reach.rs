//! Finds out what the scene that is shown uses of a document, before anything is checked: what isn't used may be broken.

use std::collections::HashMap;

use serde_json::{Map, Value};

use super::schema::{
    DRACO, INSTANCING, KHR_MESHOPT, MESHOPT, VISIBILITY, is_attribute, is_detail, is_displacement, is_placement,
};

/// How something is used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Use {
    /// Not at all.
    #[default]
    None,
    /// By looks or animations: a fault costs a warning.
    Detail,
    /// By the shape: a fault is an error.
    Shape,
}

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
    pub accessors: Vec<Use>,
    pub views: Vec<Use>,
    pub buffers: Vec<Use>,
    /// For each mesh, whether its vertices say which joints move them.
    bound: Vec<bool>,
    /// For each mesh, whether a node that is shown gives it a skin.
    skinned: Vec<bool>,
    /// For each mesh, the morph targets that have a weight at rest.
    weighed: HashMap<usize, Vec<bool>>,
    /// The meshes whose own weights are used.
    own_weights: Vec<bool>,
    /// How the data of each accessor is used. It isn't where Draco has the data.
    data: Vec<Use>,
}

/// What else uses accessors and buffer views.
pub(super) struct Beside<'a> {
    pub animations: &'a [Value],
    pub images: &'a [Value],
    pub requires_draco: bool,
    /// Whether nodes that hide themselves are shown too.
    pub show_hidden: bool,
}

impl Reach {
    /// Follows the scene that the document names, or all nodes if it has no scenes. Indices of things that don't exist are left
    /// aside here.
    pub(super) fn of(root: &Map<String, Value>, beside: &Beside) -> Self {
        let count = |name| list(root, name).len();
        let mut reach = Self {
            nodes: vec![false; count("nodes")],
            shown: vec![false; count("nodes")],
            hiding: list(root, "nodes").iter().map(|node| !beside.show_hidden && hides(node)).collect(),
            meshes: vec![false; count("meshes")],
            skins: vec![false; count("skins")],
            accessors: vec![Use::None; count("accessors")],
            data: vec![Use::None; count("accessors")],
            views: vec![Use::None; count("bufferViews")],
            buffers: vec![Use::None; count("buffers")],
            bound: list(root, "meshes").iter().map(is_bound).collect(),
            skinned: vec![false; count("meshes")],
            own_weights: vec![false; count("meshes")],
            ..Self::default()
        };
        reach.walk(root);
        reach.look_at_nodes(root);
        for (i, mesh) in list(root, "meshes").iter().enumerate() {
            let primitives = if reach.meshes[i] { values(mesh, "primitives") } else { &[] };
            for primitive in primitives {
                reach.look_at_primitive(root, i, primitive, beside.requires_draco);
            }
        }
        for sampler in beside.animations.iter().flat_map(|animation| values(animation, "samplers")) {
            for name in ["input", "output"] {
                reach.mark(index(sampler, name), Use::Detail, true);
            }
        }
        for view in beside.images.iter().filter_map(|image| index(image, "bufferView")) {
            raise(&mut reach.views, view, Use::Detail);
        }
        reach.follow_data(root);
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

    /// Returns how a mesh's morph target is used.
    pub(super) fn target(&self, mesh: usize, target: usize) -> Use {
        let is_weighed = self.weighed.get(&mesh).and_then(|weighed| weighed.get(target));
        if is_weighed == Some(&true) { Use::Shape } else { Use::Detail }
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

    /// Looks at the nodes whose meshes are shown: their meshes, instances, and weights of morph targets.
    fn look_at_nodes(&mut self, root: &Map<String, Value>) {
        let meshes = list(root, "meshes");
        for (i, node) in list(root, "nodes").iter().enumerate() {
            if !self.shown[i] {
                continue;
            }
            for (name, accessor) in extension(node, INSTANCING).into_iter().flat_map(|own| members(own, "attributes")) {
                if is_placement(name) {
                    self.mark(whole(accessor), Use::Shape, true);
                }
            }
            let Some(mesh) = index(node, "mesh").filter(|mesh| *mesh < meshes.len()) else { continue };
            self.meshes[mesh] = true;
            self.skinned[mesh] |= node.get("skin").is_some_and(|skin| !skin.is_null());
            let weights = match node.get("weights").filter(|weights| !weights.is_null()) {
                Some(_) => values(node, "weights"),
                None if std::mem::replace(&mut self.own_weights[mesh], true) => &[],
                None => values(&meshes[mesh], "weights"),
            };
            let weighed = self.weighed.entry(mesh).or_default();
            weighed.resize(weighed.len().max(weights.len()), false);
            weighed.iter_mut().zip(weights).for_each(|(weighed, weight)| *weighed |= weight.as_f64() != Some(0.0));
        }
        for (i, skin) in list(root, "skins").iter().enumerate() {
            if self.skins[i] {
                self.mark(index(skin, "inverseBindMatrices"), Use::Shape, true);
            }
        }
    }

    fn look_at_primitive(&mut self, root: &Map<String, Value>, mesh: usize, primitive: &Value, requires_draco: bool) {
        if !is_drawn(primitive) {
            return;
        }
        let packed = packed(root, primitive, requires_draco);
        let is_packed = |name: &str| packed.is_some_and(|packed| attribute(packed, name).is_some());
        for (name, accessor) in members(primitive, "attributes").filter(|(name, _)| is_attribute(name)) {
            let found = match name {
                _ if is_detail(name) => Use::Detail,
                _ if is_influence(name) && !self.is_skinned(mesh) => continue,
                _ => Use::Shape,
            };
            self.mark(whole(accessor), found, !is_packed(name));
        }
        self.mark(index(primitive, "indices"), Use::Shape, packed.is_none());
        for (i, target) in values(primitive, "targets").iter().enumerate() {
            let of_target = self.target(mesh, i);
            for (name, accessor) in target.as_object().into_iter().flatten().filter(|(name, _)| is_displacement(name)) {
                self.mark(whole(accessor), if is_detail(name) { Use::Detail } else { of_target }, true);
            }
        }
        if let Some(view) = packed.and_then(|packed| index(packed, "bufferView")) {
            raise(&mut self.views, view, Use::Shape);
        }
    }

    fn mark(&mut self, accessor: Option<usize>, found: Use, has_data: bool) {
        let Some(accessor) = accessor else { return };
        raise(&mut self.accessors, accessor, found);
        if has_data {
            raise(&mut self.data, accessor, found);
        }
    }

    /// Follows accessors to their views, and views to their buffers.
    fn follow_data(&mut self, root: &Map<String, Value>) {
        for (accessor, found) in list(root, "accessors").iter().zip(&self.data) {
            let sparse = ["/sparse/indices", "/sparse/values"].map(|place| accessor.pointer(place));
            for place in [Some(accessor)].into_iter().chain(sparse).flatten() {
                if let Some(view) = index(place, "bufferView") {
                    raise(&mut self.views, view, *found);
                }
            }
        }
        for (view, found) in list(root, "bufferViews").iter().zip(&self.views) {
            // A compressed view's own buffer is only a fallback, which is read if the compressed data is broken.
            let packed = compression(view).map(|(_, packed)| packed);
            let source = packed.unwrap_or(view);
            let copy = index(view, "buffer").filter(|_| packed.is_some() && *found != Use::None);
            let is_copy =
                |buffer: &usize| list(root, "buffers").get(*buffer).is_some_and(|buffer| compression(buffer).is_some());
            if let Some(buffer) = copy.filter(is_copy) {
                raise(&mut self.buffers, buffer, Use::Detail);
            }
            if let Some(buffer) = index(source, "buffer") {
                raise(&mut self.buffers, buffer, *found);
            }
        }
    }
}

fn raise(uses: &mut [Use], place: usize, found: Use) {
    if let Some(known) = uses.get_mut(place) {
        *known = found.max(*known);
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

fn members<'a>(object: &'a Value, name: &str) -> impl Iterator<Item = (&'a str, &'a Value)> {
    let members = object.get(name).and_then(Value::as_object).into_iter().flatten();
    members.map(|(name, value)| (name.as_str(), value))
}

/// The extension that compresses a buffer view, or that is about such views on a buffer, with its name.
pub(super) fn compression(object: &Value) -> Option<(&'static str, &Value)> {
    [KHR_MESHOPT, MESHOPT].into_iter().find_map(|name| Some((name, extension(object, name)?)))
}

fn extension<'a>(object: &'a Value, name: &str) -> Option<&'a Value> {
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
