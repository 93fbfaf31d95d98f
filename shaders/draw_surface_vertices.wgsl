// The vertex shaders of surfaces with overlays: for emitted triangles, which are drawn indexed; or, where an overlay looks at whole
// triangles, without an index buffer, so that the shader fetches each corner itself and knows the barycentric coordinates.

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
    out.normal = normal;
    out.uv = uv;
    out.domain = vec3<f32>(f32(domain.x), f32(domain.y), f32(FIXED_ONE - domain.x - domain.y)) * UNIT;
    out.corner = corner;
    out.patch_index = patch_index;
    return out;
}

fn facing(a: vec3<f32>, b: vec3<f32>, c: vec3<f32>) -> vec3<f32> {
    return cross(b - a, c - a);
}

// As in src/inspect/measure/folds.rs, in f32.
fn is_folded(patch_index: u32, a: vec3<f32>, b: vec3<f32>, c: vec3<f32>) -> bool {
    let at = patches[patch_index].points;
    let patch_facing = facing(points[at[0]].xyz, points[at[1]].xyz, points[at[2]].xyz);
    let own = facing(a, b, c);
    let longest = max(max(distance(a, b), distance(b, c)), distance(c, a));
    return dot(own, patch_facing) < 0.0 && length(own) > 8.0 * frame.ulp * longest;
}

// Whether the triangle is already turned over in the patch's domain, so that the surface is not what turns it over.
fn runs_back(a: vec2<u32>, b: vec2<u32>, c: vec2<u32>) -> bool {
    let ab = vec2<f32>(vec2<i32>(b) - vec2<i32>(a));
    let ac = vec2<f32>(vec2<i32>(c) - vec2<i32>(a));
    return ab.x * ac.y - ab.y * ac.x <= 0.0;
}

fn drawn_vertex(index: u32) -> Vertex {
    let at = indices[index];
    return vertex_of(vertex_halves[at], vertex_halves[arrayLength(&vertex_halves) / 2u + at]);
}

fn vertex_position(index: u32) -> vec3<f32> {
    return bitcast<vec3<f32>>(vertex_halves[indices[index]].xyz);
}

fn vertex_domain(index: u32) -> vec2<u32> {
    let vertex = drawn_vertex(index);
    return key_uv(vec2<u32>(vertex.key0, vertex.key1));
}

fn factor_value(word: u32) -> f32 {
    return f32(word & FACTOR_VALUE) * UNIT;
}

fn with_factors(varyings: Varyings, patch_index: u32) -> Varyings {
    var out = varyings;
    if (frame.overlays & (OVERLAY_FACTORS | OVERLAY_LOW_FACTORS)) != 0u {
        let own = patch_factors[patch_index - slab.first_patch];
        for (var i = 0u; i < 3u; i++) {
            // Opposite side s is corner s + 2.
            out.factors[(domain_side(frame.convention, i) + 2u) % 3u] = factor_value(own.outside[i]);
        }
        out.factors.w = factor_value(own.inside);
        out.low = u32(patch_is_low(own));
    }
    if (frame.overlays & OVERLAY_EXCESS) != 0u && patch_index < arrayLength(&least_triangles) {
        let count = triangle_count(patch_factors[patch_index - slab.first_patch]);
        out.excess = f32(count) / f32(max(least_triangles[patch_index], 1u));
    }
    return out;
}

// As in src/inspect/measure/sizes.rs, in f32. The largest size if the triangle crosses the near plane.
fn size_px(a: vec3<f32>, b: vec3<f32>, c: vec3<f32>) -> f32 {
    let corners = array<vec3<f32>, 3>(a, b, c);
    var places: array<vec2<f32>, 3>;
    for (var k = 0u; k < 3u; k++) {
        let clip = frame.clip_from_object * vec4<f32>(corners[k], 1.0);
        if clip.w <= 0.0 || clip.z > clip.w {
            return frame.scale_most;
        }
        places[k] = clip.xy / clip.w * 0.5 * frame.viewport;
    }
    let ab = places[1] - places[0];
    let ac = places[2] - places[0];
    return sqrt(abs(ab.x * ac.y - ab.y * ac.x));
}

fn unit_corner(k: u32) -> vec3<f32> {
    return vec3<f32>(f32(k == 0u), f32(k == 1u), f32(k == 2u));
}

@vertex
fn indexed_vertex(vertex: EmittedVertex) -> Varyings {
    let patch_index = key_patch(vertex.key);
    let normal = unpack_normal(vertex.normal);
    let out = varyings(vertex.position, normal, vertex.uv, patch_index, key_uv(vertex.key), vec3<f32>(1.0));
    return with_factors(out, patch_index);
}

@vertex
fn pulled_vertex(@builtin(vertex_index) index: u32) -> Varyings {
    let vertex = drawn_vertex(index);
    let key = vec2<u32>(vertex.key0, vertex.key1);
    let position = vec3<f32>(vertex.x, vertex.y, vertex.z);
    let normal = unpack_normal(vertex.normal);
    var out = varyings(position, normal, vertex.uv, key_patch(key), key_uv(key), unit_corner(index % 3u));
    let first = index - index % 3u;
    out.triangle = index / 3u;
    if (frame.overlays & OVERLAY_FOLDS) != 0u {
        let back = runs_back(vertex_domain(first), vertex_domain(first + 1u), vertex_domain(first + 2u));
        let a = vertex_position(first);
        let opposes = is_folded(key_patch(key), a, vertex_position(first + 1u), vertex_position(first + 2u));
        out.folded = u32(opposes && !back);
    }
    if (frame.overlays & OVERLAY_TRIANGLE_SIZE) != 0u {
        out.size = size_px(vertex_position(first), vertex_position(first + 1u), vertex_position(first + 2u));
    }
    if LOOK == LOOK_TEXEL_DENSITY {
        let surface = facing(vertex_position(first), vertex_position(first + 1u), vertex_position(first + 2u));
        let uv = drawn_vertex(first).uv;
        let on_texture = spanned_area(drawn_vertex(first + 1u).uv - uv, drawn_vertex(first + 2u).uv - uv);
        out.size = on_texture / max(length(surface), 1e-37);
    }
    return with_factors(out, key_patch(key));
}
