//! What the hull shader writes for every patch, read back: the counts pass uses it up at once.

use super::buffers::empty;
use super::pipelines::{bind_group, compute_pipeline, shader_module};
use super::pipelines::{dispatch, grid};
use super::recorder::read_buffer;
use super::{Gpu, GpuError, MeshBuffers};
use crate::tessellate::HullFactors;

/// One for each patch, from the buffers that the counts pass had.
///
/// # Errors
/// More patches than the adapter binds memory for, or a lost device.
pub fn read(
    gpu: &Gpu,
    b: &MeshBuffers,
    params: &wgpu::Buffer,
    given: &wgpu::Buffer,
) -> Result<Vec<HullFactors>, GpuError> {
    let pipeline = compute_pipeline(gpu, &shader_module(gpu, "counts"), "hull_factors_main");
    let written = empty::<HullFactors>(gpu, "hull factors", b.patch_count as usize)?;
    let buffers = [
        (0, params),
        (2, &b.points),
        (3, &b.patches),
        (4, &b.curve_nets),
        (5, &b.edge_factors),
        (8, given),
        (9, &written),
    ];
    let group = bind_group(gpu, "hull factors", &pipeline.get_bind_group_layout(0), &buffers);
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        dispatch(&mut pass, &pipeline, &group, grid(b.patch_count));
    }
    gpu.queue.submit([encoder.finish()]);
    let mut factors = bytemuck::pod_collect_to_vec(&read_buffer(gpu, &written, 0, written.size())?);
    factors.truncate(b.patch_count as usize);
    Ok(factors)
}
