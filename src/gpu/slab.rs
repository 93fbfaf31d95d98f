//! The run of patches that one scan covers: its counts, chunks and arguments, and the passes' bind groups.

use wgpu::util::DeviceExt;

use super::arena::Arena;
use super::buffers::empty;
use super::layout::{Chunk, DrawArgs, EmitArgs, PatchFactors, Slab};
use super::pipelines::bind_group;
use super::{ComputePipelines, Gpu, GpuError, MeshBuffers};

/// Patches whose counts a workgroup adds up.
pub const SCAN_BLOCK: u32 = 256;
/// Offsets of uniform bindings are multiples of this: WebGPU's default limit.
pub const UNIFORM_STRIDE: u64 = 256;

/// One slab's buffers and bind groups.
pub struct SlabPasses {
    pub slab: Slab,
    pub slab_buffer: wgpu::Buffer,
    pub patch_factors: wgpu::Buffer,
    /// One a patch and one past the last; behind those, the sums of blocks of patches.
    pub offsets: wgpu::Buffer,
    pub chunks: wgpu::Buffer,
    pub emit_args: wgpu::Buffer,
    pub draw_args: wgpu::Buffer,
    pub chunk_indices: wgpu::Buffer,
    pub groups: Option<SlabGroups>,
}

pub struct SlabGroups {
    pub edge_factors: wgpu::BindGroup,
    pub heights_inside: wgpu::BindGroup,
    pub counts: wgpu::BindGroup,
    pub scan: wgpu::BindGroup,
    pub chunks: wgpu::BindGroup,
    /// One for each pipeline.
    pub emit_vertices: [wgpu::BindGroup; 3],
    pub emit_triangles: wgpu::BindGroup,
}

impl SlabPasses {
    /// # Errors
    /// More patches than the adapter binds memory for.
    pub fn new(
        gpu: &Gpu,
        buffers: &MeshBuffers,
        arena: &Arena,
        first_patch: u32,
        patch_count: u32,
    ) -> Result<Self, GpuError> {
        let chunk_capacity = arena.chunk_capacity(patch_count);
        let slab = Slab {
            first_patch,
            patch_count,
            vertex_capacity: arena.vertex_capacity,
            triangle_capacity: arena.triangle_capacity,
            chunk_capacity,
            material_count: buffers.material_count,
            _pad: [0; 2],
        };
        let (patches, chunks) = (patch_count as usize, chunk_capacity as usize);
        let mut chunk_indices = vec![0u8; chunks * UNIFORM_STRIDE as usize];
        for (index, bytes) in chunk_indices.chunks_exact_mut(UNIFORM_STRIDE as usize).enumerate() {
            bytes[..4].copy_from_slice(&(index as u32).to_ne_bytes());
        }
        Ok(Self {
            slab,
            slab_buffer: uniform_buffer(gpu, "slab", bytemuck::bytes_of(&slab)),
            patch_factors: empty::<PatchFactors>(gpu, "patch factors", patches)?,
            offsets: empty::<[u32; 2]>(gpu, "offsets", patches + 1 + (patches + 1).div_ceil(SCAN_BLOCK as usize))?,
            chunks: empty::<Chunk>(gpu, "chunks", chunks)?,
            emit_args: empty::<EmitArgs>(gpu, "emit arguments", chunks)?,
            draw_args: empty::<DrawArgs>(gpu, "draw arguments", chunks * buffers.material_count as usize)?,
            chunk_indices: uniform_buffer(gpu, "chunk indices", &chunk_indices),
            groups: None,
        })
    }

    /// Bytes of everything but uniforms.
    pub fn bytes(&self) -> u64 {
        [&self.patch_factors, &self.offsets, &self.chunks, &self.emit_args, &self.draw_args]
            .iter()
            .map(|buffer| buffer.size())
            .sum()
    }

    /// The bind groups of all passes over this slab.
    pub fn bind(
        &self,
        gpu: &Gpu,
        pipelines: &ComputePipelines,
        b: &MeshBuffers,
        params: &wgpu::Buffer,
        given: &wgpu::Buffer,
        arena: &Arena,
    ) -> SlabGroups {
        let group = |label: &str, pipeline: &wgpu::ComputePipeline, buffers: &[(u32, &wgpu::Buffer)]| {
            bind_group(gpu, label, &pipeline.get_bind_group_layout(0), buffers)
        };
        let slab = &self.slab_buffer;
        let emit = [(1, slab), (2, &self.chunks), (3, &self.offsets), (4, &self.patch_factors)];
        let nets = [(0, params), (5, &b.points), (6, &b.patches), (7, &b.curve_nets), (8, &b.corners)];
        let factors = [
            (0, params),
            (1, &b.points),
            (2, &b.curves),
            (3, &b.curve_nets),
            (4, &b.factor_curves),
            (5, &b.edge_factors),
            (6, &b.shares),
            (22, &b.details),
        ];
        let heights_inside = [&factors[..], &[(7, &b.patches)]].concat();
        SlabGroups {
            edge_factors: group("factors", &pipelines.edge_factors, &factors),
            heights_inside: group("factors.inside", &pipelines.heights_inside, &heights_inside),
            counts: group(
                "counts",
                &pipelines.counts,
                &[
                    (0, params),
                    (1, slab),
                    (2, &b.points),
                    (3, &b.patches),
                    (4, &b.curve_nets),
                    (5, &b.edge_factors),
                    (6, &self.patch_factors),
                    (7, &self.offsets),
                    (8, given),
                ],
            ),
            scan: group("scan", &pipelines.scan, &[(0, slab), (1, &self.offsets)]),
            chunks: group(
                "chunks",
                &pipelines.chunks,
                &[
                    (0, slab),
                    (1, &self.offsets),
                    (2, &b.material_patches),
                    (3, &self.chunks),
                    (4, &self.emit_args),
                    (5, &self.draw_args),
                ],
            ),
            emit_vertices: pipelines.emit_vertices.each_ref().map(|pipeline| {
                group("emit.vertices", pipeline, &[&emit[..], &nets[..], &[(9, &arena.vertices)]].concat())
            }),
            emit_triangles: group(
                "emit.triangles",
                &pipelines.emit_triangles,
                &[&emit[..], &[(10, &arena.indices), (11, &pipelines.patterns)]].concat(),
            ),
        }
    }
}

/// A uniform, or the like in storage, that can be written again.
pub fn uniform_buffer(gpu: &Gpu, label: &str, contents: &[u8]) -> wgpu::Buffer {
    gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: Some(label),
        contents,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
    })
}
