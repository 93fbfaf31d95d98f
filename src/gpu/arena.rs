//! Memory for the tessellator's output. Its size is fixed, whatever the factors are: output that does not fit is made and used
//! in chunks, one after another.
//!
//! A chunk is as large as the arena on graphics cards. On software adapters it is a part of it, so that each step of a long drawing
//! is short: a window's own frames wait for such a step. Output that fits the arena is a single chunk on all adapters, since a chunk
//! that the arena still holds isn't made again.

use bytemuck::Zeroable;

use super::buffer::empty;
use super::layout::Vertex;
use super::mesh_buffers::MeshBuffers;
use super::{Gpu, GpuError};
use geometry::cores::fill;
use geometry::tessellate::{largest_patch, point_count, triangle_count};

/// How many chunks an arena is divided into on a software adapter, where output doesn't fit it at once.
const CHUNKS_IN_SOFTWARE: u32 = 8;
/// The draws that the tables of all chunks may have so that the arena is divided: 40 bytes each, written whenever factors change.
const MOST_DRAWS: u64 = 1 << 17;

/// How many chunks fill an arena, if output doesn't fit it at once.
pub fn chunks_an_arena(gpu: &Gpu) -> u32 {
    if gpu.is_software() { CHUNKS_IN_SOFTWARE } else { 1 }
}

/// Memory for the vertices and triangles of one chunk.
pub(super) struct Arena {
    /// The first halves of all vertices that there is capacity for, then the second halves: see `Vertex` in `shaders/types.wgsl`.
    pub vertices: wgpu::Buffer,
    pub indices: wgpu::Buffer,
    pub capacity: Capacity,
    /// What a chunk has at most where a slab doesn't fit the arena at once.
    pub chunk: Capacity,
}

/// The memory for a mesh's output. A vertex takes 32 bytes, a triangle 12.
///
/// At a factor F a patch has about 0.75 F² vertices and 1.5 F² triangles. Smaller numbers are raised to those of one
/// patch: 8,256 vertices and 16,129 triangles. WebGPU's default limits allow 4,194,304 vertices and
/// 11,184,810 triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Capacity {
    /// The most vertices that are emitted.
    pub vertices: u32,
    /// The most triangles that are emitted.
    pub triangles: u32,
}

impl Capacity {
    /// Room for the largest patch.
    fn from_patch() -> Self {
        let factors = largest_patch();
        Self { vertices: point_count(factors), triangles: triangle_count(factors) }
    }

    /// A part of it, but no less than for the largest patch.
    fn divided(self, parts: u32) -> Self {
        let patch = Self::from_patch();
        Self {
            vertices: (self.vertices / parts).max(patch.vertices),
            triangles: (self.triangles / parts).max(patch.triangles),
        }
    }

    /// A bound on the number of chunks of this size that any tessellation of so many patches takes. It follows from this: every
    /// chunk but the last has no capacity left for the vertices, or for the triangles, of one more patch; and two that follow each other
    /// would not fit one.
    pub(super) fn most_chunks(self, patch_count: u32) -> u32 {
        let patch = Self::from_patch();
        let full = |capacity: u32, patch: u32| {
            let needed = u64::from(patch) * u64::from(patch_count);
            if needed <= u64::from(capacity) {
                0
            } else {
                needed.div_ceil(u64::from((capacity - patch + 1).max(capacity / 2))) as u32
            }
        };
        full(self.vertices, patch.vertices) + full(self.triangles, patch.triangles) + 1
    }
}

impl Arena {
    /// Takes about `arena_bytes` bytes, half of them for vertices; less if so many patches can't fill it, and more if a single
    /// patch could not.
    ///
    /// # Errors
    /// A buffer would be larger than the adapter binds.
    pub(super) fn new(gpu: &Gpu, mesh: &MeshBuffers, arena_bytes: u64) -> Result<Self, GpuError> {
        let (patch, patch_count) = (Capacity::from_patch(), mesh.patch_count);
        let limits = gpu.device.limits();
        let half = (arena_bytes / 2).min(limits.max_storage_buffer_binding_size).min(limits.max_buffer_size);
        let capacity = |item: usize, patch: u32| {
            let needed = u64::from(patch) * u64::from(patch_count.max(1));
            (half / item as u64).clamp(u64::from(patch), needed.max(u64::from(patch))) as u32
        };
        let vertices = capacity(size_of::<Vertex>(), patch.vertices);
        let triangles = capacity(size_of::<[u32; 3]>(), patch.triangles);
        let arena = Self::with_capacity(gpu, Capacity { vertices, triangles })?;
        let chunk = chunk_of(arena.capacity, chunks_an_arena(gpu), mesh);
        Ok(Self { chunk, ..arena })
    }

    /// Takes memory for so many vertices and triangles, and at least for those of the largest patch.
    ///
    /// # Errors
    /// A buffer would be larger than the adapter binds.
    pub(super) fn with_capacity(gpu: &Gpu, capacity: Capacity) -> Result<Self, GpuError> {
        let capacity = capacity.divided(1);
        Ok(Self {
            vertices: empty::<Vertex>(gpu, "arena.vertices", capacity.vertices as usize)?,
            indices: empty::<[u32; 3]>(gpu, "arena.indices", capacity.triangles as usize)?,
            capacity,
            chunk: capacity,
        })
    }
}

/// The size of chunks: so small a part of the arena, unless the tables of so many chunks would be large.
fn chunk_of(capacity: Capacity, parts: u32, mesh: &MeshBuffers) -> Capacity {
    let halves = std::iter::successors(Some(parts), |parts| Some(parts / 2)).take_while(|&parts| parts > 0);
    let draws = |chunk: Capacity| u64::from(chunk.most_chunks(mesh.patch_count)) * u64::from(mesh.material_count);
    halves.map(|parts| capacity.divided(parts)).find(|&chunk| draws(chunk) <= MOST_DRAWS).unwrap_or(capacity)
}

/// Bytes of half a vertex: its position and normal, or its key and texture coordinates.
pub const VERTEX_HALF: u64 = 16;

/// Puts vertices together on all cores, in a list that is used again: `halves` holds the first halves of all of them, then the
/// second halves.
pub fn put_together(halves: &[u8], vertices: &mut Vec<Vertex>) {
    let half = VERTEX_HALF as usize;
    let (first, second) = halves.split_at(halves.len() / 2);
    vertices.resize(first.len() / half, Vertex::zeroed());
    fill(vertices, LEAST, |i| {
        let mut vertex = Vertex::zeroed();
        let (a, b) = bytemuck::bytes_of_mut(&mut vertex).split_at_mut(half);
        a.copy_from_slice(&first[i * half..][..half]);
        b.copy_from_slice(&second[i * half..][..half]);
        vertex
    });
}

/// As many vertices as a core of its own is worth.
const LEAST: usize = 1 << 14;
