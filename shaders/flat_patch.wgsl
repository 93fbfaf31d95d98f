// Flat patches: those whose surface lies in a plane, though its parametrisation may not be linear. Twin:
// src/geometry/tessellate/flat_patch.rs, which explains the bound.

// The least cosine of the angle between two corners' unit normals (1 degree) at which sliding changes no shading.
const AGREEING: f32 = 0.99985;

// Returns whether a patch looks the same wherever its points slide, as far as its corners' unit normals go.
fn normals_agree(a: vec3<f32>, b: vec3<f32>, c: vec3<f32>) -> bool {
    return min(min(dot(a, b), dot(b, c)), dot(c, a)) >= AGREEING;
}

// Returns the larger of `most` and the length of a difference in object units on screen, in px times depth, by an eye that
// sees it within `spread` px of the middle of the view.
fn longer_on_screen(view: LodView, most: f32, spread: f32, difference: vec3<f32>) -> f32 {
    let across = vec2<f32>(dot(clip_row(view, 0u), difference), dot(clip_row(view, 1u), difference)) * view.half_viewport;
    return max(most, length(across) + spread * abs(dot(clip_row(view, 3u), difference)));
}

// Returns the least depth at which a flat triangle is seen, and its largest distance from the middle of the view, in px.
fn seen_within(view: LodView, corners: array<vec3<f32>, 3>) -> vec2<f32> {
    var own = corners;
    let near = near_depth(view);
    var nearest = 3.4e38;
    var spread = 0.0;
    for (var i = 0u; i < 3u; i++) {
        let clip = view.clip_from_object * vec4<f32>(own[i], 1.0);
        let place = clip.xy * view.half_viewport / clip.w;
        nearest = min(nearest, clip.w);
        spread = max(spread, length(place));
    }
    if nearest > near && nearest > 0.0 {
        return vec2<f32>(nearest, spread);
    }
    // What is seen of it is anywhere in the view, and no nearer than the near plane.
    return vec2<f32>(near, length(view.half_viewport));
}

// No point of a patch is farther off than this share of what its control points are, if its corners aren't off; twice that,
// for two points on different sides.
const TWO_POINTS: f32 = 16.0 / 9.0;

// Returns a bound on the distance in px, across the plane of a patch's triangle, between points of the patch that have the same
// place in that plane. Large if the patch has no area.
fn plane_error(view: LodView, net: ControlNet) -> f32 {
    let a = net.corners[0];
    let area = cross(net.corners[1] - a, net.corners[2] - a);
    let size = length(area);
    if !(size > 1e-30 && size < 1e30) {
        return 3.4e38;
    }
    let normal = area * (1.0 / size);
    let within = seen_within(view, net.corners);
    var most = longer_on_screen(view, 0.0, within.y, normal * dot(normal, net.center - a));
    for (var i = 0u; i < 6u; i++) {
        most = longer_on_screen(view, most, within.y, normal * dot(normal, net.edges[i] - a));
    }
    return TWO_POINTS * most / within.x;
}

// Returns a point's difference from a line; a large one, if the point isn't beside the part between `start` and
// `start + along`.
fn beside_line(start: vec3<f32>, along: vec3<f32>, p: vec3<f32>) -> vec3<f32> {
    let share = dot(p - start, along) / dot(along, along);
    // Rounding doesn't count.
    return select(vec3<f32>(1e18), p - start - along * share, abs(share - 0.5) <= 0.50001);
}

// Returns a bound on the distance in px between points of a patch, and of triangles in place of it, that are at the same place
// along its longest side. Large if the patch isn't beside that side.
fn line_error(view: LodView, net: ControlNet) -> f32 {
    let a = net.corners[0];
    let b = net.corners[1];
    let c = net.corners[2];
    var start = a;
    var along = b - a;
    if length(c - b) > length(along) {
        start = b;
        along = c - b;
    }
    if length(a - c) > length(along) {
        start = c;
        along = a - c;
    }
    let within = seen_within(view, net.corners);
    var most = longer_on_screen(view, 0.0, within.y, beside_line(start, along, net.center));
    for (var i = 0u; i < 3u; i++) {
        most = longer_on_screen(view, most, within.y, beside_line(start, along, net.corners[i]));
    }
    for (var i = 0u; i < 6u; i++) {
        most = longer_on_screen(view, most, within.y, beside_line(start, along, net.edges[i]));
    }
    return 2.0 * most / within.x;
}
