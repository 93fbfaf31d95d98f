//! The rings inside a patch: how their points are numbered, and how a triangle between two rings is described. Twin:
//! `shaders/rings.wgsl`.

/// Returns the number of complete rings before a point or a triangle: the largest `s` up to `m / 2` with `s * (m - s)
/// <= area`. `m` is at most 64, and `area` is at most `m * m / 4`.
///
/// The formula holds because each ring has a fixed number of points (or triangles) fewer than the ring around it. The
/// exact root is an integer, or at least 1/64 below the next one. The code adds half of that, which is hundreds of
/// times the error that WGSL allows for a square root, so the result is exact on every device.
pub(super) fn rings_before(m: u32, area: u32) -> u32 {
    let root = ((m * m - 4 * area) as f32).sqrt();
    ((m as f32 - root) * 0.5 + 0.0078125) as u32
}

/// Returns the number of point `p` of a closed ring that starts at point `start`. Point `length` is the first point
/// again.
pub(super) fn ring_point(start: u32, length: u32, p: u32) -> u32 {
    start + if p == length { 0 } else { p }
}

/// One triangle between an edge and the side of the first ring beside it. Its corners are point `inner` of the ring's
/// side, point `outer` of the edge, and the next point of one of the two. Triangles of quads between two rings are like that, too.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TransitionStep {
    pub inner: u32,
    pub outer: u32,
    /// Whether the third corner is the next point of the ring's side, and not of the edge.
    pub along_inner: bool,
    /// Whether the triangle's first corner is the ring's point, and not the edge's.
    pub inner_first: bool,
}

impl TransitionStep {
    /// Returns the corners. `inner_point` and `outer_point` give the numbers of the points of either side.
    pub(super) fn triangle(self, inner_point: impl Fn(u32) -> u32, outer_point: impl Fn(u32) -> u32) -> [u32; 3] {
        let (i, o) = (inner_point(self.inner), outer_point(self.outer));
        let next = if self.along_inner { inner_point(self.inner + 1) } else { outer_point(self.outer + 1) };
        if self.inner_first { [i, o, next] } else { [o, next, i] }
    }
}
