// Tessellation factors, from what an application asks for to what the fixed-function tessellator works with.
// Twin of src/tessellate/factors.rs, which says what each function means.
//
// Integer arithmetic throughout: WGSL lets a compiler assume that no f32 is NaN or infinite and flush denormals, so
// comparisons on f32 could not tell a culled patch from a drawn one.

const PARTITIONING_INTEGER: u32 = 0u;
const PARTITIONING_POW2: u32 = 1u;
const PARTITIONING_FRACTIONAL_ODD: u32 = 2u;
const PARTITIONING_FRACTIONAL_EVEN: u32 = 3u;
const PARTITIONING_SUBTRIANGULATION: u32 = 4u;

const FIXED_ONE: u32 = 0x10000u;
const FIXED_HALF: u32 = 0x8000u;
const FACTOR_ODD: u32 = 0x80000000u;
const FACTOR_VALUE: u32 = 0x7fffffu;
const SUBTRIANGULATED: u32 = 0x40000000u;

const BITS_ONE: u32 = 0x3f800000u;
const BITS_TWO: u32 = 0x40000000u;
const BITS_63: u32 = 0x427c0000u;
const BITS_64: u32 = 0x42800000u;
const BITS_INFINITY: u32 = 0x7f800000u;
const BITS_ONE_AND_HALF_STEP: u32 = 0x3f800040u;
const BITS_ONE_AND_STEP: u32 = 0x3f800080u;

// `inside` fills the vec3's fourth word: 16 bytes, as in Rust.
struct PatchFactors {
    outside: vec3<u32>,
    inside: u32,
}

fn positive_bits(bits: u32) -> bool {
    return bits - 1u < BITS_INFINITY;
}

fn factor_lower_bound(partitioning: u32) -> u32 {
    return select(BITS_ONE, BITS_TWO, partitioning == PARTITIONING_FRACTIONAL_EVEN);
}

fn factor_upper_bound(partitioning: u32) -> u32 {
    return select(BITS_64, BITS_63, partitioning == PARTITIONING_FRACTIONAL_ODD);
}

fn factor_word(partitioning: u32, bits: u32) -> u32 {
    let exponent = (bits >> 23u) - 127u;
    let mantissa = (bits & 0x7fffffu) | 0x800000u;
    if partitioning != PARTITIONING_FRACTIONAL_ODD && partitioning != PARTITIONING_FRACTIONAL_EVEN {
        let shift = 23u - exponent;
        let whole = (mantissa + (1u << shift) - 1u) >> shift;
        return (whole << 16u) | (whole << 31u);
    }
    let shift = 7u - exponent;
    let tie_to_even = (mantissa >> shift) & 1u;
    let fixed = (mantissa + (1u << (shift - 1u)) - 1u + tie_to_even) >> shift;
    return fixed | select(0u, FACTOR_ODD, partitioning == PARTITIONING_FRACTIONAL_ODD);
}

fn inside_word(partitioning: u32, bits: u32) -> u32 {
    let word = factor_word(partitioning, bits);
    let even_one = partitioning != PARTITIONING_FRACTIONAL_ODD && word == (FACTOR_ODD | FIXED_ONE);
    return select(word, FIXED_ONE, even_one);
}

fn process(partitioning: u32, edges: vec3<f32>, inside: f32) -> PatchFactors {
    let bits = bitcast<vec3<u32>>(edges);
    if !(positive_bits(bits.x) && positive_bits(bits.y) && positive_bits(bits.z)) {
        return PatchFactors(vec3<u32>(0u), 0u);
    }
    let low = factor_lower_bound(partitioning);
    let high = factor_upper_bound(partitioning);
    let clamped = clamp(bits, vec3<u32>(low), vec3<u32>(high));

    let largest = max(max(clamped.x, clamped.y), clamped.z);
    if partitioning == PARTITIONING_SUBTRIANGULATION {
        let word = factor_word(partitioning, largest);
        return PatchFactors(vec3<u32>(word), word | SUBTRIANGULATED);
    }
    // An odd patch with any edge split needs an inner ring, if only a collapsed one.
    let splits = partitioning == PARTITIONING_FRACTIONAL_ODD && largest > BITS_ONE_AND_HALF_STEP;
    let inside_low = select(low, BITS_ONE_AND_STEP, splits);
    let inside_bits = select(0u, bitcast<u32>(inside), positive_bits(bitcast<u32>(inside)));
    return PatchFactors(
        vec3<u32>(
            factor_word(partitioning, clamped.x),
            factor_word(partitioning, clamped.y),
            factor_word(partitioning, clamped.z),
        ),
        inside_word(partitioning, clamp(inside_bits, inside_low, high)),
    );
}

