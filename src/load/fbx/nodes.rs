//! Places the nodes of a scene: their global transforms, and which ones the file shows.

use std::collections::HashMap;

use glam::DMat4;
use ufbx::{Element, Mesh, Node, Scene};

use super::convert::placement;
use super::morphs;
use super::nurbs::Meshes;
use crate::attachment::{LocalTransform, SceneNodes};
use crate::memory_budget::Budget;
use crate::model_file::ModelFile;
use crate::notes::{Notes, counted};
use crate::parts::level_names;
use crate::read_error::ReadError;
use geometry::mesh::rig::Clip;

/// How many corners, vertices, joints and shapes all nodes may have, and how many more for each byte of the file.
const MOST_ITEMS: u64 = 1 << 24;
const ITEMS_A_BYTE: u64 = 16;

/// The nodes of a scene with their places. A node's index is its `typed_id`.
pub(super) struct Placed {
    pub scene: SceneNodes,
    /// The transform from each node's own space to the scene's, in which the meshes are built.
    pub global: Vec<DMat4>,
    /// The nodes with a mesh that the file shows, in its order.
    pub shown: Vec<usize>,
    /// How many nodes with a mesh it hides.
    pub hidden: usize,
    /// Which nodes have a mesh, shown or not, on them or below them.
    pub carries_mesh: Vec<bool>,
    /// The nodes that are levels of detail other than the first, with their names.
    pub levels: HashMap<usize, String>,
}

impl Placed {
    /// Places all nodes. Adds a warning about meshes that are hidden, unless they are shown too.
    ///
    /// # Errors
    /// [`ReadError::TooMany`] if so many nodes have large meshes that reading them would take very long.
    pub(super) fn new(
        meshes: &Meshes,
        file: &ModelFile,
        budget: &Budget,
        notes: &mut Notes,
    ) -> Result<Self, ReadError> {
        check_instances(meshes, budget)?;
        let scene = meshes.scene;
        let nodes = &scene.nodes;
        let parents = nodes.into_iter().map(|node| node.parent.as_ref().map(|parent| index(parent))).collect();
        let mut order: Vec<usize> = (0..nodes.len()).collect();
        // A stable sort, which keeps siblings in order.
        order.sort_by_key(|&node| nodes[node].node_depth);
        let local = nodes.into_iter().map(|node| LocalTransform::Placement(placement(&node.local_transform))).collect();
        let mut own = SceneNodes { parents, order, local, ..SceneNodes::default() };
        let is_hidden = hidden(scene, file.selected.import.show_hidden, &own);
        let with_mesh = || (0..nodes.len()).filter(|&node| meshes.of(&nodes[node]).is_some());
        let shown: Vec<usize> = with_mesh().filter(|&node| !is_hidden[node]).collect();
        let hidden = with_mesh().count() - shown.len();
        notes.extend(counted([(hidden, "meshes that the file hides, left out (--show-hidden shows them)")]));
        own.carries = own.carrying(shown.iter().copied().chain(joints(scene, &shown)));
        let carries_mesh = own.carrying(with_mesh());
        let with_weights = |&node: &usize| {
            let rest = morphs::rest_weights(nodes[node].mesh.as_ref()?, &file.selected);
            (!rest.is_empty()).then_some((node, rest))
        };
        own.morphed = shown.iter().filter_map(with_weights).collect();
        let groups = scene.lod_groups.into_iter().flat_map(|group| &group.element.instances);
        let levels = groups.flat_map(|group| group.children.into_iter().enumerate().skip(1));
        let levels = levels.map(|(number, level)| (index(level), number)).collect();
        let levels = level_names(&levels, nodes.into_iter().map(|node| &*node.element.name).enumerate());
        Ok(Self { global: own.global(), scene: own, shown, hidden, carries_mesh, levels })
    }

    /// Lets nodes [grow](SceneNodes::grow).
    pub(super) fn grow(&mut self, clips: &[Clip]) {
        self.scene.grow(clips);
        self.global = self.scene.global();
    }
}

