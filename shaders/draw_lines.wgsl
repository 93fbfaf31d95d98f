// Thick lines, faint where something is in front of them. An instance is a line segment, or a vertex whose normal is drawn;
// each becomes a quad that faces the screen.

// In storage, not a uniform: some software drivers compile a shader again for every value of a uniform that it branches on.
@group(0) @binding(0) var<storage, read> frame: Frame;
// Only for normals.
@group(0) @binding(1) var<storage, read> points: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> patches: array<Patch>;
@group(2) @binding(0) var<uniform> slab: Slab;
@group(2) @binding(1) var<storage, read> patch_factors: array<PatchFactors>;

// Lines lie on surfaces: their depth is moved nearer by this factor.
const NEARER: f32 = 1.003;

// Opacity of lines that are behind something.
const HIDDEN: f32 = 0.3;

// As NORMAL_COLOR in src/inspect/render/layout.rs, in linear light.
const NORMAL_COLOR: vec3<f32> = vec3<f32>(0.045, 0.680, 1.0);

// Of drawn normals, in px: their length if seen from the side, half their width, and their average distance where vertices
// are closer.
const NORMAL_LENGTH: f32 = 18.0;
const NORMAL_HALF_WIDTH: f32 = 0.6;
const NORMAL_SPACING: f32 = 24.0;

struct LineVaryings {
    @builtin(position) clip: vec4<f32>,
    // Px across the line, from its middle.
    @location(0) @interpolate(linear) across: f32,
    @location(1) @interpolate(flat) color: vec3<f32>,
    @location(2) @interpolate(flat) half_width: f32,
    // How many lines are drawn over each other here, about.
    @location(3) @interpolate(flat) times: f32,
}

// Moves `a` along the segment until it lies in front of the eye.
fn in_front(a: vec4<f32>, b: vec4<f32>) -> vec4<f32> {
    let least = 1e-6 * max(abs(a.w), abs(b.w));
    if a.w >= least || b.w <= a.w {
        return a;
    }
    return mix(a, b, (least - a.w) / (b.w - a.w));
}

struct Line {
    @location(0) start: vec3<f32>,
    @location(1) end: vec3<f32>,
    @location(2) color: vec3<f32>,
    @location(3) half_width: f32,
    @location(4) times: f32,
}

// With caps, a line reaches beyond its ends by half its width, so that lines join without a notch. A dot always has them.
fn line(index: u32, own: Line, has_caps: bool) -> LineVaryings {
    let half_width = own.half_width / frame.coarseness;
    let a = frame.clip_from_object * vec4<f32>(own.start, 1.0);
    let b = frame.clip_from_object * vec4<f32>(own.end, 1.0);
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
    let is_dot = all(own.start == own.end);
    let beyond = select(0.0, half_width, has_caps || is_dot);
    let cap = along * select(-beyond, beyond, at_end);
    let clip = select(from_clip, to_clip, at_end);
    let offset = (across * side * reach + cap) / half_viewport;
    // A little nearer than the surface that the line lies on; depth is reversed. What is nearer than the near plane, or cut away by a
    // section, stays out.
    let z = select(min(clip.z * NEARER, clip.w), clip.z, clip.z > clip.w);
    return LineVaryings(vec4<f32>(clip.xy + offset * clip.w, z, clip.w), side * reach, own.color, half_width, own.times);
}

// Whether all of a line is drawn, faintly, even behind surfaces.
override THROUGH_SURFACES: bool = false;

// Without caps where lines are faint: where those of a chain overlapped, it would not be faint.
@vertex
fn line_vertex(@builtin(vertex_index) index: u32, own: Line) -> LineVaryings {
    return line(index, own, !THROUGH_SURFACES);
}

// How many px a unit of length across the view is, at a depth.
fn px_per_unit(w: f32) -> f32 {
    let upwards = vec3<f32>(frame.clip_from_object[0].y, frame.clip_from_object[1].y, frame.clip_from_object[2].y);
    return 0.5 * frame.viewport.y * length(upwards) / w;
}

// The area of a patch for each of its vertices, about, in square object units.
fn area_per_vertex(patch_index: u32) -> f32 {
    let at = patches[patch_index].points;
    let a = points[at[0]].xyz;
    let doubled = length(cross(points[at[1]].xyz - a, points[at[2]].xyz - a));
    let n = f32(max(segments(patch_factors[patch_index - slab.first_patch].inside), 1u));
    return doubled / (n * n);
}

// A permuted congruential generator (O'Neill 2014).
fn permuted(x: u32) -> u32 {
    let state = x * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

// A pseudo-random number from 0 to 1 for a vertex. It depends on the mesh's points and the vertex's weight at each, not on
// positions; and since the sum is of integers, all patches that emit the vertex get the same.
fn chance(patch_index: u32, domain: vec2<u32>) -> f32 {
    let at = patches[patch_index].points;
    let near = array<u32, 3>(domain.x, domain.y, FIXED_ONE - domain.x - domain.y);
    var sum = 0u;
    for (var k = 0u; k < 3u; k++) {
        sum += select(0u, permuted(permuted(at[k]) ^ near[k]), near[k] > 0u);
    }
    return f32(permuted(sum) >> 8u) / 16777216.0;
}

// How many patches emit a vertex: 6 at a corner and 2 on an edge, as in most meshes, and 1 inside.
fn usual_times(domain: vec2<u32>) -> f32 {
    let last = FIXED_ONE - domain.x - domain.y;
    let zeros = u32(domain.x == 0u) + u32(domain.y == 0u) + u32(last == 0u);
    return select(select(1.0, 2.0, zeros == 1u), 6.0, zeros == 2u);
}

@vertex
fn normal_vertex(@builtin(vertex_index) index: u32, vertex: EmittedVertex) -> LineVaryings {
    let w = dot(vec4<f32>(vertex.position, 1.0), vec4<f32>(
        frame.clip_from_object[0].w,
        frame.clip_from_object[1].w,
        frame.clip_from_object[2].w,
        frame.clip_from_object[3].w,
    ));
    let px = px_per_unit(max(w, 1e-30));
    let direction = unpack_normal(vertex.normal);
    let to_eye = normalize(frame.eye.xyz - vertex.position * frame.eye.w);
    // Where vertices are closer than NORMAL_SPACING, only some get a normal. At silhouettes, where patches look small, the
    // least factor keeps enough of them.
    let area = area_per_vertex(key_patch(vertex.key)) * px * px * max(abs(dot(direction, to_eye)), 0.2);
    if w <= 0.0 || chance(key_patch(vertex.key), key_uv(vertex.key)) * NORMAL_SPACING * NORMAL_SPACING >= area {
        return LineVaryings();
    }
    let end = vertex.position + direction * (NORMAL_LENGTH / px);
    let own = Line(vertex.position, end, NORMAL_COLOR, NORMAL_HALF_WIDTH, usual_times(key_uv(vertex.key)));
    return line(index, own, true);
}

@fragment
fn line_fragment(in: LineVaryings) -> @location(0) vec4<f32> {
    var opacity = line_coverage(abs(in.across), in.half_width);
    if THROUGH_SURFACES {
        // So many blended over each other have the opacity HIDDEN.
        opacity *= 1.0 - pow(1.0 - HIDDEN, 1.0 / in.times);
    }
    return vec4<f32>(in.color, opacity);
}
