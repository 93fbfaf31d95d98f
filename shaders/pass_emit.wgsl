// The domain shader and the tessellator's output of one chunk. A workgroup makes EMIT_ITEMS vertices, or triangles, that
// follow each other, and each of its invocations several: finding out once which patches they are of is then little work.

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<uniform> slab: Slab;
@group(0) @binding(2) var<storage, read> chunks: array<Chunk>;
@group(0) @binding(3) var<storage, read> offsets: array<vec2<u32>>;
@group(0) @binding(4) var<storage, read> patch_factors: array<PatchFactors>;
@group(0) @binding(5) var<storage, read> points: array<vec4<f32>>;
// Patches, curve nets and corners, 16 bytes at a time: every vertex reads some, and a word at a time that takes longer.
@group(0) @binding(6) var<storage, read> patch_words: array<vec4<u32>>;
@group(0) @binding(7) var<storage, read> curve_net_words: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read> corner_words: array<vec4<f32>>;
// All vertices' places, then all their details: see Vertex.
@group(0) @binding(9) var<storage, read_write> vertex_halves: array<vec4<u32>>;
@group(0) @binding(10) var<storage, read_write> indices: array<u32>;
// Which points triangles join: see patterns.wgsl.
@group(0) @binding(11) var<storage, read> patterns: array<u32>;
@group(1) @binding(0) var<uniform> chunk_index: u32;

// Normals that vertices get, NORMALS_*: a pipeline each, in which what the others need takes no registers.
override EMIT_NORMALS: u32 = 0u;

const NO_PATCH: u32 = 0xffffffffu;
// Invocations of a workgroup. Those that make vertices keep control nets, and have the longer runs for it.
const VERTEX_WORKGROUP: u32 = 128u;
const TRIANGLE_WORKGROUP: u32 = 256u;
// Invocations that run in step on most devices: these have items side by side, and mostly of one patch.
const LANES: u32 = 32u;

fn emit_first(workgroup: vec3<u32>, workgroups: vec3<u32>) -> u32 {
    return (workgroup.y * workgroups.x + workgroup.x) * EMIT_ITEMS;
}

// The first item, from the workgroup's first on, of the `turns` that invocation `local` and those beside it make together.
fn emit_start(local: u32, turns: u32) -> u32 {
    return (local / LANES) * (LANES * turns);
}

