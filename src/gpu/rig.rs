//! What a mesh is deformed from, in device memory.

use super::buffers::filled;
use super::pipelines::bind_group;
use super::pipelines::{dispatch, grid};
use super::{ComputePipelines, Gpu, GpuError, MeshBuffers};
use crate::mesh::{Pose, Rig, Topology};

/// A rig, and room for a pose of it.
pub struct RigBuffers {
    bindings: wgpu::Buffer,
    deltas: wgpu::Buffer,
    palette: wgpu::Buffer,
    morph_weights: wgpu::Buffer,
    point_corners: wgpu::Buffer,
    corner_count: u32,
    point_count: u32,
}

impl RigBuffers {
    /// Uploads a rig in a pose.
    ///
    /// # Errors
    /// A buffer would be larger than the adapter binds.
    pub fn new(gpu: &Gpu, rig: &Rig, topology: &Topology, pose: &Pose) -> Result<Self, GpuError> {
        Ok(Self {
            bindings: filled(gpu, "bindings", &rig.bindings)?,
            deltas: filled(gpu, "morph targets", &rig.deltas)?,
            palette: filled(gpu, "palette", &pose.palette)?,
            morph_weights: filled(gpu, "morph weights", &pose.weights)?,
            point_corners: filled(gpu, "point corners", &topology.point_corners)?,
            corner_count: rig.bindings.len() as u32,
            point_count: topology.points.len() as u32,
        })
    }

    /// Takes another pose of the same rig.
    ///
    /// # Errors
    /// A buffer would be larger than the adapter binds.
    pub fn set_pose(&mut self, gpu: &Gpu, pose: &Pose) -> Result<(), GpuError> {
        self.palette = filled(gpu, "palette", &pose.palette)?;
        self.morph_weights = filled(gpu, "morph weights", &pose.weights)?;
        Ok(())
    }

    /// Records what deforms the mesh: its corners' normals and its points.
    pub fn record(&self, gpu: &Gpu, pipelines: &ComputePipelines, mesh: &MeshBuffers, pass: &mut wgpu::ComputePass) {
        let inputs = [(0, &self.bindings), (1, &self.deltas), (2, &self.palette), (3, &self.morph_weights)];
        let corners = [&inputs[..], &[(5, &mesh.corners)]].concat();
        let points = [&inputs[..], &[(4, &self.point_corners), (6, &mesh.points)]].concat();
        let layout = |pipeline: &wgpu::ComputePipeline| pipeline.get_bind_group_layout(0);
        let corners = bind_group(gpu, "deform.corners", &layout(&pipelines.deform_corners), &corners);
        let points = bind_group(gpu, "deform.points", &layout(&pipelines.deform_points), &points);
        dispatch(pass, &pipelines.deform_corners, &corners, grid(self.corner_count));
        dispatch(pass, &pipelines.deform_points, &points, grid(self.point_count));
    }

    pub fn bytes(&self) -> u64 {
        [&self.bindings, &self.deltas, &self.palette, &self.morph_weights, &self.point_corners]
            .iter()
            .map(|buffer| buffer.size())
            .sum()
    }
}
