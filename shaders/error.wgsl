// LOD by error: how many segments keep the emitted triangles within a distance, in px on screen, of the surface. Twin:
// src/tessellate/error.rs, which explains the bounds.

// Bounds on the depth and the screen position of a set of control points, from which the size of differences on screen
// is bounded.
struct ScreenBounds {
    nearest: f32,
    farthest: f32,
    least: vec2<f32>,
    greatest: vec2<f32>,
    is_cut: bool,
}

// The part of the tolerance that edges may use up. The rest is for the rows of triangles beside them, which also bend
// in other directions.
const EDGE_SHARE: f32 = 0.75;

// Returns the bounds of no points, to be widened.
fn no_bounds() -> ScreenBounds {
    return ScreenBounds(3.4e38, 0.0, vec2<f32>(3.4e38), vec2<f32>(-3.4e38), false);
}

// Widens the bounds to include a control point `p` in object units, wherever displacement moves it.
fn widen(view: LodView, bounds: ScreenBounds, p: vec3<f32>) -> ScreenBounds {
    let clip = view.clip_from_object * vec4<f32>(p, 1.0);
    let depth = max(clip.w, clip.z);
    let place = clip.xy / depth;
    // How far displacement may move the point in depth, past the near plane, and across the view.
    let deep = length(clip_row(view, 3u)) * view.reach;
    let past_near = length(clip_row(view, 3u) - clip_row(view, 2u)) * view.reach;
    let across = vec2<f32>(length(clip_row(view, 0u)), length(clip_row(view, 1u))) * view.reach;
    let beyond = clip.z + past_near <= clip.w;
    let nearest = max(clip.w - deep, clip.z);
    let spread = (across + abs(place) * deep) / nearest;
    return ScreenBounds(
        min(bounds.nearest, nearest),
        max(bounds.farthest, depth + deep),
        min(bounds.least, select(vec2<f32>(-1.0), place - spread, beyond)),
        max(bounds.greatest, select(vec2<f32>(1.0), place + spread, beyond)),
        bounds.is_cut || !beyond,
    );
}

// Returns the bounds of an edge's four control points.
fn edge_bounds(view: LodView, a: vec3<f32>, ab: vec3<f32>, ba: vec3<f32>, b: vec3<f32>) -> ScreenBounds {
    return widen(view, widen(view, widen(view, widen(view, no_bounds(), a), ab), ba), b);
}

// Returns the bounds of a patch's ten control points.
fn net_bounds(view: LodView, net: ControlNet) -> ScreenBounds {
    var bounds = widen(view, no_bounds(), net.center);
    for (var k = 0u; k < 3u; k++) {
        bounds = widen(view, bounds, net.corners[k]);
        bounds = widen(view, bounds, net.edges[2u * k]);
        bounds = widen(view, bounds, net.edges[2u * k + 1u]);
    }
    return bounds;
}

// Returns the bounds of points that are weighted means: `share` (0 to 1) of a point within `other`, and the rest of a
// point within `own`. The bounds `own` must lie within `other`.
fn mixed_bounds(own: ScreenBounds, other: ScreenBounds, share: f32) -> ScreenBounds {
    if other.is_cut {
        // The true least depth isn't known: `nearest` was clamped to the near plane, and a mean of it would be too far.
        return other;
    }
    let nearest = own.nearest + share * (other.nearest - own.nearest);
    // On screen, means are weighted by depth.
    let reach = min(share * other.farthest / nearest, 1.0);
    return ScreenBounds(
        nearest,
        other.farthest,
        own.least + (other.least - own.least) * reach,
        own.greatest + (other.greatest - own.greatest) * reach,
        false,
    );
}

// Returns a bound on the length on screen, in px, of the difference vector of two points. The vector is in object
// units.
fn screen_length(view: LodView, bounds: ScreenBounds, difference: vec3<f32>) -> f32 {
    let across = vec2<f32>(dot(clip_row(view, 0u), difference), dot(clip_row(view, 1u), difference));
    let deep = dot(clip_row(view, 3u), difference);
    let a = abs(across - bounds.least * deep);
    let b = abs(across - bounds.greatest * deep);
    // Divide before the length is taken: squares of tiny numbers underflow.
    return length(max(a, b) / bounds.nearest * view.half_viewport);
}

