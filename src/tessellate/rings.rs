//! How the rings inside a patch are numbered, and how a triangle between two rings is described. Twin:
//! `shaders/rings.wgsl`.

/// The largest `s` up to `m / 2` with `s * (m - s) <= area`, for `m` up to 64 and `area` up to `m * m / 4`: the number
/// of whole rings before something, as a ring has a fixed number of things fewer than the one around it.
///
/// The exact root is a whole number or at least 1/64 below the next one. Half of that is added, hundreds of times the
/// error that WGSL allows a square root, so that the result is exact everywhere.
pub fn rings_before(m: u32, area: u32) -> u32 {
    let root = ((m * m - 4 * area) as f32).sqrt();
    ((m as f32 - root) * 0.5 + 0.0078125) as u32
}

/// The number of point `p` of a closed ring of `length` points: the one after the last is the first.
pub fn ring_point(start: u32, length: u32, p: u32) -> u32 {
    start + if p == length { 0 } else { p }
}

/// One triangle between an edge and the side inside it. It has point `inner` of the inner side, point `outer` of the edge,
/// and the next point of one of the two.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TransitionStep {
    pub inner: u32,
    pub outer: u32,
    /// The third corner is the inner side's next point, not the edge's.
    pub along_inner: bool,
    /// The triangle is written from its inner point.
    pub inner_first: bool,
}
