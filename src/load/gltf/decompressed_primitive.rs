//! What a compressed primitive holds.

use std::collections::HashMap;

/// The data of a decompressed primitive.
pub(crate) struct DecompressedPrimitive {
    /// The indices of vertices, three for each triangle.
    pub indices: Vec<u32>,
    /// By their names in glTF, the numbers of attributes, as many for each vertex as their accessors say; or why one that a primitive can
    /// do without can't be read, as a clause.
    pub attributes: HashMap<String, Result<Vec<f32>, String>>,
}

impl DecompressedPrimitive {
    /// Returns the size in memory, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        let values: usize = self.attributes.values().flatten().map(Vec::len).sum();
        4 * (self.indices.len() + values) as u64
    }
}
