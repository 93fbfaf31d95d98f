//! Computes the hull factors again and reads them back; the counts pass computes them too, but doesn't store them.

use super::GpuError;
use super::buffer::empty;
use super::pass_inputs::{BoundPasses, PassInputs};
use super::pipelines::HULL_FACTORS;
use super::readback::read_buffer;
use geometry::tessellate::HullFactors;

/// What a hull shader would write for each patch, from what the counts pass last ran with.
///
/// # Errors
/// More patches than the adapter binds memory for, or a lost device.
pub(super) fn read(on: &PassInputs) -> Result<Vec<HullFactors>, GpuError> {
    let (gpu, mesh) = (on.gpu, on.mesh);
    let written = empty::<HullFactors>(gpu, "hull factors", mesh.patch_count as usize)?;
    let on = PassInputs { own: &[("written_factors", &written)], bound: &BoundPasses::default(), ..*on };
    let step = on.over(HULL_FACTORS, mesh.patch_count)?;
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    step.run(&mut encoder.begin_compute_pass(&Default::default()));
    gpu.queue.submit([encoder.finish()]);
    let mut factors = bytemuck::pod_collect_to_vec(&read_buffer(gpu, &written, 0, written.size())?);
    factors.truncate(mesh.patch_count as usize);
    Ok(factors)
}
