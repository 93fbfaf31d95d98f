// Tessellation factors: from the numbers that a hull shader writes to the fixed-point words that the fixed-function
// tessellator works with, and the numbers of points and triangles that they give. Twin: src/geometry/tessellate/factors.rs.
//
// Everything here is integer arithmetic. WGSL lets a compiler assume that no f32 is NaN or infinite, and flush
// denormals, so comparisons of f32 numbers couldn't tell a culled patch from one that is drawn.

const FIXED_ONE: u32 = 0x10000u;
const FIXED_HALF: u32 = 0x8000u;
const FACTOR_ODD: u32 = 0x80000000u;
const FACTOR_VALUE: u32 = 0x7fffffu;
const SUBTRIANGULATED: u32 = 0x40000000u;
const ROWS: u32 = 0x20000000u;
const ROW_BASE_SHIFT: u32 = 24u;
const ROW_FLIP_SHIFT: u32 = 26u;
const ROW_BASE_STEP: u32 = 256u;
const MOST_ROWS: u32 = 127u;

const BITS_ONE: u32 = 0x3f800000u;
const BITS_TWO: u32 = 0x40000000u;
const BITS_63: u32 = 0x427c0000u;
const BITS_64: u32 = 0x42800000u;
const BITS_127: u32 = 0x42fe0000u;
const BITS_1792: u32 = 0x44e00000u;
const BITS_INFINITY: u32 = 0x7f800000u;
const BITS_ONE_AND_HALF_STEP: u32 = 0x3f800040u;
const BITS_ONE_AND_STEP: u32 = 0x3f800080u;

// `inside` takes the fourth word of the vec3, so the struct has 16 bytes, as in Rust.
struct PatchFactors {
    outside: vec3<u32>,
    inside: u32,
}

// Returns whether an `f32` with these bits is greater than zero. Denormals are; NaN isn't.
fn positive_bits(bits: u32) -> bool {
    return bits - 1u < BITS_INFINITY;
}

// Returns the smallest factor of a partitioning, as `f32` bits.
fn factor_lower_bound(partitioning: u32) -> u32 {
    return select(BITS_ONE, BITS_TWO, partitioning == PARTITIONING_FRACTIONAL_EVEN);
}

// Returns the largest factor of a partitioning, as `f32` bits.
fn factor_upper_bound(partitioning: u32) -> u32 {
    let most = select(BITS_64, BITS_127, partitioning == PARTITIONING_ROWS);
    return select(most, BITS_63, partitioning == PARTITIONING_FRACTIONAL_ODD);
}

// Returns the largest factor of a partitioning.
fn last_factor(partitioning: u32) -> f32 {
    return bitcast<f32>(factor_upper_bound(partitioning));
}

// Returns the word of a factor of at least 1, given as `f32` bits. The factor is rounded up to a whole number or, in the
// fractional partitionings, to the nearest 1/65536 with ties to even. Its parity is that of the partitioning, or of the
// whole number.
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

// Returns the word of an inside factor: as `factor_word`, but a whole 1 counts as even, since it acts as 2.
fn inside_word(partitioning: u32, bits: u32) -> u32 {
    let word = factor_word(partitioning, bits);
    let even_one = partitioning != PARTITIONING_FRACTIONAL_ODD && word == (FACTOR_ODD | FIXED_ONE);
    return select(word, FIXED_ONE, even_one);
}

// Returns what the tessellator makes of a patch's factors (sections 11.7.3 to 11.7.10). `edges` are the factors of the
// edges U == 0, V == 0 and W == 0.
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
    if partitioning == PARTITIONING_ROWS {
        let words = vec3<u32>(
            factor_word(partitioning, clamped.x),
            factor_word(partitioning, clamped.y),
            factor_word(partitioning, clamped.z),
        );
        return process_rows(words, bitcast<u32>(inside));
    }
    // An odd patch with a divided edge needs a ring inside, though it may have collapsed to a point.
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

