// The own least of every patch: the fewest triangles with which it would keep the tolerance of LOD by error if it chose the
// factors of its edges alone. pass_factors.wgsl has written what edges and heights need at least.

// In storage, not a uniform: some software drivers compile a shader again for every value of a uniform that it branches on.
// These are the parameters of LOD by error, whichever LOD is used.
@group(0) @binding(0) var<storage, read> params: Params;
@group(0) @binding(1) var<storage, read> points: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> patches: array<Patch>;
@group(0) @binding(3) var<storage, read> curve_nets: array<CurveNet>;
// A factor for each edge, which nothing here needs; then the least factor that each edge may get; then for each patch the
// factor that its heights need inside it, if it is displaced.
@group(0) @binding(4) var<storage, read> least_factors: array<f32>;
@group(0) @binding(5) var<storage, read> corners: array<Corner>;
// A bit for each patch: whether it has a texture.
@group(0) @binding(6) var<storage, read> textured: array<u32>;
// First 0 for the patches that are searched.
@group(0) @binding(7) var<storage, read_write> least_triangles: array<u32>;

// The factor that a patch's heights need inside it.
fn heights_inside(patch_index: u32) -> f32 {
    if params.displacement == 0u {
        return 1.0;
    }
    return least_factors[2u * params.factor_count + patch_index];
}

// The part of the tolerance that is for the surface without displacement, in px.
fn surface_tolerance() -> f32 {
    return params.tolerance * select(1.0, SURFACE_SHARE, params.displacement != 0u);
}

// The least factor of the edge of a patch's side.
fn least_of_side(patch_index: u32, side: u32) -> f32 {
    return least_factors[params.factor_count + (patches[patch_index].factors[side] >> 3u)];
}

// Those of the edges U == 0, V == 0 and W == 0: LOD takes each by the opposite corner, whatever the convention.
fn least_of_edges(patch_index: u32) -> vec3<f32> {
    return vec3<f32>(least_of_side(patch_index, 1u), least_of_side(patch_index, 2u), least_of_side(patch_index, 0u));
}

fn triangles_of(edges: vec3<f32>, inside: f32) -> u32 {
    return triangle_count(process(params.partitioning, edges, inside));
}

// Patches that one triangle shows, and others that need no search.
@compute @workgroup_size(256)
fn least_triangles_main(invocation: Invocation) {
    let index = grid_index(invocation);
    if index >= params.patch_count {
        return;
    }
    var seen = load_seen(index);
    let least = first_least(&seen, least_of_edges(index));
    let inside = heights_inside(index);
    var triangles = 0u;
    if params.surface == SURFACE_FLAT {
        triangles = triangles_of(least, whole_segments(params.partitioning, inside));
    } else if max(max(max(least.x, least.y), least.z), inside) > 64.0 {
        triangles = triangles_of(least, BEYOND_LAST);
    } else if single_suffices(&seen, BOUND_SHARE * surface_tolerance(), params.partitioning, least, inside) {
        triangles = triangles_of(least, 1.0);
    }
    least_triangles[index] = triangles;
}

// Each team of a workgroup searches the factors of one of the other patches after another.
@compute @workgroup_size(GROUP)
fn search_least_triangles_main(invocation: Invocation) {
    lane = invocation.local;
    team_size = GROUP;
    let teams = 1u;
    for (var first = invocation.workgroup.x * teams; first < params.patch_count; first += invocation.workgroups.x * teams) {
        let index = min(first + team(), params.patch_count - 1u);
        let is_searched = first + team() == index && least_triangles[index] == 0u;
        var seen = load_seen(index);
        let least = first_least(&seen, least_of_edges(index));
        let inside = select(BEYOND_LAST, heights_inside(index), is_searched);
        var own: Chosen;
        if SEARCHES_ROWS == 1u {
            own = own_least_rows(&seen, surface_tolerance(), least, inside);
        } else {
            own = own_least_factors(&seen, surface_tolerance(), params.partitioning, least, inside);
        }
        if leads_team() && is_searched {
            least_triangles[index] = triangles_of(own.edges, own.inside);
        }
    }
}
