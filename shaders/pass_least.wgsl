// The own least of every patch: the fewest triangles with which it would keep the tolerance of LOD by error if it chose the
// factors of its edges alone. pass_factors.wgsl has written what edges need at least.

// `params` are those of LOD by error, whichever LOD is used. First 0 for the patches that are searched:
@group(0) @binding(8) var<storage, read_write> least_triangles: array<u32>;

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
    let least = first_least(&seen, edges_of(index, params.factor_count));
    var own = whole_segments(params.partitioning, 1.0);
    if params.surface != SURFACE_FLAT || params.displacement != 0u {
        let sought = Sought(least, heights_need(&seen, params.tolerance, params.partitioning).w, 0.0, GOAL_MINIMUM);
        own = without_search(&seen, BOUND_SHARE * params.tolerance, params.partitioning, sought);
    }
    least_triangles[index] = select(triangles_of(least, own), 0u, own == 0.0);
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
        let least = first_least(&seen, edges_of(index, params.factor_count));
        let inside = select(BEYOND_LAST, heights_need(&seen, params.tolerance, params.partitioning).w, is_searched);
        let sought = Sought(least, inside, 0.0, GOAL_MINIMUM);
        var own: Chosen;
        if SEARCHES_ROWS == 1u {
            own = fewest_rows(&seen, params.tolerance, sought);
        } else {
            own = fewest_triangles(&seen, params.tolerance, params.partitioning, sought);
        }
        if leads_team() && is_searched {
            least_triangles[index] = triangles_of(own.edges, own.inside);
        }
    }
}
