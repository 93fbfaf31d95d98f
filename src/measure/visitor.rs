//! One walk over what was emitted feeds every measurement that was asked for: each of them is a visitor.

use crate::tessellate::Vertex;

/// What one chunk emitted: whole patches, in their order.
#[derive(Clone, Copy, Debug)]
pub struct EmittedChunk<'a> {
    /// The first of its patches: an index into [`crate::mesh::Topology::patches`].
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

/// Something that looks at everything that was emitted, one chunk after another in the order of the patches.
pub trait Visitor {
    fn take(&mut self, chunk: &EmittedChunk);
}

impl<F: FnMut(&EmittedChunk)> Visitor for F {
    fn take(&mut self, chunk: &EmittedChunk) {
        self(chunk);
    }
}
