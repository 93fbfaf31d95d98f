// Domain points and triangles of a patch, each one in closed form from its number.
// Twin of src/tessellate/domain.rs, which says what each function means. Goes with factors.wgsl and subtriangulation.wgsl.

const FIXED_TWO_THIRDS: u32 = 0xaaaau;

struct DomainRow {
    half: u32,
    odd: u32,
    fraction: u32,
    split: u32,
    coarse_step: u32,
    fine_step: u32,
}

fn segment_length(segments: u32) -> u32 {
    return u32((f32(2u * FIXED_ONE + segments) + 0.5) / f32(2u * segments));
}

fn drop_top_bit(value: u32) -> u32 {
    return value ^ (1u << firstLeadingBit(value));
}

fn row_split(whole: u32, odd: u32) -> u32 {
    let v = whole - odd;
    return select(2u * drop_top_bit(v) + 1u, 0u, v == 0u);
}

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

fn rings_before(m: u32, area: u32) -> u32 {
    let root = sqrt(f32(m * m - 4u * area));
    return u32((f32(m) - root) * 0.5 + 0.0078125);
}

const PATTERN_RINGS: u32 = 0u;
const PATTERN_MINIMAL: u32 = 1u;
const PATTERN_SUBTRIANGULATED: u32 = 2u;

struct DomainPlan {
    factors: PatchFactors,
    kind: u32,
    start1: u32,
    start2: u32,
    outer: u32,
    n: u32,
    row: DomainRow,
}

fn domain_plan(factors: PatchFactors) -> DomainPlan {
    let row = domain_row(factors.inside);
    let start1 = segments(factors.outside.x);
    let start2 = start1 + segments(factors.outside.y);
    let outer = start2 + segments(factors.outside.z);
    if patch_is_subtriangulated(factors) {
        return DomainPlan(factors, PATTERN_SUBTRIANGULATED, start1, start2, outer, segments(factors.inside), row);
    }
    let kind = select(PATTERN_RINGS, PATTERN_MINIMAL, patch_is_minimal(factors));
    return DomainPlan(factors, kind, start1, start2, outer, inside_segments(factors.inside), row);
}

fn domain_point(plan: DomainPlan, i: u32) -> vec2<u32> {
    if plan.kind == PATTERN_SUBTRIANGULATED {
        return subtriangulation_point(plan.n, i);
    }
    if i < plan.outer {
        return outer_point(plan, i);
    }
    return inner_point(plan.row, plan.n, i - plan.outer);
}

fn outer_point(plan: DomainPlan, i: u32) -> vec2<u32> {
    // One row, chosen first: on a GPU the points of three edges then take one path.
    let side = u32(i >= plan.start1) + u32(i >= plan.start2);
    let edges = plan.factors.outside;
    let word = select(select(edges.x, edges.y, side == 1u), edges.z, side == 2u);
    let p = select(select(plan.start1 - i, i - plan.start1, side == 1u), plan.outer - i, side == 2u);
    let x = row_location(domain_row(word), p);
    return select(select(vec2<u32>(0u, x), vec2<u32>(x, 0u), side == 1u), vec2<u32>(x, FIXED_ONE - x), side == 2u);
}

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

fn ring_point(start: u32, length: u32, p: u32) -> u32 {
    return start + select(p, 0u, p == length);
}

fn domain_triangle(plan: DomainPlan, t: u32) -> vec3<u32> {
    if plan.kind == PATTERN_MINIMAL {
        return vec3<u32>(0u, 1u, 2u);
    }
    if plan.kind == PATTERN_SUBTRIANGULATED {
        return subtriangulation_triangle(plan.n, t);
    }
    let transition = plan.outer + 3u * (plan.n - 2u);
    if t < transition {
        return transition_triangle(plan, t);
    }
    return regular_triangle(plan.outer, plan.n, t - transition);
}

struct TransitionStep {
    inner: u32,
    outer: u32,
    along_inner: bool,
    inner_first: bool,
}

struct TransitionPlaces {
    shift: u32,
    extra: u32,
}

fn transition_places(half_points: u32) -> TransitionPlaces {
    let top = firstLeadingBit(max(half_points, 1u));
    return TransitionPlaces(5u - top, max(half_points, 1u) - (1u << top));
}

fn points_up_to(places: TransitionPlaces, place: u32) -> u32 {
    return (place >> places.shift) + min(places.extra, (((2u * place) >> places.shift) + 1u) >> 1u);
}

fn skip_places(inner: TransitionPlaces, outer: TransitionPlaces, place: u32, skip: u32, count: u32) -> u32 {
    let further = place + skip;
    let fits = points_up_to(inner, further) + points_up_to(outer, further) <= count;
    return select(place, further, fits);
}

fn transition_before_middle(inner_half: u32, outer_half: u32, t: u32) -> TransitionStep {
    // The edge's first segment comes before all places.
    let first = min(outer_half, 1u);
    if t < first {
        return TransitionStep(0u, 0u, false, false);
    }
    let count = t - first;
    let inner_places = transition_places(inner_half);
    let outer_places = transition_places(outer_half);
    // Bisection over the 31 places, unrolled.
    var place = skip_places(inner_places, outer_places, 0u, 16u, count);
    place = skip_places(inner_places, outer_places, place, 8u, count);
    place = skip_places(inner_places, outer_places, place, 4u, count);
    place = skip_places(inner_places, outer_places, place, 2u, count);
    place = skip_places(inner_places, outer_places, place, 1u, count);

    // The triangle belongs to the next place, where the inner side goes first.
    let inner = points_up_to(inner_places, place);
    let outer = points_up_to(outer_places, place);
    let inner_steps = points_up_to(inner_places, place + 1u) - inner;
    let along_inner = inner_steps == 1u && count == inner + outer;
    return TransitionStep(select(inner + inner_steps, inner, along_inner), first + outer, along_inner, along_inner);
}

fn transition_step(row: DomainRow, inner_segments: u32, edge: u32, t: u32) -> TransitionStep {
    let inner_half = row.half - row.odd;
    let outer_half = half_segments(edge) - odd_parity(edge);
    let outer_segments = segments(edge);
    let total = inner_segments + outer_segments;
    let before = inner_half - 1u + outer_half;
    let after_middle = t + before >= total;
    if t >= before && !after_middle {
        // The middle: an odd inside's triangle, then an odd edge's.
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

    // Every triangle has point h of the inner side, point h + 1 of the outer, and a third beside one of these.
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
