// The domain shader and the tessellator's output of one chunk: a vertex an invocation, a triangle an invocation.

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<uniform> slab: Slab;
@group(0) @binding(2) var<storage, read> chunks: array<Chunk>;
@group(0) @binding(3) var<storage, read> offsets: array<vec2<u32>>;
@group(0) @binding(4) var<storage, read> patch_factors: array<PatchFactors>;
@group(0) @binding(5) var<storage, read> points: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> patches: array<Patch>;
@group(0) @binding(7) var<storage, read> curve_nets: array<CurveNet>;
@group(0) @binding(8) var<storage, read> corners: array<Corner>;
@group(0) @binding(9) var<storage, read_write> vertices: array<Vertex>;
@group(0) @binding(10) var<storage, read_write> indices: array<u32>;
@group(1) @binding(0) var<uniform> chunk_index: u32;

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

// The patches of a workgroup's first and last item bound every other item's search.
var<workgroup> bounds: array<u32, 2>;

fn find_patch_in_workgroup(component: u32, item: u32, first_item: u32, last_item: u32, local: u32) -> u32 {
    let chunk = chunks[chunk_index];
    let first = chunk.first_patch - slab.first_patch;
    let end = chunk.patch_end - slab.first_patch;
    if local < 2u {
        bounds[local] = find_patch(component, select(first_item, last_item, local == 1u), first, end);
    }
    workgroupBarrier();
    return find_patch(component, item, bounds[0], bounds[1] + 1u);
}

// What the domain shader makes of one domain point.
struct DomainVertex {
    position: vec3<f32>,
    normal: vec3<f32>,
    uv: vec2<f32>,
}

// Computed in the edge's own direction.
fn rim_vertex(patch_index: u32, side: u32, side_t: u32) -> DomainVertex {
    let curve = patches[patch_index].curves[side];
    let reversed = (curve & 1u) == 1u;
    let next = (side + 1u) % 3u;
    let start = select(side, next, reversed);
    let end = select(next, side, reversed);
    let t = select(side_t, FIXED_ONE - side_t, reversed);
    let a = points[patches[patch_index].points[start]].xyz;
    let b = points[patches[patch_index].points[end]].xyz;
    let at_a = corners[patches[patch_index].corners[start]];
    let at_b = corners[patches[patch_index].corners[end]];
    let net = curve_nets[curve >> 1u];
    var position = edge_position(params.surface, a, net.ab, net.ba, b, t);
    if t == 0u {
        position = a;
    }
    if t == FIXED_ONE {
        position = b;
    }
    var normal: vec3<f32>;
    if params.normals == NORMALS_QUADRATIC {
        normal = quadratic_edge_normal(a, b, at_a.normal, at_b.normal, t);
    } else {
        normal = edge_normal(at_a.normal, at_b.normal, t);
    }
    return DomainVertex(position, normal, edge_uv(at_a.uv, at_b.uv, t));
}

fn patch_vertex(patch_index: u32, u: u32, v: u32) -> DomainVertex {
    let a = corners[patches[patch_index].corners[0]];
    let b = corners[patches[patch_index].corners[1]];
    let c = corners[patches[patch_index].corners[2]];
    let net = load_net(patch_index);
    let normals = array<vec3<f32>, 3>(a.normal, b.normal, c.normal);
    var normal: vec3<f32>;
    if params.normals == NORMALS_QUADRATIC {
        normal = quadratic_normal(net.corners, normals, u, v);
    } else {
        normal = linear_normal(normals, u, v);
    }
    let position = patch_position(params.surface, net, u, v);
    return DomainVertex(position, normal, linear_uv(array<vec2<f32>, 3>(a.uv, b.uv, c.uv), u, v));
}

@compute @workgroup_size(256)
fn emit_vertices_main(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let chunk = chunks[chunk_index];
    let first = grid_index(workgroup, workgroups, 0u);
    let index = first + local;
    let item = chunk.first_vertex + index;
    let last = chunk.first_vertex + min(first + WORKGROUP, chunk.vertex_count) - 1u;
    let entry = find_patch_in_workgroup(0u, min(item, last), chunk.first_vertex + first, last, local);
    if index >= chunk.vertex_count {
        return;
    }
    let patch_index = slab.first_patch + entry;
    let uv = corner_weights(params.convention, domain_point(patch_factors[entry], item - offsets[entry].x));
    let at = place(uv.x, uv.y);
    var made: DomainVertex;
    if at.side == 3u || params.edges == EDGES_AS_PUBLISHED {
        made = patch_vertex(patch_index, uv.x, uv.y);
    } else {
        made = rim_vertex(patch_index, at.side, at.t);
    }
    if params.normals == NORMALS_SURFACE {
        // Every patch's own, also on its rim, where its neighbours' differ.
        made.normal = surface_normal(params.surface, load_net(patch_index), uv.x, uv.y, made.normal);
    }
    let key = pack_key(patch_index, uv.x, uv.y);
    let p = made.position;
    vertices[index] = Vertex(p.x, p.y, p.z, key.x, key.y, pack_normal(made.normal), made.uv);
}

@compute @workgroup_size(256)
fn emit_triangles_main(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let chunk = chunks[chunk_index];
    let first = grid_index(workgroup, workgroups, 0u);
    let index = first + local;
    let item = chunk.first_triangle + index;
    let last = chunk.first_triangle + min(first + WORKGROUP, chunk.triangle_count) - 1u;
    let entry = find_patch_in_workgroup(1u, min(item, last), chunk.first_triangle + first, last, local);
    if index >= chunk.triangle_count {
        return;
    }
    let corners = domain_triangle(patch_factors[entry], item - offsets[entry].y);
    let base = offsets[entry].x - chunk.first_vertex;
    indices[3u * index] = base + corners.x;
    indices[3u * index + 1u] = base + corners.y;
    indices[3u * index + 2u] = base + corners.z;
}
