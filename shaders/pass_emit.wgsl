// The vertices and triangles of one chunk: what the tessellator and the domain shader would output. Each workgroup makes
// thousands of consecutive vertices (or triangles) and each invocation several, so that finding their patches is little
// work.
// With: connectivity_table

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<uniform> slab: Slab;
@group(0) @binding(2) var<storage, read> chunks: array<Chunk>;
@group(0) @binding(3) var<storage, read> offsets: array<vec2<u32>>;
@group(0) @binding(4) var<storage, read> patch_factors: array<PatchFactors>;
@group(0) @binding(5) var<storage, read> points: array<vec4<f32>>;
// Patches, curve nets and corners as vectors: every vertex reads some, and reading 16 bytes at a time is faster.
@group(0) @binding(6) var<storage, read> patch_words: array<vec4<u32>>;
@group(0) @binding(7) var<storage, read> curve_net_words: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read> corner_words: array<vec4<f32>>;
// All vertices' places, then all their details: see Vertex.
@group(0) @binding(9) var<storage, read_write> vertex_halves: array<vec4<u32>>;
@group(0) @binding(10) var<storage, read_write> indices: array<u32>;
// Which points triangles join: see connectivity_table.wgsl.
@group(0) @binding(11) var<storage, read> connectivity_table: array<u32>;
@group(1) @binding(0) var<uniform> chunk_index: u32;

// How normals are made, NORMALS_*. Each way has a pipeline of its own, without the registers that the others need.
override EMIT_NORMALS: u32 = 0u;
// 1 if all patches are cut into rows. The pipelines for rows prepare them once a patch, and the others are without them.
override EMIT_ROWS: u32 = 0u;

const NO_PATCH: u32 = 0xffffffffu;
// Invocations of a workgroup. Vertices have fewer, each with more to do, since loading a control net takes long.
const VERTEX_WORKGROUP: u32 = 128u;
const TRIANGLE_WORKGROUP: u32 = 256u;
// Invocations that run in lockstep on most GPUs. They work on neighbouring items, which are mostly of one patch.
const LANES: u32 = 32u;

