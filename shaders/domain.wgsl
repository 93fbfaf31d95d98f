// Domain points and triangles of a patch, each computed from its number alone. Twin: src/geometry/tessellate/domain.rs, which
// describes the pattern. Needs connectivity.wgsl or connectivity_table.wgsl.

// Two thirds in 16.16 fixed point, rounded down as in the specification.
const FIXED_TWO_THIRDS: u32 = 0xaaaau;

const PATTERN_RINGS: u32 = 0u;
const PATTERN_MINIMAL: u32 = 1u;
const PATTERN_SUBTRIANGULATED: u32 = 2u;
const PATTERN_ROWS: u32 = 3u;

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
    if patch_is_subtriangulated(factors) {
        return DomainPlan(factors, PATTERN_SUBTRIANGULATED, start1, start2, outer, segments(factors.inside), row);
    }
    var kind = select(PATTERN_RINGS, PATTERN_MINIMAL, patch_is_minimal(factors));
    if patch_has_rows(factors) {
        kind = PATTERN_ROWS;
    }
    return DomainPlan(factors, kind, start1, start2, outer, inside_segments(factors.inside), row);
}

// Returns (U, V) of domain point `i`, below `point_count(factors)`, in 16.16 fixed point; W = 1 - U - V.
fn domain_point(plan: DomainPlan, i: u32) -> vec2<u32> {
    if plan.kind == PATTERN_SUBTRIANGULATED {
        return subtriangulation_point(plan.n, i);
    }
    if i < plan.outer {
        return outer_point(plan, i);
    }
    if plan.kind == PATTERN_ROWS {
        return row_point(numbered_rows(plan.factors), i - plan.outer);
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
    if plan.kind == PATTERN_SUBTRIANGULATED {
        return subtriangulation_triangle(plan.n, t);
    }
    if plan.kind == PATTERN_ROWS {
        return row_triangle(numbered_rows(plan.factors), t);
    }
    let transition = plan.outer + 3u * (plan.n - 2u);
    if t < transition {
        return transition_triangle(plan, t);
    }
    return regular_triangle(plan.outer, plan.n, t - transition);
}

// Returns (U, V) of the corners of triangle `t`, in 16.16 fixed point. Those of rows are counted in another order than that of
// `domain_triangle`.
fn domain_triangle_places(plan: DomainPlan, t: u32) -> array<vec2<u32>, 3> {
    if plan.kind == PATTERN_ROWS {
        return row_triangle_places(row_plan(plan.factors), t);
    }
    let at = domain_triangle(plan, t);
    return array<vec2<u32>, 3>(domain_point(plan, at.x), domain_point(plan, at.y), domain_point(plan, at.z));
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