// Entry of `offsets` (from the slab's start) whose patch emits item `item`, in [low, high). Component 0 counts
// vertices, 1 triangles. Patches that emit nothing are skipped.
fn find_patch(component: u32, item: u32, first: u32, end: u32) -> u32 {
    var low = first;
    var high = end;
    while low + 1u < high {
        let middle = (low + high) / 2u;
        if offsets[middle][component] <= item {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

// The patches whose items a workgroup makes: the first, and how many begin after its first item.
struct PatchRun {
    first: u32,
    count: u32,
}

var<workgroup> run_first: u32;
var<workgroup> run_count: u32;
var<workgroup> run_is_whole: u32;
// Where the patches after the first begin.
var<workgroup> run_starts: array<u32, EMIT_ITEMS>;

// All `width` invocations look for the first item's patch together: each round leaves one part of so many.
fn find_run(component: u32, first_item: u32, last_item: u32, local: u32, width: u32) -> PatchRun {
    let chunk = chunks[chunk_index];
    let end = chunk.patch_end - slab.first_patch;
    var low = chunk.first_patch - slab.first_patch;
    var high = end;
    while low + 1u < high {
        let stride = (high - low + width - 1u) / width;
        let at = low + local * stride;
        let next = at + stride;
        if at < high && offsets[at][component] <= first_item && (next >= high || offsets[next][component] > first_item) {
            run_first = at;
        }
        low = workgroupUniformLoad(&run_first);
        high = min(low + stride, high);
    }
    if local == 0u {
        run_count = 0u;
    }
    workgroupBarrier();
    // Mostly one round finds them all.
    for (var filled = 0u; filled < EMIT_ITEMS; filled += width) {
        let i = filled + local;
        let entry = low + 1u + i;
        let start = offsets[min(entry, end)][component];
        run_starts[i] = start;
        let is_last = i == EMIT_ITEMS - 1u || entry + 1u >= end || offsets[min(entry + 1u, end)][component] > last_item;
        if entry < end && start <= last_item && is_last {
            run_count = i + 1u;
        }
        if local == width - 1u {
            run_is_whole = u32(entry >= end || start > last_item);
        }
        if workgroupUniformLoad(&run_is_whole) == 1u {
            break;
        }
    }
    return PatchRun(low, workgroupUniformLoad(&run_count));
}

// Whether a run's patches have so many items each that 32 invocations are worth one patch at a time. They then read it
// once, and take one path all.
fn is_of_large_patches(run: PatchRun) -> bool {
    return run.count < EMIT_ITEMS / (2u * LANES);
}

// Of the run's patches, counted from its first, the one whose item this is; `before` is that of an earlier item.
fn run_patch(run: PatchRun, component: u32, item: u32, before: u32) -> u32 {
    var patch_index = before;
    while patch_index < run.count && run_starts[patch_index] <= item {
        patch_index += 1u;
    }
    if patch_index < EMIT_ITEMS {
        return patch_index;
    }
    // So many begin here only where most are empty.
    let chunk = chunks[chunk_index];
    return find_patch(component, item, run.first + EMIT_ITEMS, chunk.patch_end - slab.first_patch) - run.first;
}

fn patch_at(index: u32) -> Patch {
    let a = patch_words[3u * index];
    let b = patch_words[3u * index + 1u];
    let c = patch_words[3u * index + 2u];
    return Patch(
        array<u32, 3>(a.x, a.y, a.z),
        array<u32, 3>(a.w, b.x, b.y),
        array<u32, 3>(b.z, b.w, c.x),
        array<u32, 3>(c.y, c.z, c.w),
    );
}

fn curve_net_at(index: u32) -> CurveNet {
    return CurveNet(curve_net_words[2u * index].xyz, curve_net_words[2u * index + 1u].xyz);
}

fn corner_at(index: u32) -> Corner {
    return Corner(corner_words[2u * index].xyz, corner_words[2u * index + 1u].xy);
}

// An array that is indexed by what only runs know lives in memory; three values needn't.
fn of_three(values: array<u32, 3>, k: u32) -> u32 {
    return select(select(values[0], values[1], k == 1u), values[2], k == 2u);
}

// What the domain shader makes of one domain point.
struct DomainVertex {
    position: vec3<f32>,
    normal: vec3<f32>,
    uv: vec2<f32>,
}

// Computed in the edge's own direction.
fn rim_vertex(patch_index: u32, side: u32, side_t: u32) -> DomainVertex {
    let own = patch_at(patch_index);
    let curve = of_three(own.curves, side);
    let reversed = (curve & 1u) == 1u;
    let next = (side + 1u) % 3u;
    let start = select(side, next, reversed);
    let end = select(next, side, reversed);
    let t = select(side_t, FIXED_ONE - side_t, reversed);
    let a = points[of_three(own.points, start)].xyz;
    let b = points[of_three(own.points, end)].xyz;
    let at_a = corner_at(of_three(own.corners, start));
    let at_b = corner_at(of_three(own.corners, end));
    let net = curve_net_at(curve >> 1u);
    var position = edge_position(params.surface, a, net.ab, net.ba, b, t);
    if t == 0u {
        position = a;
    }
    if t == FIXED_ONE {
        position = b;
    }
    var normal: vec3<f32>;
    if EMIT_NORMALS == NORMALS_QUADRATIC {
        normal = quadratic_edge_normal(a, b, at_a.normal, at_b.normal, t);
    } else {
        normal = edge_normal(at_a.normal, at_b.normal, t);
    }
    return DomainVertex(position, normal, edge_uv(at_a.uv, at_b.uv, t));
}

// What the domain shader reads of a patch.
struct HullPatch {
    net: ControlNet,
    normals: array<vec3<f32>, 3>,
    uvs: array<vec2<f32>, 3>,
}

fn load_hull(patch_index: u32) -> HullPatch {
    let own = patch_at(patch_index);
    let a = corner_at(own.corners[0]);
    let b = corner_at(own.corners[1]);
    let c = corner_at(own.corners[2]);
    let normals = array<vec3<f32>, 3>(a.normal, b.normal, c.normal);
    return HullPatch(load_net(patch_index), normals, array<vec2<f32>, 3>(a.uv, b.uv, c.uv));
}

fn patch_vertex(hull: HullPatch, u: u32, v: u32) -> DomainVertex {
    var normal: vec3<f32>;
    if EMIT_NORMALS == NORMALS_QUADRATIC {
        normal = quadratic_normal(hull.net.corners, hull.normals, u, v);
    } else {
        normal = linear_normal(hull.normals, u, v);
    }
    return DomainVertex(patch_position(params.surface, hull.net, u, v), normal, linear_uv(hull.uvs, u, v));
}

fn store_vertex(index: u32, patch_index: u32, hull: HullPatch, uv: vec2<u32>) {
    let at = place(uv.x, uv.y);
    var made: DomainVertex;
    if at.side == 3u || params.edges == EDGES_AS_PUBLISHED {
        made = patch_vertex(hull, uv.x, uv.y);
    } else {
        made = rim_vertex(patch_index, at.side, at.t);
    }
    if EMIT_NORMALS == NORMALS_SURFACE {
        // Every patch's own, also on its rim, where its neighbours' differ.
        made.normal = surface_normal(params.surface, hull.net, uv.x, uv.y, made.normal);
    }
    let key = pack_key(patch_index, uv.x, uv.y);
    vertex_halves[index] = vertex_place(made.position, pack_normal(made.normal));
    vertex_halves[arrayLength(&vertex_halves) / 2u + index] = vertex_detail(key, made.uv);
}

// Vertices `first` to `end` of a patch, whose first is `start`, in turns of all lanes.
fn emit_patch_vertices(plan: DomainPlan, hull: HullPatch, patch_index: u32, start: u32, first: u32, end: u32) {
    for (var index = first; index < end; index += LANES) {
        let uv = corner_weights(params.convention, domain_point(plan, index - start));
        store_vertex(index, patch_index, hull, uv);
    }
}

@compute @workgroup_size(VERTEX_WORKGROUP)
fn emit_vertices_main(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let chunk = chunks[chunk_index];
    let first = emit_first(workgroup, workgroups);
    let last = chunk.first_vertex + min(first + EMIT_ITEMS, chunk.vertex_count) - 1u;
    let run = find_run(0u, chunk.first_vertex + first, last, local, VERTEX_WORKGROUP);
    if is_of_large_patches(run) {
        vertices_by_patch(chunk, run, first, local);
    } else {
        vertices_by_item(chunk, run, first, local);
    }
}

fn vertices_by_patch(chunk: Chunk, run: PatchRun, first: u32, local: u32) {
    let turns = EMIT_ITEMS / VERTEX_WORKGROUP;
    var at = first + emit_start(local, turns);
    let end = min(at + LANES * turns, chunk.vertex_count);
    var in_run = run_patch(run, 0u, chunk.first_vertex + at, 0u);
    while at < end {
        let entry = run.first + in_run;
        let patch_index = slab.first_patch + entry;
        // Where the patch starts and ends, in the chunk: its start may lie before it.
        let start = offsets[entry].x - chunk.first_vertex;
        let factors = patch_factors[entry];
        let plan = domain_plan(factors);
        let stop = min(start + point_count(factors), end);
        let hull = load_hull(patch_index);
        // The outline first, and then the inside, which takes another path.
        let inside = clamp(start + plan.outer, at, stop);
        emit_patch_vertices(plan, hull, patch_index, start, at + local % LANES, inside);
        emit_patch_vertices(plan, hull, patch_index, start, inside + local % LANES, stop);
        at = stop;
        in_run += 1u;
    }
}

fn vertices_by_item(chunk: Chunk, run: PatchRun, first: u32, local: u32) {
    var known = NO_PATCH;
    var in_run = 0u;
    var start = 0u;
    var plan: DomainPlan;
    let turns = EMIT_ITEMS / VERTEX_WORKGROUP;
    for (var turn = 0u; turn < turns; turn++) {
        let index = first + emit_start(local, turns) + turn * LANES + local % LANES;
        if index >= chunk.vertex_count {
            return;
        }
        let item = chunk.first_vertex + index;
        in_run = run_patch(run, 0u, item, in_run);
        let entry = run.first + in_run;
        if entry != known {
            known = entry;
            start = offsets[entry].x;
            plan = domain_plan(patch_factors[entry]);
        }
        let uv = corner_weights(params.convention, domain_point(plan, item - start));
        let patch_index = slab.first_patch + entry;
        store_vertex(index, patch_index, load_hull(patch_index), uv);
    }
}

fn store_triangle(index: u32, corners: vec3<u32>) {
    indices[3u * index] = corners.x;
    indices[3u * index + 1u] = corners.y;
    indices[3u * index + 2u] = corners.z;
}

// Triangles `first` to `end` of a patch, whose first is `start` and whose vertices start at `base`, in turns of all lanes.
fn emit_patch_triangles(plan: DomainPlan, base: u32, start: u32, first: u32, end: u32) {
    for (var index = first; index < end; index += LANES) {
        store_triangle(index, base + domain_triangle(plan, index - start));
    }
}

@compute @workgroup_size(TRIANGLE_WORKGROUP)
fn emit_triangles_main(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let chunk = chunks[chunk_index];
    let first = emit_first(workgroup, workgroups);
    let last = chunk.first_triangle + min(first + EMIT_ITEMS, chunk.triangle_count) - 1u;
    let run = find_run(1u, chunk.first_triangle + first, last, local, TRIANGLE_WORKGROUP);
    if is_of_large_patches(run) {
        triangles_by_patch(chunk, run, first, local);
    } else {
        triangles_by_item(chunk, run, first, local);
    }
}

fn triangles_by_patch(chunk: Chunk, run: PatchRun, first: u32, local: u32) {
    let turns = EMIT_ITEMS / TRIANGLE_WORKGROUP;
    var at = first + emit_start(local, turns);
    let end = min(at + LANES * turns, chunk.triangle_count);
    var in_run = run_patch(run, 1u, chunk.first_triangle + at, 0u);
    while at < end {
        let entry = run.first + in_run;
        let starts = offsets[entry] - vec2<u32>(chunk.first_vertex, chunk.first_triangle);
        let factors = patch_factors[entry];
        let plan = domain_plan(factors);
        let stop = min(starts.y + triangle_count(factors), end);
        // Those at the outline first, and then the others, which take another path.
        let inside = clamp(starts.y + plan.outer + 3u * (plan.n - 2u), at, stop);
        emit_patch_triangles(plan, starts.x, starts.y, at + local % LANES, inside);
        emit_patch_triangles(plan, starts.x, starts.y, inside + local % LANES, stop);
        at = stop;
        in_run += 1u;
    }
}

fn triangles_by_item(chunk: Chunk, run: PatchRun, first: u32, local: u32) {
    var known = NO_PATCH;
    var in_run = 0u;
    var start = vec2<u32>(0u);
    var plan: DomainPlan;
    let turns = EMIT_ITEMS / TRIANGLE_WORKGROUP;
    for (var turn = 0u; turn < turns; turn++) {
        let index = first + emit_start(local, turns) + turn * LANES + local % LANES;
        if index >= chunk.triangle_count {
            return;
        }
        let item = chunk.first_triangle + index;
        in_run = run_patch(run, 1u, item, in_run);
        let entry = run.first + in_run;
        if entry != known {
            known = entry;
            start = offsets[entry];
            plan = domain_plan(patch_factors[entry]);
        }
        store_triangle(index, start.x - chunk.first_vertex + domain_triangle(plan, item - start.y));
    }
}
