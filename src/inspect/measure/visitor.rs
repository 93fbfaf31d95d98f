//! Visitors of what was emitted. Each measurement is a visitor, so that one walk over all chunks feeds all measurements.

use geometry::tessellate::Vertex;

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

impl<F: FnMut(&EmittedChunk)> Visitor for F {
    fn take(&mut self, chunk: &EmittedChunk) {
        self(chunk);
    }
}
