// Draws layers of surfaces with nothing on them but their materials: draw_lit.wgsl draws what hides everything behind it.

@fragment
fn lit_depth_fragment(
    in: LitVaryings,
    @builtin(front_facing) front: bool,
    @builtin(sample_index) sample: u32,
) -> @builtin(frag_depth) f32 {
    // Neither the normal, the eye nor the position matters.
    let place = surface_place(in.uv, in.weights, in.patch_index, in.normal, front, in.normal, in.normal);
    if !is_beyond_last(in.clip, sample, lit_frame.left) || !shows_behind(place) {
        discard;
    }
    return in.clip.z;
}

@fragment
fn lit_layer_fragment(
    in: LitVaryings,
    @builtin(front_facing) front: bool,
    @builtin(sample_index) sample: u32,
) -> @location(0) vec4<f32> {
    let place = lit_place(in, lit_normal(in), front);
    // Derivatives are known by now, so that what isn't shown needn't be lit.
    if !is_last(in.clip, sample, lit_frame.left) {
        discard;
    }
    return layer_output(material_seen(place, lit_frame));
}
