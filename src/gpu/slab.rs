//! A slab: the run of patches that one scan covers. Its counts, chunks and indirect arguments, and the passes over it.

use std::num::NonZeroU64;
use std::sync::OnceLock;

use super::arena::Arena;
use super::bound_pass::{BoundPass, PassInputs};
use super::buffer::{empty, uniform_buffer};
use super::layout::{Chunk, DrawArgs, EmitArgs, PatchFactors, Slab};
use super::lazy::get_or_try;
use super::mesh_buffers::MeshBuffers;
use super::pipelines::WORKGROUP;
use super::relief_buffers::HeightImages;
use super::{Gpu, GpuError};
use geometry::tessellate::Normals;

/// Patches whose counts a workgroup adds up: as many as it has invocations.
pub(super) const SCAN_BLOCK: u32 = WORKGROUP;
/// Offsets of uniform bindings are multiples of this: WebGPU's default limit.
const UNIFORM_STRIDE: u64 = 256;

/// One slab's buffers, and its passes bound to them.
pub(super) struct SlabPasses {
    pub slab: Slab,
    pub slab_buffer: wgpu::Buffer,
    pub patch_factors: wgpu::Buffer,
    /// For each patch, and for the end of the last, how many vertices and triangles come before it. Behind those, the sums of
    /// blocks of [`SCAN_BLOCK`] patches.
    pub offsets: wgpu::Buffer,
    pub chunks: wgpu::Buffer,
    pub emit_args: wgpu::Buffer,
    pub draw_args: wgpu::Buffer,
    /// The number of each chunk, [`UNIFORM_STRIDE`] bytes apart, since a pass learns its chunk's from a uniform.
    chunk_numbers: wgpu::Buffer,
    bound: Bound,
}

/// The passes, each bound when it first runs.
#[derive(Default)]
struct Bound {
    counts: OnceLock<BoundPass>,
    scan: OnceLock<BoundPass>,
    chunks: OnceLock<BoundPass>,
    /// As the pipelines are: for the patterns of Direct3D, then for rows.
    emit_vertices: [[OnceLock<BoundPass>; 3]; 2],
    emit_triangles: [OnceLock<BoundPass>; 2],
    displace: OnceLock<BoundPass>,
}