// Returns a bound on the length on screen, in px, of any vector whose length is `radius` object units.
fn screen_radius(view: LodView, bounds: ScreenBounds, radius: f32) -> f32 {
    let across = vec2<f32>(length(clip_row(view, 0u)), length(clip_row(view, 1u)));
    let deep = length(clip_row(view, 3u));
    let most = max(abs(bounds.least), abs(bounds.greatest));
    return length((across + most * deep) * (radius / bounds.nearest) * view.half_viewport);
}

// Returns the least *level* of `least` or more. A level is a factor whose rows of points nest with the rows of all
// other levels. What is beyond the last level is returned as it is, as a factor above 64, so that callers can tell.
fn nesting_factor(partitioning: u32, least: f32) -> f32 {
    let odd = partitioning == PARTITIONING_FRACTIONAL_ODD;
    if least > select(64.0, 33.0, odd) {
        return max(least, 64.5);
    }
    if odd {
        if least <= 1.0 {
            return 1.0;
        }
        return 1.0 + round_pow2(max(least - 1.0, 2.0));
    }
    if partitioning == PARTITIONING_FRACTIONAL_EVEN {
        return round_pow2(max(least, 2.0));
    }
    if partitioning == PARTITIONING_INTEGER && least <= 5.0 {
        return ceil(least);
    }
    return round_pow2(least);
}

// Which numbers of segments inside nest with an edge of 5, 8, 9, 16, 17, 32, 33 or 64 segments: bit n - 1 stands for n
// segments, and the first word has 1 to 32.
const NESTING: array<vec2<u32>, 8> = array<vec2<u32>, 8>(
    vec2<u32>(0xfffff797u, 0xffffffffu),
    vec2<u32>(0xffffe19fu, 0xffffffffu),
    vec2<u32>(0xe4078117u, 0xff5c177fu),
    vec2<u32>(0xe001819fu, 0xfe000007u),
    vec2<u32>(0x80010117u, 0xe0000005u),
    vec2<u32>(0x8001819fu, 0xe0000001u),
    vec2<u32>(0x00010117u, 0x80000001u),
    vec2<u32>(0x8001819fu, 0x80000001u),
);

// Returns whether the first ring of a patch with `segments` segments inside nests with an edge of the level `factor`.
fn nests(factor: f32, segments: u32) -> bool {
    if factor <= 4.0 || factor > 64.0 {
        return true;
    }
    let power = round_pow2(factor);
    let above = select(1u, 0u, factor == power);
    // The exponent of the power of two at or below it: 4, 8, 16, 32 or 64.
    let exponent = ((bitcast<u32>(power) >> 23u) - 127u) - above;
    var nesting = NESTING;
    let words = nesting[2u * exponent + above - 5u];
    let bit = segments - 1u;
    return ((words[bit >> 5u] >> (bit & 31u)) & 1u) == 1u;
}

// Returns the least factor (not rounded, 1 or more) that keeps an edge within `tolerance` px of its cubic curve:
// sqrt(3/4 d / tolerance), where d is the larger second difference on screen in px (Wang 1984).
fn edge_error_factor(
    view: LodView,
    tolerance: f32,
    a: vec3<f32>,
    ab: vec3<f32>,
    ba: vec3<f32>,
    b: vec3<f32>,
) -> f32 {
    let bounds = edge_bounds(view, a, ab, ba, b);
    let near_a = screen_length(view, bounds, a - ab * 2.0 + ba);
    let near_b = screen_length(view, bounds, ab - ba * 2.0 + b);
    return max_with_one(sqrt(0.75 * max(near_a, near_b) / tolerance));
}

// The shares of the tolerance where a surface is displaced: for the surface without displacement, for the detail of the
// heights that is lost between segments, and for the turning of the direction of displacement.
const SURFACE_SHARE: f32 = 0.5;
const DETAIL_SHARE: f32 = 0.3;
const TURN_SHARE: f32 = 0.2;

// Returns the least factor (not rounded, 1 or more) that shows the heights of one image along an edge, which is
// `texels` px of level 0 long.
fn displacement_factor(
    view: LodView,
    bounds: ScreenBounds,
    tolerance: f32,
    texels: f32,
    turn: f32,
    scale: f32,
    detail: array<vec4<f32>, 4>,
) -> f32 {
    let bend = screen_radius(view, bounds, view.reach * 0.28125 * turn * turn);
    var segments = texels;
    var losses = detail;
    for (var level = 1u; level < MAX_LEVELS; level++) {
        if screen_radius(view, bounds, scale * losses[level / 4u][level % 4u]) > DETAIL_SHARE * tolerance {
            break;
        }
        segments *= 0.5;
    }
    return max_with_one(max(segments, sqrt(bend / (TURN_SHARE * tolerance))));
}

