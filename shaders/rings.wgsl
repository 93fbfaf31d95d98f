// How the rings inside a patch are numbered, and how a triangle between two rings is described.
// Twin of src/tessellate/rings.rs, which says what each function means.

fn rings_before(m: u32, area: u32) -> u32 {
    let root = sqrt(f32(m * m - 4u * area));
    return u32((f32(m) - root) * 0.5 + 0.0078125);
}

fn ring_point(start: u32, length: u32, p: u32) -> u32 {
    return start + select(p, 0u, p == length);
}

struct TransitionStep {
    inner: u32,
    outer: u32,
    along_inner: bool,
    inner_first: bool,
}
