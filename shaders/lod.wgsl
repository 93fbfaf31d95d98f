// Level of detail: the tessellation factor of an edge, by its length on screen or its distance from the eye. Twin:
// src/geometry/tessellate/lod.rs. LOD by error is in least_factors.wgsl.

struct LodView {
    clip_from_object: mat4x4<f32>,
    half_viewport: vec2<f32>,
    // The largest distance in object units by which displacement moves a point.
    reach: f32,
    eye: vec3<f32>,
    radius: f32,
}

// Returns a position on screen, from the middle of the view, in segments of `pixels_per_segment` px.
fn project_and_scale(view: LodView, pixels_per_segment: f32, position: vec3<f32>) -> vec2<f32> {
    let clip = view.clip_from_object * vec4<f32>(position, 1.0);
    return clip.xy / clip.w * view.half_viewport / pixels_per_segment;
}

// Returns `length`, but 1 if it is less than 1 or NaN. The length of an edge through the eye's plane may be NaN.
fn max_with_one(length: f32) -> f32 {
    let is_nan = (bitcast<u32>(length) & 0x7fffffffu) > 0x7f800000u;
    return select(length, 1.0, is_nan || length < 1.0);
}

// Returns the white paper's factor of an edge with these four control points (`ComputeEdgeLOD` of McDonald and Kilgard
// 2010): the length of its control polygon on screen, in segments. The points must be in the edge's own direction.
fn paper_edge_factor(
    view: LodView,
    pixels_per_segment: f32,
    a: vec3<f32>,
    ab: vec3<f32>,
    ba: vec3<f32>,
    b: vec3<f32>,
) -> f32 {
    let pa = project_and_scale(view, pixels_per_segment, a);
    let pab = project_and_scale(view, pixels_per_segment, ab);
    let pba = project_and_scale(view, pixels_per_segment, ba);
    let pb = project_and_scale(view, pixels_per_segment, b);
    return max_with_one(distance(pa, pab) + distance(pab, pba) + distance(pba, pb));
}

// Returns whether a clip-space position lies on the near plane or beyond. Depth is reversed: z = w on the near plane.
fn beyond_near(clip: vec4<f32>) -> bool {
    return clip.z <= clip.w;
}

// Returns the gradient of a clip-space coordinate (0 to 3 for x, y, z, w) in object space.
fn clip_row(view: LodView, row: u32) -> vec3<f32> {
    let m = view.clip_from_object;
    return vec3<f32>(m[0][row], m[1][row], m[2][row]);
}

// Returns how many px an object unit across the view covers at depth w = 1.
fn pixels_per_unit(view: LodView) -> f32 {
    return max(length(clip_row(view, 0u)) * view.half_viewport.x, length(clip_row(view, 1u)) * view.half_viewport.y);
}

// Returns the factor of an edge that isn't completely beyond the near plane: the length of its control polygon in
// segments, as if it lay across the view at the nearest depth of a sphere around the control points. If the whole
// sphere is nearer than the near plane, the factor is 1.
fn near_edge_factor(
    view: LodView,
    pixels_per_segment: f32,
    a: vec3<f32>,
    ab: vec3<f32>,
    ba: vec3<f32>,
    b: vec3<f32>,
) -> f32 {
    let center = (a + b) * 0.5;
    let radius = max(max(distance(a, center), distance(ab, center)), distance(ba, center)) + view.reach;
    let clip = view.clip_from_object * vec4<f32>(center, 1.0);
    let depth = clip_row(view, 3u);
    let past_near = depth - clip_row(view, 2u);
    if clip.w - clip.z + radius * length(past_near) < 0.0 {
        return 1.0;
    }
    let nearest = max(clip.w - radius * length(depth), clip.z);
    let polygon = distance(a, ab) + distance(ab, ba) + distance(ba, b);
    return max_with_one(polygon * pixels_per_unit(view) / nearest / pixels_per_segment);
}

// Returns `paper_edge_factor` if all four control points lie beyond the near plane, otherwise `near_edge_factor`.
fn edge_length_factor(
    view: LodView,
    pixels_per_segment: f32,
    a: vec3<f32>,
    ab: vec3<f32>,
    ba: vec3<f32>,
    b: vec3<f32>,
) -> f32 {
    let m = view.clip_from_object;
    let ends = beyond_near(m * vec4<f32>(a, 1.0)) && beyond_near(m * vec4<f32>(b, 1.0));
    if ends && beyond_near(m * vec4<f32>(ab, 1.0)) && beyond_near(m * vec4<f32>(ba, 1.0)) {
        return paper_edge_factor(view, pixels_per_segment, a, ab, ba, b);
    }
    return near_edge_factor(view, pixels_per_segment, a, ab, ba, b);
}

// Returns the factor of a point `p` in object units: `factor` up to a distance of `near` bounding radii from the eye, 1
// from `far` bounding radii on, and linear between.
fn point_distance_factor(view: LodView, factor: f32, near: f32, far: f32, p: vec3<f32>) -> f32 {
    let part = (far - distance(p, view.eye) / view.radius) / (far - near);
    return 1.0 + (factor - 1.0) * clamp(part, 0.0, 1.0);
}

// Returns the factor of an edge under LOD by distance: the mean of the factors at its ends.
fn distance_factor(view: LodView, factor: f32, near: f32, far: f32, a: vec3<f32>, b: vec3<f32>) -> f32 {
    return max_with_one(0.5 * (point_distance_factor(view, factor, near, far, a) + point_distance_factor(view, factor, near, far, b)));
}
