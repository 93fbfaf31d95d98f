//! What was repaired in the vertices of primitives.

use super::notes::counts;

counts! {
    pub(super) struct VertexFlaws {
        bad_uvs => "uvs that aren't finite, replaced by (0, 0)";
        missing_uvs => "primitives without the texture coordinates of a map, which has (0, 0) there";
        bad_colors => "colours of vertices that aren't finite, replaced by white";
        bad_tangents => "tangents without a direction, replaced by ones that are computed";
        bad_weights => "vertices with unusable joints or weights, left unskinned";
    }
}

/// What was repaired in vertices.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct VertexRepairs {
    /// Primitives without normals.
    pub without_normals: usize,
    pub flaws: VertexFlaws,
    /// Vertices that more joints than are kept move.
    pub cut_weights: usize,
    /// The largest part of a vertex's weights that was left out, of 1.
    pub largest_cut: f64,
}

impl VertexRepairs {
    /// Adds what was repaired in other vertices.
    pub(super) fn add(&mut self, other: &Self) {
        self.without_normals += other.without_normals;
        self.flaws += other.flaws;
        self.cut_weights += other.cut_weights;
        self.largest_cut = self.largest_cut.max(other.largest_cut);
    }
}