fn round_pow2(factor: f32) -> f32 {
    let bits = bitcast<u32>(factor);
    if !positive_bits(bits) {
        return factor;
    }
    let clamped = clamp(bits, BITS_ONE, BITS_64);
    // A carry out of the mantissa lands in the exponent.
    return bitcast<f32>((clamped + 0x7fffffu) & 0x7f800000u);
}

fn patch_is_culled(factors: PatchFactors) -> bool {
    return factors.outside.x == 0u;
}

fn patch_is_subtriangulated(factors: PatchFactors) -> bool {
    return !patch_is_culled(factors) && (factors.inside & SUBTRIANGULATED) != 0u;
}

fn patch_is_minimal(factors: PatchFactors) -> bool {
    let edges_are_one = all(factors.outside == vec3<u32>(FACTOR_ODD | FIXED_ONE));
    return edges_are_one && (factors.inside & FACTOR_VALUE) == FIXED_ONE;
}

fn patch_is_low(factors: PatchFactors) -> bool {
    let edges_are_low = all((factors.outside & vec3<u32>(FACTOR_VALUE)) < vec3<u32>(2u * FIXED_ONE));
    return !patch_is_culled(factors) && edges_are_low && (factors.inside & FACTOR_VALUE) < 2u * FIXED_ONE;
}

fn odd_parity(word: u32) -> u32 {
    return word >> 31u;
}

fn half_factor(word: u32) -> u32 {
    let half = ((word & FACTOR_VALUE) + 1u) >> 1u;
    let rounds_up = odd_parity(word) == 1u || half == FIXED_HALF;
    return select(half, half + FIXED_HALF, rounds_up);
}

fn half_segments(word: u32) -> u32 {
    return (half_factor(word) + (FIXED_ONE - 1u)) >> 16u;
}

fn segments(word: u32) -> u32 {
    return 2u * half_segments(word) - odd_parity(word);
}

fn inside_segments(word: u32) -> u32 {
    return max(segments(word), 2u + odd_parity(word));
}

fn outer_count(factors: PatchFactors) -> u32 {
    return segments(factors.outside.x) + segments(factors.outside.y) + segments(factors.outside.z);
}

fn point_count(factors: PatchFactors) -> u32 {
    if patch_is_culled(factors) {
        return 0u;
    }
    if patch_is_minimal(factors) {
        return 3u;
    }
    if patch_is_subtriangulated(factors) {
        let n = segments(factors.inside);
        return ((n + 1u) * (n + 2u)) >> 1u;
    }
    // The rings inside hold 3 R^2 points (odd) or 3 R (R + 1) + 1 (even, with the centre), R = (n - 1) / 2.
    let n = inside_segments(factors.inside);
    return outer_count(factors) + ((3u * (n - 1u) * (n - 1u) + 1u) >> 2u);
}

fn triangle_count(factors: PatchFactors) -> u32 {
    if patch_is_culled(factors) {
        return 0u;
    }
    if patch_is_minimal(factors) {
        return 1u;
    }
    if patch_is_subtriangulated(factors) {
        let n = segments(factors.inside);
        return n * n;
    }
    let inner = inside_segments(factors.inside) - 2u;
    return outer_count(factors) + 3u * inner + ((3u * inner * inner) >> 1u);
}