// Returns what becomes of the words of a patch's edges and its inside factor under rows. The smallest width is 1, and the
// largest MOST_ROWS.
fn process_rows(outside: vec3<u32>, inside: u32) -> PatchFactors {
    let positive = select(BITS_ONE, max(inside, BITS_ONE), positive_bits(inside));
    let rounded = (factor_word(PARTITIONING_ROWS, min(positive, BITS_1792)) >> 16u) & 0x7fffu;
    var step = rounded / ROW_BASE_STEP;
    var width = clamp(rounded % ROW_BASE_STEP, 1u, MOST_ROWS);
    if step > 6u {
        step = 0u;
        width = MOST_ROWS;
    }
    var base = (step + 2u) % 3u;
    if step == 0u {
        base = base_by_edges(outside);
    }
    let chosen = (base << ROW_BASE_SHIFT) | (u32(step > 3u) << ROW_FLIP_SHIFT);
    return PatchFactors(outside, (width << 16u) | (width << 31u) | ROWS | chosen);
}

// Returns which edge is the base of rows if nothing else says so: the one whose neighbours have the most similar numbers of
// segments, so that the fewest rows share points; of several the one with the fewest segments, or the first.
fn base_by_edges(outside: vec3<u32>) -> u32 {
    let u = segments(outside.x);
    let v = segments(outside.y);
    let w = segments(outside.z);
    // Numbers of segments are below 128.
    let unlike = vec3<u32>(
        (max(v, w) - min(v, w)) * 128u + u,
        (max(w, u) - min(w, u)) * 128u + v,
        (max(u, v) - min(u, v)) * 128u + w,
    );
    let least = min(min(unlike.x, unlike.y), unlike.z);
    return u32(unlike.x != least) + u32(unlike.x != least && unlike.y != least);
}

// Returns the factor of the edge that base_by_edges makes the base: the rows then widen to what the base has.
fn base_factor(edges: vec3<f32>) -> f32 {
    let factors = process(PARTITIONING_ROWS, edges, 1.0);
    let base = select(row_base(factors), 0u, patch_is_culled(factors));
    return select(select(edges.x, edges.y, base == 1u), edges.z, base == 2u);
}

// Returns the factor that a shader compiler passes to the tessellator under pow2: clamped to 1 to 64, then rounded up
// to a power of two. Factors that cull a patch (NaN, zero, negative numbers) are returned unchanged.
fn round_pow2(factor: f32) -> f32 {
    let bits = bitcast<u32>(factor);
    if !positive_bits(bits) {
        return factor;
    }
    let clamped = clamp(bits, BITS_ONE, BITS_64);
    // The sum carries from the mantissa into the exponent.
    return bitcast<f32>((clamped + 0x7fffffu) & 0x7f800000u);
}

// Returns whether the patch is culled: it has no points and no triangles.
fn patch_is_culled(factors: PatchFactors) -> bool {
    return factors.outside.x == 0u;
}

// Returns whether the patch is cut by uniform subtriangulation instead of Direct3D's tessellator.
fn patch_is_subtriangulated(factors: PatchFactors) -> bool {
    return !patch_is_culled(factors) && (factors.inside & SUBTRIANGULATED) != 0u;
}

// Returns whether the patch is cut into rows.
fn patch_has_rows(factors: PatchFactors) -> bool {
    return !patch_is_culled(factors) && (factors.inside & ROWS) != 0u;
}

// Returns which edge is the base of a patch's rows: 0, 1 or 2 for U == 0, V == 0 or W == 0.
fn row_base(factors: PatchFactors) -> u32 {
    return (factors.inside >> ROW_BASE_SHIFT) & 3u;
}

// Returns 1 if the diagonals of a patch's rows are flipped, else 0.
fn row_flip(factors: PatchFactors) -> u32 {
    return (factors.inside >> ROW_FLIP_SHIFT) & 1u;
}

// Returns the number of rows of a patch: the larger number of segments of the edges beside the base.
fn row_count(factors: PatchFactors) -> u32 {
    let u = segments(factors.outside.x);
    let v = segments(factors.outside.y);
    let w = segments(factors.outside.z);
    let base = row_base(factors);
    return select(select(max(v, w), max(w, u), base == 1u), max(u, v), base == 2u);
}

