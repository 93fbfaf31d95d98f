//! What deforms a mesh, in device memory: joints, morph targets, and a pose of them.

use super::bound_pass::{BoundPass, PassInputs};
use super::buffer::filled;
use super::pipelines::grid;
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

    /// The passes that deform the mesh, in the order in which they run: its corners' normals and tangents, and its points. Each comes with
    /// the grid that it runs over.
    ///
    /// # Errors
    /// A pipeline can't be made: out of memory, or a lost device.
    pub(super) fn passes(&self, on: &PassInputs) -> Result<[(BoundPass, [u32; 3]); 2], GpuError> {
        let inputs = [(0, &self.bindings), (1, &self.deltas), (2, &self.palette), (3, &self.morph_weights)];
        let details = [(7, &self.tangents), (8, &on.mesh.corner_details)];
        let corners = [&inputs[..], &[(5, &on.mesh.corners)], &details].concat();
        let points = [&inputs[..], &[(4, &self.point_corners), (6, &on.mesh.points)]].concat();
        Ok([
            (BoundPass::new(on.gpu, &on.pipelines.deform_corners, &corners)?, grid(self.corner_count)),
            (BoundPass::new(on.gpu, &on.pipelines.deform_points, &points)?, grid(self.point_count)),
        ])
    }

    pub(super) fn bytes(&self) -> u64 {
        [&self.bindings, &self.tangents, &self.deltas, &self.palette, &self.morph_weights, &self.point_corners]
            .iter()
            .map(|buffer| buffer.size())
            .sum()
    }
}
