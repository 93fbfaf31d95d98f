// For every patch of a slab: the factors that the tessellator works with, and how many vertices and triangles it will emit.

// In storage, not a uniform: some software drivers compile a shader again for every value of a uniform that it branches on.
@group(0) @binding(0) var<storage, read> params: Params;
@group(0) @binding(1) var<uniform> slab: Slab;
@group(0) @binding(2) var<storage, read> points: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> patches: array<Patch>;
@group(0) @binding(4) var<storage, read> curve_nets: array<CurveNet>;
// Of edges; under LOD by error then what pass_requests.wgsl says, the inside factors of patches among it.
@group(0) @binding(5) var<storage, read> edge_factors: array<f32>;
@group(0) @binding(6) var<storage, read_write> patch_factors: array<PatchFactors>;
@group(0) @binding(7) var<storage, read_write> offsets: array<vec2<u32>>;
// For every patch the bits of the factors that were given in place of LOD's: of its three edges, and inside.
@group(0) @binding(8) var<storage, read> given_factors: array<vec4<u32>>;
// Written by hull_factors_main, for every patch.
@group(0) @binding(9) var<storage, read_write> written_factors: array<vec4<f32>>;

// A patch's control net, or nothing if the settings have no use for it.
fn needed_net(patch_index: u32) -> ControlNet {
    var net: ControlNet;
    if params.clip != CLIP_OFF || params.culls_back == 1u {
        net = load_net(patch_index);
    }
    return net;
}

// Returns an inside factor under rows whose base is an edge in the order of a convention, for one whose base is the edge U == 0,
// V == 0 or W == 0 as LOD takes them: each is the edge opposite corner 0, 1 or 2.
fn inside_of_base(convention: u32, inside: f32) -> f32 {
    let step = u32(inside) / ROW_BASE_STEP;
    let base = (step + 2u) % 3u;
    for (var written = 0u; written < 3u; written++) {
        if step > 0u && factor_side(convention, written) == step % 3u {
            return inside + f32(ROW_BASE_STEP * written) - f32(ROW_BASE_STEP * base);
        }
    }
    return inside;
}

// What a hull shader would write for a patch: the factors of its edges in the order of the convention, and the one inside.
fn hull_factors(patch_index: u32) -> vec4<f32> {
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
    let edges = vec3<f32>(
        sides[factor_side(params.convention, 0u)],
        sides[factor_side(params.convention, 1u)],
        sides[factor_side(params.convention, 2u)],
    );
    var inside = max(max(sides.x, sides.y), sides.z);
    if params.partitioning == PARTITIONING_ROWS {
        inside = base_factor(edges);
    }
    if params.lod == LOD_ERROR {
        inside = edge_factors[inside_at(patch_index)];
        if params.partitioning == PARTITIONING_ROWS {
            inside = inside_of_base(params.convention, inside);
        }
    }
    return vec4<f32>(edges, inside);
}

// Stores a patch's factors, and returns how many vertices and triangles they give.
fn counted(index: u32) -> vec2<u32> {
    let patch_index = slab.first_patch + index;
    let net = needed_net(patch_index);
    let why = cull_reason(params.clip, params.culls_back == 1u, params.view, net);
    var factors: PatchFactors;
    factors.inside = why;
    if why == NOT_CULLED {
        let written = hull_factors(patch_index);
        factors = process(params.partitioning, written.xyz, written.w);
    }
    patch_factors[index] = factors;
    return vec2<u32>(point_count(factors), triangle_count(factors));
}

// Writes, for every patch, the sums over the patches before it in its block (one workgroup), and behind all those the sum
// of every block. pass_scan.wgsl turns both into offsets within the slab.
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

// The same factors for every patch of the mesh, for reading them back.
@compute @workgroup_size(256)
fn hull_factors_main(invocation: Invocation) {
    let index = grid_index(invocation);
    if index < params.patch_count {
        let net = needed_net(index);
        if cull_reason(params.clip, params.culls_back == 1u, params.view, net) == NOT_CULLED {
            written_factors[index] = hull_factors(index);
        }
    }
}
