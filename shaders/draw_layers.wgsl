// Layers of surfaces that show what is behind them, found one after another at every sample (depth peeling: Everitt 2001). Depth
// is reversed, so that nearer surfaces have a greater depth. See src/inspect/render/layers.rs.

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
