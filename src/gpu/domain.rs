//! The tessellator alone on the device, without a mesh: sets of factors in, domain points and triangles out.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};

use super::buffer::{empty, uniform_buffer};
use super::compute_pipeline::{ComputePipeline, ShaderModule};
use super::pipelines::WORKGROUP;
use super::readback::read_buffers;
use super::{Gpu, GpuError};
use geometry::tessellate::Partitioning;

/// Twin of `DomainParams` in `shaders/pass_domain.wgsl`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub struct DomainParams {
    pub partitioning: u32,
    pub set_count: u32,
}

/// The most points that a set of factors gives, at 127 rows; `DOMAIN_POINTS` in the shader.
pub const DOMAIN_POINTS: usize = 8256;
/// The most triangles likewise; `DOMAIN_TRIANGLES` in the shader.
pub const DOMAIN_TRIANGLES: usize = 16129;

/// What the tessellator makes of one set of factors.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DomainPattern {
    /// U and V in 16.16 fixed point.
    pub points: Vec<[u32; 2]>,
    /// Indices into `points`.
    pub triangles: Vec<[u32; 3]>,
}

/// The pass that runs the tessellator. Its pipeline is made when it first runs.
pub struct DomainPass(ComputePipeline);

impl Default for DomainPass {
    fn default() -> Self {
        Self(ComputePipeline::new(&Arc::new(ShaderModule::new("pass_domain")), "domain_main"))
    }
}

impl DomainPass {
    /// Tessellates each set of four factors: of the edges where U, V and W is 0, and inside. At most a thousand sets at once.
    ///
    /// # Errors
    /// More sets than the adapter binds memory for, or a lost device.
    pub fn run(
        &self,
        gpu: &Gpu,
        partitioning: Partitioning,
        sets: &[[f32; 4]],
    ) -> Result<Vec<DomainPattern>, GpuError> {
        let params = DomainParams { partitioning: partitioning as u32, set_count: sets.len() as u32 };
        let params = uniform_buffer(gpu, "domain.params", bytemuck::bytes_of(&params));
        let factors = uniform_buffer(gpu, "domain.factors", bytemuck::cast_slice(sets));
        let counts = empty::<[u32; 2]>(gpu, "domain counts", sets.len())?;
        let points = empty::<[u32; 2]>(gpu, "domain points", sets.len() * DOMAIN_POINTS)?;
        let triangles = empty::<[u32; 3]>(gpu, "domain triangles", sets.len() * DOMAIN_TRIANGLES)?;
        let bound = self.0.bind(gpu, |name| {
            let buffer = match name {
                "domain_params" => &params,
                "factor_sets" => &factors,
                "domain_counts" => &counts,
                "domain_points" => &points,
                _ => &triangles,
            };
            Some(buffer.as_entire_binding())
        })?;
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let workgroups = [DOMAIN_TRIANGLES.div_ceil(WORKGROUP as usize) as u32, sets.len() as u32, 1];
        bound.dispatch(&mut encoder.begin_compute_pass(&Default::default()), workgroups);
        gpu.queue.submit([encoder.finish()]);
        let bytes = read_buffers(gpu, [&counts, &points, &triangles].map(|buffer| (buffer, 0..buffer.size())))?;
        let (counts, bytes) = bytes.split_at(counts.size() as usize);
        let (points, triangles) = bytes.split_at(points.size() as usize);
        let counts: Vec<[u32; 2]> = bytemuck::pod_collect_to_vec(counts);
        let points: Vec<[u32; 2]> = bytemuck::pod_collect_to_vec(points);
        let triangles: Vec<[u32; 3]> = bytemuck::pod_collect_to_vec(triangles);
        let slots = points.chunks(DOMAIN_POINTS).zip(triangles.chunks(DOMAIN_TRIANGLES));
        let pattern = |([point_count, triangle_count], (points, triangles)): ([u32; 2], (&[_], &[_]))| DomainPattern {
            points: points[..point_count as usize].to_vec(),
            triangles: triangles[..triangle_count as usize].to_vec(),
        };
        Ok(counts.into_iter().zip(slots).take(sets.len()).map(pattern).collect())
    }
}