// Returns the control point with these three indices (0 to 2), in any order: (0, 0, 1) is b210.
fn control_point(net: ControlNet, i: u32, j: u32, l: u32) -> vec3<f32> {
    if i == j && j == l {
        return net.corners[i];
    }
    if i != j && j != l && l != i {
        return net.center;
    }
    // The index that occurs twice, and the one that occurs once.
    let twice = select(j, i, i == j || i == l);
    let once = i + j + l - 2u * twice;
    if once == (twice + 1u) % 3u {
        return net.edges[2u * twice];
    }
    return net.edges[2u * once + 1u];
}

// Returns a sixth of a patch's second derivatives at corner `i`, in object units: twice along the edge opposite corner
// `k`; once along it and once inward; twice inward.
fn second_differences(net: ControlNet, i: u32, k: u32) -> array<vec3<f32>, 3> {
    let p = (k + 1u) % 3u;
    let q = (k + 2u) % 3u;
    let pp = control_point(net, i, p, p);
    let pq = control_point(net, i, p, q);
    let qq = control_point(net, i, q, q);
    let kp = control_point(net, i, k, p);
    let kq = control_point(net, i, k, q);
    let kk = control_point(net, i, k, k);
    let along = pp - pq * 2.0 + qq;
    let mixed = (kp - kq - (pp - qq) * 0.5) * (2.0 / 3.0);
    let inward = (kk - kp - kq + (pp + pq * 2.0 + qq) * 0.25) * (4.0 / 9.0);
    return array<vec3<f32>, 3>(along, mixed, inward);
}

// Returns bounds on the three `second_differences` at any corner, in px on screen, then a bound on those along both
// diagonals of a segment.
fn screen_differences(view: LodView, bounds: ScreenBounds, net: ControlNet, k: u32) -> vec4<f32> {
    var largest = vec4<f32>(0.0);
    for (var i = 0u; i < 3u; i++) {
        let own = second_differences(net, i, k);
        let rising = screen_length(view, bounds, own[0] + own[1] * 2.0 + own[2]);
        let falling = screen_length(view, bounds, own[0] - own[1] * 2.0 + own[2]);
        let on_screen = vec4<f32>(
            screen_length(view, bounds, own[0]),
            screen_length(view, bounds, own[1]),
            screen_length(view, bounds, own[2]),
            max(rising, falling),
        );
        largest = max(largest, on_screen);
    }
    return largest;
}

// Returns a bound on the error, in px, of a triangle with these second differences along its sides.
fn triangle_error(a: f32, b: f32, c: f32) -> f32 {
    let most = max(max(a, b), c);
    let least = min(min(a, b), c);
    let middle = max(min(a, b), min(max(a, b), c));
    let more = least - (most - middle);
    if more <= 0.0 {
        return 0.75 * most;
    }
    return 3.0 * most / (4.0 - (more / least) * (more / middle));
}

// Returns a bound on the error, in px, of a row of triangles beside an edge: 6/8 of the second differences `on_screen`
// (Filip et al. 1986).
fn row_error(on_screen: vec3<f32>, reach: f32, slant: f32, height: f32) -> f32 {
    return 0.751 * (on_screen.x * reach * reach + 2.0 * on_screen.y * slant * height + on_screen.z * height * height);
}

// Returns a bound on the error, in px, of all triangles inside the first ring if the patch has `segments` segments
// inside. `on_screen` has the `screen_differences` of each edge.
fn inner_error(on_screen: array<vec4<f32>, 3>, segments: f32) -> f32 {
    var worst = triangle_error(on_screen[0].x, on_screen[1].x, on_screen[2].x);
    for (var k = 0u; k < 3u; k++) {
        worst = max(worst, triangle_error(on_screen[k].x, on_screen[k].z, on_screen[k].w));
    }
    return 1.001 * worst / (segments * segments);
}

// What the error of the row of triangles along an edge depends on: the bounds of the edge itself, and the second
// differences along it (`along`), and along it and inward (`mixed`), at its two ends and at the opposite corner.
struct EdgeRow {
    bounds: ScreenBounds,
    along: array<vec3<f32>, 3>,
    mixed: array<vec3<f32>, 3>,
}

