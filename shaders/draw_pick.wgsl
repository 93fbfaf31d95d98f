// Finds what is in front at one pixel. The render target is that pixel alone.

@group(0) @binding(0) var<uniform> pixel_from_object: mat4x4<f32>;
@group(0) @binding(1) var<storage, read> points: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> patches: array<Patch>;
@group(0) @binding(3) var<storage, read> vertex_halves: array<vec4<u32>>;
@group(0) @binding(4) var<storage, read> indices: array<u32>;
@group(0) @binding(5) var drawn: texture_2d<u32>;
@group(0) @binding(6) var<storage, read_write> pick: Pick;

struct PickVaryings {
    @builtin(position) clip: vec4<f32>,
    @location(0) weights: vec3<f32>,
    // Number of the emitted triangle in its chunk, or of the patch.
    @location(1) @interpolate(flat) number: u32,
}

fn drawn_vertex(index: u32) -> Vertex {
    let at = indices[index];
    return vertex_of(vertex_halves[at], vertex_halves[arrayLength(&vertex_halves) / 2u + at]);
}

fn weights_of(uv: vec2<u32>) -> vec3<f32> {
    return vec3<f32>(f32(uv.x), f32(uv.y), f32(FIXED_ONE - uv.x - uv.y)) * UNIT;
}

@vertex
fn pick_emitted_vertex(@builtin(vertex_index) index: u32) -> PickVaryings {
    let vertex = drawn_vertex(index);
    let clip = pixel_from_object * vec4<f32>(vertex.x, vertex.y, vertex.z, 1.0);
    return PickVaryings(clip, weights_of(key_uv(vec2<u32>(vertex.key0, vertex.key1))), index / 3u);
}

@vertex
fn pick_source_vertex(@builtin(vertex_index) index: u32) -> PickVaryings {
    let k = index % 3u;
    let clip = pixel_from_object * vec4<f32>(points[patches[index / 3u].points[k]].xyz, 1.0);
    return PickVaryings(clip, vec3<f32>(f32(k == 0u), f32(k == 1u), f32(k == 2u)), index / 3u);
}

// 1 plus the number (so that 0 means nothing), and the weight (0 u, 1 v, 2 w) that is the fewest px from 0.
@fragment
fn pick_fragment(in: PickVaryings) -> @location(0) vec4<u32> {
    let dx = dpdx(in.weights);
    let dy = dpdy(in.weights);
    let px = in.weights / max(sqrt(dx * dx + dy * dy), vec3<f32>(1e-12));
    var nearest = 0u;
    if px.y < px.x {
        nearest = 1u;
    }
    if px.z < min(px.x, px.y) {
        nearest = 2u;
    }
    return vec4<u32>(1u + in.number, nearest, 0u, 0u);
}

fn triangle_patch(triangle: u32) -> u32 {
    let vertex = drawn_vertex(3u * triangle);
    return key_patch(vec2<u32>(vertex.key0, vertex.key1));
}

// The first triangle of the patch that `triangle` belongs to: a chunk holds whole patches, in order.
fn first_triangle(triangle: u32) -> u32 {
    let patch_index = triangle_patch(triangle);
    var low = 0u;
    var high = triangle;
    while low < high {
        let middle = (low + high) / 2u;
        if triangle_patch(middle) < patch_index {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    return low;
}

// Takes the result of drawing a chunk, while the arena still holds that chunk. A nearer result of a later chunk replaces
// it.
@compute @workgroup_size(1)
fn pick_emitted_main() {
    let found = textureLoad(drawn, vec2<u32>(0u), 0);
    if found.x == 0u {
        return;
    }
    let triangle = found.x - 1u;
    for (var corner = 0u; corner < 3u; corner++) {
        pick.vertices[corner] = drawn_vertex(3u * triangle + corner);
    }
    pick.found = FOUND_EMITTED;
    pick.patch_index = triangle_patch(triangle);
    pick.triangle = triangle - first_triangle(triangle);
    pick.weight = found.y;
}

@compute @workgroup_size(1)
fn pick_source_main() {
    let found = textureLoad(drawn, vec2<u32>(0u), 0);
    if found.x == 0u {
        return;
    }
    pick.found = FOUND_SOURCE;
    pick.patch_index = found.x - 1u;
    pick.weight = found.y;
}
