// Structs and helpers that passes share. src/gpu/layout.rs has the same structs, field by field; a test compares them.

// Settings and view of one tessellation.
struct Params {
    view: LodView,
    factor: f32,
    pixels_per_segment: f32,
    // As which patches are evaluated: flat if all of them are.
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
    // 1 if patches that face away from the eye are left out.
    culls_back: u32,
    convention: u32,
    // How strong Phong tessellation is, 0 to 1.
    alpha: f32,
    normals: u32,
    displacement: u32,
    // In object units: how far white is above black in images that don't say it.
    height_scale: f32,
    midlevel: f32,
    // That of parts which have none of their own.
    chosen_surface: u32,
}

// A value of Params.lod that no LOD has: the factors of every patch were given.
const LOD_GIVEN: u32 = 0xffffffffu;

// The most workgroups along one dimension that WebGPU allows.
const MOST_WORKGROUPS: u32 = 65535u;

// How many counters the searches of LOD by error have: see search_state.wgsl.
const SEARCH_COUNTERS: u32 = 10u;

// The run of patches that one scan covers, and how much fits the arena.
struct Slab {
    first_patch: u32,
    patch_count: u32,
    vertex_capacity: u32,
    triangle_capacity: u32,
    // What a chunk has at most where the slab doesn't fit the arena at once.
    chunk_vertices: u32,
    chunk_triangles: u32,
    chunk_capacity: u32,
    material_count: u32,
}

// An input triangle. Side k runs from corner k to corner k + 1.
struct Patch {
    points: array<u32, 3>,
    corners: array<u32, 3>,
    // For side k: twice the index of its curve, plus 1 if the side runs against its edge's direction.
    curves: array<u32, 3>,
    // For side k: 8 times the index of its factor, plus the kind of its edge.
    factors: array<u32, 3>,
}

struct Corner {
    normal: vec3<f32>,
    uv: vec2<f32>,
}

// What a corner has beside its shading attributes, for materials that need more.
struct CornerDetail {
    // The texture coordinates TEXCOORD_0 (xy) and TEXCOORD_1 (zw) of the file.
    uvs: vec4<f32>,
    // Linear RGBA that multiplies the base colour.
    color: vec4<f32>,
    // A unit vector, or zero if it isn't known; w is 1, or -1 where the bitangent is -cross(normal, tangent).
    tangent: vec4<f32>,
}

// A curve, which some or all sides of an edge share: its end points in the edge's direction, and its run of `curve_sides`.
struct Curve {
    points: array<u32, 2>,
    first_side: u32,
    side_count: u32,
}

// The two inner control points of a curve: the one near its start, and the one near its end.
struct CurveNet {
    ab: vec3<f32>,
    ba: vec3<f32>,
}

// Where a buffer of curve nets has room behind `ab`, it says what the parts beside the curve have of their own: the count of their detail
// (see patch_traits.wgsl), and so many times the number of their surface, from 1, or 0 for that of the settings.
const CURVE_SURFACE_STEP: u32 = 2048u;

// What patches share where they meet, so that displacement doesn't tear them apart. One buffer holds, one after another:
// - for each point, the direction in which it moves, the level at which its height is looked up, and its dominant corner;
// - for each factor's edge, the level and the dominant side;
// - for each corner, two elements whose directions are the gradients of its two texture coordinates;
struct Share {
    direction: vec3<f32>,
    level: f32,
    // 4 times a patch, plus which of its corners or sides.
    dominant: u32,
}

// What is known of the heights over a patch: see src/geometry/mesh/heights/relief.rs.
struct PatchRelief {
    form: vec3<f32>,
    // Negative where no image displaces the patch.
    longest: f32,
    range: f32,
    slope: f32,
    losses: array<vec2<f32>, 5>,
}

// The most height images that a mesh has.
const MAX_MAPS: u32 = 256u;

// One of the height images: width and height of its level 0 in px, its number of mip levels, and where its heights start
// among those of all images.
struct HeightMap {
    @align(16) size: vec2<u32>,
    levels: u32,
    start: u32,
    // What is beyond it, a WRAP: along u in the lowest two bits, along v in the next.
    wrap: u32,
    // 1 if it has a scale and a midlevel of its own, 0 if those of Params hold.
    has_amount: u32,
    scale: f32,
    midlevel: f32,
}

// A vertex as it is drawn: position, a normal packed in 32 bits, patch and domain coordinates packed in 64 (the key), and
// texture coordinates.
//
// The arena holds the first half (the place) of every vertex, and then the second half (the detail) of every vertex. So
// neighbouring invocations fill whole cache lines, where alternating halves take twice as long to store; and a draw that
// needs only places reads only places.
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

// Indirect arguments of the two dispatches that emit a chunk, and of the one that displaces it with one invocation a
// vertex.
struct EmitArgs {
    vertices: array<u32, 3>,
    triangles: array<u32, 3>,
    displaced: array<u32, 3>,
}

// Indirect arguments of the draw of one material's triangles of a chunk: for an indexed draw, and for one without an index
// buffer whose shader fetches (pulls) each corner's vertex itself.
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

// A key: u and v take 17 bits each, the patch the other 30.
fn pack_key(patch_index: u32, u: u32, v: u32) -> vec2<u32> {
    return vec2<u32>(u | (v << 17u), (v >> 15u) | (patch_index << 2u));
}

fn key_patch(key: vec2<u32>) -> u32 {
    return key.y >> 2u;
}

fn key_uv(key: vec2<u32>) -> vec2<u32> {
    return vec2<u32>(key.x & 0x1ffffu, (key.x >> 17u) | ((key.y & 3u) << 15u));
}

// Invocations of a workgroup of most passes.
const WORKGROUP: u32 = 256u;

// How many of a chunk's vertices (or triangles) each workgroup emits. Few enough that all processors of a GPU have work.
fn emit_items(count: u32) -> u32 {
    return select(2048u, 4096u, count >= 0x700000u);
}

// The workgroups along the first dimension of a grid. WebGPU allows 65,535 in each.
const GRID_WIDTH: u32 = 32768u;

// The workgroups in each dimension for so many invocations.
fn grid(items: u32) -> array<u32, 3> {
    return workgroup_grid((items + WORKGROUP - 1u) / WORKGROUP);
}

fn workgroup_grid(workgroups: u32) -> array<u32, 3> {
    let x = min(workgroups, GRID_WIDTH);
    return array<u32, 3>(x, (workgroups + GRID_WIDTH - 1u) / GRID_WIDTH, 1u);
}

// Where an invocation is in such a grid.
struct Invocation {
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
}

// Its index.
fn grid_index(own: Invocation) -> u32 {
    return (own.workgroup.y * own.workgroups.x + own.workgroup.x) * WORKGROUP + own.local;
}
