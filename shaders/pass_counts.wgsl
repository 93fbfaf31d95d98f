// What every patch of a slab will emit: its processed factors, and its numbers of vertices and triangles.

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<uniform> slab: Slab;
@group(0) @binding(2) var<storage, read> points: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> patches: array<Patch>;
@group(0) @binding(4) var<storage, read> curve_nets: array<CurveNet>;
@group(0) @binding(5) var<storage, read> edge_factors: array<f32>;
@group(0) @binding(6) var<storage, read_write> patch_factors: array<PatchFactors>;
@group(0) @binding(7) var<storage, read_write> offsets: array<vec2<u32>>;

@compute @workgroup_size(256)
fn counts_main(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let index = grid_index(workgroup, workgroups, local);
    if index > slab.patch_count {
        return;
    }
    if index == slab.patch_count {
        // After the scan, the entry past the last patch holds the totals.
        offsets[index] = vec2<u32>(0u);
        return;
    }
    let patch_index = slab.first_patch + index;
    // Factor i belongs to the edge opposite corner i: side i + 1.
    var edges: vec3<f32>;
    for (var i = 0u; i < 3u; i++) {
        edges[i] = edge_factors[patches[patch_index].factors[(i + 1u) % 3u] >> 3u];
    }
    let culls_back = params.culls_back == 1u;
    let by_error = params.lod == LOD_ERROR && params.surface != SURFACE_FLAT;
    var net: ControlNet;
    if by_error || culls_back || params.clip != CLIP_OFF {
        net = load_net(patch_index);
    }
    let why = unseen(params.clip, culls_back, params.view, net);
    var factors: PatchFactors;
    factors.inside = why;
    if why == SEEN {
        var inside = max(max(edges.x, edges.y), edges.z);
        if by_error {
            inside = inside_error_factor(params.view, params.tolerance, params.partitioning, net, edges);
        }
        factors = process(params.partitioning, edges, inside);
    }
    patch_factors[index] = factors;
    offsets[index] = vec2<u32>(point_count(factors), triangle_count(factors));
}
