// Draws what is behind the mesh: the light from all around, as it is seen from the mesh's middle.
// With: draw_whole

// A uniform, as in draw_lit.wgsl. No branch depends on it.
@group(0) @binding(6) var<uniform> background_frame: Frame;
// Longitude across and latitude down. Its middle is at -Z, +X is to the right of it, and +Y is at the top.
@group(1) @binding(0) var panorama: texture_2d<f32>;
@group(1) @binding(1) var panorama_sampler: sampler;

// The tangent of half the usual field of view, which the background of an orthographic view has: all rays of that have one direction.
const HALF_VIEW: f32 = 0.36397023;

// The direction that is seen at a place of the picture, in px.
fn seen_direction(px: vec2<f32>) -> vec3<f32> {
    let viewport = background_frame.viewport;
    let at = vec2<f32>(2.0, -2.0) * px / viewport + vec2<f32>(-1.0, 1.0);
    let rows = transpose(background_frame.clip_from_object);
    // All points on a line of sight have one x / w and one y / w: see toward_eye.
    let seen = cross(rows[1].xyz - at.y * rows[3].xyz, rows[0].xyz - at.x * rows[3].xyz);
    let right = normalize(rows[0].xyz);
    let up = normalize(rows[1].xyz);
    let across = HALF_VIEW * vec2<f32>(at.x * viewport.x / viewport.y, at.y);
    let in_parallel_view = right * across.x + up * across.y - cross(right, up);
    return normalize(select(in_parallel_view, seen, length(rows[3].xyz) > 0.0));
}

@fragment
fn background_fragment(@builtin(position) px: vec4<f32>) -> @location(0) vec4<f32> {
    let direction = surroundings.light_from_object * seen_direction(px.xy - vec2<f32>(background_frame.shift, 0.0));
    let longitude = atan2(direction.x, -direction.z);
    let latitude = acos(clamp(direction.y, -1.0, 1.0));
    let at = vec2<f32>(0.5 + longitude / (2.0 * PI), latitude / PI);
    let radiance = surroundings.brightness * textureSampleLevel(panorama, panorama_sampler, at, 0.0).rgb;
    return vec4<f32>(exposed(radiance), 1.0);
}
