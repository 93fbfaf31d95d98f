// LOD by error: every patch asks its edges for factors, of which they get the largest; then every patch takes the least inside
// factor that is enough beside them. Both take two passes: one with an invocation for each patch, which is enough for those
// that one triangle shows; and one in which a workgroup searches the factors of one of the other patches after another.
//
// Beside factors that other patches asked for, a patch may need a much larger inside factor than it has chosen, or find none
// that is enough. Such patches ask again, for no less than what their edges have, and all patches whose edges then have other
// factors take their inside factors anew. There are a few such rounds.

// In storage, not a uniform: some software drivers compile a shader again for every value of a uniform that it branches on.
@group(0) @binding(0) var<storage, read> params: Params;
@group(0) @binding(1) var<storage, read> points: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> patches: array<Patch>;
@group(0) @binding(3) var<storage, read> curve_nets: array<CurveNet>;
@group(0) @binding(5) var<storage, read> corners: array<Corner>;
// A bit for each patch: whether it has a texture.
@group(0) @binding(6) var<storage, read> textured: array<u32>;
// Bits of numbers, whose order is that of the numbers since none is negative. One after another: the factors of edges; the
// least factor of each edge; the factor that each patch's heights need inside it, if it is displaced; the inside factors of
// patches, first those that they chose; the least factors with which their inner triangles are within the tolerance, 0 where
// they aren't known; the numbers of patches of three searches; the number of rounds that are over; the patches of the first
// two searches, one after the other; those of the third.
@group(0) @binding(4) var<storage, read_write> edge_factors: array<atomic<u32>>;

// Where the inside factor of a patch is.
fn inside_at(patch_index: u32) -> u32 {
    return 2u * params.factor_count + params.patch_count + patch_index;
}

// Where the least factor is with which a patch's inner triangles are within the tolerance.
fn inner_at(patch_index: u32) -> u32 {
    return inside_at(params.patch_count + patch_index);
}

fn known_inner(patch_index: u32) -> f32 {
    return bitcast<f32>(atomicLoad(&edge_factors[inner_at(patch_index)]));
}

