// Draws layers of surfaces with overlays: draw_surface.wgsl draws what hides everything behind it.

@fragment
fn surface_depth_fragment(
    in: Varyings,
    @builtin(front_facing) front: bool,
    @builtin(sample_index) sample: u32,
) -> @builtin(frag_depth) f32 {
    // Neither the normal, the eye nor the position matters.
    let place = surface_place(in.uv, in.domain.xy, in.patch_index, in.normal, front, in.normal, in.normal);
    if !is_beyond_last(in.clip, sample, frame.left) || !shows_behind(place) {
        discard;
    }
    return in.clip.z;
}

@fragment
fn surface_layer_fragment(
    in: Varyings,
    @builtin(front_facing) front: bool,
    @builtin(sample_index) sample: u32,
) -> @location(0) vec4<f32> {
    let normal = surface_normal_of(in);
    let place = lit_surface_place(in, normal, front);
    let own = material_seen(place, frame);
    // Lines and marks aren't seen through.
    let drawn = surface_color(in, normal, front, vec4<f32>(own.color, 1.0));
    // What is blended has no alpha to keep lines in.
    let color = mix(drawn.color, WIRE_COLOR, drawn.wire);
    if !is_last(in.clip, sample, frame.left) {
        discard;
    }
    return layer_output(Seen(color.rgb, own.behind * (1.0 - color.a)));
}
