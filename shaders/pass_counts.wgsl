// What every patch of a slab will emit: its processed factors, and its numbers of vertices and triangles.

// Not a uniform: some software drivers build a shader anew for every value of one that a branch depends on.
@group(0) @binding(0) var<storage, read> params: Params;
@group(0) @binding(1) var<uniform> slab: Slab;
@group(0) @binding(2) var<storage, read> points: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> patches: array<Patch>;
@group(0) @binding(4) var<storage, read> curve_nets: array<CurveNet>;
// Of edges; then where images are mixed what heights ask for inside patches.
@group(0) @binding(5) var<storage, read> edge_factors: array<f32>;
@group(0) @binding(6) var<storage, read_write> patch_factors: array<PatchFactors>;
@group(0) @binding(7) var<storage, read_write> offsets: array<vec2<u32>>;
// Bits of what was given in place of LOD's factors, for every patch: three factors of edges and the one inside.
@group(0) @binding(8) var<storage, read> given_factors: array<vec4<u32>>;
// What hull_factors_main writes, patch by patch.
@group(0) @binding(9) var<storage, read_write> written_factors: array<vec4<f32>>;

// A patch's net, where anything looks at it.
fn needed_net(patch_index: u32) -> ControlNet {
    var net: ControlNet;
    let by_error = params.lod == LOD_ERROR && params.surface != SURFACE_FLAT;
    if by_error || params.clip != CLIP_OFF || params.culls_back == 1u {
        net = load_net(patch_index);
    }
    return net;
}

// What the hull shader writes for a patch: three factors of edges in the order of the convention, and the one inside.
fn hull_factors(patch_index: u32, net: ControlNet) -> vec4<f32> {
    if params.lod == LOD_GIVEN {
        var given = bitcast<vec4<f32>>(given_factors[patch_index]);
        if params.partitioning == PARTITIONING_POW2 {
            for (var i = 0u; i < 4u; i++) {
                given[i] = round_pow2(given[i]);
            }
        }
        return given;
    }
    var sides: vec3<f32>;
    for (var k = 0u; k < 3u; k++) {
        sides[k] = edge_factors[patches[patch_index].factors[k] >> 3u];
    }
    // Heights are as fine inside as on the edges, where the patch's own image alone speaks for them.
    var inside = max(max(sides.x, sides.y), sides.z);
    if params.mixed == 1u {
        inside = edge_factors[params.factor_count + patch_index];
    }
    if params.lod == LOD_ERROR && params.surface != SURFACE_FLAT {
        let tolerance = params.tolerance * select(1.0, SURFACE_SHARE, params.displacement != 0u);
        let own = inside_error_factor(params.view, tolerance, params.partitioning, net, sides.yzx);
        inside = select(own, max(own, inside), params.displacement != 0u);
    }
    return vec4<f32>(
        sides[factor_side(params.convention, 0u)],
        sides[factor_side(params.convention, 1u)],
        sides[factor_side(params.convention, 2u)],
        inside,
    );
}

// Vertices and triangles of a patch, whose factors it keeps.
fn counted(index: u32) -> vec2<u32> {
    let patch_index = slab.first_patch + index;
    let net = needed_net(patch_index);
    let why = unseen(params.clip, params.culls_back == 1u, params.view, net);
    var factors: PatchFactors;
    factors.inside = why;
    if why == SEEN {
        let written = hull_factors(patch_index, net);
        factors = process(params.partitioning, written.xyz, written.w);
    }
    patch_factors[index] = factors;
    return vec2<u32>(point_count(factors), triangle_count(factors));
}

// Leaves offsets within a block of patches, and behind them all the sum of every block: what pass_scan.wgsl makes offsets of.
@compute @workgroup_size(256)
fn counts_main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let index = workgroup.x * WORKGROUP + local;
    var count = vec2<u32>(0u);
    if index < slab.patch_count {
        count = counted(index);
    }
    let before = workgroup_scan(local, count);
    // The entry past the last patch will hold the totals.
    if index <= slab.patch_count {
        offsets[index] = before;
    }
    if local == WORKGROUP - 1u {
        offsets[slab.patch_count + 1u + workgroup.x] = before + count;
    }
}

// Every patch of the mesh, for those who want to see them.
@compute @workgroup_size(256)
fn hull_factors_main(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let index = grid_index(workgroup, workgroups, local);
    if index < params.patch_count {
        let net = needed_net(index);
        if unseen(params.clip, params.culls_back == 1u, params.view, net) == SEEN {
            written_factors[index] = hull_factors(index, net);
        }
    }
}
