// Draws the surface with overlays: lit by the lights at the camera or by light from all
// around, and cut by the masks of materials.
// With: draw_surface_vertices

fn surface_normal_of(in: Varyings) -> vec3<f32> {
    return drawn_normal(in.normal, in.patch_index, in.domain.xy);
}

// The last argument is the colour of the material in light from all around: none, since the lights at the camera take its place.
@fragment
fn surface_fragment(in: Varyings, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    return opaque_surface_color(in, surface_normal_of(in), front, vec4<f32>(0.0));
}

@fragment
fn lit_surface_fragment(in: Varyings, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    let normal = surface_normal_of(in);
    let own = material_color(lit_surface_place(in, normal, front));
    let color = opaque_surface_color(in, normal, front, vec4<f32>(own.rgb, 1.0));
    if (HAS_MASK || HAS_TRANSMISSION) && own.a == 0.0 {
        discard;
    }
    return color;
}

@fragment
fn masked_surface_fragment(in: Varyings, @builtin(front_facing) front: bool) -> MaskedPixel {
    let normal = surface_normal_of(in);
    let place = lit_surface_place(in, normal, front);
    let own = material_color(place);
    return masked_pixel(place, opaque_surface_color(in, normal, front, vec4<f32>(own.rgb, 1.0)));
}

// The same with the lights at the camera.
@fragment
fn cut_samples_fragment(in: Varyings, @builtin(front_facing) front: bool) -> MaskedPixel {
    let normal = surface_normal_of(in);
    let place = lit_surface_place(in, normal, front);
    return masked_pixel(place, opaque_surface_color(in, normal, front, vec4<f32>(0.0)));
}

@fragment
fn cut_surface_fragment(in: Varyings, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    let normal = surface_normal_of(in);
    let place = lit_surface_place(in, normal, front);
    let color = opaque_surface_color(in, normal, front, vec4<f32>(0.0));
    if base_color(place, place_detail(place)).a < material.cutoff {
        discard;
    }
    return color;
}

fn lit_surface_place(in: Varyings, normal: vec3<f32>, front: bool) -> SurfacePlace {
    let to_eye = toward_eye(frame.clip_from_object, frame.viewport, unmoved(in.clip, frame.shift).xy);
    var position: vec3<f32>;
    if LIGHT_COUNT > 0u || has_map(BEHIND) {
        position = fragment_place(frame.clip_from_object, frame.viewport, unmoved(in.clip, frame.shift));
    }
    return surface_place(in.uv, in.domain.xy, in.patch_index, normalize(normal), front, to_eye, position);
}
