// Thick lines, faint where something is in front of them: one instance a segment, a quad facing the screen.

@group(0) @binding(0) var<uniform> frame: Frame;

const NEARER: f32 = 1.003;

// What is left of a line behind something.
const HIDDEN: f32 = 0.3;

struct LineVaryings {
    @builtin(position) clip: vec4<f32>,
    // Px across the line, from its middle.
    @location(0) @interpolate(linear) across: f32,
    @location(1) @interpolate(flat) color: vec3<f32>,
    @location(2) @interpolate(flat) half_width: f32,
}

// Moves `a` along the segment until it lies in front of the eye.
fn in_front(a: vec4<f32>, b: vec4<f32>) -> vec4<f32> {
    let least = 1e-6 * max(abs(a.w), abs(b.w));
    if a.w >= least || b.w <= a.w {
        return a;
    }
    return mix(a, b, (least - a.w) / (b.w - a.w));
}

@vertex
fn line_vertex(
    @builtin(vertex_index) index: u32,
    @location(0) start: vec3<f32>,
    @location(1) end: vec3<f32>,
    @location(2) color: vec3<f32>,
    @location(3) half_width: f32,
) -> LineVaryings {
    let a = frame.clip_from_object * vec4<f32>(start, 1.0);
    let b = frame.clip_from_object * vec4<f32>(end, 1.0);
    let from_clip = in_front(a, b);
    let to_clip = in_front(b, a);
    let half_viewport = 0.5 * frame.viewport;
    let along_px = (to_clip.xy / to_clip.w - from_clip.xy / from_clip.w) * half_viewport;
    let length_px = length(along_px);
    let along = select(vec2<f32>(1.0, 0.0), along_px / max(length_px, 1e-6), length_px > 1e-6);
    let across = vec2<f32>(-along.y, along.x);
    // Two triangles: corners 0 1 2 and 3 2 1; bit 0 picks the end, bit 1 the side.
    let corner = select(index, 6u - index, index >= 3u);
    let at_end = (corner & 1u) == 1u;
    let side = select(-1.0, 1.0, (corner & 2u) == 2u);
    let reach = half_width + 1.0;
    let cap = along * select(-half_width, half_width, at_end);
    let clip = select(from_clip, to_clip, at_end);
    let offset = (across * side * reach + cap) / half_viewport;
    // A little nearer than the surface that the line lies on; depth is reversed.
    let z = min(clip.z * NEARER, clip.w);
    return LineVaryings(vec4<f32>(clip.xy + offset * clip.w, z, clip.w), side * reach, color, half_width);
}

fn line_coverage(in: LineVaryings) -> f32 {
    return 1.0 - smoothstep(in.half_width - 0.5, in.half_width + 0.5, abs(in.across));
}

@fragment
fn line_fragment(in: LineVaryings) -> @location(0) vec4<f32> {
    return vec4<f32>(in.color, line_coverage(in));
}

@fragment
fn hidden_line_fragment(in: LineVaryings) -> @location(0) vec4<f32> {
    return vec4<f32>(in.color, HIDDEN * line_coverage(in));
}
