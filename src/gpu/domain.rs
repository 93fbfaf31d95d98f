//! The bare tessellator on the device: sets of factors in, domain points and triangles out.

use bytemuck::{Pod, Zeroable};
use wgpu::util::DeviceExt;

use super::buffers::empty;
use super::pipelines::{bind_group, compute_pipeline, shader_module};
use super::recorder::read_buffer;
use super::{Gpu, GpuError};
use crate::tessellate::Partitioning;

/// Twin of `DomainParams` in `shaders/pass_domain.wgsl`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub struct DomainParams {
    pub partitioning: u32,
    pub set_count: u32,
}

/// Room for one set's output; `DOMAIN_POINTS` and `DOMAIN_TRIANGLES` of the shader.
const POINTS: usize = 3169;
const TRIANGLES: usize = 6144;

/// What the tessellator makes of one set of factors.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DomainPattern {
    /// U and V in 16.16 fixed point.
    pub points: Vec<[u32; 2]>,
    /// Indices into `points`.
    pub triangles: Vec<[u32; 3]>,
}

/// The compiled pass.
pub struct DomainPass {
    pipeline: wgpu::ComputePipeline,
}

impl DomainPass {
    pub fn new(gpu: &Gpu) -> Self {
        Self { pipeline: compute_pipeline(gpu, &shader_module(gpu, "domain"), "domain_main") }
    }

    /// Tessellates each set [U==0, V==0, W==0 edges, inside]; at most a thousand at once.
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
        let init = |label, contents: &[u8], usage| {
            gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: Some(label), contents, usage })
        };
        let params = init("domain.params", bytemuck::bytes_of(&params), wgpu::BufferUsages::UNIFORM);
        let factors = init("domain.factors", bytemuck::cast_slice(sets), wgpu::BufferUsages::STORAGE);
        let counts = empty::<[u32; 2]>(gpu, "domain counts", sets.len())?;
        let points = empty::<[u32; 2]>(gpu, "domain points", sets.len() * POINTS)?;
        let triangles = empty::<[u32; 3]>(gpu, "domain triangles", sets.len() * TRIANGLES)?;
        let buffers = [(0, &params), (1, &factors), (2, &counts), (3, &points), (4, &triangles)];
        let group = bind_group(gpu, "domain", &self.pipeline.get_bind_group_layout(0), &buffers);
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.dispatch_workgroups(TRIANGLES.div_ceil(256) as u32, sets.len() as u32, 1);
        }
        gpu.queue.submit([encoder.finish()]);
        let read = |buffer: &wgpu::Buffer| read_buffer(gpu, buffer, 0, buffer.size());
        let counts: Vec<[u32; 2]> = bytemuck::pod_collect_to_vec(&read(&counts)?);
        let points: Vec<[u32; 2]> = bytemuck::pod_collect_to_vec(&read(&points)?);
        let triangles: Vec<[u32; 3]> = bytemuck::pod_collect_to_vec(&read(&triangles)?);
        let slots = points.chunks(POINTS).zip(triangles.chunks(TRIANGLES));
        let pattern = |([point_count, triangle_count], (points, triangles)): ([u32; 2], (&[_], &[_]))| DomainPattern {
            points: points[..point_count as usize].to_vec(),
            triangles: triangles[..triangle_count as usize].to_vec(),
        };
        Ok(counts.into_iter().zip(slots).take(sets.len()).map(pattern).collect())
    }
}
