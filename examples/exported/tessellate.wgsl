// SPDX-License-Identifier: MIT OR Apache-2.0
// Copyright (c) 2026 the pnaen authors. You may use this file under either licence, at your option.
//
// Made by pnaen 0.1.0: pnaen shaders --language wgsl -o examples/exported
// surface pn-aen, LOD uniform, partitioning fractional-odd, clipping off, back faces kept, convention d3d11,
// linear normals, shared edges computed once
//
// Vertex buffer: 32 bytes a corner: position (3 numbers, object units), unit normal (3), texture coordinates (2).
// Index buffer: 32-bit numbers, 9 a patch: its corners 0, 1, 2, then the two corners that the neighbour has along
// side 0-1, along 1-2 and along 2-0, in the patch's own direction; at a boundary the patch's own corners (pnaen
// adjacency FILE --indices 9 -o OUT.bin).
// Constant buffer: 192 bytes, std140. Offsets in bytes:
//   0 clip_from_object: 4x4 matrix, column after column: what vertices are drawn with
//   64 view.clip_from_object: 4x4 matrix, column after column: what LOD and culling are computed for; depth is
//     reversed, 1 at the near plane
//   128 view.half_viewport: half the width and half the height of the view, in px
//   136 view.reach: 0
//   144 view.eye: 3 numbers: where the camera is, in object units
//   156 view.radius: the bounding radius in object units: the greatest distance of a corner from the middle of the
//     bounding box
//   160 factor: here 8: the factor of uniform LOD, and the largest of LOD by distance, 1 to 64
//   164 pixels_per_segment: here 8: the length of a segment on screen, in px
//   168 near: here 2: the distance up to which edges get factor, in bounding radii
//   172 far: here 10: the distance from which on edges get 1, in bounding radii
//   176 alpha: here 0.75: the strength of Phong tessellation, 0 to 1

const PARTITIONING_FRACTIONAL_ODD: u32 = 2u;
const PARTITIONING_FRACTIONAL_EVEN: u32 = 3u;
const PARTITIONING_ROWS: u32 = 5u;
const FIXED_ONE: u32 = 0x10000u;
const FIXED_HALF: u32 = 0x8000u;
const FACTOR_ODD: u32 = 0x80000000u;
const FACTOR_VALUE: u32 = 0x7fffffu;
const BITS_ONE: u32 = 0x3f800000u;
const BITS_TWO: u32 = 0x40000000u;
const BITS_63: u32 = 0x427c0000u;
const BITS_64: u32 = 0x42800000u;
const BITS_127: u32 = 0x42fe0000u;
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