// Returns the number of segments to which a patch's rows widen.
fn row_width(factors: PatchFactors) -> u32 {
    return (factors.inside & FACTOR_VALUE) >> 16u;
}

// Returns the inside factor in 16.16 fixed point, which says how far apart points inside are; of rows the lesser of their number
// and their width.
fn inside_value(factors: PatchFactors) -> u32 {
    let width = factors.inside & FACTOR_VALUE;
    if patch_has_rows(factors) {
        return min(width, row_count(factors) << 16u);
    }
    return width;
}

// Returns the number of points inside a patch with so many rows of some width. `divisor` is the common_divisor of both.
fn points_in_rows(rows: u32, width: u32, divisor: u32) -> u32 {
    return ((rows - 1u) * (width - 1u) + 1u - divisor) >> 1u;
}

// Returns the number of points inside a patch of rows.
fn row_points(factors: PatchFactors) -> u32 {
    let rows = row_count(factors);
    let width = row_width(factors);
    return points_in_rows(rows, width, common_divisor(rows, width));
}

// Returns whether all factors are 1, so that the patch is one triangle.
fn patch_is_minimal(factors: PatchFactors) -> bool {
    let edges_are_one = all(factors.outside == vec3<u32>(FACTOR_ODD | FIXED_ONE));
    return edges_are_one && (factors.inside & FACTOR_VALUE) == FIXED_ONE;
}

// Returns whether the patch is drawn and all its factors are below 2: without tessellation it would look nearly the
// same.
fn patch_is_low(factors: PatchFactors) -> bool {
    let edges_are_low = all((factors.outside & vec3<u32>(FACTOR_VALUE)) < vec3<u32>(2u * FIXED_ONE));
    return !patch_is_culled(factors) && edges_are_low && (factors.inside & FACTOR_VALUE) < 2u * FIXED_ONE;
}

// Returns 1 if the word's parity is odd, else 0.
fn odd_parity(word: u32) -> u32 {
    return word >> 31u;
}

// Returns the number of segments from an end of a row to its middle, in 16.16 fixed point. The fraction is how far the
// newest segment has grown. The middle segment of an odd row counts as a whole one.
fn half_factor(word: u32) -> u32 {
    let half = ((word & FACTOR_VALUE) + 1u) >> 1u;
    let rounds_up = odd_parity(word) == 1u || half == FIXED_HALF;
    return select(half, half + FIXED_HALF, rounds_up);
}

// Returns `half_factor` rounded up: the segments of half a row, with the middle one of an odd row.
fn half_segments(word: u32) -> u32 {
    return (half_factor(word) + (FIXED_ONE - 1u)) >> 16u;
}

// Returns the number of segments of an edge: one less than its points.
fn segments(word: u32) -> u32 {
    return 2u * half_segments(word) - odd_parity(word);
}

// Returns the number of segments inside: at least 3 if odd, at least 2 if even.
fn inside_segments(word: u32) -> u32 {
    return max(segments(word), 2u + odd_parity(word));
}

// Returns the number of points on the patch's outline.
fn outer_count(factors: PatchFactors) -> u32 {
    return segments(factors.outside.x) + segments(factors.outside.y) + segments(factors.outside.z);
}

// Returns the number of domain points of the patch.
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
    if patch_has_rows(factors) {
        return outer_count(factors) + row_points(factors);
    }
    // With R = (n - 1) / 2 rounded down, the rings inside have 3 R^2 points if n is odd, and 3 R (R + 1) + 1 if it is even.
    let n = inside_segments(factors.inside);
    return outer_count(factors) + ((3u * (n - 1u) * (n - 1u) + 1u) >> 2u);
}

// Returns the number of triangles of the patch.
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
    if patch_has_rows(factors) {
        // By Euler's formula.
        return outer_count(factors) + 2u * row_points(factors) - 2u;
    }
    let inner = inside_segments(factors.inside) - 2u;
    return outer_count(factors) + 3u * inner + ((3u * inner * inner) >> 1u);
}
