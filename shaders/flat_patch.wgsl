// Flat patches: those whose surface lies in a plane, though its parametrisation may not be linear. Twin:
// src/tessellate/flat_patch.rs, which explains the bound.

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

// Returns a bound on the distance in px, across the plane of a patch's triangle, between points of the patch that have the same
// place in that plane. Large if the patch has no area.
fn plane_error(view: LodView, net: ControlNet) -> f32 {
    let a = net.corners[0];
    let b = net.corners[1];
    let c = net.corners[2];
    let area = cross(b - a, c - a);
    let size = length(area);
    if !(size > 1e-30 && size < 1e30) {
        return 3.4e38;
    }
    let normal = area * (1.0 / size);
    let near = near_depth(view);
    var nearest = 3.4e38;
    var spread = 0.0;
    for (var i = 0u; i < 3u; i++) {
        let clip = view.clip_from_object * vec4<f32>(net.corners[i], 1.0);
        let place = clip.xy * view.half_viewport / clip.w;
        nearest = min(nearest, clip.w);
        spread = max(spread, length(place));
    }
    if !(nearest > near && nearest > 0.0) {
        // What is seen of it is anywhere in the view, and no nearer than the near plane.
        nearest = near;
        spread = length(view.half_viewport);
    }
    var most = longer_on_screen(view, 0.0, spread, normal * dot(normal, net.center - a));
    for (var i = 0u; i < 6u; i++) {
        most = longer_on_screen(view, most, spread, normal * dot(normal, net.edges[i] - a));
    }
    // No point is farther off than 8/9 of the control points are, and two points are on both sides of the plane at worst.
    return 16.0 / 9.0 * most / nearest;
}
