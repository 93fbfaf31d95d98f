//! A whole mesh in a pose: what the deform pass does on the device, for whatever measures, exports or asks where things
//! are.

use std::sync::{Arc, OnceLock};

use glam::Vec3;

use super::deform::{blend, deform_normal, deform_position};
use super::normal::unit_or;
use crate::mesh::rig::{Binding, JointMatrix};
use crate::mesh::{Bounds, Mesh, Moment, Pose, Rig, Topology};

/// Positions that the bounds of a clip are taken from, at most.
const BOUNDS_POSITIONS: usize = 1 << 19;
/// Times at which they are taken, ends included.
const BOUNDS_TIMES: usize = 17;

/// Corners of a mesh that is deformed in no time that a person notices.
const QUICK: usize = 1 << 16;

/// A mesh, and the pose in which it is wanted. Clones share what has been made of it.
#[derive(Clone, Debug)]
pub struct Posed {
    mesh: Arc<Mesh>,
    topology: Arc<Topology>,
    /// None at rest.
    pose: Option<Arc<Pose>>,
    deformed: Arc<OnceLock<Deformed>>,
}

/// A mesh and its topology.
pub type Deformed = (Arc<Mesh>, Arc<Topology>);

impl Posed {
    pub fn new(mesh: Arc<Mesh>, topology: Arc<Topology>, pose: Option<Arc<Pose>>) -> Self {
        Self { mesh, topology, pose, deformed: Arc::default() }
    }

    pub fn pose(&self) -> Option<&Pose> {
        self.pose.as_deref()
    }

    /// Both in the pose. May take a while the first time.
    pub fn deformed(&self) -> Deformed {
        let make = || match &self.pose {
            None => (self.mesh.clone(), self.topology.clone()),
            Some(pose) => {
                let (mesh, topology) = deform(&self.mesh, &self.topology, pose);
                (Arc::new(mesh), Arc::new(topology))
            }
        };
        self.deformed.get_or_init(make).clone()
    }

    /// The same for who can't wait: none where it would take long and nobody has asked for it before.
    pub fn deformed_soon(&self) -> Option<Deformed> {
        let is_quick = self.pose.is_none() || self.mesh.corners.len() <= QUICK;
        if is_quick { Some(self.deformed()) } else { self.deformed.get().cloned() }
    }
}

/// The mesh and its topology in a pose; both as they are where the mesh doesn't move. What was connected stays so, also
/// where points fall together, and edges keep their kinds. The deformed mesh moves no further.
pub fn deform(mesh: &Mesh, topology: &Topology, pose: &Pose) -> (Mesh, Topology) {
    let (mut mesh, mut topology) = (mesh.clone(), topology.clone());
    let Some(rig) = mesh.rig.take() else { return (mesh, topology) };
    for (point, &corner) in topology.points.iter_mut().zip(&topology.point_corners) {
        *point = posed_position(&rig, pose, corner);
    }
    for (index, (corner, &point)) in (0..).zip(mesh.corners.iter_mut().zip(&topology.corner_points)) {
        corner.position = topology.points[point as usize];
        corner.normal = posed_normal(&rig, pose, index);
    }
    (mesh, topology)
}

/// The bounds of a mesh at rest and all through a clip, taken at 17 of its times, of meshes with many corners from some of
/// them; at rest alone without a clip.
pub fn bounds_through(mesh: &Mesh, clip: Option<usize>) -> Bounds {
    let moving = mesh.rig.as_ref().zip(clip).and_then(|(rig, index)| Some((rig, index, rig.clips.get(index)?)));
    let Some((rig, index, clip)) = moving else { return mesh.bounds() };
    let mut positions: Vec<Vec3> = mesh.corners.iter().map(|corner| corner.position).collect();
    let stride = (BOUNDS_TIMES * mesh.corners.len()).div_ceil(BOUNDS_POSITIONS).max(1);
    for i in 0..BOUNDS_TIMES {
        let time = clip.duration * i as f64 / (BOUNDS_TIMES - 1) as f64;
        let pose = rig.pose(Moment { clip: index, time });
        let corners = (0..mesh.corners.len() as u32).step_by(stride);
        positions.extend(corners.map(|corner| posed_position(rig, &pose, corner)));
    }
    Bounds::of(positions.into_iter())
}

/// Morph targets come first, then joints (glTF 2.0, section 3.7.2.2).
fn posed_position(rig: &Rig, pose: &Pose, corner: u32) -> Vec3 {
    let bound = &rig.bindings[corner as usize];
    let mut position = Vec3::from(bound.position);
    for delta in &rig.deltas[bound.first_delta as usize..][..bound.delta_count as usize] {
        position += Vec3::from(delta.position) * pose.weights[delta.weight as usize];
    }
    deform_position(&posed_matrix(pose, bound), position)
}

fn posed_normal(rig: &Rig, pose: &Pose, corner: u32) -> Vec3 {
    let bound = &rig.bindings[corner as usize];
    let mut normal = Vec3::from(bound.normal);
    for delta in &rig.deltas[bound.first_delta as usize..][..bound.delta_count as usize] {
        normal += Vec3::from(delta.normal) * pose.weights[delta.weight as usize];
    }
    deform_normal(&posed_matrix(pose, bound), unit_or(normal, bound.normal.into()))
}

fn posed_matrix(pose: &Pose, bound: &Binding) -> JointMatrix {
    let [a, b, c, d] = bound.joints.map(|joint| &pose.palette[joint as usize]);
    blend(a, b, c, d, bound.weights)
}
