// Connectivity: which points the triangles inside a patch join. Each triangle is computed from its number alone. Twin:
// src/geometry/tessellate/connectivity.rs.
// With: domain

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