impl SlabPasses {
    /// # Errors
    /// More patches than the adapter binds memory for.
    pub(super) fn new(
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
            vertex_capacity: arena.room.vertices,
            triangle_capacity: arena.room.triangles,
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
            slab_buffer: uniform_buffer(gpu, "slab", bytemuck::bytes_of(&slab)),
            patch_factors: empty::<PatchFactors>(gpu, "patch factors", patches)?,
            offsets: empty::<[u32; 2]>(gpu, "offsets", patches + 1 + (patches + 1).div_ceil(SCAN_BLOCK as usize))?,
            chunks: empty::<Chunk>(gpu, "chunks", chunks)?,
            emit_args: empty::<EmitArgs>(gpu, "emit arguments", chunks)?,
            draw_args: empty::<DrawArgs>(gpu, "draw arguments", chunks * buffers.material_count as usize)?,
            chunk_numbers: uniform_buffer(gpu, "chunk numbers", &chunk_numbers),
            bound: Bound::default(),
        })
    }

    /// Bytes of everything but uniforms.
    pub(super) fn bytes(&self) -> u64 {
        [&self.patch_factors, &self.offsets, &self.chunks, &self.emit_args, &self.draw_args]
            .iter()
            .map(|buffer| buffer.size())
            .sum()
    }

    /// Lets go of what passes are bound to, since some of those buffers were replaced.
    pub(super) fn unbind(&mut self) {
        self.bound = Bound::default();
    }

    /// Factors and counts of every patch, added up within blocks of [`SCAN_BLOCK`].
    pub(super) fn counts(&self, on: &PassInputs) -> Result<&BoundPass, GpuError> {
        let buffers = [
            (0, on.params),
            (1, &self.slab_buffer),
            (2, &on.mesh.points),
            (3, &on.mesh.patches),
            (4, &on.mesh.curve_nets),
            (5, &on.mesh.edge_factors),
            (6, &self.patch_factors),
            (7, &self.offsets),
            (8, on.given),
        ];
        BoundPass::once(&self.bound.counts, on.gpu, &on.pipelines.counts, &buffers)
    }

    /// Sums within blocks to offsets within the slab.
    pub(super) fn scan(&self, on: &PassInputs) -> Result<&BoundPass, GpuError> {
        let buffers = [(0, &self.slab_buffer), (1, &self.offsets)];
        BoundPass::once(&self.bound.scan, on.gpu, &on.pipelines.scan, &buffers)
    }

    /// Chunks that fit the arena, and their indirect arguments.
    pub(super) fn chunks(&self, on: &PassInputs) -> Result<&BoundPass, GpuError> {
        let buffers = [
            (0, &self.slab_buffer),
            (1, &self.offsets),
            (2, &on.mesh.material_patches),
            (3, &self.chunks),
            (4, &self.emit_args),
            (5, &self.draw_args),
        ];
        BoundPass::once(&self.bound.chunks, on.gpu, &on.pipelines.chunks, &buffers)
    }

    /// The vertices of a chunk. Its pipeline depends on whether patches are cut into rows, and on how normals are made: a number of
    /// [`Normals`].
    pub(super) fn emit_vertices(&self, on: &PassInputs, rows: bool, normals: usize) -> Result<&BoundPass, GpuError> {
        let normals = normals.min(Normals::Surface as usize);
        let buffers = [
            &self.emit_buffers()[..],
            &[(0, on.params), (5, &on.mesh.points), (6, &on.mesh.patches), (7, &on.mesh.curve_nets)],
            &[(8, &on.mesh.corners), (9, &on.arena.vertices)],
        ];
        let (cells, pipelines) = (&self.bound.emit_vertices, &on.pipelines.emit_vertices);
        let rows = usize::from(rows);
        BoundPass::once(&cells[rows][normals], on.gpu, &pipelines[rows][normals], &buffers.concat())
    }

    /// The triangles of a chunk. Its pipeline depends on whether patches are cut into rows.
    pub(super) fn emit_triangles(&self, on: &PassInputs, rows: bool) -> Result<&BoundPass, GpuError> {
        let patterns = on.pipelines.patterns(on.gpu)?;
        let buffers = [&self.emit_buffers()[..], &[(10, &on.arena.indices), (11, patterns)]].concat();
        let (cells, pipelines) = (&self.bound.emit_triangles, &on.pipelines.emit_triangles);
        let rows = usize::from(rows);
        BoundPass::once(&cells[rows], on.gpu, &pipelines[rows], &buffers)
    }

    fn emit_buffers(&self) -> [(u32, &wgpu::Buffer); 4] {
        [(1, &self.slab_buffer), (2, &self.chunks), (3, &self.offsets), (4, &self.patch_factors)]
    }

    /// The displacement of a chunk's vertices.
    pub(super) fn displace(&self, on: &PassInputs, images: &HeightImages) -> Result<&BoundPass, GpuError> {
        get_or_try(&self.bound.displace, || {
            let pipeline = on.pipelines.displace.get(on.gpu)?.clone();
            let buffers = [
                (0, on.params),
                (1, &self.slab_buffer),
                (2, &self.chunks),
                (4, &self.patch_factors),
                (5, &on.mesh.points),
                (6, &on.mesh.patches),
                (7, &on.mesh.curve_nets),
                (8, &on.mesh.corners),
                (9, &on.arena.vertices),
                (11, &on.mesh.shares),
                (21, &images.maps),
            ];
            let buffers =
                buffers.map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() });
            let view = wgpu::BindingResource::TextureView(&images.view);
            let entries = [&buffers[..], &[wgpu::BindGroupEntry { binding: 20, resource: view }]].concat();
            let group = on.gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("displace"),
                layout: &pipeline.get_bind_group_layout(0),
                entries: &entries,
            });
            Ok(BoundPass { pipeline, group })
        })
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
