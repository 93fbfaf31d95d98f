// How many segments an edge gets. Twin: src/tessellate/lod.rs.

const LOD_UNIFORM: u32 = 0u;
const LOD_PAPER: u32 = 1u;
const LOD_EDGE_LENGTH: u32 = 2u;
const LOD_ERROR: u32 = 3u;
const LOD_DISTANCE: u32 = 4u;

struct LodView {
    clip_from_object: mat4x4<f32>,
    half_viewport: vec2<f32>,
    // How far what is emitted may be from the surface: it is displaced.
    reach: f32,
    eye: vec3<f32>,
    radius: f32,
}

// Divides by w as the paper does, so points behind the eye land on the wrong side.
fn project_and_scale(view: LodView, pixels_per_segment: f32, position: vec3<f32>) -> vec2<f32> {
    let clip = view.clip_from_object * vec4<f32>(position, 1.0);
    return clip.xy / clip.w * view.half_viewport / pixels_per_segment;
}

// At least 1, and 1 for NaN, which is told by its bits.
fn at_least_one(length: f32) -> f32 {
    let is_nan = (bitcast<u32>(length) & 0x7fffffffu) > 0x7f800000u;
    return select(length, 1.0, is_nan || length < 1.0);
}

// ComputeEdgeLOD of the PN-AEN white paper, in the edge's own direction.
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
    return at_least_one(distance(pa, pab) + distance(pab, pba) + distance(pba, pb));
}

// Depth is reversed: z = w on the near plane.
fn beyond_near(clip: vec4<f32>) -> bool {
    return clip.z <= clip.w;
}

fn clip_row(view: LodView, row: u32) -> vec3<f32> {
    let m = view.clip_from_object;
    return vec3<f32>(m[0][row], m[1][row], m[2][row]);
}

fn pixels_per_unit(view: LodView) -> f32 {
    return max(length(clip_row(view, 0u)) * view.half_viewport.x, length(clip_row(view, 1u)) * view.half_viewport.y);
}

// The control polygon at the nearest depth of the sphere around it; 1 if all of that is nearer than the near plane.
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
    return at_least_one(polygon * pixels_per_unit(view) / nearest / pixels_per_segment);
}

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

fn distance_at(view: LodView, factor: f32, near: f32, far: f32, p: vec3<f32>) -> f32 {
    let part = (far - distance(p, view.eye) / view.radius) / (far - near);
    return 1.0 + (factor - 1.0) * clamp(part, 0.0, 1.0);
}

fn distance_factor(view: LodView, factor: f32, near: f32, far: f32, a: vec3<f32>, b: vec3<f32>) -> f32 {
    return at_least_one(0.5 * (distance_at(view, factor, near, far, a) + distance_at(view, factor, near, far, b)));
}
