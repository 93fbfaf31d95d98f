// How many segments keep what is emitted within a distance of the surface, in px on screen. Twin:
// src/tessellate/error.rs.

struct Sight {
    nearest: f32,
    farthest: f32,
    least: vec2<f32>,
    greatest: vec2<f32>,
    is_cut: bool,
}

// Edges use up only a part of the tolerance: the rest is for the rows beside them, which bend in other directions too.
const EDGE_SHARE: f32 = 0.75;

fn no_sight() -> Sight {
    return Sight(3.4e38, 0.0, vec2<f32>(3.4e38), vec2<f32>(-3.4e38), false);
}

fn widen(view: LodView, sight: Sight, p: vec3<f32>) -> Sight {
    let clip = view.clip_from_object * vec4<f32>(p, 1.0);
    let depth = max(clip.w, clip.z);
    let place = clip.xy / depth;
    // Displacement moves it towards the eye, away and across.
    let deep = length(clip_row(view, 3u)) * view.reach;
    let past_near = length(clip_row(view, 3u) - clip_row(view, 2u)) * view.reach;
    let across = vec2<f32>(length(clip_row(view, 0u)), length(clip_row(view, 1u))) * view.reach;
    let beyond = clip.z + past_near <= clip.w;
    let nearest = max(clip.w - deep, clip.z);
    let spread = (across + abs(place) * deep) / nearest;
    return Sight(
        min(sight.nearest, nearest),
        max(sight.farthest, depth + deep),
        min(sight.least, select(vec2<f32>(-1.0), place - spread, beyond)),
        max(sight.greatest, select(vec2<f32>(1.0), place + spread, beyond)),
        sight.is_cut || !beyond,
    );
}

fn edge_sight(view: LodView, a: vec3<f32>, ab: vec3<f32>, ba: vec3<f32>, b: vec3<f32>) -> Sight {
    return widen(view, widen(view, widen(view, widen(view, no_sight(), a), ab), ba), b);
}

fn net_sight(view: LodView, net: ControlNet) -> Sight {
    var sight = widen(view, no_sight(), net.center);
    for (var k = 0u; k < 3u; k++) {
        sight = widen(view, sight, net.corners[k]);
        sight = widen(view, sight, net.edges[2u * k]);
        sight = widen(view, sight, net.edges[2u * k + 1u]);
    }
    return sight;
}

fn mixed_sight(own: Sight, other: Sight, share: f32) -> Sight {
    if other.is_cut {
        // Its least depth is the near plane's, and points between may be nearer than that would make them.
        return other;
    }
    let nearest = own.nearest + share * (other.nearest - own.nearest);
    // Places on screen are averages by depth.
    let reach = min(share * other.farthest / nearest, 1.0);
    return Sight(
        nearest,
        other.farthest,
        own.least + (other.least - own.least) * reach,
        own.greatest + (other.greatest - own.greatest) * reach,
        false,
    );
}

// The most that a difference of two points can look, in px.
fn seen_length(view: LodView, sight: Sight, difference: vec3<f32>) -> f32 {
    let across = vec2<f32>(dot(clip_row(view, 0u), difference), dot(clip_row(view, 1u), difference));
    let deep = dot(clip_row(view, 3u), difference);
    let a = abs(across - sight.least * deep);
    let b = abs(across - sight.greatest * deep);
    // Divided first: squares of tiny lengths are none.
    return length(max(a, b) / sight.nearest * view.half_viewport);
}

fn seen_radius(view: LodView, sight: Sight, radius: f32) -> f32 {
    let across = vec2<f32>(length(clip_row(view, 0u)), length(clip_row(view, 1u)));
    let deep = length(clip_row(view, 3u));
    let most = max(abs(sight.least), abs(sight.greatest));
    return length((across + most * deep) * (radius / sight.nearest) * view.half_viewport);
}

