// LOD by error: every patch asks its edges for factors, of which they get the largest; then every patch takes the least inside
// factor that is enough beside them.

// In storage, not a uniform: some software drivers compile a shader again for every value of a uniform that it branches on.
@group(0) @binding(0) var<storage, read> params: Params;
@group(0) @binding(1) var<storage, read> points: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> patches: array<Patch>;
@group(0) @binding(3) var<storage, read> curve_nets: array<CurveNet>;
@group(0) @binding(5) var<storage, read> corners: array<Corner>;
// A bit for each patch: whether it has a texture.
@group(0) @binding(6) var<storage, read> textured: array<u32>;
// Bits of numbers, whose order is that of the numbers since none is negative: the factors of edges; the least factor of each
// edge; and for each patch first the factor that its heights need inside it (if it is displaced), then its inside factor.
@group(0) @binding(4) var<storage, read_write> edge_factors: array<atomic<u32>>;

// Invocations of a workgroup: few, since one patch may take much longer than another.
const ASKED_WORKGROUP: u32 = 64u;

// Where the inside factor of a patch is.
fn inside_at(patch_index: u32) -> u32 {
    return 2u * params.factor_count + patch_index;
}

// The factor that a patch's heights need inside it.
fn heights_inside(patch_index: u32) -> f32 {
    if params.displacement == 0u {
        return 1.0;
    }
    return bitcast<f32>(atomicLoad(&edge_factors[inside_at(patch_index)]));
}

// The part of the tolerance that is for the surface without displacement, in px.
fn surface_tolerance() -> f32 {
    return params.tolerance * select(1.0, SURFACE_SHARE, params.displacement != 0u);
}

// The factors of the edges U == 0, V == 0 and W == 0 of a patch: LOD takes each by the opposite corner, whatever the
// convention. They are those `first` places into `edge_factors`.
fn edges_of(patch_index: u32, first: u32) -> vec3<f32> {
    let own = patches[patch_index].factors;
    return vec3<f32>(
        bitcast<f32>(atomicLoad(&edge_factors[first + (own[1] >> 3u)])),
        bitcast<f32>(atomicLoad(&edge_factors[first + (own[2] >> 3u)])),
        bitcast<f32>(atomicLoad(&edge_factors[first + (own[0] >> 3u)])),
    );
}

// Whether one triangle shows a patch within the tolerance though points of the surface slide: the patch is flat, and nothing on
// it depends on where they do.
fn slides(patch_index: u32, net: ControlNet) -> bool {
    let has_texture = ((textured[patch_index / 32u] >> (patch_index % 32u)) & 1u) == 1u;
    if params.displacement != 0u || has_texture {
        return false;
    }
    let own = patches[patch_index].corners;
    return normals_agree(corners[own[0]].normal, corners[own[1]].normal, corners[own[2]].normal)
        && flat_error(params.view, net) <= BOUND_SHARE * params.tolerance;
}

@compute @workgroup_size(ASKED_WORKGROUP)
fn asked_factors_main(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let index = (workgroup.y * workgroups.x + workgroup.x) * ASKED_WORKGROUP + local;
    if index >= params.patch_count {
        return;
    }
    // Patches that are left out ask, too: what others look like doesn't depend on it.
    var asked = edges_of(index, params.factor_count);
    let net = load_net(index);
    if slides(index, net) {
        asked = vec3<f32>(whole_segments(params.partitioning, 1.0));
    } else if params.surface != SURFACE_FLAT {
        var seen = seen_patch(params.view, net);
        asked = asked_factors(&seen, surface_tolerance(), params.partitioning, asked, heights_inside(index));
    }
    for (var i = 0u; i < 3u; i++) {
        let edge = patches[index].factors[(i + 1u) % 3u] >> 3u;
        atomicMax(&edge_factors[edge], bitcast<u32>(asked[i]));
    }
}

@compute @workgroup_size(ASKED_WORKGROUP)
fn inside_factors_main(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let index = (workgroup.y * workgroups.x + workgroup.x) * ASKED_WORKGROUP + local;
    if index >= params.patch_count {
        return;
    }
    var inside = whole_segments(params.partitioning, heights_inside(index));
    let net = load_net(index);
    if params.surface != SURFACE_FLAT && !slides(index, net) {
        var seen = seen_patch(params.view, net);
        inside = least_inside_factor(&seen, surface_tolerance(), params.partitioning, edges_of(index, 0u), inside);
    }
    atomicStore(&edge_factors[inside_at(index)], bitcast<u32>(inside));
}
