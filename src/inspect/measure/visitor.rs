//! Visitors of what was emitted. Each measurement is a visitor, so that one walk over all chunks feeds all measurements.

use geometry::tessellate::Vertex;
use gpu::put_together;

/// How many vertices or triangles are worth a core.
pub(super) const LEAST: usize = 1 << 14;

/// The output of one chunk: whole patches, in order.
#[derive(Clone, Copy, Debug)]
pub struct EmittedChunk<'a> {
    /// Its first patch: an index into [`geometry::mesh::Topology::patches`].
    pub first_patch: u32,
    pub vertices: &'a [Vertex],
    /// Indices into `vertices`.
    pub triangles: &'a [[u32; 3]],
}

impl<'a> EmittedChunk<'a> {
    /// The output of all patches as one chunk.
    pub fn whole(vertices: &'a [Vertex], triangles: &'a [[u32; 3]]) -> Self {
        Self { first_patch: 0, vertices, triangles }
    }
}

/// Visits all chunks that were emitted, in the order of the patches.
pub trait Visitor {
    /// Takes the next chunk.
    fn take(&mut self, chunk: &EmittedChunk);
}

/// Gives a chunk that was read back to every visitor. `bytes` are the first halves of its vertices, their second halves, which
/// `vertex_bytes` counts together, and its triangles. `vertices` is where these are put together, a list that may be used again.
pub fn visit_bytes(
    first_patch: u32,
    vertex_bytes: usize,
    bytes: &[u8],
    vertices: &mut Vec<Vertex>,
    visitors: &mut [&mut dyn Visitor],
) {
    let (halves, indices) = bytes.split_at(vertex_bytes);
    put_together(halves, vertices);
    let chunk = EmittedChunk { first_patch, vertices, triangles: bytemuck::cast_slice(indices) };
    visitors.iter_mut().for_each(|visitor| visitor.take(&chunk));
}

impl<F: FnMut(&EmittedChunk)> Visitor for F {
    fn take(&mut self, chunk: &EmittedChunk) {
        self(chunk);
    }
}