// Returns these of the edge opposite corner `k`.
fn edge_row(view: LodView, net: ControlNet, k: u32) -> EdgeRow {
    let p = (k + 1u) % 3u;
    let q = (k + 2u) % 3u;
    let bounds = edge_bounds(view, net.corners[p], control_point(net, p, p, q), control_point(net, p, q, q), net.corners[q]);
    let at_p = second_differences(net, p, k);
    let at_q = second_differences(net, q, k);
    let at_k = second_differences(net, k, k);
    let along = array<vec3<f32>, 3>(at_p[0], at_q[0], at_k[0]);
    return EdgeRow(bounds, along, array<vec3<f32>, 3>(at_p[1], at_q[1], at_k[1]));
}

// Returns a bound, in px on screen, on weighted means of three differences of which the last has a weight of at most
// `share`.
fn edge_row_length(view: LodView, beside: ScreenBounds, differences: array<vec3<f32>, 3>, share: f32) -> f32 {
    let at_p = screen_length(view, beside, differences[0]);
    let at_q = screen_length(view, beside, differences[1]);
    let at_k = screen_length(view, beside, differences[2]);
    let own = max(at_p, at_q);
    return own + share * max(at_k - own, 0.0);
}

// Returns a bound on the error, in px, of the row along an edge of `factor` segments if the patch has `segments`
// segments inside. `bounds` is the whole patch's; `on_screen` has the `screen_differences` for this edge.
fn edge_row_error(view: LodView, row: EdgeRow, bounds: ScreenBounds, on_screen: vec4<f32>, factor: f32, segments: f32) -> f32 {
    let share = (2.0 / 3.0) / segments;
    let outside = 1.0 - (1.0 - share) * (1.0 - share) * (1.0 - share);
    let beside = mixed_bounds(row.bounds, bounds, outside);
    let along = edge_row_length(view, beside, row.along, share);
    let mixed = edge_row_length(view, beside, row.mixed, share);
    let size = 1.0 / segments;
    let reach = max(size, 1.0 / factor);
    // An edge of one segment: half of the row's triangles start at each end.
    let slant = select(reach, 0.5 + 0.5 * size, factor <= 1.0);
    return row_error(vec3<f32>(along, mixed, on_screen.z), reach, slant, size);
}

// Returns the least number of segments, `least` or more, that a partitioning has without fractions: any whole number, a
// power of two, or an odd or even number.
fn whole_segments(partitioning: u32, least: f32) -> f32 {
    if partitioning == PARTITIONING_INTEGER || partitioning == PARTITIONING_SUBTRIANGULATION {
        return ceil(least);
    }
    if partitioning == PARTITIONING_POW2 {
        return round_pow2(least);
    }
    if partitioning == PARTITIONING_FRACTIONAL_ODD {
        return 2.0 * ceil(0.5 * (least - 1.0)) + 1.0;
    }
    return 2.0 * ceil(0.5 * least);
}

// Returns the least inside factor that keeps a patch within `tolerance` px of its surface, given the levels of the
// edges U == 0, V == 0 and W == 0. The result is above 64 if no factor does.
fn inside_error_factor(
    view: LodView,
    tolerance: f32,
    partitioning: u32,
    net: ControlNet,
    edges: vec3<f32>,
) -> f32 {
    let bounds = net_bounds(view, net);
    var on_screen = array<vec4<f32>, 3>(
        screen_differences(view, bounds, net, 0u),
        screen_differences(view, bounds, net, 1u),
        screen_differences(view, bounds, net, 2u),
    );
    let minimal = max(max(edges.x, edges.y), edges.z) <= 1.0;
    let single = inner_error(on_screen, 1.0);
    if minimal && single <= tolerance {
        return 1.0;
    }
    var all = array<EdgeRow, 3>(edge_row(view, net, 0u), edge_row(view, net, 1u), edge_row(view, net, 2u));
    // Errors fall with the square of the number of segments. The tessellator treats 1 segment inside as 2.
    let least = max(sqrt(single / tolerance), 2.0);
    let last = select(64.0, 63.0, partitioning == PARTITIONING_FRACTIONAL_ODD);
    var inside = whole_segments(partitioning, least);
    while inside <= last && least <= last {
        let segments = u32(inside);
        if nests(edges.x, segments) && nests(edges.y, segments) && nests(edges.z, segments) {
            var rows = 0.0;
            for (var k = 0u; k < 3u; k++) {
                rows = max(rows, edge_row_error(view, all[k], bounds, on_screen[k], edges[k], inside));
            }
            if rows <= tolerance {
                return inside;
            }
        }
        if inside == last {
            break;
        }
        inside = min(whole_segments(partitioning, inside + 1.0), last);
    }
    return max(least, 64.5);
}
