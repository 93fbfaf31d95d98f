//! What deforms a mesh, in device memory: joints, morph targets, and a pose of them.

use super::buffer::{bytes_of, filled};
use super::compute_pipeline::Step;
use super::pass_inputs::{BoundPasses, PassInputs};
use super::pipelines::{DEFORM_CORNERS, DEFORM_POINTS};
use super::{Gpu, GpuError};
use geometry::mesh::{Pose, Rig, Topology};

/// A rig, and one pose of it: what the passes read, by the names in WGSL.
pub(super) struct RigBuffers {
    rig: [Named; 4],
    pose: [Named; 2],
    corner_count: u32,
    point_count: u32,
}

/// A buffer, and its name in WGSL.
type Named = (&'static str, wgpu::Buffer);

impl RigBuffers {
    /// Uploads a rig and a pose.
    ///
    /// # Errors
    /// A buffer would be larger than the adapter binds.
    pub(super) fn new(gpu: &Gpu, rig: &Rig, topology: &Topology, pose: &Pose) -> Result<Self, GpuError> {
        Ok(Self {
            rig: [
                ("bindings", filled(gpu, "bindings", &rig.bindings)?),
                // The corners' tangents at rest; one element, of zeros, for a mesh without tangents.
                ("tangents", filled(gpu, "tangents", &rig.tangents)?),
                ("deltas", filled(gpu, "morph targets", &rig.deltas)?),
                ("point_corners", filled(gpu, "point corners", &topology.point_corners)?),
            ],
            pose: pose_buffers(gpu, pose)?,
            corner_count: rig.bindings.len() as u32,
            point_count: topology.points.len() as u32,
        })
    }

    /// Replaces the pose by another of the same rig.
    ///
    /// # Errors
    /// A buffer would be larger than the adapter binds.
    pub(super) fn set_pose(&mut self, gpu: &Gpu, pose: &Pose) -> Result<(), GpuError> {
        self.pose = pose_buffers(gpu, pose)?;
        Ok(())
    }

    /// The passes that deform the mesh, in the order in which they run: its corners' normals and tangents, and its points.
    ///
    /// # Errors
    /// A pipeline can't be made: out of memory, or a lost device.
    pub(super) fn steps(&self, on: &PassInputs) -> Result<[Step; 2], GpuError> {
        let own: Vec<_> = self.rig.iter().chain(&self.pose).map(|(name, buffer)| (*name, buffer)).collect();
        // The buffers of a pose are its own.
        let on = PassInputs { own: &own, bound: &BoundPasses::default(), ..*on };
        Ok([on.over(DEFORM_CORNERS, self.corner_count)?, on.over(DEFORM_POINTS, self.point_count)?])
    }

    pub(super) fn bytes(&self) -> u64 {
        bytes_of(self.rig.iter().chain(&self.pose).map(|(_, buffer)| buffer))
    }
}

fn pose_buffers(gpu: &Gpu, pose: &Pose) -> Result<[Named; 2], GpuError> {
    let palette = filled(gpu, "palette", &pose.palette)?;
    Ok([("palette", palette), ("morph_weights", filled(gpu, "morph weights", &pose.weights)?)])
}
