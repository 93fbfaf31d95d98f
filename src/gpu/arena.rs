//! Memory for the tessellator's output. Its size is fixed, whatever the factors are: output that does not fit is made and used
//! in chunks, one after another.

use bytemuck::Zeroable;

use super::buffer::empty;
use super::layout::Vertex;
use super::{Gpu, GpuError};
use crate::tessellate::{Partitioning, point_count, process, triangle_count};

/// Memory for the vertices and triangles of one chunk.
pub(super) struct Arena {
    /// The first halves of all vertices that there is room for, then the second halves: see `Vertex` in `shaders/types.wgsl`.
    pub vertices: wgpu::Buffer,
    pub indices: wgpu::Buffer,
    pub vertex_capacity: u32,
    pub triangle_capacity: u32,
}

impl Arena {
    /// Takes about `arena_bytes` bytes, half of them for vertices; less if so many patches can't fill it, and more if a single
    /// patch could not.
    ///
    /// # Errors
    /// A buffer would be larger than the adapter binds.
    pub(super) fn new(gpu: &Gpu, patch_count: u32, arena_bytes: u64) -> Result<Self, GpuError> {
        let (patch_vertices, patch_triangles) = largest_patch();
        let limits = gpu.device.limits();
        let half = (arena_bytes / 2).min(limits.max_storage_buffer_binding_size).min(limits.max_buffer_size);
        let capacity = |item: usize, patch: u32| {
            let needed = u64::from(patch) * u64::from(patch_count.max(1));
            (half / item as u64).clamp(u64::from(patch), needed.max(u64::from(patch))) as u32
        };
        let vertex_capacity = capacity(size_of::<Vertex>(), patch_vertices);
        Self::with_room(gpu, vertex_capacity, capacity(size_of::<[u32; 3]>(), patch_triangles))
    }

    /// Takes memory for so many vertices and triangles, and at least for those of the largest patch.
    ///
    /// # Errors
    /// A buffer would be larger than the adapter binds.
    pub(super) fn with_room(gpu: &Gpu, vertices: u32, triangles: u32) -> Result<Self, GpuError> {
        let (patch_vertices, patch_triangles) = largest_patch();
        let (vertex_capacity, triangle_capacity) = (vertices.max(patch_vertices), triangles.max(patch_triangles));
        Ok(Self {
            vertices: empty::<Vertex>(gpu, "arena.vertices", vertex_capacity as usize)?,
            indices: empty::<[u32; 3]>(gpu, "arena.indices", triangle_capacity as usize)?,
            vertex_capacity,
            triangle_capacity,
        })
    }

    /// A bound on the number of chunks that any tessellation of so many patches takes. It follows from this: every chunk but the
    /// last has no room left for the vertices, or for the triangles, of one more patch.
    pub(super) fn chunk_capacity(&self, patch_count: u32) -> u32 {
        let (patch_vertices, patch_triangles) = largest_patch();
        let full = |capacity: u32, patch: u32| {
            let needed = u64::from(patch) * u64::from(patch_count);
            if needed <= u64::from(capacity) { 0 } else { needed.div_ceil(u64::from(capacity - patch + 1)) as u32 }
        };
        full(self.vertex_capacity, patch_vertices) + full(self.triangle_capacity, patch_triangles) + 1
    }
}

/// Bytes of half a vertex: its position and normal, or its key and texture coordinates.
pub(crate) const VERTEX_HALF: u64 = 16;

/// Puts vertices together: `halves` holds the first halves of all of them, then the second halves.
pub(crate) fn vertices_of(halves: &[u8]) -> Vec<Vertex> {
    let (first, second) = halves.split_at(halves.len() / 2);
    let half = VERTEX_HALF as usize;
    let whole = |(a, b): (&[u8], &[u8])| {
        let mut vertex = Vertex::zeroed();
        let (to_a, to_b) = bytemuck::bytes_of_mut(&mut vertex).split_at_mut(half);
        to_a.copy_from_slice(a);
        to_b.copy_from_slice(b);
        vertex
    };
    first.chunks_exact(half).zip(second.chunks_exact(half)).map(whole).collect()
}

/// The number of vertices and of triangles of a patch at the largest factors.
fn largest_patch() -> (u32, u32) {
    let factors = process(Partitioning::Integer, [64.0; 3], 64.0);
    (point_count(factors), triangle_count(factors))
}
