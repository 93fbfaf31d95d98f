//! A slab: the run of patches that one scan covers. Its counts, chunks and indirect arguments.

use std::num::NonZeroU64;

use super::arena::Arena;
use super::buffer::{bytes_of, empty, uniform_buffer};
use super::layout::{Chunk, DrawArgs, EmitArgs, PatchFactors, Slab};
use super::mesh_buffers::MeshBuffers;
use super::pipelines::WORKGROUP;
use super::{Gpu, GpuError};

/// Patches whose counts a workgroup adds up: as many as it has invocations.
pub(super) const SCAN_BLOCK: u32 = WORKGROUP;
/// Offsets of uniform bindings are multiples of this: WebGPU's default limit.
const UNIFORM_STRIDE: u64 = 256;

/// One slab's buffers.
pub(super) struct SlabBuffers {
    pub slab: Slab,
    pub uniform: wgpu::Buffer,
    pub patch_factors: wgpu::Buffer,
    /// For each patch, and for the end of the last, how many vertices and triangles come before it. Behind those, the sums of
    /// blocks of [`SCAN_BLOCK`] patches.
    pub offsets: wgpu::Buffer,
    pub chunks: wgpu::Buffer,
    pub emit_args: wgpu::Buffer,
    pub draw_args: wgpu::Buffer,
    /// The number of each chunk, [`UNIFORM_STRIDE`] bytes apart, since a pass learns its chunk's from a uniform.
    chunk_numbers: wgpu::Buffer,
}

impl SlabBuffers {
    /// # Errors
    /// More patches than the adapter binds memory for.
    pub(super) fn new(
        gpu: &Gpu,
        buffers: &MeshBuffers,
        arena: &Arena,
        first_patch: u32,
        patch_count: u32,
    ) -> Result<Self, GpuError> {
        let chunk_capacity = arena.chunk.most_chunks(patch_count);
        let slab = Slab {
            first_patch,
            patch_count,
            vertex_capacity: arena.capacity.vertices,
            triangle_capacity: arena.capacity.triangles,
            chunk_vertices: arena.chunk.vertices,
            chunk_triangles: arena.chunk.triangles,
            chunk_capacity,
            material_count: buffers.material_count,
        };
        let (patches, chunks) = (patch_count as usize, chunk_capacity as usize);
        let mut chunk_numbers = vec![0u8; chunks * UNIFORM_STRIDE as usize];
        for (number, bytes) in chunk_numbers.chunks_exact_mut(UNIFORM_STRIDE as usize).enumerate() {
            bytes[..4].copy_from_slice(&(number as u32).to_ne_bytes());
        }
        Ok(Self {
            slab,
            uniform: uniform_buffer(gpu, "slab", bytemuck::bytes_of(&slab)),
            patch_factors: empty::<PatchFactors>(gpu, "patch factors", patches)?,
            offsets: empty::<[u32; 2]>(gpu, "offsets", patches + 1 + (patches + 1).div_ceil(SCAN_BLOCK as usize))?,
            chunks: empty::<Chunk>(gpu, "chunks", chunks)?,
            emit_args: empty::<EmitArgs>(gpu, "emit arguments", chunks)?,
            draw_args: empty::<DrawArgs>(gpu, "draw arguments", chunks * buffers.material_count as usize)?,
            chunk_numbers: uniform_buffer(gpu, "chunk numbers", &chunk_numbers),
        })
    }

    /// Bytes of everything but uniforms.
    pub(super) fn bytes(&self) -> u64 {
        bytes_of([&self.patch_factors, &self.offsets, &self.chunks, &self.emit_args, &self.draw_args])
    }

    /// Bind group 1 of the passes over a chunk: the chunk's number in this slab.
    pub(super) fn chunk_number(&self, gpu: &Gpu, pipeline: &wgpu::ComputePipeline, chunk: u32) -> wgpu::BindGroup {
        let binding = wgpu::BufferBinding {
            buffer: &self.chunk_numbers,
            offset: u64::from(chunk) * UNIFORM_STRIDE,
            size: NonZeroU64::new(4),
        };
        gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("chunk number"),
            layout: &pipeline.get_bind_group_layout(1),
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::Buffer(binding) }],
        })
    }
}