// Returns the word of a factor of at least 1, given as `f32` bits. The factor is rounded up to a whole number or, in the
// fractional partitionings, to the nearest 1/65536 with ties to even. Its parity is that of the partitioning, or of the
// whole number.
fn factor_word(partitioning: u32, bits: u32) -> u32 {
    let exponent = (bits >> 23u) - 127u;
    let mantissa = (bits & 0x7fffffu) | 0x800000u;
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

// Returns whether the patch is culled: it has no points and no triangles.
fn patch_is_culled(factors: PatchFactors) -> bool {
    return factors.outside.x == 0u;
}

// Returns whether all factors are 1, so that the patch is one triangle.
fn patch_is_minimal(factors: PatchFactors) -> bool {
    let edges_are_one = all(factors.outside == vec3<u32>(FACTOR_ODD | FIXED_ONE));
    return edges_are_one && (factors.inside & FACTOR_VALUE) == FIXED_ONE;
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
    let inner = inside_segments(factors.inside) - 2u;
    return outer_count(factors) + 3u * inner + ((3u * inner * inner) >> 1u);
}

// A row of points, prepared for `row_location`.
struct DomainRow {
    half: u32,
    odd: u32,
    fraction: u32,
    split: u32,
    coarse_step: u32,
    fine_step: u32,
}

// Returns the length of one of `segments` equal segments in 16.16 fixed point: 1 / segments, rounded half up. There are
// at most 128 segments.
fn segment_length(segments: u32) -> u32 {
    return u32((f32(2u * FIXED_ONE + segments) + 0.5) / f32(2u * segments));
}

// Clears the highest set bit of a number, which must not be zero.
fn drop_top_bit(value: u32) -> u32 {
    return value ^ (1u << firstLeadingBit(value));
}

// Returns the point of each half after which the next new point grows. New points come in the order of a breadth-first
// bisection.
fn row_split(whole: u32, odd: u32) -> u32 {
    let v = whole - odd;
    return select(2u * drop_top_bit(v) + 1u, 0u, v == 0u);
}

// Prepares the row of a factor's word.
fn domain_row(word: u32) -> DomainRow {
    let factor = half_factor(word);
    let whole = factor >> 16u;
    let odd = odd_parity(word);
    let fraction = factor & 0xffffu;
    let half = half_segments(word);
    return DomainRow(
        half,
        odd,
        fraction,
        select(row_split(whole, odd), 0xffffffffu, fraction == 0u),
        segment_length(2u * whole - odd),
        segment_length(2u * half - odd),
    );
}

// Returns where point `p` of a row lies, from 0 to 1 in 16.16 fixed point. Rows are symmetric to the last bit.
fn row_location(row: DomainRow, p: u32) -> u32 {
    if row.odd == 0u && p == row.half {
        return FIXED_HALF;
    }
    let mirrored = p >= row.half;
    let fine = select(p, 2u * row.half - row.odd - p, mirrored);
    let coarse = select(fine, fine - 1u, fine > row.split);
    let coarse_part = coarse * row.coarse_step * (FIXED_ONE - row.fraction);
    let fine_part = fine * row.fine_step * row.fraction;
    let x = (coarse_part + fine_part + FIXED_HALF) >> 16u;
    return select(x, FIXED_ONE - x, mirrored);
}

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

// Two thirds in 16.16 fixed point, rounded down as in the specification.
const FIXED_TWO_THIRDS: u32 = 0xaaaau;

const PATTERN_RINGS: u32 = 0u;
const PATTERN_MINIMAL: u32 = 1u;

// A patch's factors, prepared for `domain_point` and `domain_triangle`.
struct DomainPlan {
    factors: PatchFactors,
    kind: u32,
    start1: u32,
    start2: u32,
    outer: u32,
    n: u32,
    row: DomainRow,
}

// Prepares the pattern of a patch that isn't culled.
fn domain_plan(factors: PatchFactors) -> DomainPlan {
    let row = domain_row(factors.inside);
    let start1 = segments(factors.outside.x);
    let start2 = start1 + segments(factors.outside.y);
    let outer = start2 + segments(factors.outside.z);
    var kind = select(PATTERN_RINGS, PATTERN_MINIMAL, patch_is_minimal(factors));
    return DomainPlan(factors, kind, start1, start2, outer, inside_segments(factors.inside), row);
}

// Returns (U, V) of domain point `i`, below `point_count(factors)`, in 16.16 fixed point; W = 1 - U - V.
fn domain_point(plan: DomainPlan, i: u32) -> vec2<u32> {
    if i < plan.outer {
        return outer_point(plan, i);
    }
    return inner_point(plan.row, plan.n, i - plan.outer);
}

// Returns point `i` of the outline, which starts at V == 1 with the edge U == 0. Each edge's last point is the next
// one's first.
fn outer_point(plan: DomainPlan, i: u32) -> vec2<u32> {
    // Choose the row first, so that on a GPU the points of all three edges take the same branch.
    let side = u32(i >= plan.start1) + u32(i >= plan.start2);
    let edges = plan.factors.outside;
    let word = select(select(edges.x, edges.y, side == 1u), edges.z, side == 2u);
    let p = select(select(plan.start1 - i, i - plan.start1, side == 1u), plan.outer - i, side == 2u);
    let x = row_location(domain_row(word), p);
    return select(select(vec2<u32>(0u, x), vec2<u32>(x, 0u), side == 1u), vec2<u32>(x, FIXED_ONE - x), side == 2u);
}

// Returns point `i` of the rings inside, which are cut from `row` with `n` segments.
fn inner_point(row: DomainRow, n: u32, i: u32) -> vec2<u32> {
    let rings = rings_before(n - 1u, i / 3u);
    let ring = rings + 1u;
    let side_length = n - 2u * ring;
    if side_length == 0u {
        return vec2<u32>(0x5555u, 0x5555u);
    }
    let in_ring = i - 3u * rings * (n - 1u - rings);
    let side = u32(in_ring >= side_length) + u32(in_ring >= 2u * side_length);
    let p = in_ring - side * side_length;

    let across = (row_location(row, ring) * FIXED_TWO_THIRDS + FIXED_HALF) >> 16u;
    let along = row_location(row, select(n - ring - p, ring + p, side == 1u)) - ((across + 1u) >> 1u);
    let beside = select(vec2<u32>(across, along), vec2<u32>(along, across), side == 1u);
    return select(beside, vec2<u32>(along, FIXED_ONE - along - across), side == 2u);
}

// Returns the corners of triangle `t`, below `triangle_count(factors)`, as point numbers, clockwise.
fn domain_triangle(plan: DomainPlan, t: u32) -> vec3<u32> {
    if plan.kind == PATTERN_MINIMAL {
        return vec3<u32>(0u, 1u, 2u);
    }
    let transition = plan.outer + 3u * (plan.n - 2u);
    if t < transition {
        return transition_triangle(plan, t);
    }
    return regular_triangle(plan.outer, plan.n, t - transition);
}

// Returns triangle `t` between an edge and the first ring. The second half of a side mirrors the first.
fn transition_step(row: DomainRow, inner_segments: u32, edge: u32, t: u32) -> TransitionStep {
    let inner_half = row.half - row.odd;
    let outer_half = half_segments(edge) - odd_parity(edge);
    let outer_segments = segments(edge);
    let total = inner_segments + outer_segments;
    let before = inner_half - 1u + outer_half;
    let after_middle = t + before >= total;
    if t >= before && !after_middle {
        // In the middle there is a triangle if the inside is odd, then one if the edge is odd.
        let along_inner = t == before && row.odd == 1u;
        return TransitionStep(inner_half - 1u + (t - before), outer_half, along_inner, true);
    }
    let step = transition_before_middle(inner_half, outer_half, select(t, total - 1u - t, after_middle));
    if !after_middle {
        return step;
    }
    return TransitionStep(
        inner_segments - step.inner - u32(step.along_inner),
        outer_segments - step.outer - u32(!step.along_inner),
        step.along_inner,
        step.inner_first,
    );
}

// Returns triangle `t` of those between the outline and the first ring, whose numbers of segments may differ.
fn transition_triangle(plan: DomainPlan, t: u32) -> vec3<u32> {
    let inner_segments = plan.n - 2u;
    let start1 = plan.start1;
    let start2 = plan.start2;
    let outer = plan.outer;
    let side = u32(t >= start1 + inner_segments) + u32(t >= start2 + 2u * inner_segments);
    let side_start = select(select(0u, start1, side == 1u), start2, side == 2u);
    let edges = plan.factors.outside;
    let edge = select(select(edges.x, edges.y, side == 1u), edges.z, side == 2u);

    let step = transition_step(plan.row, inner_segments, edge, t - side_start - side * inner_segments);
    let inner_start = side * inner_segments + step.inner;
    let outer_start = side_start + step.outer;
    let i = ring_point(outer, 3u * inner_segments, inner_start);
    let o = ring_point(0u, outer, outer_start);
    let next = select(
        ring_point(0u, outer, outer_start + 1u),
        ring_point(outer, 3u * inner_segments, inner_start + 1u),
        step.along_inner,
    );
    return select(vec3<u32>(o, next, i), vec3<u32>(i, o, next), step.inner_first);
}

// Which of the 31 places before a side's middle have a point. Points appear in the order of a breadth-first bisection:
// place 16, then 8 and 24, then 4, 12, 20, 28, and so on.
struct TransitionPlaces {
    shift: u32,
    extra: u32,
}

// Returns the places of a side with this many points in half of it.
fn transition_places(half_points: u32) -> TransitionPlaces {
    let top = firstLeadingBit(max(half_points, 1u));
    return TransitionPlaces(5u - top, max(half_points, 1u) - (1u << top));
}

// Returns the number of points at places 1 to `place`.
fn points_up_to(places: TransitionPlaces, place: u32) -> u32 {
    return (place >> places.shift) + min(places.extra, (((2u * place) >> places.shift) + 1u) >> 1u);
}

// Returns `place + skip` if both sides together have at most `count` points up to there, else `place`.
fn skip_places(inner: TransitionPlaces, outer: TransitionPlaces, place: u32, skip: u32, count: u32) -> u32 {
    let further = place + skip;
    let fits = points_up_to(inner, further) + points_up_to(outer, further) <= count;
    return select(place, further, fits);
}

// Returns triangle `t` of those before the middle of a side.
fn transition_before_middle(inner_half: u32, outer_half: u32, t: u32) -> TransitionStep {
    // The first triangle is the one on the edge's first segment, before place 1.
    let first = min(outer_half, 1u);
    if t < first {
        return TransitionStep(0u, 0u, false, false);
    }
    let count = t - first;
    let inner_places = transition_places(inner_half);
    let outer_places = transition_places(outer_half);
    // A bisection over the 31 places, unrolled.
    var place = skip_places(inner_places, outer_places, 0u, 16u, count);
    place = skip_places(inner_places, outer_places, place, 8u, count);
    place = skip_places(inner_places, outer_places, place, 4u, count);
    place = skip_places(inner_places, outer_places, place, 2u, count);
    place = skip_places(inner_places, outer_places, place, 1u, count);

    // The triangle belongs to the next place. If both sides have a point there, the inner side's triangle comes first.
    let inner = points_up_to(inner_places, place);
    let outer = points_up_to(outer_places, place);
    let inner_steps = points_up_to(inner_places, place + 1u) - inner;
    let along_inner = inner_steps == 1u && count == inner + outer;
    return TransitionStep(select(inner + inner_steps, inner, along_inner), first + outer, along_inner, along_inner);
}

// Returns triangle `t` of those inside the first ring.
fn regular_triangle(outer: u32, n: u32, t: u32) -> vec3<u32> {
    let rings = rings_before(n - 2u, t / 6u);
    let ring = rings + 2u;
    let around_start = outer + 3u * rings * (n - 1u - rings);
    if 2u * ring > n {
        return vec3<u32>(around_start, around_start + 1u, around_start + 2u);
    }
    let inner_segments = n - 2u * ring;
    let around_length = 3u * (inner_segments + 2u);
    let start = around_start + around_length;
    let in_ring = t - 6u * rings * (n - 2u - rings);
    let per_side = 2u * inner_segments + 2u;
    let side = u32(in_ring >= per_side) + u32(in_ring >= 2u * per_side);
    let q = in_ring - side * per_side;

    // Every triangle joins point h of the inner side, point h + 1 of the outer side, and a neighbour of one of them.
    let h = q >> 1u;
    let odd = (q & 1u) == 1u;
    let early = q <= 2u * ((inner_segments + 1u) >> 1u);
    let inner_start = side * inner_segments + h;
    let outer_start = side * (inner_segments + 2u) + h;
    let i = ring_point(start, 3u * inner_segments, inner_start);
    let o = ring_point(around_start, around_length, outer_start + 1u);
    let third = select(
        ring_point(start, 3u * inner_segments, select(inner_start - 1u, inner_start + 1u, odd)),
        ring_point(around_start, around_length, outer_start + select(0u, 2u, odd)),
        early != odd,
    );
    let last = q == per_side - 1u;
    let odd_triangle = select(vec3<u32>(i, o, third), vec3<u32>(o, third, i), early || last);
    return select(vec3<u32>(third, o, i), odd_triangle, odd);
}

const SURFACE_PN_AEN: u32 = 2u;
const UNIT: f32 = 1.0 / 65536.0;

// Returns the point at `t` (16.16 fixed point) on the edge from `a` to `b` with control points `ab` (near a) and `ba`
// (near b), in object units. The arguments must be in the edge's own direction: then all sides do the same arithmetic
// on the same bits, and get the same point.
fn edge_position(surface: u32, a: vec3<f32>, ab: vec3<f32>, ba: vec3<f32>, b: vec3<f32>, t: u32) -> vec3<f32> {
    let y = f32(t) * UNIT;
    let x = f32(FIXED_ONE - t) * UNIT;
    return a * (x * x * x) + ab * (3.0 * x * x * y) + ba * (3.0 * x * y * y) + b * (y * y * y);
}

// b300 b030 b003; on sides 0, 1 and 2, near their starts and ends, b210 b120, b021 b012, b102 b201; b111.
struct ControlNet {
    corners: array<vec3<f32>, 3>,
    edges: array<vec3<f32>, 6>,
    center: vec3<f32>,
}

// Returns the point of a patch at weights `u` and `v` (16.16 fixed point; w is the rest of 1), in object units (Vlachos
// et al. 2001, equation 1).
fn patch_position(surface: u32, net: ControlNet, u: u32, v: u32) -> vec3<f32> {
    let x = f32(u) * UNIT;
    let y = f32(v) * UNIT;
    let z = f32(FIXED_ONE - u - v) * UNIT;
    return net.corners[0] * (x * x * x)
        + net.corners[1] * (y * y * y)
        + net.corners[2] * (z * z * z)
        + net.edges[0] * (3.0 * x * x * y)
        + net.edges[1] * (3.0 * x * y * y)
        + net.edges[2] * (3.0 * y * y * z)
        + net.edges[3] * (3.0 * y * z * z)
        + net.edges[4] * (3.0 * z * z * x)
        + net.edges[5] * (3.0 * z * x * x)
        + net.center * (6.0 * x * y * z);
}

// Returns the linearly interpolated texture coordinate at weights `u` and `v` of a patch.
fn linear_uv(uvs: array<vec2<f32>, 3>, u: u32, v: u32) -> vec2<f32> {
    return uvs[0] * (f32(u) * UNIT) + uvs[1] * (f32(v) * UNIT) + uvs[2] * (f32(FIXED_ONE - u - v) * UNIT);
}

// Returns the linearly interpolated texture coordinate at `t` (16.16 fixed point) on an edge whose ends have `a` and
// `b`.
fn edge_uv(a: vec2<f32>, b: vec2<f32>, t: u32) -> vec2<f32> {
    return a * (f32(FIXED_ONE - t) * UNIT) + b * (f32(t) * UNIT);
}

// A point on a patch's outline: the side, and the weight of the side's end. Side 3 means inside the patch.
struct OutlinePlace {
    side: u32,
    t: u32,
}

// Returns where the domain point (u, v, w) lies on the patch's outline.
fn outline_place(u: u32, v: u32) -> OutlinePlace {
    let w = FIXED_ONE - u - v;
    if w == 0u {
        return OutlinePlace(0u, v);
    }
    if u == 0u {
        return OutlinePlace(1u, w);
    }
    if v == 0u {
        return OutlinePlace(2u, u);
    }
    return OutlinePlace(3u, 0u);
}

// Returns the control point near `a` of a PN triangle's edge: the point one third of the way from `a` to `b`, projected
// into the tangent plane at `a` (Vlachos et al. 2001, section 3.1: b210 = (2 P1 + P2 - w12 N1) / 3). `normal` is the
// unit normal at `a`.
fn edge_control_point(a: vec3<f32>, b: vec3<f32>, normal: vec3<f32>) -> vec3<f32> {
    return (a * 2.0 + b - normal * dot(b - a, normal)) * (1.0 / 3.0);
}

// Returns the control points near `a` and near `b` that one side of an edge proposes. `at_a` and `at_b` are the side's
// own unit normals at the ends; `alpha` is the strength of Phong tessellation, which other surfaces ignore.
fn side_control_points(
    surface: u32,
    alpha: f32,
    a: vec3<f32>,
    b: vec3<f32>,
    at_a: vec3<f32>,
    at_b: vec3<f32>,
) -> array<vec3<f32>, 2> {
    return array<vec3<f32>, 2>(edge_control_point(a, b, at_a), edge_control_point(b, a, at_b));
}

// Returns the control point b111 of a net with these corners and six edge control points: E + (E - V) / 2, where E is
// the mean of the edge control points and V is the mean of the corners (Vlachos et al. 2001, section 3.1).
fn center_control_point(corners: array<vec3<f32>, 3>, edges: array<vec3<f32>, 6>) -> vec3<f32> {
    let e = (edges[0] + edges[1] + edges[2] + edges[3] + edges[4] + edges[5]) * (1.0 / 6.0);
    let v = (corners[0] + corners[1] + corners[2]) * (1.0 / 3.0);
    return e + (e - v) * 0.5;
}

// Weighted sums of unit normals that are shorter than this are rounding errors: the normals cancel.
const CANCELLED: f32 = 1e-6;

// Returns a weighted sum of normals at unit length, or `nearest` (the normal with the greatest weight) if they cancel.
fn unit_or(sum: vec3<f32>, nearest: vec3<f32>) -> vec3<f32> {
    let length_squared = dot(sum, sum);
    return select(nearest, sum * inverseSqrt(length_squared), length_squared > CANCELLED * CANCELLED);
}

// Returns the linearly interpolated unit normal at weights `u` and `v` of a patch, or the normal of the nearest corner
// if the normals cancel.
fn linear_normal(normals: array<vec3<f32>, 3>, u: u32, v: u32) -> vec3<f32> {
    let w = FIXED_ONE - u - v;
    let nearest = select(select(normals[2], normals[1], v >= w), normals[0], u >= v && u >= w);
    return unit_or(normals[0] * (f32(u) * UNIT) + normals[1] * (f32(v) * UNIT) + normals[2] * (f32(w) * UNIT), nearest);
}

// Returns the linearly interpolated unit normal at `t` on an edge whose ends have normals `a` and `b`. The arguments
// must be in the edge's own direction, as for edge_position.
fn edge_normal(a: vec3<f32>, b: vec3<f32>, t: u32) -> vec3<f32> {
    let nearest = select(b, a, 2u * t <= FIXED_ONE);
    return unit_or(a * (f32(FIXED_ONE - t) * UNIT) + b * (f32(t) * UNIT), nearest);
}

struct LodView {
    clip_from_object: mat4x4<f32>,
    half_viewport: vec2<f32>,
    // The largest distance in object units by which displacement moves a point.
    reach: f32,
    eye: vec3<f32>,
    radius: f32,
}

// The two inner control points of a curve: the one near its start, and the one near its end.
struct CurveNet {
    ab: vec3<f32>,
    ba: vec3<f32>,
}

const CONVENTION_D3D11: u32 = 0u;

// Returns the side (0 to 2) whose factor the hull shader writes as factor `i` (0 to 2).
fn factor_side(convention: u32, i: u32) -> u32 {
    return (i + 1u) % 3u;
}

// Returns the weights of corners 0 and 1 for a domain point that the tessellator gives as U and V. All are 16.16 fixed
// point; the weight of corner 2 is the rest of 1.
fn corner_weights(convention: u32, domain: vec2<u32>) -> vec2<u32> {
    let w = FIXED_ONE - domain.x - domain.y;
    return domain;
}

const CHOSEN_SURFACE: u32 = SURFACE_PN_AEN;
const CHOSEN_PARTITIONING: u32 = PARTITIONING_FRACTIONAL_ODD;
const CHOSEN_CONVENTION: u32 = CONVENTION_D3D11;

// The numbers that a host may change from frame to frame.
struct StageConstants {
    // The matrix that vertices are drawn with.
    clip_from_object: mat4x4<f32>,
    // What LOD and culling are computed for.
    view: LodView,
    // The factor of uniform LOD, and the largest of LOD by distance, 1 to 64.
    factor: f32,
    // The length of a segment on screen in px, of LOD by the length of edges.
    pixels_per_segment: f32,
    // The distances of LOD by distance in bounding radii: up to `near` edges get `factor`, from `far` on 1.
    near: f32,
    far: f32,
    // How strong Phong tessellation is, 0 to 1.
    alpha: f32,
}

// The unit normals of one side of an edge, at the edge's start and at its end.
struct SideNormals {
    at_a: vec3<f32>,
    at_b: vec3<f32>,
}

// What the hull shader computes for a side of a patch: the control points near its start and near its end, and the factor of
// its edge.
struct HullSide {
    near_start: vec3<f32>,
    near_end: vec3<f32>,
    factor: f32,
}

// What the domain shader reads of a patch.
struct StagePatch {
    net: ControlNet,
    normals: array<vec3<f32>, 3>,
    uvs: array<vec2<f32>, 3>,
}

// What the domain shader makes of one domain point.
struct StageVertex {
    position: vec3<f32>,
    normal: vec3<f32>,
    uv: vec2<f32>,
}

// Returns whether a position comes before another one, by x, then y, then z.
fn comes_before(a: vec3<f32>, b: vec3<f32>) -> bool {
    if a.x != b.x {
        return a.x < b.x;
    }
    if a.y != b.y {
        return a.y < b.y;
    }
    return a.z < b.z;
}

// Returns whether a side of a patch, from `start` to `end`, runs against its edge. An edge runs from the end that comes first to
// the other one, which all its sides see alike: they compute it in that direction, and get the same bits. As published, every
// side has a direction of its own.
fn side_is_reversed(start: vec3<f32>, end: vec3<f32>) -> bool {
    return comes_before(end, start);
}

// Returns the normals of a side in the direction of its edge.
fn along_edge(side: SideNormals, reversed: bool) -> SideNormals {
    return SideNormals(select(side.at_a, side.at_b, reversed), select(side.at_b, side.at_a, reversed));
}

// Returns the normals of `one` side, or those of the `other` one.
fn chosen_normals(one: SideNormals, other: SideNormals, takes_other: bool) -> SideNormals {
    return SideNormals(select(one.at_a, other.at_a, takes_other), select(one.at_b, other.at_b, takes_other));
}

// Returns the control points that one side of an edge from `a` to `b` proposes.
fn unshared_curve(alpha: f32, a: vec3<f32>, b: vec3<f32>, side: SideNormals) -> CurveNet {
    let proposed = side_control_points(CHOSEN_SURFACE, alpha, a, b, side.at_a, side.at_b);
    return CurveNet(proposed[0], proposed[1]);
}

// Returns the control points of an edge from `a` to `b` that two sides share: the mean of what both propose, or on a crease
// those along it.
fn shared_curve(alpha: f32, a: vec3<f32>, b: vec3<f32>, one: SideNormals, other: SideNormals) -> CurveNet {
    let of_one = unshared_curve(alpha, a, b, one);
    let of_other = unshared_curve(alpha, a, b, other);
    let ab = (of_one.ab + of_other.ab) * 0.5;
    let ba = (of_one.ba + of_other.ba) * 0.5;
    return CurveNet(ab, ba);
}

// Returns the curve of a patch's side: shared with the side across the edge if the surface doesn't tear, else the patch's own.
fn side_curve(alpha: f32, a: vec3<f32>, b: vec3<f32>, own: SideNormals, across: SideNormals, reversed: bool) -> CurveNet {
    // The side that runs along the edge first, so that both sides add up in the same order.
    return shared_curve(alpha, a, b, chosen_normals(own, across, reversed), chosen_normals(across, own, reversed));
}

// Returns LOD's factor of an edge with these control points, in the edge's direction.
fn edge_curve_factor(constants: StageConstants, a: vec3<f32>, curve: CurveNet, b: vec3<f32>) -> f32 {
    return constants.factor;
}

// Returns the factor of a patch's side. Where a surface tears, the sides of an edge have curves of different lengths; both take
// the larger factor, so that only the surface tears and not the pattern.
fn hull_side_factor(
    constants: StageConstants,
    a: vec3<f32>,
    b: vec3<f32>,
    curve: CurveNet,
    across: SideNormals,
) -> f32 {
    let own = edge_curve_factor(constants, a, curve, b);
    return own;
}

// Returns a factor as it is handed to the tessellator: under pow2 rounded up to a power of two.
fn written_factor(factor: f32) -> f32 {
    return factor;
}

// Returns what the hull shader computes for the side of a patch from `start` to `end`, whose corners have the normals `own`;
// `across` are those that the neighbour's corners have there, in the same order, or `own` where there is no neighbour.
fn hull_side(
    constants: StageConstants,
    start: vec3<f32>,
    end: vec3<f32>,
    own: SideNormals,
    across: SideNormals,
) -> HullSide {
    // Both directions run the same code, which a compiler then rounds alike.
    let reversed = side_is_reversed(start, end);
    let a = select(start, end, reversed);
    let b = select(end, start, reversed);
    let side_along = along_edge(own, reversed);
    let across_along = along_edge(across, reversed);
    let curve = side_curve(constants.alpha, a, b, side_along, across_along, reversed);
    let factor = written_factor(hull_side_factor(constants, a, b, curve, across_along));
    return HullSide(select(curve.ab, curve.ba, reversed), select(curve.ba, curve.ab, reversed), factor);
}

// Returns what the hull shader hands to the tessellator: the factors of the edges in the order of the convention, and the one
// inside. `sides` are the factors of the sides 0-1, 1-2 and 2-0. A patch that is left out gets zeros.
fn tessellation_factors(constants: StageConstants, net: ControlNet, sides: vec3<f32>) -> vec4<f32> {
    let edges = vec3<f32>(
        sides[factor_side(CHOSEN_CONVENTION, 0u)],
        sides[factor_side(CHOSEN_CONVENTION, 1u)],
        sides[factor_side(CHOSEN_CONVENTION, 2u)],
    );
    return vec4<f32>(edges, max(max(sides.x, sides.y), sides.z));
}

// Returns the vertex at `side_t` (16.16 fixed point) on a side of a patch, computed in the direction of its edge.
fn edge_vertex(hull: StagePatch, side: u32, side_t: u32) -> StageVertex {
    let next = (side + 1u) % 3u;
    let reversed = side_is_reversed(hull.net.corners[side], hull.net.corners[next]);
    let start = select(side, next, reversed);
    let end = select(next, side, reversed);
    let t = select(side_t, FIXED_ONE - side_t, reversed);
    let a = hull.net.corners[start];
    let b = hull.net.corners[end];
    let near_a = hull.net.edges[2u * side + u32(reversed)];
    let near_b = hull.net.edges[2u * side + u32(!reversed)];
    let curved = edge_position(CHOSEN_SURFACE, a, near_a, near_b, b, t);
    // The ends are corners of other patches too, whose bits they must have.
    let position = select(select(curved, a, t == 0u), b, t == FIXED_ONE);
    let normal = edge_vertex_normal(a, b, hull.normals[start], hull.normals[end], t);
    return StageVertex(position, normal, edge_uv(hull.uvs[start], hull.uvs[end], t));
}

// Returns the normal at `t` on an edge from `a` to `b`.
fn edge_vertex_normal(a: vec3<f32>, b: vec3<f32>, at_a: vec3<f32>, at_b: vec3<f32>, t: u32) -> vec3<f32> {
    return edge_normal(at_a, at_b, t);
}

// Returns the vertex of a patch at weights `u` and `v`.
fn inner_vertex(hull: StagePatch, u: u32, v: u32) -> StageVertex {
    return StageVertex(patch_position(CHOSEN_SURFACE, hull.net, u, v), inner_normal(hull, u, v), linear_uv(hull.uvs, u, v));
}

// Returns the normal of a patch at weights `u` and `v`.
fn inner_normal(hull: StagePatch, u: u32, v: u32) -> vec3<f32> {
    return linear_normal(hull.normals, u, v);
}

// Returns the vertex of a patch at weights `u` and `v`, which on a side is computed for the edge.
fn shared_vertex(hull: StagePatch, u: u32, v: u32) -> StageVertex {
    let place = outline_place(u, v);
    if place.side < 3u {
        return edge_vertex(hull, place.side, place.t);
    }
    return inner_vertex(hull, u, v);
}

// Returns the vertex at a domain point that the tessellator gives as U and V, in 16.16 fixed point.
fn stage_vertex(hull: StagePatch, domain: vec2<u32>) -> StageVertex {
    let weights = corner_weights(CHOSEN_CONVENTION, domain);
    let made = shared_vertex(hull, weights.x, weights.y);
    return made;
}

const PATCH_INDICES: u32 = 9u;
@group(0) @binding(0) var<uniform> constants: StageConstants;

// The mesh's corners, 8 numbers each: position (object units), unit normal, texture coordinates.
@group(0) @binding(1) var<storage, read> corners: array<f32>;

// The indices of the patches, which `pnaen adjacency` writes.
@group(0) @binding(2) var<storage, read> indices: array<u32>;

@group(0) @binding(3) var<storage, read_write> hulls: array<Hull>;

// Where the output of each patch begins: its vertices (x) and its triangles (y). offsets_main makes that of their numbers.
@group(0) @binding(4) var<storage, read_write> offsets: array<vec2<u32>>;

// The output: 8 numbers a vertex, as of corners, and 3 indices a triangle.
@group(0) @binding(5) var<storage, read_write> out_vertices: array<f32>;

@group(0) @binding(6) var<storage, read_write> out_indices: array<u32>;
@group(0) @binding(7) var<storage, read_write> status: Status;

// What hull_main computes for a patch.
struct Hull {
    net: ControlNet,
    factors: PatchFactors,
}

// Arguments of an indexed indirect draw of all that was emitted, and how much that is. Patches that don't fit the output's
// buffers are left out; then `vertices` and `triangles`, which count all, are more than the buffers hold.
struct Status {
    index_count: u32,
    instance_count: u32,
    first_index: u32,
    base_vertex: i32,
    first_instance: u32,
    vertices: u32,
    triangles: u32,
}

// Invocations of a workgroup.
const EXPORTED_WORKGROUP: u32 = 64u;

const SCAN_WORKGROUP: u32 = 256u;

fn patch_count() -> u32 {
    return arrayLength(&indices) / PATCH_INDICES;
}

fn exported_position(corner: u32) -> vec3<f32> {
    return vec3<f32>(corners[8u * corner], corners[8u * corner + 1u], corners[8u * corner + 2u]);
}

fn exported_normal(corner: u32) -> vec3<f32> {
    return vec3<f32>(corners[8u * corner + 3u], corners[8u * corner + 4u], corners[8u * corner + 5u]);
}

fn exported_uv(corner: u32) -> vec2<f32> {
    return vec2<f32>(corners[8u * corner + 6u], corners[8u * corner + 7u]);
}

// What a hull shader's invocation for side `k` computes.
fn patch_side(first: u32, k: u32) -> HullSide {
    let start = indices[first + k];
    let end = indices[first + (k + 1u) % 3u];
    let across_start = indices[first + 3u + 2u * k];
    let across_end = indices[first + 4u + 2u * k];
    return hull_side(
        constants,
        exported_position(start),
        exported_position(end),
        SideNormals(exported_normal(start), exported_normal(end)),
        SideNormals(exported_normal(across_start), exported_normal(across_end)),
    );
}

// Computes a patch's control net and factors, and counts what it will emit.
@compute @workgroup_size(EXPORTED_WORKGROUP)
fn hull_main(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let index = (workgroup.y * workgroups.x + workgroup.x) * EXPORTED_WORKGROUP + local;
    if index >= patch_count() {
        return;
    }
    var net: ControlNet;
    var sides: vec3<f32>;
    for (var k = 0u; k < 3u; k++) {
        let side = patch_side(PATCH_INDICES * index, k);
        net.corners[k] = exported_position(indices[PATCH_INDICES * index + k]);
        net.edges[2u * k] = side.near_start;
        net.edges[2u * k + 1u] = side.near_end;
        sides[k] = side.factor;
    }
    net.center = center_control_point(net.corners, net.edges);
    let written = tessellation_factors(constants, net, sides);
    let factors = process(CHOSEN_PARTITIONING, written.xyz, written.w);
    hulls[index] = Hull(net, factors);
    offsets[index] = vec2<u32>(point_count(factors), triangle_count(factors));
}

var<workgroup> partial_sums: array<vec2<u32>, SCAN_WORKGROUP>;

// Turns counts into offsets, in one workgroup: each invocation adds up a run of patches (Blelloch 1990, section 1.2, with one
// level).
@compute @workgroup_size(SCAN_WORKGROUP)
fn offsets_main(@builtin(local_invocation_index) local: u32) {
    let count = patch_count();
    let run = (count + SCAN_WORKGROUP - 1u) / SCAN_WORKGROUP;
    let first = min(local * run, count);
    let end = min(first + run, count);
    var sum = vec2<u32>(0u);
    for (var i = first; i < end; i++) {
        sum += offsets[i];
    }
    partial_sums[local] = sum;
    workgroupBarrier();
    var before = vec2<u32>(0u);
    for (var i = 0u; i < local; i++) {
        before += partial_sums[i];
    }
    for (var i = first; i < end; i++) {
        let own = offsets[i];
        offsets[i] = before;
        before += own;
        if has_room(before) {
            atomicMax(&fitting_triangles, before.y);
        }
    }
    workgroupBarrier();
    if local == SCAN_WORKGROUP - 1u {
        status = Status(3u * atomicLoad(&fitting_triangles), 1u, 0u, 0, 0u, before.x, before.y);
    }
}

var<workgroup> fitting_triangles: atomic<u32>;

// Whether the output has room for so many vertices (x) and triangles (y).
fn has_room(counts: vec2<u32>) -> bool {
    return counts.x <= arrayLength(&out_vertices) / 8u && counts.y <= arrayLength(&out_indices) / 3u;
}

fn patch_hull(index: u32) -> StagePatch {
    let a = indices[PATCH_INDICES * index];
    let b = indices[PATCH_INDICES * index + 1u];
    let c = indices[PATCH_INDICES * index + 2u];
    return StagePatch(
        hulls[index].net,
        array<vec3<f32>, 3>(exported_normal(a), exported_normal(b), exported_normal(c)),
        array<vec2<f32>, 3>(exported_uv(a), exported_uv(b), exported_uv(c)),
    );
}

fn put_vertex(index: u32, made: StageVertex) {
    out_vertices[8u * index] = made.position.x;
    out_vertices[8u * index + 1u] = made.position.y;
    out_vertices[8u * index + 2u] = made.position.z;
    out_vertices[8u * index + 3u] = made.normal.x;
    out_vertices[8u * index + 4u] = made.normal.y;
    out_vertices[8u * index + 5u] = made.normal.z;
    out_vertices[8u * index + 6u] = made.uv.x;
    out_vertices[8u * index + 7u] = made.uv.y;
}

// Emits the vertices and triangles of a patch: the fixed-function tessellator's points, numbered and joined as it does, each
// put through what a domain shader would do.
@compute @workgroup_size(EXPORTED_WORKGROUP)
fn emit_main(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let index = workgroup.y * workgroups.x + workgroup.x;
    if index >= patch_count() {
        return;
    }
    let factors = hulls[index].factors;
    let counts = vec2<u32>(point_count(factors), triangle_count(factors));
    let start = offsets[index];
    if counts.x == 0u || !has_room(start + counts) {
        return;
    }
    let hull = patch_hull(index);
    let plan = domain_plan(factors);
    for (var i = local; i < counts.x; i += EXPORTED_WORKGROUP) {
        put_vertex(start.x + i, stage_vertex(hull, domain_point(plan, i)));
    }
    for (var t = local; t < counts.y; t += EXPORTED_WORKGROUP) {
        let triangle = domain_triangle(plan, t);
        let at = 3u * (start.y + t);
        out_indices[at] = start.x + triangle.x;
        out_indices[at + 1u] = start.x + triangle.y;
        out_indices[at + 2u] = start.x + triangle.z;
    }
}
