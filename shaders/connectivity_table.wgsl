// The results of connectivity.wgsl in a table: the storage buffer `connectivity_table`, which the module that includes
// this declares. Twin: src/geometry/tessellate/connectivity_table.rs.
// With: domain

// The numbers of segments that half a side may have: 0 to 32.
const PATTERN_HALVES: u32 = 33u;
// The table has room for this many triangles before the middle of a side.
const PATTERN_STEPS: u32 = 64u;

// Returns the index of triangle `t` before the middle of a side.
fn step_index(inner_half: u32, outer_half: u32, t: u32) -> u32 {
    return (inner_half * PATTERN_HALVES + outer_half) * PATTERN_STEPS + t;
}

// Returns the index of the first triangle inside the first ring of a patch with `n` segments inside, 2 or more.
fn regular_index(n: u32) -> u32 {
    let rows = n - 2u;
    let squares = (rows - 1u) * rows * (2u * rows - 1u) / 2u;
    return PATTERN_HALVES * PATTERN_HALVES * PATTERN_STEPS + (squares - rows / 2u) / 2u;
}

// Looks up triangle `t` of those before the middle of a side.
fn transition_before_middle(inner_half: u32, outer_half: u32, t: u32) -> TransitionStep {
    let word = connectivity_table[step_index(inner_half, outer_half, t)];
    return TransitionStep(word & 0xffu, (word >> 8u) & 0xffu, (word & 0x10000u) != 0u, (word & 0x20000u) != 0u);
}

// Looks up triangle `t` of those inside the first ring.
fn regular_triangle(outer: u32, n: u32, t: u32) -> vec3<u32> {
    let word = connectivity_table[regular_index(n) + t];
    let a = outer + (word & 0xfffu);
    return vec3<u32>(a, a + ((word >> 12u) & 0x3ffu) - 512u, a + (word >> 22u) - 512u);
}