// Levels are factors whose rows of points nest, so that the triangles between two rows reach no farther along them than a
// segment.
fn level(partitioning: u32, least: f32) -> f32 {
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

// Bit n - 1: whether n segments inside nest with an edge of 5, 8, 9, 16, 17, 32, 33 or 64.
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

fn nests(factor: f32, segments: u32) -> bool {
    if factor <= 4.0 || factor > 64.0 {
        return true;
    }
    let power = round_pow2(factor);
    let above = select(1u, 0u, factor == power);
    // Of the power of two below or at it: 4, 8, 16, 32, 64.
    let exponent = ((bitcast<u32>(power) >> 23u) - 127u) - above;
    var nesting = NESTING;
    let words = nesting[2u * exponent + above - 5u];
    let bit = segments - 1u;
    return ((words[bit >> 5u] >> (bit & 31u)) & 1u) == 1u;
}

// sqrt(3/4 d / tolerance), d the larger second difference (Wang 1984).
fn edge_error_factor(
    view: LodView,
    tolerance: f32,
    a: vec3<f32>,
    ab: vec3<f32>,
    ba: vec3<f32>,
    b: vec3<f32>,
) -> f32 {
    let sight = edge_sight(view, a, ab, ba, b);
    let near_a = seen_length(view, sight, a - ab * 2.0 + ba);
    let near_b = seen_length(view, sight, ab - ba * 2.0 + b);
    return at_least_one(sqrt(0.75 * max(near_a, near_b) / tolerance));
}

const SURFACE_SHARE: f32 = 0.5;
const DETAIL_SHARE: f32 = 0.3;
const TURN_SHARE: f32 = 0.2;

// As fine as the coarsest level of a height image whose loss is within the tolerance, and as the turn asks for.
fn relief_factor(
    view: LodView,
    sight: Sight,
    tolerance: f32,
    texels: f32,
    turn: f32,
    scale: f32,
    detail: array<vec4<f32>, 4>,
) -> f32 {
    let bend = seen_radius(view, sight, view.reach * 0.28125 * turn * turn);
    var segments = texels;
    var losses = detail;
    for (var level = 1u; level < MAX_LEVELS; level++) {
        if seen_radius(view, sight, scale * losses[level / 4u][level % 4u]) > DETAIL_SHARE * tolerance {
            break;
        }
        segments *= 0.5;
    }
    return at_least_one(max(segments, sqrt(bend / (TURN_SHARE * tolerance))));
}

// The control point with these three indices, in any order: (0, 0, 1) is b210.
fn control_point(net: ControlNet, i: u32, j: u32, l: u32) -> vec3<f32> {
    if i == j && j == l {
        return net.corners[i];
    }
    if i != j && j != l && l != i {
        return net.center;
    }
    // The index that comes twice, and the other.
    let twice = select(j, i, i == j || i == l);
    let once = i + j + l - 2u * twice;
    if once == (twice + 1u) % 3u {
        return net.edges[2u * twice];
    }
    return net.edges[2u * once + 1u];
}

// A sixth of the second derivatives at corner i: along the edge opposite corner k twice, along and inward, inward twice.
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

// The last: along the diagonals of a segment each way.
fn seen_differences(view: LodView, sight: Sight, net: ControlNet, k: u32) -> vec4<f32> {
    var largest = vec4<f32>(0.0);
    for (var i = 0u; i < 3u; i++) {
        let own = second_differences(net, i, k);
        let rising = seen_length(view, sight, own[0] + own[1] * 2.0 + own[2]);
        let falling = seen_length(view, sight, own[0] - own[1] * 2.0 + own[2]);
        let seen = vec4<f32>(
            seen_length(view, sight, own[0]),
            seen_length(view, sight, own[1]),
            seen_length(view, sight, own[2]),
            max(rising, falling),
        );
        largest = max(largest, seen);
    }
    return largest;
}

// 3 times the squared radius of the least circle around a triangle with these squared sides.
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

// Filip et al. 1986.
fn row_error(seen: vec3<f32>, reach: f32, slant: f32, height: f32) -> f32 {
    return 0.751 * (seen.x * reach * reach + 2.0 * seen.y * slant * height + seen.z * height * height);
}

fn inner_error(seen: array<vec4<f32>, 3>, segments: f32) -> f32 {
    var worst = triangle_error(seen[0].x, seen[1].x, seen[2].x);
    for (var k = 0u; k < 3u; k++) {
        worst = max(worst, triangle_error(seen[k].x, seen[k].z, seen[k].w));
    }
    return 1.001 * worst / (segments * segments);
}

struct Rim {
    sight: Sight,
    along: array<vec3<f32>, 3>,
    mixed: array<vec3<f32>, 3>,
}

// Of the edge opposite corner k: its sight, and the second differences at its ends and opposite.
fn edge_rim(view: LodView, net: ControlNet, k: u32) -> Rim {
    let p = (k + 1u) % 3u;
    let q = (k + 2u) % 3u;
    let sight = edge_sight(view, net.corners[p], control_point(net, p, p, q), control_point(net, p, q, q), net.corners[q]);
    let at_p = second_differences(net, p, k);
    let at_q = second_differences(net, q, k);
    let at_k = second_differences(net, k, k);
    let along = array<vec3<f32>, 3>(at_p[0], at_q[0], at_k[0]);
    return Rim(sight, along, array<vec3<f32>, 3>(at_p[1], at_q[1], at_k[1]));
}

// Of differences of which the last has no more than this share.
fn rim_length(view: LodView, beside: Sight, differences: array<vec3<f32>, 3>, share: f32) -> f32 {
    let at_p = seen_length(view, beside, differences[0]);
    let at_q = seen_length(view, beside, differences[1]);
    let at_k = seen_length(view, beside, differences[2]);
    let own = max(at_p, at_q);
    return own + share * max(at_k - own, 0.0);
}

fn rim_error(view: LodView, rim: Rim, sight: Sight, seen: vec4<f32>, factor: f32, segments: f32) -> f32 {
    let share = (2.0 / 3.0) / segments;
    let outside = 1.0 - (1.0 - share) * (1.0 - share) * (1.0 - share);
    let beside = mixed_sight(rim.sight, sight, outside);
    let along = rim_length(view, beside, rim.along, share);
    let mixed = rim_length(view, beside, rim.mixed, share);
    let size = 1.0 / segments;
    let reach = max(size, 1.0 / factor);
    // An edge of one segment: half of the row's triangles start at either end.
    let slant = select(reach, 0.5 + 0.5 * size, factor <= 1.0);
    return row_error(vec3<f32>(along, mixed, seen.z), reach, slant, size);
}

fn whole(partitioning: u32, least: f32) -> f32 {
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

fn inside_error_factor(
    view: LodView,
    tolerance: f32,
    partitioning: u32,
    net: ControlNet,
    edges: vec3<f32>,
) -> f32 {
    let sight = net_sight(view, net);
    var seen = array<vec4<f32>, 3>(
        seen_differences(view, sight, net, 0u),
        seen_differences(view, sight, net, 1u),
        seen_differences(view, sight, net, 2u),
    );
    let minimal = max(max(edges.x, edges.y), edges.z) <= 1.0;
    let single = inner_error(seen, 1.0);
    if minimal && single <= tolerance {
        return 1.0;
    }
    var all = array<Rim, 3>(edge_rim(view, net, 0u), edge_rim(view, net, 1u), edge_rim(view, net, 2u));
    // Errors fall with the square of the number of segments. One alone would act as two.
    let least = max(sqrt(single / tolerance), 2.0);
    let last = select(64.0, 63.0, partitioning == PARTITIONING_FRACTIONAL_ODD);
    var inside = whole(partitioning, least);
    while inside <= last && least <= last {
        let segments = u32(inside);
        if nests(edges.x, segments) && nests(edges.y, segments) && nests(edges.z, segments) {
            var rims = 0.0;
            for (var k = 0u; k < 3u; k++) {
                rims = max(rims, rim_error(view, all[k], sight, seen[k], edges[k], inside));
            }
            if rims <= tolerance {
                return inside;
            }
        }
        if inside == last {
            break;
        }
        inside = min(whole(partitioning, inside + 1.0), last);
    }
    return max(least, 64.5);
}
