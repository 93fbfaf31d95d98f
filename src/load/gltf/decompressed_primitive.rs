//! The indices and attributes of a primitive after decompression.

/// The data of a decompressed primitive.
pub(crate) struct DecompressedPrimitive {
    /// The indices of vertices, three for each triangle.
    pub indices: Vec<u32>,
    pub attributes: Vec<Attribute>,
    /// The names of attributes that should be there but can't be read, and that a primitive can do without.
    pub left_out: Vec<String>,
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

    /// Returns whether an attribute should be there but can't be read.
    pub(crate) fn lacks(&self, name: &str) -> bool {
        self.left_out.iter().any(|left_out| left_out == name)
    }

    /// Returns the size in memory, in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        let values: usize = self.attributes.iter().map(|attribute| attribute.values.len()).sum();
        4 * (self.indices.len() + values) as u64
    }
}
