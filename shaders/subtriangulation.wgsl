// Uniform subtriangulation: a patch of n segments on each side becomes n * n equal triangles. Each point and each
// triangle is computed from its number alone. Twin: src/geometry/tessellate/subtriangulation.rs, which describes the pattern.
// Needs factors.wgsl.

// Returns the number of complete rings before a point or a triangle: the largest `r` up to `m / 6` with `3 r (m - 3 r)
// <= area`. For a point, `m` is `2 n + 3` and `area` is twice the number of points before it. For a triangle, `m` is `2
// n` and `area` is the number of triangles before it. `n` is at most 64.
fn subtriangulation_rings(m: u32, area: u32) -> u32 {
    let root = sqrt(f32(m * m - 4u * area));
    return u32((f32(m) - root) * (1.0 / 6.0) + 0.0009765625);
}

// Returns `k / n` in 16.16 fixed point, rounded to the nearest. There are no ties for `n` up to 64, so the results for
// `k` and `n - k` add up to 1.
fn subtriangulation_location(n: u32, k: u32) -> u32 {
    return (2u * FIXED_ONE * k + n) / (2u * n);
}

// Returns (U, V) of point `i` of a patch of `n` segments on each side; W = 1 - U - V.
fn subtriangulation_point(n: u32, i: u32) -> vec2<u32> {
    let ring = subtriangulation_rings(2u * n + 3u, 2u * i);
    let length = n - 3u * ring;
    let in_ring = i - ((3u * ring * (2u * n + 3u - 3u * ring)) >> 1u);
    let side = u32(in_ring >= length) + u32(in_ring >= 2u * length);
    let p = in_ring - side * length;
    let up = ring + p;
    let down = ring + length - p;
    let beside = select(vec2<u32>(ring, down), vec2<u32>(up, ring), side == 1u);
    let place = select(beside, vec2<u32>(down, up), side == 2u);
    return vec2<u32>(subtriangulation_location(n, place.x), subtriangulation_location(n, place.y));
}

// Returns the number of point `q` of the row that lies inside side `side` of a ring. The ring starts at point `start`,
// and its sides have `length` segments.
fn subtriangulation_row(start: u32, length: u32, side: u32, q: u32) -> u32 {
    if q == 0u {
        return start + (side * length + 3u * length - 1u) % (3u * length);
    }
    // In a ring that is a single point, every point of a side is that point.
    let inner = length - 3u;
    return start + 3u * length + (side * inner + q - 1u) % max(3u * inner, 1u);
}

// Returns the corners of triangle `t` of a patch of `n` segments on each side, as point numbers, clockwise.
fn subtriangulation_triangle(n: u32, t: u32) -> vec3<u32> {
    let ring = subtriangulation_rings(2u * n, t);
    let length = n - 3u * ring;
    let start = (3u * ring * (2u * n + 3u - 3u * ring)) >> 1u;
    if length < 3u && t + 1u == n * n {
        // The triangle in the middle of the innermost ring joins its corners, or the middles of its sides.
        return vec3<u32>(start + length - 1u, start + 2u * length - 1u, start + 3u * length - 1u);
    }
    // A side's triangles have an edge on the side and on the row inside by turns. The last corner belongs to the next side.
    let per_side = 2u * length - 3u;
    let in_ring = t - 3u * ring * (2u * n - 3u * ring);
    let side = u32(in_ring >= per_side) + u32(in_ring >= 2u * per_side);
    let q = in_ring - side * per_side;
    let h = q >> 1u;
    let inner = subtriangulation_row(start, length, side, h);
    let outer = start + side * length + h;
    if (q & 1u) == 0u {
        return vec3<u32>(outer, outer + 1u, inner);
    }
    return vec3<u32>(inner, outer + 1u, subtriangulation_row(start, length, side, h + 1u));
}
