// Draws patches: the emitted triangles (indexed, or pulled one corner at a time so that each knows its own
// barycentric coordinates), or the input triangles as they are.

@group(0) @binding(0) var<uniform> frame: Frame;
@group(0) @binding(1) var<storage, read> points: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> corners: array<Corner>;
@group(0) @binding(3) var<storage, read> patches: array<Patch>;
@group(0) @binding(4) var<storage, read> vertices: array<Vertex>;
@group(0) @binding(5) var<storage, read> indices: array<u32>;
@group(1) @binding(0) var<uniform> material: Material;
@group(1) @binding(1) var base_texture: texture_2d<f32>;
@group(1) @binding(2) var base_sampler: sampler;

struct Varyings {
    @builtin(position) clip: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>,
    // Domain coordinates in the patch.
    @location(3) domain: vec3<f32>,
    // Barycentric coordinates in the drawn triangle; all 1 where they are not known.
    @location(4) corner: vec3<f32>,
    @location(5) @interpolate(flat) edge_kinds: vec3<u32>,
    // 1 where the drawn triangle faces away from the side that its patch faces.
    @location(6) @interpolate(flat) folded: u32,
}

fn varyings(
    position: vec3<f32>,
    normal: vec3<f32>,
    uv: vec2<f32>,
    patch_index: u32,
    domain: vec2<u32>,
    corner: vec3<f32>,
) -> Varyings {
    var out: Varyings;
    out.clip = frame.clip_from_object * vec4<f32>(position, 1.0);
    out.position = position;
    out.normal = normal;
    out.uv = uv;
    out.domain = vec3<f32>(f32(domain.x), f32(domain.y), f32(FIXED_ONE - domain.x - domain.y)) * UNIT;
    out.corner = corner;
    if (frame.overlays & OVERLAY_ADJACENCY) != 0u {
        // Kind of the edge where u, v, w is 0: opposite corner 0, 1, 2, which is side 1, 2, 0.
        let sides = patches[patch_index].factors;
        out.edge_kinds = vec3<u32>(sides[1] & 7u, sides[2] & 7u, sides[0] & 7u);
    }
    return out;
}

fn facing(a: vec3<f32>, b: vec3<f32>, c: vec3<f32>) -> vec3<f32> {
    return cross(b - a, c - a);
}

// As in src/measure/folds.rs, in f32.
fn is_folded(patch_index: u32, a: vec3<f32>, b: vec3<f32>, c: vec3<f32>) -> bool {
    let at = patches[patch_index].points;
    let patch_facing = facing(points[at[0]].xyz, points[at[1]].xyz, points[at[2]].xyz);
    let own = facing(a, b, c);
    let longest = max(max(distance(a, b), distance(b, c)), distance(c, a));
    return dot(own, patch_facing) < 0.0 && length(own) > 8.0 * frame.ulp * longest;
}

// Whether the pattern runs back here, so that it is not the surface that turns this triangle over.
fn runs_back(a: vec2<u32>, b: vec2<u32>, c: vec2<u32>) -> bool {
    let ab = vec2<f32>(vec2<i32>(b) - vec2<i32>(a));
    let ac = vec2<f32>(vec2<i32>(c) - vec2<i32>(a));
    return ab.x * ac.y - ab.y * ac.x <= 0.0;
}

fn vertex_position(index: u32) -> vec3<f32> {
    let vertex = vertices[indices[index]];
    return vec3<f32>(vertex.x, vertex.y, vertex.z);
}

fn vertex_domain(index: u32) -> vec2<u32> {
    let vertex = vertices[indices[index]];
    return key_uv(vec2<u32>(vertex.key0, vertex.key1));
}

fn unit_corner(k: u32) -> vec3<f32> {
    return vec3<f32>(f32(k == 0u), f32(k == 1u), f32(k == 2u));
}

@vertex
fn indexed_vertex(
    @location(0) position: vec3<f32>,
    @location(1) key: vec2<u32>,
    @location(2) normal: u32,
    @location(3) uv: vec2<f32>,
) -> Varyings {
    return varyings(position, unpack_normal(normal), uv, key_patch(key), key_uv(key), vec3<f32>(1.0));
}

@vertex
fn pulled_vertex(@builtin(vertex_index) index: u32) -> Varyings {
    let vertex = vertices[indices[index]];
    let key = vec2<u32>(vertex.key0, vertex.key1);
    let position = vec3<f32>(vertex.x, vertex.y, vertex.z);
    let normal = unpack_normal(vertex.normal);
    var out = varyings(position, normal, vertex.uv, key_patch(key), key_uv(key), unit_corner(index % 3u));
    if (frame.overlays & OVERLAY_FOLDS) != 0u {
        let first = index - index % 3u;
        let back = runs_back(vertex_domain(first), vertex_domain(first + 1u), vertex_domain(first + 2u));
        let a = vertex_position(first);
        let opposes = is_folded(key_patch(key), a, vertex_position(first + 1u), vertex_position(first + 2u));
        out.folded = u32(opposes && !back);
    }
    return out;
}

