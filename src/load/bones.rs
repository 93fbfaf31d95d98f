//! Lists the joints of skins, so that they can be shown.

use geometry::casts::to_u32;
use geometry::mesh::Bone;
use glam::DMat4;

use super::rig_builder::RigBuilder;

/// Returns the bones of these joints, at rest: each once, parents before children. `order` has all nodes, parents before children, and
/// `global` their places. If there is a binder, it is told what moves the bones.
pub(super) fn bones(
    joints: impl Iterator<Item = usize>,
    order: &[usize],
    parents: &[Option<usize>],
    global: &[DMat4],
    mut binder: Option<&mut RigBuilder>,
) -> Vec<Bone> {
    let mut is_joint = vec![false; parents.len()];
    joints.for_each(|joint| is_joint[joint] = true);
    // Of each node the bone that it is, or else the nearest one above it.
    let mut nearest: Vec<Option<u32>> = vec![None; parents.len()];
    let mut bones = Vec::new();
    for &node in order {
        let parent = parents[node].and_then(|parent| nearest[parent]);
        nearest[node] = if is_joint[node] { Some(to_u32(bones.len())) } else { parent };
        if is_joint[node] {
            bones.push(Bone { place: global[node].w_axis.truncate().as_vec3(), parent });
            binder.iter_mut().for_each(|binder| binder.add_bone(node));
        }
    }
    bones
}
