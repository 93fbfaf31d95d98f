// Layers of surfaces that show what is behind them, found one after another at every sample (depth peeling: Everitt 2001). Depth
// is reversed, so that nearer surfaces have a greater depth. See src/inspect/render/layers.rs. The depths
// that are compared are textures of layers_single.wgsl or layers_multisampled.wgsl.

// Whether the draw looks for the layer in front of the one that was found last, and not for the one behind it.
override TOWARD_EYE: bool = false;
// What the draw does with the layer that was found last: one of LAYER_*.
override LAYER_DRAW: u32 = 0u;

// Covers what is behind.
const LAYER_OVER: u32 = 0u;
// Multiplies what is behind by the layer's colours.
const LAYER_FILTER: u32 = 1u;
// Adds the light that comes from the layer itself.
const LAYER_ADD: u32 = 2u;

// What is seen of a place.
struct Seen {
    // Linear RGB, of as much of the place as the surface covers.
    color: vec3<f32>,
    // Factor of what is seen behind, in linear RGB.
    behind: vec3<f32>,
}

// The depth of the layer that was found last. A texture with one sample a pixel has a level in place of samples: both are 0 then.
fn passed_depth(px: vec2<f32>, sample: u32) -> f32 {
    return textureLoad(passed_depths, vec2<i32>(px), i32(sample));
}

// The depth of the surface that hides everything behind it.
fn hiding_depth(px: vec2<f32>, sample: u32) -> f32 {
    return textureLoad(hiding_depths, vec2<i32>(px), i32(sample));
}

// Whether a depth is beyond the last layer, in the direction in which the draw looks, and nothing hides it. `left` is the first
// column of the half: the scissors of some software drivers let samples through in the column beside it.
fn is_beyond_last(clip: vec4<f32>, sample: u32, left: f32) -> bool {
    if clip.x < left {
        return false;
    }
    let passed = passed_depth(clip.xy, sample);
    if TOWARD_EYE {
        return clip.z > max(passed, hiding_depth(clip.xy, sample));
    }
    return clip.z < passed && clip.z > hiding_depth(clip.xy, sample);
}

// Whether a depth is that of the last layer. Where there was none, its depth is 1.
fn is_last(clip: vec4<f32>, sample: u32, left: f32) -> bool {
    let passed = passed_depth(clip.xy, sample);
    return clip.x >= left && clip.z == passed && passed < 1.0;
}

// What is blended with the picture. The fourth component of a picture says how much of a pixel is covered; what is behind a
// coloured layer is covered by as much as the layer takes of its three channels, on average.
fn layer_output(seen: Seen) -> vec4<f32> {
    let shown = dot(seen.behind, vec3<f32>(1.0 / 3.0));
    if LAYER_DRAW == LAYER_FILTER {
        return vec4<f32>(seen.behind, shown);
    }
    if LAYER_DRAW == LAYER_ADD {
        return vec4<f32>(seen.color, 1.0 - shown);
    }
    return vec4<f32>(seen.color, 1.0 - seen.behind.x);
}

// What is seen of a place that shows what is behind it. A body that refracts light, and a rough surface, show the picture of what
// is behind them, at another place or blurred: that takes the place of what is right behind.
fn material_seen(place: SurfacePlace, frame_of_place: Frame) -> Seen {
    let detail = place_detail(place);
    let base = base_color(place, detail);
    let normal = shown_normal(place, detail);
    var look = look_at(place, detail, base.rgb, normal);
    look.transmission = transmission_at(place, detail);
    let coverage = select(1.0, clamp(base.a, 0.0, 1.0), material.blends > 0.5);
    var color = coverage * surface_radiance(place, detail, base.rgb, look, normal);
    var behind = vec3<f32>(1.0 - coverage);
    if HAS_TRANSMISSION {
        let through = coverage * transmitted_through(look, normal, place.to_eye);
        if has_map(BEHIND) && LAYER_DRAW == LAYER_OVER {
            let seen = seen_through(place, detail, look, normal, frame_of_place);
            color += through * seen.rgb;
            // In a transparent picture, light may come from where there is nothing.
            behind += vec3<f32>(dot(through, vec3<f32>(1.0 / 3.0)) * (1.0 - seen.a));
        } else {
            behind += through;
        }
    }
    return Seen(color, behind);
}

// What is seen of the picture behind a body, where the refracted ray leaves it (KHR_materials_volume, section
// "Implementation"), or behind a thin surface, of thickness 0; and how much of it is covered. Roughness blurs by mip levels.
fn seen_through(place: SurfacePlace, detail: PlaceDetail, look: LookAt, normal: vec3<f32>, at: Frame) -> vec4<f32> {
    let thickness = material.thickness * map_texel(place, detail, SLOT_THICKNESS).g;
    // An index of refraction of 0 stands for an infinite one.
    let ray = refract(-place.to_eye, normal, select(1.0 / look.ior, 0.0, look.ior < 1.0));
    let clip = at.clip_from_object * vec4<f32>(place.position + thickness * ray, 1.0);
    let moved = vec2<f32>(at.shift / at.viewport.x, 0.0);
    let on_picture = vec2<f32>(0.5, -0.5) * clip.xy / clip.w + 0.5 + moved;
    // The blurriest level is one texel. A surface that doesn't refract doesn't blur.
    let roughness = look.roughness * clamp(2.0 * look.ior - 2.0, 0.0, 1.0);
    let texel_size = pow(at.viewport.x, roughness) / at.viewport;
    let blurred = ImagePlace(on_picture, vec2<f32>(texel_size.x, 0.0), vec2<f32>(0.0, texel_size.y));
    let seen = slot_texel(BEHIND, blurred);
    // Beer and Lambert.
    return vec4<f32>(seen.rgb * exp(-material.absorption * thickness), seen.a);
}
