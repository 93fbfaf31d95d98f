//! Computes the hull factors again and reads them back; the counts pass computes them too, but doesn't store them.

use super::GpuError;
use super::bound_pass::{BoundPass, PassInputs};
use super::buffer::empty;
use super::pipelines::grid;
use super::readback::read_buffer;
use geometry::tessellate::HullFactors;

/// What a hull shader would write for each patch, from what the counts pass last ran with.
///
/// # Errors
/// More patches than the adapter binds memory for, or a lost device.
pub(super) fn read(on: &PassInputs) -> Result<Vec<HullFactors>, GpuError> {
    let (gpu, mesh) = (on.gpu, on.mesh);
    let written = empty::<HullFactors>(gpu, "hull factors", mesh.patch_count as usize)?;
    let buffers = [
        (0, on.params),
        (2, &mesh.points),
        (3, &mesh.patches),
        (4, &mesh.curve_nets),
        (5, &mesh.edge_factors),
        (8, on.given),
        (9, &written),
    ];
    let bound = BoundPass::new(gpu, &on.pipelines.hull_factors, &buffers)?;
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    bound.dispatch(&mut encoder.begin_compute_pass(&Default::default()), grid(mesh.patch_count));
    gpu.queue.submit([encoder.finish()]);
    let mut factors = bytemuck::pod_collect_to_vec(&read_buffer(gpu, &written, 0, written.size())?);
    factors.truncate(mesh.patch_count as usize);
    Ok(factors)
}
