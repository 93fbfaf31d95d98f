//! Reads skins: joints, and the four that move each vertex most.

use glam::DMat4;
use ufbx::{Mesh, Node, SkinDeformer};

use super::convert::matrix;
use super::nodes;
use crate::rig_builder::SkinJoints;

/// The greatest number of joints of a vertex.
const MOST: usize = 4;

/// The skin of a mesh.
pub(super) struct Skin<'a> {
    deformer: &'a SkinDeformer,
    /// Its clusters that have a joint.
    pub joints: SkinJoints,
    /// For each joint, the matrix that takes a vertex to the scene.
    matrices: Vec<DMat4>,
    /// For each cluster, the index of its joint.
    joint_of: Vec<Option<usize>>,
}

impl<'a> Skin<'a> {
    /// Reads the skin of a node's mesh, if it has one. `global` has the places of all nodes. Joints move the mesh as the first of its
    /// nodes has it; the others have copies.
    pub(super) fn new(node: &Node, mesh: &'a Mesh, global: &[DMat4]) -> Option<Self> {
        let deformer = mesh.skin_deformers.into_iter().next()?;
        let placed = |node: &Node| global[nodes::index(node)] * matrix(&node.geometry_to_node);
        let first = mesh.element.instances.first().filter(|first| nodes::index(first) != nodes::index(node));
        let place = first.map(|first| placed(node) * placed(first).inverse()).filter(DMat4::is_finite);
        let place = place.unwrap_or(DMat4::IDENTITY);
        let mut joints = SkinJoints { nodes: Vec::new(), inverse_binds: Vec::new(), place };
        let joint_of = deformer.clusters.into_iter().map(|cluster| {
            let bone = cluster.bone_node.as_ref()?;
            joints.nodes.push(nodes::index(bone));
            joints.inverse_binds.push(matrix(&cluster.geometry_to_bone));
            Some(joints.nodes.len() - 1)
        });
        let joint_of = joint_of.collect();
        let matrices = joints.matrices(global);
        Some(Self { deformer, joints, matrices, joint_of })
    }

    /// Collects the joints that move a vertex most, with weights that add up to 1. There are none if no joint moves it.
    /// Returns whether others were left out.
    pub(super) fn influences(&self, vertex: usize, found: &mut Vec<(usize, f64)>) -> bool {
        found.clear();
        let Some(own) = self.deformer.vertices.get(vertex) else { return false };
        let (first, count) = (own.weight_begin as usize, own.num_weights as usize);
        let weights = self.deformer.weights.get(first..first.saturating_add(count)).unwrap_or_default();
        // They are sorted, the largest first.
        let mut known = weights.iter().filter_map(|weight| {
            let joint = (*self.joint_of.get(weight.cluster_index as usize)?)?;
            (weight.weight > 0.0 && weight.weight.is_finite()).then_some((joint, weight.weight))
        });
        found.extend(known.by_ref().take(MOST));
        let total: f64 = found.iter().map(|(_, weight)| weight).sum();
        found.iter_mut().for_each(|(_, weight)| *weight /= total);
        if !total.is_finite() {
            found.clear();
        }
        known.next().is_some()
    }

    /// Returns the matrix that takes a vertex with these joints to the scene.
    pub(super) fn matrix(&self, influences: &[(usize, f64)]) -> DMat4 {
        influences.iter().fold(DMat4::ZERO, |sum, &(joint, weight)| sum + self.matrices[joint] * weight)
    }
}
