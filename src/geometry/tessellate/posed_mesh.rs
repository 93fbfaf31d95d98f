//! Meshes deformed into a pose on the CPU, as the deform pass does on the GPU: for measuring, exporting and finding
//! positions.

use std::ops::Range;
use std::sync::{Arc, OnceLock};

use glam::{Vec3, Vec4};

use super::deform::{blend, deform_normal, deform_position, deform_tangent, scaled_unit_or, turn_along};
use super::normal::unit_or;
use super::patch_bounds::PatchBounds;
use crate::mesh::rig::{Binding, Delta, JointMatrix};
use crate::mesh::{Bounds, Mesh, Moment, Pose, Rig, Topology};

/// The largest number of positions from which the bounds of an animation clip are taken.
const BOUNDS_POSITIONS: usize = 1 << 19;
/// The number of times of a clip at which they are taken, with both its ends.
const BOUNDS_TIMES: usize = 17;

/// Meshes of up to this many corners are deformed so quickly that no one notices.
const QUICK: usize = 1 << 16;

/// A mesh with the pose in which it is wanted. The deformed mesh is made when first requested; clones share it.
#[derive(Clone, Debug)]
pub struct PosedMesh {
    mesh: Arc<Mesh>,
    topology: Arc<Topology>,
    /// `None` for the mesh at rest.
    pose: Option<Arc<Pose>>,
    deformed: Arc<OnceLock<Deformed>>,
    /// See [`Self::see_through_bounds`].
    see_through: Arc<OnceLock<Option<Vec<PatchBounds>>>>,
}

/// A mesh and its topology.
pub type Deformed = (Arc<Mesh>, Arc<Topology>);

impl PosedMesh {
    pub fn new(mesh: Arc<Mesh>, topology: Arc<Topology>, pose: Option<Arc<Pose>>) -> Self {
        Self { mesh, topology, pose, deformed: Arc::default(), see_through: Arc::default() }
    }

    pub fn pose(&self) -> Option<&Pose> {
        self.pose.as_deref()
    }

    /// Returns the deformed mesh and its topology. The first call may take long.
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

    /// Returns the deformed mesh and its topology, or `None` if making them would take long and no one has made them
    /// before.
    pub fn deformed_if_quick(&self) -> Option<Deformed> {
        let is_quick = self.pose.is_none() || self.mesh.corners.len() <= QUICK;
        if is_quick { Some(self.deformed()) } else { self.deformed.get().cloned() }
    }

    /// Returns the bounds of some patches in this pose, or `None` if there are none.
    pub(crate) fn bounds_of(&self, patches: Range<u32>) -> Option<PatchBounds> {
        let moving = self.mesh.rig.as_ref().zip(self.pose.as_ref());
        let position = |point: u32| match moving {
            None => self.topology.points[point as usize],
            Some((rig, pose)) => posed_position(rig, pose, self.topology.point_corners[point as usize]),
        };
        let points = |corner: u32| self.topology.corner_points[corner as usize];
        PatchBounds::new(patches.map(|patch| self.topology.patch_corners(patch).map(points).map(position)))
    }

    /// Returns the bounds of each material that shows what is behind it, or `None` if finding them takes long in this pose. They
    /// are found at the first call; clones share them.
    pub fn see_through_bounds(&self) -> Option<&[PatchBounds]> {
        let find = || {
            let materials = self.mesh.materials.iter().zip(&self.topology.material_patches);
            let patches = materials.filter(|(material, _)| material.shows_behind()).map(|(_, patches)| patches.clone());
            let count: usize = patches.clone().map(|patches| patches.len()).sum();
            let is_quick = self.pose.is_none() || count <= QUICK / 3;
            is_quick.then(|| patches.filter_map(|patches| self.bounds_of(patches)).collect())
        };
        self.see_through.get_or_init(find).as_deref()
    }
}