// The factor that a patch's heights need inside it.
fn heights_inside(patch_index: u32) -> f32 {
    if params.displacement == 0u {
        return 1.0;
    }
    return bitcast<f32>(atomicLoad(&edge_factors[2u * params.factor_count + patch_index]));
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

// The searches: for the factors that patches ask for, for their inside factors, and for what patches ask for again.
const SEARCH_ASKED: u32 = 0u;
const SEARCH_INSIDE: u32 = 1u;
const SEARCH_AGAIN: u32 = 2u;

// Where the number of rounds is that are over.
fn rounds_at() -> u32 {
    return searched_count_at(3u);
}

// Where the number of patches is that a search is for.
fn searched_count_at(search: u32) -> u32 {
    return inner_at(params.patch_count) + search;
}

// Where the `i`-th of those patches is.
fn searched_at(search: u32, i: u32) -> u32 {
    return searched_count_at(4u) + select(0u, params.patch_count, search == SEARCH_AGAIN) + i;
}

fn search_later(search: u32, patch_index: u32) {
    let i = atomicAdd(&edge_factors[searched_count_at(search)], 1u);
    atomicStore(&edge_factors[searched_at(search, i)], patch_index);
}

fn set_inside(patch_index: u32, inside: f32) {
    atomicStore(&edge_factors[inside_at(patch_index)], bitcast<u32>(inside));
}

fn ask(patch_index: u32, asked: vec3<f32>) {
    for (var i = 0u; i < 3u; i++) {
        let edge = patches[patch_index].factors[(i + 1u) % 3u] >> 3u;
        atomicMax(&edge_factors[edge], bitcast<u32>(asked[i]));
    }
}

// Patches that are left out ask, too: what others look like doesn't depend on it.
@compute @workgroup_size(256)
fn asked_factors_main(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let index = grid_index(workgroup, workgroups, local);
    if index >= params.patch_count {
        return;
    }
    var seen = load_seen(index);
    let least = first_least(&seen, edges_of(index, params.factor_count));
    let inside = heights_inside(index);
    let within = BOUND_SHARE * surface_tolerance();
    atomicStore(&edge_factors[inner_at(index)], 0u);
    let is_known = params.surface == SURFACE_FLAT || max(max(max(least.x, least.y), least.z), inside) > 64.0;
    if is_known || single_suffices(&seen, within, params.partitioning, least, inside) {
        ask(index, least);
        set_inside(index, whole_segments(params.partitioning, inside));
    } else {
        search_later(SEARCH_ASKED, index);
    }
}

// The patch that a workgroup searches.
var<workgroup> group_patch: u32;

const NO_MORE: u32 = 0xffffffffu;

// Returns the `i`-th patch that is searched, the same for all invocations of the workgroup; NO_MORE if there are fewer.
fn searched_patch(search: u32, i: u32) -> u32 {
    if lane == 0u {
        group_patch = NO_MORE;
        if i < min(atomicLoad(&edge_factors[searched_count_at(search)]), params.patch_count) {
            group_patch = atomicLoad(&edge_factors[searched_at(search, i)]);
        }
    }
    return workgroupUniformLoad(&group_patch);
}

// Searches what patches ask for, or ask for again.
@compute @workgroup_size(GROUP)
fn search_asked_factors_main(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    lane = local;
    let search = select(SEARCH_ASKED, SEARCH_AGAIN, is_later_round());
    var i = workgroup.x;
    var index = searched_patch(search, i);
    while index != NO_MORE {
        var seen = load_seen(index);
        var least = edges_of(index, params.factor_count);
        if search == SEARCH_ASKED {
            least = first_least(&seen, least);
        }
        let inner = known_inner(index);
        let asked = asked_factors(&seen, surface_tolerance(), params.partitioning, least, heights_inside(index), inner);
        if lane == 0u {
            ask(index, asked.edges);
            set_inside(index, asked.inside);
            atomicStore(&edge_factors[inner_at(index)], bitcast<u32>(asked.inner));
        }
        i += workgroups.x;
        index = searched_patch(search, i);
    }
}

// Whether the first round is over.
fn is_later_round() -> bool {
    return atomicLoad(&edge_factors[rounds_at()]) > 0u;
}

@compute @workgroup_size(256)
fn inside_factors_main(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let index = grid_index(workgroup, workgroups, local);
    if index >= params.patch_count {
        return;
    }
    let heights = heights_inside(index);
    let edges = edges_of(index, 0u);
    if index == 0u {
        // Those that asked have been searched.
        atomicStore(&edge_factors[searched_count_at(SEARCH_AGAIN)], 0u);
    }
    // In later rounds most edges have what they had.
    if is_later_round() && all(edges == edges_of(index, params.factor_count)) {
        return;
    }
    var inside = whole_segments(params.partitioning, heights);
    if params.surface != SURFACE_FLAT {
        var seen = load_seen(index);
        if single_suffices(&seen, BOUND_SHARE * surface_tolerance(), params.partitioning, edges, heights) {
            inside = 1.0;
        } else if max(max(max(edges.x, edges.y), edges.z), heights) > 64.0 {
            inside = BEYOND_LAST;
        } else {
            search_later(SEARCH_INSIDE, index);
            return;
        }
    }
    set_inside(index, inside);
}

@compute @workgroup_size(GROUP)
fn search_inside_factors_main(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    lane = local;
    var i = workgroup.x;
    var index = searched_patch(SEARCH_INSIDE, i);
    while index != NO_MORE {
        var seen = load_seen(index);
        let edges = edges_of(index, 0u);
        let least = heights_inside(index);
        let inner = known_inner(index);
        let inside = least_inside_factor(&seen, surface_tolerance(), params.partitioning, edges, least, inner);
        if lane == 0u {
            let chosen = bitcast<f32>(atomicExchange(&edge_factors[inside_at(index)], bitcast<u32>(inside)));
            if asks_again(chosen, inside) {
                search_later(SEARCH_AGAIN, index);
            }
        }
        i += workgroups.x;
        index = searched_patch(SEARCH_INSIDE, i);
    }
}

// Ends a round: what edges have becomes the least that they may get.
@compute @workgroup_size(256)
fn keep_factors_main(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let index = grid_index(workgroup, workgroups, local);
    if index == 0u {
        atomicStore(&edge_factors[searched_count_at(SEARCH_INSIDE)], 0u);
        atomicAdd(&edge_factors[rounds_at()], 1u);
    }
    if index < params.factor_count {
        atomicStore(&edge_factors[params.factor_count + index], atomicLoad(&edge_factors[index]));
    }
}
