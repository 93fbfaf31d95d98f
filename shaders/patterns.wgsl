// The functions of connectivity.wgsl as look-ups in a table, the storage buffer `patterns` that the module declares.
// Twin of src/tessellate/patterns.rs, which says what each function means.

const PATTERN_HALVES: u32 = 33u;
const PATTERN_STEPS: u32 = 64u;

fn step_place(inner_half: u32, outer_half: u32, t: u32) -> u32 {
    return (inner_half * PATTERN_HALVES + outer_half) * PATTERN_STEPS + t;
}

fn regular_place(n: u32) -> u32 {
    let rows = n - 2u;
    let squares = (rows - 1u) * rows * (2u * rows - 1u) / 2u;
    return PATTERN_HALVES * PATTERN_HALVES * PATTERN_STEPS + (squares - rows / 2u) / 2u;
}

fn transition_before_middle(inner_half: u32, outer_half: u32, t: u32) -> TransitionStep {
    let word = patterns[step_place(inner_half, outer_half, t)];
    return TransitionStep(word & 0xffu, (word >> 8u) & 0xffu, (word & 0x10000u) != 0u, (word & 0x20000u) != 0u);
}

fn regular_triangle(outer: u32, n: u32, t: u32) -> vec3<u32> {
    let word = patterns[regular_place(n) + t];
    let a = outer + (word & 0xfffu);
    return vec3<u32>(a, a + ((word >> 12u) & 0x3ffu) - 512u, a + (word >> 22u) - 512u);
}