@vertex
fn source_vertex(@builtin(vertex_index) index: u32) -> Varyings {
    let k = index % 3u;
    let corner = corners[patches[index / 3u].corners[k]];
    let position = points[patches[index / 3u].points[k]].xyz;
    let domain = vec2<u32>(select(0u, FIXED_ONE, k == 0u), select(0u, FIXED_ONE, k == 1u));
    return varyings(position, corner.normal, corner.uv, index / 3u, domain, unit_corner(k));
}

// As the window's legend has it: src/render/layout.rs.
const FOLD_COLOR: vec3<f32> = vec3<f32>(0.515, 0.061, 1.0);

// The same.
const BACK_FACE_COLOR: vec3<f32> = vec3<f32>(0.753, 0.013, 0.156);

// Colours of edge kinds, as the window's legend has them: src/render/layout.rs.
fn edge_color(kind: u32) -> vec3<f32> {
    var color = vec3<f32>(0.40, 0.43, 0.47);
    if kind == 1u {
        color = vec3<f32>(0.791, 0.347, 0.0);
    } else if kind == 2u {
        color = vec3<f32>(0.0, 0.342, 0.171);
    } else if kind == 3u {
        color = vec3<f32>(0.093, 0.456, 0.815);
    } else if kind == 4u {
        color = vec3<f32>(0.604, 0.191, 0.386);
    }
    return color;
}

// How far one has to go, in px, for each coordinate to change by 1: a triangle's heights.
fn heights(coordinates: vec3<f32>) -> vec3<f32> {
    let dx = dpdx(coordinates);
    let dy = dpdy(coordinates);
    return 1.0 / max(sqrt(dx * dx + dy * dy), vec3<f32>(1e-12));
}

// How much of a line `half_width` px to either side covers a pixel `distance` px away.
fn line_coverage(distance: f32, half_width: f32) -> f32 {
    return 1.0 - smoothstep(half_width - 0.5, half_width + 0.5, distance);
}

fn shade(base: vec3<f32>, normal: vec3<f32>, position: vec3<f32>) -> vec3<f32> {
    let to_eye = normalize(frame.eye.xyz - position * frame.eye.w);
    let key = max(dot(normal, frame.key_light.xyz), 0.0);
    let fill = 0.5 + 0.5 * dot(normal, frame.fill_light.xyz);
    let half_way = normalize(frame.key_light.xyz + to_eye);
    let gloss = pow(max(dot(normal, half_way), 0.0), 48.0) * 0.08;
    return base * (0.62 * key + 0.22 * fill + 0.04) + vec3<f32>(gloss);
}

@fragment
fn surface_fragment(in: Varyings, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    // Derivatives and samples first: both need uniform control flow.
    let to_edges = in.domain * heights(in.domain);
    let side_heights = heights(in.corner);
    let to_sides = in.corner * side_heights;
    let texel = textureSample(base_texture, base_sampler, in.uv);
    var base = material.base_color.rgb * texel.rgb;
    if (frame.overlays & OVERLAY_BARYCENTRIC) != 0u {
        base = clamp(in.domain, vec3<f32>(0.0), vec3<f32>(1.0));
    }
    if (frame.overlays & OVERLAY_BACK_FACES) != 0u && !front {
        base = BACK_FACE_COLOR;
    }
    let normal = normalize(select(-in.normal, in.normal, front));
    var color = shade(base, normal, in.position);
    if in.folded != 0u {
        // Unlit: folds mostly face away from the light.
        color = FOLD_COLOR;
    }
    if (frame.overlays & OVERLAY_WIREFRAME) != 0u {
        let nearest = min(min(to_sides.x, to_sides.y), to_sides.z);
        // Triangles of a px or two would be nothing but lines: those fade, and the surface stays readable.
        let height = max(max(side_heights.x, side_heights.y), side_heights.z);
        let strength = mix(0.25, 0.75, smoothstep(2.0, 10.0, height));
        color = mix(color, vec3<f32>(0.008, 0.010, 0.014), strength * line_coverage(nearest, 0.5));
    }
    let nearest_edge = min(min(to_edges.x, to_edges.y), to_edges.z);
    if (frame.overlays & OVERLAY_PATCHES) != 0u {
        color = mix(color, vec3<f32>(0.93, 0.94, 0.96), line_coverage(nearest_edge, 0.9));
    }
    if (frame.overlays & OVERLAY_ADJACENCY) != 0u {
        var kind = in.edge_kinds.z;
        if to_edges.x <= nearest_edge {
            kind = in.edge_kinds.x;
        } else if to_edges.y <= nearest_edge {
            kind = in.edge_kinds.y;
        }
        // Smooth edges are most of a mesh and least of its news.
        color = mix(color, edge_color(kind), line_coverage(nearest_edge, select(1.75, 0.75, kind == 0u)));
    }
    return vec4<f32>(color, 1.0);
}
