// Which points the triangles inside a patch join, each in closed form from its number.
// Twin of src/tessellate/connectivity.rs, which says what each function means.

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
