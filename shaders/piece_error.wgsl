// The error of one flat triangle of a patch's pattern (a piece): how far on screen, in px, its points are from the points of
// the surface at the same places of the domain. Twin: src/geometry/tessellate/piece_error.rs, which explains the bounds.

// The steps of the finest grid.
const FINEST_GRID: u32 = 8u;

// The steps of the grid of a triangle that is only partly in view.
const PARTIAL_STEPS: u32 = 8u;

// A patch in clip space: x and y in px times depth, and the depth (w). All are divided by the largest depth of its control
// points, which changes nothing on screen, so that squares don't leave the range of f32.
struct SeenPatch {
    // The ten control points: corners, edges, centre.
    points: array<vec3<f32>, 10>,
    // A sixth of the second derivatives at each corner: twice along a, along a and b, twice along b. Direction a leads from
    // corner 2 to corner 0, b from corner 2 to corner 1.
    second: array<array<vec3<f32>, 3>, 3>,
    half_viewport: vec2<f32>,
    // The depth of the near plane; 0 in an orthographic view.
    near: f32,
    // How far displacement may move a point: in depth, and across the view in px times depth.
    deep: f32,
    across: vec2<f32>,
    // Which way its triangle turns: see turn_of.
    turn: f32,
    // Where points may slide along the surface, how far in px it may be off the plane of its triangle, and off its longest
    // side; else large numbers.
    off_plane: f32,
    off_line: f32,
    // By what points, depths and second derivatives were multiplied.
    scale: f32,
    relief: SeenRelief,
}

