// How many segments an edge gets. Twin: src/tessellate/lod.rs.

const LOD_UNIFORM: u32 = 0u;
const LOD_PAPER: u32 = 1u;

struct LodView {
    clip_from_object: mat4x4<f32>,
    half_viewport: vec2<f32>,
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
