//! The indices and attributes of a primitive after decompression.

/// The data of a decompressed primitive.
pub(crate) struct DecompressedPrimitive {
    /// The indices of vertices, three for each triangle.
    pub indices: Vec<u32>,
    pub attributes: Vec<Attribute>,
    /// The names of attributes that should be there but can't be read, and that a primitive can do without; and why, as a clause.
    pub left_out: Vec<(String, String)>,
}

/// The values of one attribute.
pub(crate) struct Attribute {
    /// The name in glTF, such as POSITION.
    pub name: String,
    /// `width` numbers for each vertex.
    pub values: Vec<f32>,
    pub width: usize,
}

impl DecompressedPrimitive {
    /// Returns the values of an attribute with N numbers a vertex; none if it has another width, or wasn't compressed.
    pub(crate) fn values<const N: usize>(&self, name: &str) -> Option<&[[f32; N]]> {
        let attribute = self.attributes.iter().find(|attribute| attribute.name == name && attribute.width == N)?;
        Some(attribute.values.as_chunks().0)
    }

    /// Returns why an attribute that should be there can't be read, as a clause.
    pub(crate) fn lacks(&self, name: &str) -> Option<&str> {
        self.left_out.iter().find(|(left_out, _)| left_out == name).map(|(_, reason)| reason.as_str())
    }

    /// Returns the size in memory, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        let values: usize = self.attributes.iter().map(|attribute| attribute.values.len()).sum();
        4 * (self.indices.len() + values) as u64
    }
}