/// Returns a mesh and its topology in a pose, or copies of both if the mesh doesn't move. Connections and the kinds of
/// edges stay as they are, even if points come to lie on each other. The returned mesh has no rig.
pub fn deform(mesh: &Mesh, topology: &Topology, pose: &Pose) -> (Mesh, Topology) {
    let (mut mesh, mut topology) = (mesh.clone(), topology.clone());
    let Some(rig) = mesh.rig.take() else { return (mesh, topology) };
    (mesh.lights, mesh.cameras, mesh.bones) = (mesh.lights_in(pose), mesh.cameras_in(pose), mesh.bones_in(Some(pose)));
    for (point, &corner) in topology.points.iter_mut().zip(&topology.point_corners) {
        *point = posed_position(&rig, pose, corner);
    }
    for ((corner, bound), &point) in mesh.corners.iter_mut().zip(&rig.bindings).zip(&topology.corner_points) {
        corner.position = topology.points[point as usize];
        corner.normal = deform_normal(&posed_matrix(pose, bound), morphed_normal(&rig, pose, bound));
    }
    if let Some(details) = mesh.details.as_mut().filter(|_| !rig.tangents.is_empty()) {
        for (index, detail) in (0..).zip(Arc::make_mut(details)) {
            let tangent = posed_tangent(&rig, pose, index);
            (detail.tangent, detail.bitangent_sign) = (tangent.truncate(), tangent.w);
        }
    }
    (mesh, topology)
}

/// Returns the bounds of a mesh at rest and during an animation clip, or at rest only if there is no clip. The clip is
/// sampled at 17 times. Of meshes with many corners only some are used.
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
    Bounds::new(positions.into_iter())
}

/// Applies morph targets and then joints to a corner's position (glTF 2.0, section 3.7.2.2).
fn posed_position(rig: &Rig, pose: &Pose, corner: u32) -> Vec3 {
    let bound = &rig.bindings[corner as usize];
    let position = morphed(bound.position.into(), deltas_of(rig, bound), pose, |delta| delta.position.into());
    deform_position(&posed_matrix(pose, bound), position)
}

/// Returns the displacements of a corner by morph targets.
fn deltas_of<'a>(rig: &'a Rig, bound: &Binding) -> &'a [Delta] {
    &rig.deltas[bound.first_delta as usize..][..bound.delta_count as usize]
}

/// Adds what each morph target adds, times its weight.
fn morphed(own: Vec3, deltas: &[Delta], pose: &Pose, added: impl Fn(&Delta) -> Vec3) -> Vec3 {
    deltas.iter().fold(own, |sum, delta| sum + added(delta) * pose.weights[delta.weight as usize])
}

/// Returns the unit normal of a corner that morph targets have turned.
fn morphed_normal(rig: &Rig, pose: &Pose, bound: &Binding) -> Vec3 {
    let normal = morphed(bound.normal.into(), deltas_of(rig, bound), pose, |delta| delta.normal.into());
    unit_or(normal, bound.normal.into())
}

/// Applies morph targets and then joints to a corner's tangent. Targets that don't displace tangents turn it along with the
/// normal.
fn posed_tangent(rig: &Rig, pose: &Pose, corner: u32) -> Vec4 {
    let bound = &rig.bindings[corner as usize];
    let rest = Vec4::from(rig.tangents[corner as usize]);
    let (own, sign) = (rest.truncate(), rest.w);
    let deltas = deltas_of(rig, bound);
    let displacement = |delta: &Delta| Vec4::from(rig.tangents[delta.tangent as usize]).truncate();
    let tangent = match deltas.first() {
        None => own,
        Some(first) if first.tangent > 0 => scaled_unit_or(morphed(own, deltas, pose, displacement), own),
        Some(_) => {
            let normal = Vec3::from(bound.normal);
            turn_along(own, unit_or(normal, normal), morphed_normal(rig, pose, bound))
        }
    };
    deform_tangent(&posed_matrix(pose, bound), tangent.extend(sign))
}

/// Returns the blended matrix of a corner's joints.
fn posed_matrix(pose: &Pose, bound: &Binding) -> JointMatrix {
    let [a, b, c, d] = bound.joints.map(|joint| &pose.palette[joint as usize]);
    blend(a, b, c, d, bound.weights)
}