fn emit_first(workgroup: vec3<u32>, workgroups: vec3<u32>, items: u32) -> u32 {
    return (workgroup.y * workgroups.x + workgroup.x) * items;
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

// The same, from an earlier item's entry on: in steps that double until they are too far (Bentley and Yao 1976).
fn later_patch(component: u32, item: u32, before: u32, end: u32) -> u32 {
    var low = before;
    var stride = 1u;
    while low + stride < end && offsets[low + stride][component] <= item {
        low += stride;
        stride *= 2u;
    }
    return find_patch(component, item, low, min(low + stride, end));
}

var<workgroup> first_found: u32;

// The same of a workgroup's first item, for which all its `width` invocations look together: each round leaves one part of
// so many.
fn find_together(component: u32, item: u32, first: u32, end: u32, local: u32, width: u32) -> u32 {
    var low = first;
    var high = end;
    while low + 1u < high {
        let stride = (high - low + width - 1u) / width;
        let at = low + local * stride;
        let next = at + stride;
        if at < high && offsets[at][component] <= item && (next >= high || offsets[next][component] > item) {
            first_found = at;
        }
        low = workgroupUniformLoad(&first_found);
        high = min(low + stride, high);
    }
    return low;
}

// Whether the patches of `items` items, of which the last is `last`, have so many each that 32 invocations are worth one
// patch at a time. They then read it once, and take one path all.
fn is_of_large_patches(component: u32, items: u32, last: u32, first: u32, end: u32) -> bool {
    let few = first + items / (2u * LANES);
    return few >= end || offsets[few][component] > last;
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

// values[k]. Compilers put an array that is indexed dynamically in memory; selecting keeps three values in registers.
fn of_three(values: array<u32, 3>, k: u32) -> u32 {
    return select(select(values[0], values[1], k == 1u), values[2], k == 2u);
}

// A patch's pattern, prepared for `emit_point` and `emit_triangle`.
struct EmitPlan {
    domain: DomainPlan,
    // All zeros if patches aren't cut into rows.
    rows: NumberedRows,
}

fn emit_plan(factors: PatchFactors) -> EmitPlan {
    var rows: NumberedRows;
    if EMIT_ROWS == 1u {
        rows = numbered_rows(factors);
    }
    return EmitPlan(domain_plan(factors), rows);
}

// The numbers of points and of triangles of a patch, which its rows know already.
fn emit_counts(plan: EmitPlan, factors: PatchFactors) -> vec2<u32> {
    if EMIT_ROWS == 0u {
        return vec2<u32>(point_count(factors), triangle_count(factors));
    }
    let outer = plan.domain.outer;
    let inside = plan.rows.inside;
    // By Euler's formula.
    return select(vec2<u32>(outer + inside, outer + 2u * inside - 2u), vec2<u32>(0u), patch_is_culled(factors));
}

fn emit_point(plan: EmitPlan, i: u32) -> vec2<u32> {
    if EMIT_ROWS == 0u {
        return domain_point(plan.domain, i);
    }
    if i < plan.domain.outer {
        return outer_point(plan.domain, i);
    }
    return row_point(plan.rows, i - plan.domain.outer);
}

fn emit_triangle(plan: EmitPlan, t: u32) -> vec3<u32> {
    if EMIT_ROWS == 1u {
        return row_triangle(plan.rows, t);
    }
    return domain_triangle(plan.domain, t);
}

// What the domain shader makes of one domain point.
struct DomainVertex {
    position: vec3<f32>,
    normal: vec3<f32>,
    uv: vec2<f32>,
}

// A vertex on a side, computed in the direction of the edge, so that both patches at the edge compute the same.
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
    let at = outline_place(uv.x, uv.y);
    var made: DomainVertex;
    if at.side == 3u || params.edges == EDGES_AS_PUBLISHED {
        made = patch_vertex(hull, uv.x, uv.y);
    } else {
        made = rim_vertex(patch_index, at.side, at.t);
    }
    if EMIT_NORMALS == NORMALS_SURFACE {
        // Each patch's own normal, also on its sides, where neighbours have other normals.
        made.normal = surface_normal(params.surface, hull.net, uv.x, uv.y, made.normal);
    }
    let key = pack_key(patch_index, uv.x, uv.y);
    vertex_halves[index] = vertex_place(made.position, pack_normal(made.normal));
    vertex_halves[arrayLength(&vertex_halves) / 2u + index] = vertex_detail(key, made.uv);
}

// Emits vertices `first`, `first + LANES` and so on up to `end` of the patch whose first vertex is `start`.
fn emit_patch_vertices(plan: EmitPlan, hull: HullPatch, patch_index: u32, start: u32, first: u32, end: u32) {
    for (var index = first; index < end; index += LANES) {
        let uv = corner_weights(params.convention, emit_point(plan, index - start));
        store_vertex(index, patch_index, hull, uv);
    }
}

@compute @workgroup_size(VERTEX_WORKGROUP)
fn emit_vertices_main(invocation: Invocation) {
    let chunk = chunks[chunk_index];
    let items = emit_items(chunk.vertex_count);
    let first = emit_first(invocation.workgroup, invocation.workgroups, items);
    let last = chunk.first_vertex + min(first + items, chunk.vertex_count) - 1u;
    let begin = chunk.first_patch - slab.first_patch;
    let end = chunk.patch_end - slab.first_patch;
    let entry = find_together(0u, chunk.first_vertex + first, begin, end, invocation.local, VERTEX_WORKGROUP);
    let turns = items / VERTEX_WORKGROUP;
    if is_of_large_patches(0u, items, last, entry, end) {
        vertices_by_patch(chunk, entry, first, turns, invocation.local);
    } else {
        vertices_by_item(chunk, entry, first, turns, invocation.local);
    }
}

// The workgroup's vertices from `first` on, whose patch is at `first_entry`: all lanes work on one patch at a time.
fn vertices_by_patch(chunk: Chunk, first_entry: u32, first: u32, turns: u32, local: u32) {
    var at = first + emit_start(local, turns);
    let end = min(at + LANES * turns, chunk.vertex_count);
    var entry = later_patch(0u, chunk.first_vertex + at, first_entry, chunk.patch_end - slab.first_patch);
    while at < end {
        let patch_index = slab.first_patch + entry;
        // Where the patch starts and ends, in the chunk: its start may lie before it.
        let start = offsets[entry].x - chunk.first_vertex;
        let factors = patch_factors[entry];
        let plan = emit_plan(factors);
        let stop = min(start + emit_counts(plan, factors).x, end);
        let hull = load_hull(patch_index);
        // The outline first, then the inside: each takes another path through emit_point.
        let inside = clamp(start + plan.domain.outer, at, stop);
        emit_patch_vertices(plan, hull, patch_index, start, at + local % LANES, inside);
        emit_patch_vertices(plan, hull, patch_index, start, inside + local % LANES, stop);
        at = stop;
        entry += 1u;
    }
}

// The same, with each invocation finding the patch of its own vertex.
fn vertices_by_item(chunk: Chunk, first_entry: u32, first: u32, turns: u32, local: u32) {
    var known = NO_PATCH;
    var entry = first_entry;
    var start = 0u;
    var plan: EmitPlan;
    for (var turn = 0u; turn < turns; turn++) {
        let index = first + emit_start(local, turns) + turn * LANES + local % LANES;
        if index >= chunk.vertex_count {
            return;
        }
        let item = chunk.first_vertex + index;
        entry = later_patch(0u, item, entry, chunk.patch_end - slab.first_patch);
        if entry != known {
            known = entry;
            start = offsets[entry].x;
            plan = emit_plan(patch_factors[entry]);
        }
        let uv = corner_weights(params.convention, emit_point(plan, item - start));
        let patch_index = slab.first_patch + entry;
        store_vertex(index, patch_index, load_hull(patch_index), uv);
    }
}

fn store_triangle(index: u32, corners: vec3<u32>) {
    indices[3u * index] = corners.x;
    indices[3u * index + 1u] = corners.y;
    indices[3u * index + 2u] = corners.z;
}

// Emits triangles `first`, `first + LANES` and so on up to `end` of the patch whose first triangle is `start` and whose
// first vertex is `base`.
fn emit_patch_triangles(plan: EmitPlan, base: u32, start: u32, first: u32, end: u32) {
    for (var index = first; index < end; index += LANES) {
        store_triangle(index, base + emit_triangle(plan, index - start));
    }
}

@compute @workgroup_size(TRIANGLE_WORKGROUP)
fn emit_triangles_main(invocation: Invocation) {
    let chunk = chunks[chunk_index];
    let items = emit_items(chunk.triangle_count);
    let first = emit_first(invocation.workgroup, invocation.workgroups, items);
    let last = chunk.first_triangle + min(first + items, chunk.triangle_count) - 1u;
    let begin = chunk.first_patch - slab.first_patch;
    let end = chunk.patch_end - slab.first_patch;
    let entry = find_together(1u, chunk.first_triangle + first, begin, end, invocation.local, TRIANGLE_WORKGROUP);
    let turns = items / TRIANGLE_WORKGROUP;
    if is_of_large_patches(1u, items, last, entry, end) {
        triangles_by_patch(chunk, entry, first, turns, invocation.local);
    } else {
        triangles_by_item(chunk, entry, first, turns, invocation.local);
    }
}

fn triangles_by_patch(chunk: Chunk, first_entry: u32, first: u32, turns: u32, local: u32) {
    var at = first + emit_start(local, turns);
    let end = min(at + LANES * turns, chunk.triangle_count);
    var entry = later_patch(1u, chunk.first_triangle + at, first_entry, chunk.patch_end - slab.first_patch);
    while at < end {
        let starts = offsets[entry] - vec2<u32>(chunk.first_vertex, chunk.first_triangle);
        let factors = patch_factors[entry];
        let plan = emit_plan(factors);
        let stop = min(starts.y + emit_counts(plan, factors).y, end);
        // Those at the outline first, then the others: each takes another path through domain_triangle. Rows mostly take one.
        let ring = plan.domain.outer + 3u * (plan.domain.n - 2u);
        let inside = select(clamp(starts.y + ring, at, stop), at, EMIT_ROWS == 1u);
        emit_patch_triangles(plan, starts.x, starts.y, at + local % LANES, inside);
        emit_patch_triangles(plan, starts.x, starts.y, inside + local % LANES, stop);
        at = stop;
        entry += 1u;
    }
}

fn triangles_by_item(chunk: Chunk, first_entry: u32, first: u32, turns: u32, local: u32) {
    var known = NO_PATCH;
    var entry = first_entry;
    var start = vec2<u32>(0u);
    var plan: EmitPlan;
    for (var turn = 0u; turn < turns; turn++) {
        let index = first + emit_start(local, turns) + turn * LANES + local % LANES;
        if index >= chunk.triangle_count {
            return;
        }
        let item = chunk.first_triangle + index;
        entry = later_patch(1u, item, entry, chunk.patch_end - slab.first_patch);
        if entry != known {
            known = entry;
            start = offsets[entry];
            plan = emit_plan(patch_factors[entry]);
        }
        store_triangle(index, start.x - chunk.first_vertex + emit_triangle(plan, item - start.y));
    }
}
