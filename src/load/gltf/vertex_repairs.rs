//! What was repaired in the vertices of primitives.

/// Counts of what was repaired in vertices.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct VertexRepairs {
    /// Primitives without normals.
    pub without_normals: usize,
    /// Vertices with texture coordinates that aren't finite, which became (0, 0).
    pub bad_uvs: usize,
    /// Primitives without texture coordinates that a map of their material uses.
    pub missing_uvs: usize,
    /// Vertices with colours that aren't finite, which became white.
    pub bad_colors: usize,
    /// Vertices with tangents without a direction, for which others are computed.
    pub bad_tangents: usize,
    /// Vertices whose weights don't add up to anything, or that name a joint that doesn't exist; they stay where the
    /// mesh has them.
    pub bad_weights: usize,
    /// Vertices that more joints than are kept move.
    pub cut_weights: usize,
    /// The largest part of a vertex's weights that was left out, of 1.
    pub largest_cut: f64,
}

impl VertexRepairs {
    /// Adds what was repaired in other vertices.
    pub(super) fn add(&mut self, other: &Self) {
        self.without_normals += other.without_normals;
        self.bad_uvs += other.bad_uvs;
        self.missing_uvs += other.missing_uvs;
        self.bad_colors += other.bad_colors;
        self.bad_tangents += other.bad_tangents;
        self.bad_weights += other.bad_weights;
        self.cut_weights += other.cut_weights;
        self.largest_cut = self.largest_cut.max(other.largest_cut);
    }
}