// Returns whether an error is within a tolerance. NaN never is.
fn is_within(error: f32, tolerance: f32) -> bool {
    return error <= tolerance;
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

// Returns a difference vector in object units as one in clip space.
fn clip_difference(view: LodView, difference: vec3<f32>) -> vec3<f32> {
    let across = vec2<f32>(dot(clip_row(view, 0u), difference), dot(clip_row(view, 1u), difference)) * view.half_viewport;
    return vec3<f32>(across, dot(clip_row(view, 3u), difference));
}

// Returns a point in object units in clip space, all of it multiplied by `scale`.
fn clip_point(view: LodView, scale: f32, p: vec3<f32>) -> vec3<f32> {
    let clip = view.clip_from_object * vec4<f32>(p, 1.0) * scale;
    return vec3<f32>(clip.xy * view.half_viewport, clip.w);
}

// Returns the absolute depth (w) of a point in object units, or `deepest` if that is larger.
fn deeper(view: LodView, deepest: f32, p: vec3<f32>) -> f32 {
    let clip = view.clip_from_object * vec4<f32>(p, 1.0);
    return max(deepest, abs(clip.w));
}

// Returns the scale by which the largest depth becomes 1.
fn depth_scale(deepest: f32) -> f32 {
    return select(1.0, 1.0 / deepest, deepest > 1e-38);
}

// Returns the depth (w) of the near plane, where z = w; 0 in an orthographic view. Along the view, z is a linear function of
// w.
fn near_depth(view: LodView) -> f32 {
    let z = clip_row(view, 2u);
    let w = clip_row(view, 3u);
    let square = dot(w, w);
    if square <= 0.0 {
        return 0.0;
    }
    let slope = dot(z, w) / square;
    return (view.clip_from_object[3].z - slope * view.clip_from_object[3].w) / (1.0 - slope);
}

// Returns a sixth of a patch's second derivatives at corner `i`, multiplied by `scale`: see `SeenPatch`.
fn second_derivatives(view: LodView, scale: f32, net: ControlNet, i: u32) -> array<vec3<f32>, 3> {
    let at_c = control_point(net, i, 2u, 2u);
    let ac = control_point(net, i, 0u, 2u);
    let bc = control_point(net, i, 1u, 2u);
    let aa = control_point(net, i, 0u, 0u) - ac * 2.0 + at_c;
    let ab = control_point(net, i, 0u, 1u) - ac - bc + at_c;
    let bb = control_point(net, i, 1u, 1u) - bc * 2.0 + at_c;
    return array<vec3<f32>, 3>(
        clip_difference(view, aa * scale),
        clip_difference(view, ab * scale),
        clip_difference(view, bb * scale),
    );
}

// A sixth of a patch's second derivatives at a place, along two directions a and b of the domain: on screen, in px.
struct SecondForms {
    aa: vec2<f32>,
    ab: vec2<f32>,
    bb: vec2<f32>,
}

// Returns a difference on screen, in px, as an eye sees it that looks at a point in clip space.
fn seen_at(at: vec3<f32>, difference: vec3<f32>) -> vec2<f32> {
    return (difference.xy - (at.xy / at.z) * difference.z) / at.z;
}

// Returns the second derivatives at a corner, as an eye sees them that looks at it; zeros if it isn't before the near plane.
fn second_forms(seen: ptr<function, SeenPatch>, corner: u32, a: vec2<f32>, b: vec2<f32>) -> SecondForms {
    let at = (*seen).points[corner];
    if !(at.z > (*seen).near && at.z > 0.0) {
        return SecondForms(vec2<f32>(0.0), vec2<f32>(0.0), vec2<f32>(0.0));
    }
    let xx = (*seen).second[corner][0];
    let xy = (*seen).second[corner][1];
    let yy = (*seen).second[corner][2];
    return SecondForms(
        seen_at(at, xx * (a.x * a.x) + xy * (2.0 * a.x * a.y) + yy * (a.y * a.y)),
        seen_at(at, xx * (a.x * b.x) + xy * (a.x * b.y + a.y * b.x) + yy * (a.y * b.y)),
        seen_at(at, xx * (b.x * b.x) + xy * (2.0 * b.x * b.y) + yy * (b.y * b.y)),
    );
}

// Returns what least_for_heights does for a patch.
fn heights_need(seen: ptr<function, SeenPatch>, tolerance: f32, partitioning: u32) -> vec4<f32> {
    let corners = array<vec3<f32>, 3>((*seen).points[0], (*seen).points[1], (*seen).points[2]);
    return least_for_heights((*seen).relief, corners, (*seen).deep, (*seen).near, tolerance, partitioning == PARTITIONING_ROWS);
}

// Returns a number whose sign tells which way a triangle of a plane turns on screen, wherever the eye is. The points are in
// clip space.
fn turn_of(a: vec3<f32>, b: vec3<f32>, c: vec3<f32>) -> f32 {
    return dot(a, cross(b - a, c - a));
}

// Returns a patch as it is seen, whose points may not slide.
fn seen_patch(view: LodView, net: ControlNet) -> SeenPatch {
    var deepest = deeper(view, 0.0, net.center);
    for (var i = 0u; i < 3u; i++) {
        deepest = deeper(view, deepest, net.corners[i]);
    }
    for (var i = 0u; i < 6u; i++) {
        deepest = deeper(view, deepest, net.edges[i]);
    }
    let scale = depth_scale(deepest);
    var points: array<vec3<f32>, 10>;
    for (var i = 0u; i < 3u; i++) {
        points[i] = clip_point(view, scale, net.corners[i]);
    }
    for (var i = 0u; i < 6u; i++) {
        points[3u + i] = clip_point(view, scale, net.edges[i]);
    }
    points[9] = clip_point(view, scale, net.center);
    let second = array<array<vec3<f32>, 3>, 3>(
        second_derivatives(view, scale, net, 0u),
        second_derivatives(view, scale, net, 1u),
        second_derivatives(view, scale, net, 2u),
    );
    let across = vec2<f32>(length(clip_row(view, 0u)), length(clip_row(view, 1u))) * view.half_viewport;
    let deep = length(clip_row(view, 3u)) * view.reach * scale;
    let turn = turn_of(points[0], points[1], points[2]);
    let reach = view.reach * scale;
    let near = near_depth(view) * scale;
    var none: SeenRelief;
    none.relief.longest = -1.0;
    return SeenPatch(points, second, view.half_viewport, near, deep, across * reach, turn, 3.4e38, 3.4e38, scale, none);
}

// Returns what is seen of the heights over a patch: its corners move along unit directions by `height_scale` object units from black to
// white.
fn seen_relief(
    view: LodView,
    scale: f32,
    directions: array<vec3<f32>, 3>,
    height_scale: f32,
    relief: PatchRelief,
) -> SeenRelief {
    let turning = turning_of(directions[0], directions[1], directions[2]);
    let unit = abs(height_scale) * scale;
    let part = select(0.0, abs(height_scale) / view.reach, view.reach > 0.0);
    let seen = array<vec3<f32>, 3>(
        clip_difference(view, directions[0] * unit),
        clip_difference(view, directions[1] * unit),
        clip_difference(view, directions[2] * unit),
    );
    return SeenRelief(relief, seen, turning.x, turning.y, part);
}

// Returns the point of the surface at a place of the domain.
fn seen_point(seen: ptr<function, SeenPatch>, place: vec2<f32>) -> vec3<f32> {
    let x = place.x;
    let y = place.y;
    let z = 1.0 - x - y;
    return (*seen).points[0] * (x * x * x)
        + (*seen).points[1] * (y * y * y)
        + (*seen).points[2] * (z * z * z)
        + (*seen).points[3] * (3.0 * x * x * y)
        + (*seen).points[4] * (3.0 * x * y * y)
        + (*seen).points[5] * (3.0 * y * y * z)
        + (*seen).points[6] * (3.0 * y * z * z)
        + (*seen).points[7] * (3.0 * z * z * x)
        + (*seen).points[8] * (3.0 * z * x * x)
        + (*seen).points[9] * (6.0 * x * y * z);
}

// Returns a sixth of the second derivatives at a place of the domain along three directions.
fn along_sides(seen: ptr<function, SeenPatch>, place: vec2<f32>, sides: array<vec2<f32>, 3>) -> array<vec3<f32>, 3> {
    let x = place.x;
    let y = place.y;
    let z = 1.0 - x - y;
    let aa = (*seen).second[0][0] * x + (*seen).second[1][0] * y + (*seen).second[2][0] * z;
    let ab = (*seen).second[0][1] * x + (*seen).second[1][1] * y + (*seen).second[2][1] * z;
    let bb = (*seen).second[0][2] * x + (*seen).second[1][2] * y + (*seen).second[2][2] * z;
    let p = sides[0];
    let q = sides[1];
    let r = sides[2];
    return array<vec3<f32>, 3>(
        aa * (p.x * p.x) + ab * (2.0 * p.x * p.y) + bb * (p.y * p.y),
        aa * (q.x * q.x) + ab * (2.0 * q.x * q.y) + bb * (q.y * q.y),
        aa * (r.x * r.x) + ab * (2.0 * r.x * r.y) + bb * (r.y * r.y),
    );
}

// A flat triangle, and its difference from the surface behind it.
struct Piece {
    // Its corners in clip space, and their places on screen in px from the middle of the view.
    corners: array<vec3<f32>, 3>,
    places: array<vec2<f32>, 3>,
    // The control points of the difference, surface minus triangle: for each side k the one near corner k and the one near
    // corner k + 1, and the one in the centre.
    differences: array<vec3<f32>, 7>,
    // A sixth of the second derivatives at each corner, along each side.
    second: array<array<vec3<f32>, 3>, 3>,
}

// Returns the flat triangle with its corners at three places of the domain.
fn piece_of(seen: ptr<function, SeenPatch>, p: vec2<f32>, q: vec2<f32>, r: vec2<f32>) -> Piece {
    let sides = array<vec2<f32>, 3>(q - p, r - q, p - r);
    let at_p = along_sides(seen, p, sides);
    let at_q = along_sides(seen, q, sides);
    let at_r = along_sides(seen, r, sides);
    let sum = at_p[0] + at_p[1] + at_p[2] + at_q[0] + at_q[1] + at_q[2] + at_r[0] + at_r[1] + at_r[2];
    let differences = array<vec3<f32>, 7>(
        (at_p[0] * 2.0 + at_q[0]) * (-1.0 / 3.0),
        (at_p[0] + at_q[0] * 2.0) * (-1.0 / 3.0),
        (at_q[1] * 2.0 + at_r[1]) * (-1.0 / 3.0),
        (at_q[1] + at_r[1] * 2.0) * (-1.0 / 3.0),
        (at_r[2] * 2.0 + at_p[2]) * (-1.0 / 3.0),
        (at_r[2] + at_p[2] * 2.0) * (-1.0 / 3.0),
        sum * (-1.0 / 6.0),
    );
    let a = seen_point(seen, p);
    let b = seen_point(seen, q);
    let c = seen_point(seen, r);
    let places = array<vec2<f32>, 3>(a.xy / a.z, b.xy / b.z, c.xy / c.z);
    let second = array<array<vec3<f32>, 3>, 3>(at_p, at_q, at_r);
    return Piece(array<vec3<f32>, 3>(a, b, c), places, differences, second);
}

// Returns how far in px times depth the corners of a piece lie at least beyond the view's right, top, left and bottom side, less
// how far the surface and displacement come back. Where a point of the flat triangle is beyond a side by this, neither that point
// nor the one of the surface is in view.
fn beyond_sides(seen: ptr<function, SeenPatch>, piece: ptr<function, Piece>) -> array<vec4<f32>, 3> {
    let half = (*seen).half_viewport;
    var back = vec4<f32>(0.0);
    for (var i = 0u; i < 7u; i++) {
        let across = (*piece).differences[i].xy;
        let deep = half * (*piece).differences[i].z;
        back = min(back, vec4<f32>(across - deep, -across - deep));
    }
    let moved = (*seen).across + half * (*seen).deep;
    back -= vec4<f32>(moved, moved);
    var beyond: array<vec4<f32>, 3>;
    for (var i = 0u; i < 3u; i++) {
        let across = (*piece).corners[i].xy;
        let deep = half * (*piece).corners[i].z;
        beyond[i] = vec4<f32>(across - deep, -across - deep) + back;
    }
    return beyond;
}

// Returns whether all corners are beyond the same side.
fn is_beside_view(beyond: ptr<function, array<vec4<f32>, 3>>) -> bool {
    let zero = vec4<f32>(0.0);
    return any(((*beyond)[0] > zero) & ((*beyond)[1] > zero) & ((*beyond)[2] > zero));
}

// Returns a bound on the depth of the points of a flat triangle that may be in view: none has less. It may be negative.
// `depths` are those of its corners.
fn seen_depth(depths: vec3<f32>, beyond: ptr<function, array<vec4<f32>, 3>>) -> f32 {
    // For each side of the view the least depth of what is on its inner side: at a corner, or where a side of the triangle
    // crosses.
    let none = vec4<f32>(3.4e38);
    let zero = vec4<f32>(0.0);
    var least = none;
    for (var i = 0u; i < 3u; i++) {
        let j = (i + 1u) % 3u;
        let p = (*beyond)[i];
        let q = (*beyond)[j];
        let here = vec4<f32>(depths[i]);
        let there = vec4<f32>(depths[j]);
        let crosses = (p <= zero) != (q <= zero);
        let share = p / select(vec4<f32>(1.0), p - q, crosses);
        least = min(least, select(none, here, p <= zero));
        least = min(least, select(none, here + (there - here) * share, crosses));
    }
    // Nothing is found among NaN.
    let found = select(-none, least, least < vec4<f32>(3e38));
    return max(max(found.x, found.y), max(found.z, found.w));
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

// Returns a bound on the error of a flat triangle, in px, from its second derivatives alone: as seen from a depth of 1, by
// an eye that sees it within `spread` px of `middle`.
fn derivative_bound(piece: ptr<function, Piece>, middle: vec2<f32>, spread: f32) -> f32 {
    var most = vec3<f32>(0.0);
    for (var i = 0u; i < 3u; i++) {
        for (var k = 0u; k < 3u; k++) {
            let second = (*piece).second[i][k];
            let distance = length(second.xy - middle * second.z) + spread * abs(second.z);
            // NaN counts as infinite.
            most[k] = max(most[k], select(3.4e38, distance, distance < 3.4e38));
        }
    }
    return triangle_error(most.x, most.y, most.z);
}

// Returns whether points of a patch may slide along the surface within a tolerance.
fn may_slide(seen: ptr<function, SeenPatch>, tolerance: f32) -> bool {
    return min((*seen).off_plane, (*seen).off_line) <= tolerance;
}

// Returns whether the side between two places of the domain is part of an edge of the patch.
fn is_on_edge(p: vec2<f32>, q: vec2<f32>) -> bool {
    return max(p.x, q.x) == 0.0 || max(p.y, q.y) == 0.0 || min(p.x + p.y, q.x + q.y) == 1.0;
}

// Returns the length of a difference that sliding along a side doesn't take back; all of it, if its control point isn't beside
// the side. In px times depth, by an eye that sees it within `spread` px of `middle`. `along` leads from the side's start to
// its end.
fn beside_edge(middle: vec2<f32>, spread: f32, along: vec3<f32>, difference: vec3<f32>) -> f32 {
    let on_screen = along.xy - middle * along.z;
    let share = dot(difference.xy - middle * difference.z, on_screen) / dot(on_screen, on_screen);
    let rest = select(difference, difference - along * share, abs(share) <= 1.0 / 3.0);
    return length(rest.xy - middle * rest.z) + spread * abs(rest.z);
}

// Returns a bound on the distance in px between a flat triangle and the nearest points of the surface, where points may slide
// and as far as no other triangle's sides come into it; large if that bound doesn't hold. All that counts of it is seen within
// `spread` px of `middle` and no nearer than `nearest`.
fn sliding_error(
    seen: ptr<function, SeenPatch>,
    piece: ptr<function, Piece>,
    at: array<vec2<f32>, 3>,
    middle: vec2<f32>,
    spread: f32,
    nearest: f32,
) -> f32 {
    var places = at;
    let p = at[1] - at[0];
    let q = at[2] - at[0];
    let turned = turn_of((*piece).corners[0], (*piece).corners[1], (*piece).corners[2]) * (p.x * q.y - p.y * q.x) * (*seen).turn;
    if !is_within(0.0, turned) {
        return 3.4e38;
    }
    var most = 0.0;
    for (var k = 0u; k < 3u; k++) {
        let next = (k + 1u) % 3u;
        if is_on_edge(places[k], places[next]) {
            let along = (*piece).corners[next] - (*piece).corners[k];
            most = max(most, beside_edge(middle, spread, along, (*piece).differences[2u * k]));
            most = max(most, beside_edge(middle, spread, along, (*piece).differences[2u * k + 1u]));
        }
    }
    return (*seen).off_plane + 0.75 * most / nearest;
}

// Returns the difference at the weights `x`, `y` and `z` of a piece's corners.
fn piece_difference(piece: ptr<function, Piece>, x: f32, y: f32, z: f32) -> vec3<f32> {
    return ((*piece).differences[0] * x + (*piece).differences[1] * y) * (3.0 * x * y)
        + ((*piece).differences[2] * y + (*piece).differences[3] * z) * (3.0 * y * z)
        + ((*piece).differences[4] * z + (*piece).differences[5] * x) * (3.0 * z * x)
        + (*piece).differences[6] * (6.0 * x * y * z);
}

// Returns the largest error on a grid of `steps` steps, in px, and the largest difference in depth. `coarser` are those on the
// grid of half as many steps, if there is one. It ends early with the first error that isn't within the tolerance.
fn grid_error(
    seen: ptr<function, SeenPatch>,
    piece: ptr<function, Piece>,
    moved: f32,
    tolerance: f32,
    steps: u32,
    coarser: vec2<f32>,
) -> vec2<f32> {
    var worst = coarser;
    for (var i = 0u; i <= steps; i++) {
        // Every second point of every second line is on the coarser grid.
        let is_coarser = steps > 2u && i % 2u == 0u;
        for (var j = select(0u, 1u, is_coarser); j <= steps - i; j += select(1u, 2u, is_coarser)) {
            let x = f32(i) / f32(steps);
            let y = f32(j) / f32(steps);
            let z = f32(steps - i - j) / f32(steps);
            let corner_depths = vec3<f32>((*piece).corners[0].z, (*piece).corners[1].z, (*piece).corners[2].z);
            let weights = vec3<f32>(x, y, z) * corner_depths;
            let depth = weights.x + weights.y + weights.z;
            let sum = (*piece).places[0] * weights.x + (*piece).places[1] * weights.y + (*piece).places[2] * weights.z;
            let difference = piece_difference(piece, x, y, z);
            let distance = length(difference.xy - sum / depth * difference.z) + moved * abs(difference.z);
            let own = distance / (depth + difference.z - (*seen).deep);
            worst.y = max(worst.y, abs(difference.z));
            if !is_within(own, tolerance) {
                return vec2<f32>(own, worst.y);
            }
            worst.x = max(worst.x, own);
        }
    }
    return worst;
}

// Returns the error of a flat triangle at the same places of the domain: an upper bound if it is at most `tolerance`. `piece` is
// in front of the near plane, `piece_bound` is its derivative_bound, and displacement moves it by up to `moved` px.
fn same_place_error(
    seen: ptr<function, SeenPatch>,
    piece: ptr<function, Piece>,
    tolerance: f32,
    piece_bound: f32,
    moved: f32,
    depths: vec2<f32>,
) -> f32 {
    let nearest = depths.x;
    let bound = piece_bound / nearest;
    let a = (*piece).places[0];
    let b = (*piece).places[1];
    let c = (*piece).places[2];
    let longest = max(max(distance(a, b), distance(b, c)), distance(c, a));
    let ratio = depths.y / nearest;
    var steps = 1u;
    var upper = bound;
    var worst = vec2<f32>(0.0);
    while !is_within(upper, tolerance) && steps < FINEST_GRID {
        steps *= 2u;
        worst = grid_error(seen, piece, moved, tolerance, steps, worst);
        if !is_within(worst.x, tolerance) {
            return worst.x;
        }
        // Between points of the grid: depth and place change, and the difference isn't linear.
        let share = 1.0 / f32(steps);
        let between = bound * share * share + longest * ratio * share * worst.y / nearest;
        upper = worst.x * (1.0 + (ratio - 1.0) * share) + between;
        // What is on a finer grid is no less.
        let finest = 1.0 / f32(FINEST_GRID);
        let least = worst.x * (1.0 + (ratio - 1.0) * finest) + bound * finest * finest;
        if !is_within(least, tolerance) {
            return least;
        }
    }
    return upper;
}

// Returns a bound on the error of a flat triangle, only part of which is in view, in px. It is cut into smaller ones, each of
// which counts with what may be in view of it: within `spread` px of `middle`, and beyond the near plane. The depths of the
// surface are between `before` and `behind` more than those of the triangle, and `bound` is derivative_bound. It ends early once
// an error isn't within the tolerance.
fn partial_error(
    seen: ptr<function, SeenPatch>,
    piece: ptr<function, Piece>,
    beyond: ptr<function, array<vec4<f32>, 3>>,
    before: f32,
    behind: f32,
    middle: vec2<f32>,
    spread: f32,
    bound: f32,
    tolerance: f32,
) -> f32 {
    // Between the corners of the smaller triangles.
    let between = bound / f32(PARTIAL_STEPS * PARTIAL_STEPS);
    var error = 0.0;
    for (var i = 0u; i < PARTIAL_STEPS; i++) {
        for (var j = 0u; j < 2u * (PARTIAL_STEPS - i) - 1u; j++) {
            // Those that point up and those that point down, in turn.
            let across = j / 2u;
            let down = j % 2u;
            var at = array<vec2<u32>, 3>(
                vec2<u32>(i + down, across),
                vec2<u32>(i + 1u - down, across + down),
                vec2<u32>(i + down, across + 1u),
            );
            var depths = vec3<f32>(0.0);
            var outside: array<vec4<f32>, 3>;
            var most = 0.0;
            for (var k = 0u; k < 3u; k++) {
                let x = f32(at[k].x) / f32(PARTIAL_STEPS);
                let y = f32(at[k].y) / f32(PARTIAL_STEPS);
                let z = 1.0 - x - y;
                depths[k] = (*piece).corners[0].z * x + (*piece).corners[1].z * y + (*piece).corners[2].z * z;
                outside[k] = (*beyond)[0] * x + (*beyond)[1] * y + (*beyond)[2] * z;
                let difference = piece_difference(piece, x, y, z);
                most = max(most, length(difference.xy - middle * difference.z) + spread * abs(difference.z));
            }
            let depth = max((*seen).near, seen_depth(depths, &outside) + before - (*seen).deep);
            let farthest = max(max(depths.x, depths.y), depths.z) + behind + (*seen).deep;
            let own = (most + between) / depth;
            let is_hidden = is_beside_view(&outside) || farthest < (*seen).near;
            if !is_hidden {
                if !is_within(own, tolerance) {
                    return own;
                }
                error = max(error, own);
            }
        }
    }
    return error;
}

// Returns the error of the flat triangle with its corners at three places of the domain (weights of corners 0 and 1). If it
// is at most `tolerance`, it is an upper bound. If it is larger or NaN, the piece may be that far off.
fn piece_error(
    seen: ptr<function, SeenPatch>,
    tolerance: f32,
    p: vec2<f32>,
    q: vec2<f32>,
    r: vec2<f32>,
) -> f32 {
    var piece = piece_of(seen, p, q, r);
    var behind = 0.0;
    var before = 0.0;
    for (var i = 0u; i < 7u; i++) {
        behind = max(behind, piece.differences[i].z);
        before = min(before, piece.differences[i].z);
    }
    let depths = vec3<f32>(piece.corners[0].z, piece.corners[1].z, piece.corners[2].z);
    let farthest = max(max(depths.x, depths.y), depths.z) + behind + (*seen).deep;
    let nearest = min(min(depths.x, depths.y), depths.z) + before - (*seen).deep;
    if farthest < (*seen).near {
        return 0.0;
    }
    var beyond = beyond_sides(seen, &piece);
    if is_beside_view(&beyond) {
        return 0.0;
    }
    let a = piece.places[0];
    let b = piece.places[1];
    let c = piece.places[2];
    // What is seen of it is anywhere in the view, and no nearer than the near plane.
    var middle = vec2<f32>(0.0);
    var spread = length((*seen).half_viewport);
    var moved = 0.0;
    var depth = max((*seen).near, seen_depth(depths, &beyond) + before - (*seen).deep);
    // NaN is no depth in front of the eye.
    let is_before_eye = nearest > 0.0 && nearest >= (*seen).near;
    if is_before_eye {
        middle = (a + b + c) / 3.0;
        // How far displacement moves it on screen.
        let most = max(max(abs(a), abs(b)), abs(c));
        moved = length(((*seen).across + most * (*seen).deep) / nearest);
        spread = max(max(distance(a, middle), distance(b, middle)), distance(c, middle)) + moved;
        depth = nearest;
    }
    let at = array<vec2<f32>, 3>(p, q, r);
    let anywhere = length((*seen).across + (length(middle) + spread) * (*seen).deep);
    let lost = heights_error((*seen).relief, anywhere, at, middle, spread, depth);
    if !is_within(lost, tolerance) {
        return lost;
    }
    // What is left of it is for the surface without displacement.
    let left = tolerance - lost;
    var error = 3.4e38;
    if may_slide(seen, left) {
        error = sliding_error(seen, &piece, at, middle, spread, depth);
        error = min((*seen).off_line, error);
    }
    if is_within(error, left) {
        return lost + error;
    }
    let bound = derivative_bound(&piece, middle, spread);
    if is_before_eye {
        error = min(error, same_place_error(seen, &piece, left, bound, moved, vec2<f32>(nearest, farthest)));
    } else {
        error = min(error, bound / depth);
    }
    let most_beyond = max(max(beyond[0], beyond[1]), beyond[2]);
    let is_partial = !is_before_eye || any(most_beyond > vec4<f32>(0.0));
    if is_partial && !is_within(error, left) {
        error = min(error, partial_error(seen, &piece, &beyond, before, behind, middle, spread, bound, left));
    }
    return lost + error;
}
