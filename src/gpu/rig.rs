//! What deforms a mesh, in device memory: joints, morph targets, and a pose of them.

use super::bound_pass::Step;
use super::buffer::{bytes_of, filled};
use super::pass_inputs::{BoundPasses, PassInputs};
use super::pipelines::{DEFORM_CORNERS, DEFORM_POINTS};
use super::{Gpu, GpuError};
use geometry::mesh::{Pose, Rig, Topology};

/// A rig, and one pose of it.
pub(super) struct RigBuffers {
    bindings: wgpu::Buffer,
    /// The corners' tangents at rest; one element, of zeros, for a mesh without tangents.
    tangents: wgpu::Buffer,
    deltas: wgpu::Buffer,
    palette: wgpu::Buffer,
    morph_weights: wgpu::Buffer,
    point_corners: wgpu::Buffer,
    corner_count: u32,
    point_count: u32,
}

impl RigBuffers {
    /// Uploads a rig and a pose.
    ///
    /// # Errors
    /// A buffer would be larger than the adapter binds.
    pub(super) fn new(gpu: &Gpu, rig: &Rig, topology: &Topology, pose: &Pose) -> Result<Self, GpuError> {
        Ok(Self {
            bindings: filled(gpu, "bindings", &rig.bindings)?,
            tangents: filled(gpu, "tangents", &rig.tangents)?,
            deltas: filled(gpu, "morph targets", &rig.deltas)?,
            palette: filled(gpu, "palette", &pose.palette)?,
            morph_weights: filled(gpu, "morph weights", &pose.weights)?,
            point_corners: filled(gpu, "point corners", &topology.point_corners)?,
            corner_count: rig.bindings.len() as u32,
            point_count: topology.points.len() as u32,
        })
    }

    /// Replaces the pose by another of the same rig.
    ///
    /// # Errors
    /// A buffer would be larger than the adapter binds.
    pub(super) fn set_pose(&mut self, gpu: &Gpu, pose: &Pose) -> Result<(), GpuError> {
        self.palette = filled(gpu, "palette", &pose.palette)?;
        self.morph_weights = filled(gpu, "morph weights", &pose.weights)?;
        Ok(())
    }

    /// The passes that deform the mesh, in the order in which they run: its corners' normals and tangents, and its points.
    ///
    /// # Errors
    /// A pipeline can't be made: out of memory, or a lost device.
    pub(super) fn steps(&self, on: &PassInputs) -> Result<[Step; 2], GpuError> {
        let own = [
            ("bindings", &self.bindings),
            ("deltas", &self.deltas),
            ("palette", &self.palette),
            ("morph_weights", &self.morph_weights),
            ("point_corners", &self.point_corners),
            ("tangents", &self.tangents),
        ];
        // The buffers of a pose are its own.
        let on = PassInputs { own: &own, bound: &BoundPasses::default(), ..*on };
        Ok([on.over(DEFORM_CORNERS, self.corner_count)?, on.over(DEFORM_POINTS, self.point_count)?])
    }

    pub(super) fn bytes(&self) -> u64 {
        let pose = [&self.palette, &self.morph_weights];
        bytes_of(pose) + bytes_of([&self.bindings, &self.tangents, &self.deltas, &self.point_corners])
    }
}