/// Adds up what is read for every node with a mesh: corners, vertices, joints, materials, shapes and their offsets. A small file may
/// have many nodes that share a large mesh.
fn check_instances(meshes: &Meshes, budget: &Budget) -> Result<(), ReadError> {
    let of_mesh = |mesh: &Mesh| {
        let keys = || morphs::channels(mesh).flat_map(|channel| channel.keyframes.iter());
        let offsets = keys().fold(0_u64, |sum, key| sum.saturating_add(1 + key.shape.offset_vertices.len() as u64));
        let joints: usize = mesh.skin_deformers.into_iter().map(|skin| skin.clusters.len()).sum();
        let lists = mesh.num_indices + mesh.num_vertices + joints + mesh.materials.len();
        offsets.saturating_add(lists as u64).saturating_add(morphs::channels(mesh).count() as u64)
    };
    let costs: Vec<u64> = meshes.scene.meshes.into_iter().map(of_mesh).collect();
    let limit = MOST_ITEMS.saturating_add(budget.files().saturating_mul(ITEMS_A_BYTE));
    let shown = meshes.scene.nodes.into_iter().filter_map(|node| meshes.of(node));
    // Polygons of surfaces aren't in the scene's list.
    let cost = |mesh: &Mesh| costs.get(mesh.element.typed_id as usize).copied().unwrap_or_else(|| of_mesh(mesh));
    let all = shown.fold(0_u64, |sum, mesh| sum.saturating_add(cost(mesh)));
    let what = "corners, vertices, joints and shapes in all copies of meshes";
    if all > limit { Err(ReadError::TooMany { limit, what }) } else { Ok(()) }
}

/// Returns a node's index in the scene.
pub(super) fn index(node: &Node) -> usize {
    node.element.typed_id as usize
}

/// Whether a switch of an object is on; none if the object doesn't have it. Of a switch that only an animation names, as in files before
/// version 6000, ufbx knows the value as a real number alone.
pub(super) fn is_set(element: &Element, name: &str) -> Option<bool> {
    ufbx::find_prop(&element.props, name).map(|prop| prop.value_int != 0 || prop.value_vec4.x != 0.0)
}

/// Whether a switch of an object is on, as it is if the object doesn't have it.
pub(super) fn is_on(element: &Element, name: &str) -> bool {
    is_set(element, name).unwrap_or(true)
}

/// Returns which nodes the file hides: those that are switched off, or whose display layer is, and those below them that inherit
/// it. None are if hidden nodes are shown.
fn hidden(scene: &Scene, show_hidden: bool, nodes: &SceneNodes) -> Vec<bool> {
    let mut is_off: Vec<bool> = scene.nodes.into_iter().map(|node| !is_on(&node.element, "Visibility")).collect();
    let layers = scene.display_layers.into_iter().filter(|layer| !is_on(&layer.element, "Show"));
    layers.flat_map(|layer| &layer.nodes).for_each(|node| is_off[index(node)] = true);
    if show_hidden {
        is_off.fill(false);
    }
    let mut hidden = vec![false; nodes.order.len()];
    for &node in &nodes.order {
        let (own, above) = (&scene.nodes[node].element, nodes.parents[node]);
        let inherits = || is_on(own, "Visibility Inheritance");
        hidden[node] = is_off[node] || above.is_some_and(|above| hidden[above] && inherits());
    }
    hidden
}

/// Returns the joints of the skins of these nodes' meshes.
pub(super) fn joints(scene: &Scene, shown: &[usize]) -> impl Iterator<Item = usize> {
    let skins = shown.iter().filter_map(|&node| scene.nodes[node].mesh.as_ref()).flat_map(|mesh| &mesh.skin_deformers);
    let joints = skins.flat_map(|skin| &skin.clusters).filter_map(|cluster| cluster.bone_node.as_ref());
    joints.map(|joint| index(joint))
}
