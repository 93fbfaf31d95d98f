//! A primitive's indices and attributes, once they are decompressed.

/// What a compressed primitive holds.
pub struct Unpacked {
    /// Indices of vertices, three for each triangle.
    pub indices: Vec<u32>,
    pub attributes: Vec<Attribute>,
}

/// One attribute of all vertices.
pub struct Attribute {
    /// As glTF has it, such as POSITION.
    pub name: String,
    /// `width` numbers a vertex, one vertex after another.
    pub values: Vec<f32>,
    pub width: usize,
}

impl Unpacked {
    /// The values of an attribute, N numbers a vertex; none if it has another width, or wasn't compressed.
    pub fn values<const N: usize>(&self, name: &str) -> Option<&[[f32; N]]> {
        let attribute = self.attributes.iter().find(|attribute| attribute.name == name && attribute.width == N)?;
        Some(attribute.values.as_chunks().0)
    }

    /// Its size in memory, in bytes.
    pub fn bytes(&self) -> u64 {
        let values: usize = self.attributes.iter().map(|attribute| attribute.values.len()).sum();
        4 * (self.indices.len() + values) as u64
    }
}
