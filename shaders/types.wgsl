// What the passes share. Twin: src/gpu/layout.rs, field by field; a test compares sizes and offsets.

// Settings and view of one tessellation.
struct Params {
    view: LodView,
    factor: f32,
    pixels_per_segment: f32,
    surface: u32,
    partitioning: u32,
    lod: u32,
    clip: u32,
    point_count: u32,
    patch_count: u32,
    factor_count: u32,
    curve_count: u32,
    edges: u32,
    tolerance: f32,
    near: f32,
    far: f32,
    // 1 where patches that face away are left out.
    culls_back: u32,
    convention: u32,
    // How strong Phong tessellation is, 0 to 1.
    alpha: f32,
    normals: u32,
    displacement: u32,
    // Object units.
    height_scale: f32,
    midlevel: f32,
    // 1 where some edge's sides have different height images, and factors are by error: patches have factors of their own.
    mixed: u32,
}

// In place of a LOD: factors are given patch by patch.
const LOD_GIVEN: u32 = 5u;

// The run of patches that one scan covers, and what the arena holds.
struct Slab {
    first_patch: u32,
    patch_count: u32,
    vertex_capacity: u32,
    triangle_capacity: u32,
    chunk_capacity: u32,
    material_count: u32,
}

// An input triangle. Side k runs from corner k to corner k + 1.
struct Patch {
    points: array<u32, 3>,
    corners: array<u32, 3>,
    // Curve of side k, times 2, plus 1 where the side runs against its edge's direction.
    curves: array<u32, 3>,
    // Factor of side k, times 8, plus the kind of its edge.
    factors: array<u32, 3>,
}

struct Corner {
    normal: vec3<f32>,
    uv: vec2<f32>,
}

// What a set of an edge's sides share: end points in the edge's direction, and those sides.
struct Curve {
    points: array<u32, 2>,
    first_side: u32,
    side_count: u32,
}

// Control points of a curve: near its start and near its end.
struct CurveNet {
    ab: vec3<f32>,
    ba: vec3<f32>,
}

// What displacement shares. Of a point: the direction in which it moves, and the level of the height image; its dominant
// corner, as a patch times 4, plus which of its corners. Of a factor's edge, behind the points: the level, and its dominant
// side likewise, and one of its sides' images. Of a corner, behind the factors: how its texture coordinates change, one
// after the other, as directions. Behind the corners: further images of edges' sides.
struct Share {
    direction: vec3<f32>,
    level: f32,
    dominant: u32,
    // How long the edge is at most in a height image, in px of level 0; that image, 1 for the first, 0 for none; and where
    // the next of its sides' images stands here, 0 for nowhere.
    texels: f32,
    map: u32,
    next: u32,
}

// The most mip levels that a height image has.
const MAX_LEVELS: u32 = 13u;

// The most height images that a mesh has.
const MAX_MAPS: u32 = 256u;

// One of the height images: width and height of level 0 in px, and where it starts among all heights.
struct HeightMap {
    @align(16) size: vec2<u32>,
    levels: u32,
    start: u32,
    // 1 where it starts again where it ends.
    repeats: u32,
}

// A vertex as it is drawn: position, normal packed in 32 bits, patch and domain coordinates packed in 64, uv.
//
// The arena holds the first half of every vertex, its place, and behind them all the second of every vertex, its detail:
// invocations side by side then fill whole lines of memory (where halves take turns, storing takes twice as long), and who
// needs no more than places reads no more.
struct Vertex {
    x: f32,
    y: f32,
    z: f32,
    normal: u32,
    key0: u32,
    key1: u32,
    uv: vec2<f32>,
}

fn vertex_of(place: vec4<u32>, detail: vec4<u32>) -> Vertex {
    let position = bitcast<vec3<f32>>(place.xyz);
    return Vertex(position.x, position.y, position.z, place.w, detail.x, detail.y, bitcast<vec2<f32>>(detail.zw));
}

fn vertex_place(position: vec3<f32>, normal: u32) -> vec4<u32> {
    return vec4<u32>(bitcast<vec3<u32>>(position), normal);
}

fn vertex_detail(key: vec2<u32>, uv: vec2<f32>) -> vec4<u32> {
    return vec4<u32>(key, bitcast<vec2<u32>>(uv));
}

// Patches that go through the arena together. `first_vertex` and `first_triangle` count from the slab's start.
struct Chunk {
    first_patch: u32,
    patch_end: u32,
    first_vertex: u32,
    first_triangle: u32,
    vertex_count: u32,
    triangle_count: u32,
}

// Indirect arguments of a chunk's two emit dispatches, and of displacement, which takes a vertex an invocation.
struct EmitArgs {
    vertices: array<u32, 3>,
    triangles: array<u32, 3>,
    displaced: array<u32, 3>,
}

// Indirect arguments of one material's draw within a chunk: indexed, and by pulling vertices one corner at a time.
struct DrawArgs {
    index_count: u32,
    instance_count: u32,
    first_index: u32,
    base_vertex: i32,
    first_instance: u32,
    pull_vertex_count: u32,
    pull_instance_count: u32,
    pull_first_vertex: u32,
    pull_first_instance: u32,
}

// Whether what an edge's sides agree on is computed by the edge, or by every patch for itself.
const EDGES_PER_EDGE: u32 = 0u;
const EDGES_AS_PUBLISHED: u32 = 1u;

// U and V need 17 bits each; the patch gets the other 30.
fn pack_key(patch_index: u32, u: u32, v: u32) -> vec2<u32> {
    return vec2<u32>(u | (v << 17u), (v >> 15u) | (patch_index << 2u));
}

fn key_patch(key: vec2<u32>) -> u32 {
    return key.y >> 2u;
}

fn key_uv(key: vec2<u32>) -> vec2<u32> {
    return vec2<u32>(key.x & 0x1ffffu, (key.x >> 17u) | ((key.y & 3u) << 15u));
}

const WORKGROUP: u32 = 256u;

// Of so many vertices, or triangles, those that a workgroup of emission makes: as many as leave work for every processor.
fn emit_items(count: u32) -> u32 {
    return select(2048u, 4096u, count >= 0x700000u);
}

// The workgroups along the first dimension of a grid. WebGPU allows 65,535 in each.
const GRID_WIDTH: u32 = 32768u;

// Work of any size as a grid within 65,535 workgroups a dimension; the index of an invocation in such a grid.
fn grid(items: u32) -> array<u32, 3> {
    return workgroup_grid((items + WORKGROUP - 1u) / WORKGROUP);
}

fn workgroup_grid(workgroups: u32) -> array<u32, 3> {
    let x = min(workgroups, GRID_WIDTH);
    return array<u32, 3>(x, (workgroups + GRID_WIDTH - 1u) / GRID_WIDTH, 1u);
}

fn grid_index(workgroup: vec3<u32>, workgroups: vec3<u32>, local: u32) -> u32 {
    return (workgroup.y * workgroups.x + workgroup.x) * WORKGROUP + local;
}
