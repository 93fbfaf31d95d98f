// The rings inside a patch: how their points are numbered, and how a triangle between two rings is described. Twin:
// src/geometry/tessellate/rings.rs.

// Returns the number of complete rings before a point or a triangle: the largest `s` up to `m / 2` with `s * (m - s) <=
// area`. `m` is at most 64, and `area` is at most `m * m / 4`.
fn rings_before(m: u32, area: u32) -> u32 {
    let root = sqrt(f32(m * m - 4u * area));
    return u32((f32(m) - root) * 0.5 + 0.0078125);
}

// Returns the number of point `p` of a closed ring that starts at point `start`. Point `length` is the first point
// again.
fn ring_point(start: u32, length: u32, p: u32) -> u32 {
    return start + select(p, 0u, p == length);
}

// One triangle between an edge and the side of the first ring beside it. Its corners are point `inner` of the ring's
// side, point `outer` of the edge, and the next point of one of the two.
struct TransitionStep {
    inner: u32,
    outer: u32,
    along_inner: bool,
    inner_first: bool,
}
