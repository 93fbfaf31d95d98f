//! Compute pipelines together with the buffers that they work on.

use std::sync::OnceLock;

use super::arena::Arena;
use super::compute_pipeline::ComputePipeline;
use super::lazy::get_or_try;
use super::mesh_buffers::MeshBuffers;
use super::pipelines::{ComputePipelines, bind_group};
use super::{Gpu, GpuError};

/// What passes are bound to, besides the buffers of a slab.
pub(super) struct PassInputs<'a> {
    pub gpu: &'a Gpu,
    pub pipelines: &'a ComputePipelines,
    pub mesh: &'a MeshBuffers,
    /// A [`super::layout::Params`].
    pub params: &'a wgpu::Buffer,
    /// Hull factors that were given in place of LOD's, one for each patch.
    pub given: &'a wgpu::Buffer,
    pub arena: &'a Arena,
}

/// A compute pipeline, and its bind group 0.
pub struct BoundPass {
    pub pipeline: wgpu::ComputePipeline,
    pub group: wgpu::BindGroup,
}

impl BoundPass {
    /// Binds whole buffers, each at its binding number.
    ///
    /// # Errors
    /// The pipeline can't be made: out of memory, or a lost device.
    pub fn new(gpu: &Gpu, pipeline: &ComputePipeline, buffers: &[(u32, &wgpu::Buffer)]) -> Result<Self, GpuError> {
        let (label, pipeline) = (pipeline.entry_point(), pipeline.get(gpu)?.clone());
        let group = bind_group(gpu, label, &pipeline.get_bind_group_layout(0), buffers);
        Ok(Self { pipeline, group })
    }

    /// The same, made when it is first needed and kept in `cell`.
    ///
    /// # Errors
    /// The pipeline can't be made: out of memory, or a lost device.
    pub fn once<'a>(
        cell: &'a OnceLock<Self>,
        gpu: &Gpu,
        pipeline: &ComputePipeline,
        buffers: &[(u32, &wgpu::Buffer)],
    ) -> Result<&'a Self, GpuError> {
        get_or_try(cell, || Self::new(gpu, pipeline, buffers))
    }

    /// Runs it over a grid of workgroups.
    pub fn dispatch(&self, pass: &mut wgpu::ComputePass, [x, y, z]: [u32; 3]) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.dispatch_workgroups(x, y, z);
    }

    /// Runs it over as many workgroups as a buffer says, `offset` bytes into it.
    pub(crate) fn dispatch_indirect(&self, pass: &mut wgpu::ComputePass, workgroups: &wgpu::Buffer, offset: u64) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.dispatch_workgroups_indirect(workgroups, offset);
    }
}
