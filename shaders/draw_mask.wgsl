// Masks of materials, which cut a pixel's samples one by one.

// Where the four samples of a pixel are, in px from its middle: the standard sample locations of the Vulkan specification (section
// "Multisampling"), which are also those of Direct3D.
const SAMPLE_PLACES: array<vec2<f32>, 4> = array<vec2<f32>, 4>(
    vec2<f32>(-0.125, -0.375),
    vec2<f32>(0.375, -0.125),
    vec2<f32>(-0.375, 0.125),
    vec2<f32>(0.125, 0.375),
);

// Which of a pixel's samples a mask leaves. Alpha counts as linear in a pixel, so that where the border of the mask crosses it, as
// many samples are left as the surface covers there. This does in a shader what alpha to coverage does with alpha that is sharpened
// about the cutoff by its change from pixel to pixel (Golus 2017, "Anti-aliased Alpha Test"). So the pattern is the same on all
// devices, and the picture's own alpha stays 1.
fn mask_samples(place: SurfacePlace) -> u32 {
    let detail = place_detail(place);
    let alpha = base_color(place, detail).a;
    // Only varyings have derivatives that can be relied on, so that the next pixels' alpha is computed here.
    let own = place.own;
    let right = texel(base_texture, base_sampler, ImagePlace(own.uv + own.right, own.right, own.below)).a;
    let below = texel(base_texture, base_sampler, ImagePlace(own.uv + own.below, own.right, own.below)).a;
    let colors = material.base_color.a * (vec2<f32>(detail.color.a) + detail.alpha_change);
    let change = colors * vec2<f32>(right, below) - alpha;
    var samples = 0u;
    for (var i = 0u; i < 4u; i++) {
        let sampled = alpha + dot(change, SAMPLE_PLACES[i]);
        // Beyond 0 and 1 there is no alpha: a cutoff of 0 leaves everything.
        samples |= select(0u, 1u << i, clamp(sampled, 0.0, 1.0) >= material.cutoff);
    }
    return samples;
}

// A pixel of a surface with a mask, and which of its samples the mask leaves.
struct MaskedPixel {
    @location(0) color: vec4<f32>,
    @builtin(sample_mask) samples: u32,
}

// A pixel of this colour; none if the mask leaves nothing of it.
fn masked_pixel(place: SurfacePlace, color: vec4<f32>) -> MaskedPixel {
    let samples = mask_samples(place);
    if samples == 0u {
        discard;
    }
    return MaskedPixel(color, samples);
}
