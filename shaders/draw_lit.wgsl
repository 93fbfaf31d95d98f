// Draws the surface with nothing on it but its materials, in light from all around.

// A uniform, which GPUs read fastest where all invocations read the same. No branch depends on it: see draw_surface_inputs.wgsl.
@group(0) @binding(6) var<uniform> lit_frame: Frame;

struct LitVaryings {
    // Invariant, since draws of one layer must agree on depths.
    @builtin(position) @invariant clip: vec4<f32>,
    @location(0) normal: vec3<f32>,
    @location(1) uv: vec2<f32>,
    // Weights u and v in the patch.
    @location(2) weights: vec2<f32>,
    @location(3) @interpolate(flat) patch_index: u32,
}

@vertex
fn lit_vertex(vertex: EmittedVertex) -> LitVaryings {
    let clip = lit_frame.clip_from_object * vec4<f32>(vertex.position, 1.0);
    let weights = vec2<f32>(key_uv(vertex.key)) * UNIT;
    return LitVaryings(clip, unpack_normal(vertex.normal), vertex.uv, weights, key_patch(vertex.key));
}

fn lit_normal(in: LitVaryings) -> vec3<f32> {
    return drawn_normal(normalize(in.normal), in.patch_index, in.weights);
}

fn lit_place(in: LitVaryings, normal: vec3<f32>, front: bool) -> SurfacePlace {
    let to_eye = toward_eye(lit_frame.clip_from_object, lit_frame.viewport, unmoved(in.clip, lit_frame.shift).xy);
    var position: vec3<f32>;
    if LIGHT_COUNT > 0u || has_map(BEHIND) {
        position = fragment_place(lit_frame.clip_from_object, lit_frame.viewport, unmoved(in.clip, lit_frame.shift));
    }
    return surface_place(in.uv, in.weights, in.patch_index, normal, front, to_eye, position);
}

@fragment
fn lit_fragment(in: LitVaryings, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    let color = material_color(lit_place(in, lit_normal(in), front));
    if (HAS_MASK || HAS_TRANSMISSION) && color.a == 0.0 {
        discard;
    }
    return vec4<f32>(color.rgb, 1.0);
}

@fragment
fn masked_lit_fragment(in: LitVaryings, @builtin(front_facing) front: bool) -> MaskedPixel {
    let place = lit_place(in, lit_normal(in), front);
    return masked_pixel(place, vec4<f32>(material_color(place).rgb, 1.0));
}
