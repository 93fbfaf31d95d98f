// LOD by error: every patch requests factors for its edges, which get the largest; then every patch takes the least inside
// factor that is enough beside them. Beside factors that other patches requested, a patch may need a much larger inside factor than
// it has chosen, or find none that is enough. Then it requests again, for no less than what its edges have. There are a few such rounds.
//
// A round takes three passes. In the first an invocation looks at each patch: one whose edges have changed is done if one triangle
// shows it, and else put on a list. In the second a workgroup searches an inside factor for one patch on the list after another; in
// the third those are searched that request again. Before the rounds each patch requests: then there is no second pass.

// The counters. The numbers of large and of small patches are those of the patches that ask; after them come those of the patches
// whose edges have their factors.
const LARGE_PATCHES: u32 = 0u;
const SMALL_PATCHES: u32 = 1u;
const LIST_COUNTERS: u32 = 2u;
const WORKGROUPS_DONE: u32 = 4u;
const SEARCHES_OVER: u32 = 5u;

// The lists: of patches that ask, and of those whose edges have their factors.
const REQUESTING: u32 = 0u;
const GIVEN: u32 = 1u;

// Where the counters of a list are.
fn list_counter_at(list: u32, counter: u32) -> u32 {
    return counter_at(LIST_COUNTERS * list + counter);
}

// Where the `i`-th patch of a list is.
fn listed_at(list: u32, i: u32) -> u32 {
    return counter_at(SEARCH_COUNTERS) + list * params.patch_count + i;
}

// The list of the next search: those of the two kinds take turns.
fn next_list() -> u32 {
    return atomicLoad(&edge_factors[counter_at(SEARCHES_OVER)]) % 2u;
}

// Some software drivers end the loops of an invocation after 65,535 turns, and take microseconds even for workgroups that have
// nothing to do. So there is one for each patch that is searched, up to as many as can be dispatched, and at least one, which ends the search.
@compute @workgroup_size(1)
fn search_workgroups_main() {
    let large = atomicLoad(&edge_factors[list_counter_at(next_list(), LARGE_PATCHES)]);
    let small = atomicLoad(&edge_factors[list_counter_at(next_list(), SMALL_PATCHES)]);
    search_workgroups = array<u32, 3>(clamp(large + small, 1u, MOST_WORKGROUPS), 1u, 1u);
}

// How large a factor a pattern has that is searched by a whole workgroup.
const LARGE: f32 = 4.0;

// Of fewer patches than this each may need thousands of triangles, and is searched by a whole
// workgroup. A smaller team may take more turns than a software driver gives its loops, and then that workgroup never ends its search:
// its invocations no longer meet at barriers.
const MANY_PATCHES: u32 = 128u;

// Puts a patch on a list. These factors will be among its pattern's.
fn search_later(list: u32, patch_index: u32, edges: vec3<f32>, inside: f32) {
    if params.patch_count < MANY_PATCHES || max(max(max(edges.x, edges.y), edges.z), inside) >= LARGE {
        let i = atomicAdd(&edge_factors[list_counter_at(list, LARGE_PATCHES)], 1u);
        atomicStore(&edge_factors[listed_at(list, i)], patch_index);
    } else {
        let i = atomicAdd(&edge_factors[list_counter_at(list, SMALL_PATCHES)], 1u);
        atomicStore(&edge_factors[listed_at(list, params.patch_count - 1u - i)], patch_index);
    }
}

// What a patch knows: the factors of the edges U == 0, V == 0 and W == 0 beside which it has its inside factor, or beside which one
// is searched for; and `inner` as in `Chosen`. As whole numbers, and 128 for BEYOND_LAST, they take 8 bits each.
struct Known {
    edges: vec3<f32>,
    inner: f32,
}

fn known_from(word: u32) -> Known {
    let numbers = (vec4<u32>(word) >> vec4<u32>(0u, 8u, 16u, 24u)) & vec4<u32>(255u);
    return Known(min(vec3<f32>(numbers.xyz), vec3<f32>(BEYOND_LAST)), f32(numbers.w));
}

fn set_known(patch_index: u32, edges: vec3<f32>, inner: f32) {
    let numbers = vec3<u32>(min(ceil(edges), vec3<f32>(128.0)));
    let word = numbers.x | (numbers.y << 8u) | (numbers.z << 16u) | (u32(inner) << 24u);
    atomicStore(&edge_factors[known_at(patch_index)], word);
}

// A patch with no inside factor within the tolerance comes as close as it can.
fn request(patch_index: u32, own: vec3<f32>, inside: f32) {
    let least = select(1.0, last_factor(params.partitioning), inside == BEYOND_LAST);
    let requested = max(own, vec3<f32>(least));
    for (var i = 0u; i < 3u; i++) {
        let edge = patches[patch_index].factors[(i + 1u) % 3u] >> 3u;
        atomicMax(&edge_factors[edge], bitcast<u32>(requested[i]));
    }
}

// Returns the size of what a patch has chosen: its inside factor, or under rows the number of points inside it. If it later needs
// one that is much larger, it requests again.
fn chosen_size(edges: vec3<f32>, inside: f32) -> f32 {
    if params.partitioning == PARTITIONING_ROWS {
        return points_inside(edges, inside);
    }
    return inside;
}

// Patches that are left out ask, too: what others look like doesn't depend on it.
@compute @workgroup_size(256)
fn list_patches_main(invocation: Invocation) {
    let index = grid_index(invocation);
    if index >= params.patch_count {
        return;
    }
    let word = atomicLoad(&edge_factors[known_at(index)]);
    let known = known_from(word);
    let is_first = word == 0u;
    var edges = edges_of(index, 0u);
    if !is_first && all(edges == known.edges) {
        return;
    }
    var seen = load_seen(index);
    if is_first {
        edges = first_least(&seen, edges_of(index, params.factor_count));
    }
    let heights = heights_need(&seen, params.tolerance, params.partitioning).w;
    var inside = whole_segments(params.partitioning, 1.0);
    if params.surface != SURFACE_FLAT || params.displacement != 0u {
        let sought = Sought(edges, heights, known.inner, GOAL_GIVEN);
        inside = without_search(&seen, BOUND_SHARE * params.tolerance, params.partitioning, sought);
        if inside == 0.0 {
            // In place of the inside factor the search reads the size that was chosen.
            inside = select(chosen_size(known.edges, bitcast<f32>(inside_of(index))), 0.0, is_first);
            search_later(select(GIVEN, REQUESTING, is_first), index, edges, heights);
        }
    }
    if is_first && inside > 0.0 {
        request(index, edges, inside);
    }
    set_inside(index, inside);
    set_known(index, edges, known.inner);
}

// The patches that the teams of a workgroup search.
var<workgroup> team_patches: array<u32, 16>;
var<workgroup> searched_counts: vec2<u32>;

const NO_MORE: u32 = 0xffffffffu;

// How many patches the workgroups before this one and this one have begun.
var<private> begun: u32;

// Returns the next patch that this invocation's team searches, NO_MORE if there is none: of the large ones, each is for a whole
// workgroup; then of the small ones, one for each team.
fn next_patch(list: u32, workgroups: u32) -> u32 {
    if lane == 0u {
        searched_counts = vec2<u32>(
            min(atomicLoad(&edge_factors[list_counter_at(list, LARGE_PATCHES)]), params.patch_count),
            min(atomicLoad(&edge_factors[list_counter_at(list, SMALL_PATCHES)]), params.patch_count),
        );
    }
    let counts = workgroupUniformLoad(&searched_counts);
    let at = begun;
    begun += workgroups;
    team_size = select(TOGETHER, GROUP, at < counts.x);
    let small = (at - counts.x) * (GROUP / TOGETHER) + team();
    if leads_team() {
        team_patches[team()] = NO_MORE;
        if at < counts.x {
            team_patches[team()] = atomicLoad(&edge_factors[listed_at(list, at)]);
        } else if small < counts.y {
            team_patches[team()] = atomicLoad(&edge_factors[listed_at(list, params.patch_count - 1u - small)]);
        }
    }
    workgroupBarrier();
    return team_patches[team()];
}

// Whether a patch requests again, whose edges have their factors and which had chosen this size before.
fn needs_more(chosen: f32, found: Chosen) -> bool {
    if SEARCHES_ROWS == 1u {
        return found.inside == BEYOND_LAST || rows_request_again(chosen, points_inside(found.edges, found.inside));
    }
    return requests_again(chosen, found.inside);
}

// The number of rounds. In the last one no patch requests again.
override ROUNDS: u32 = 0u;

// Searches the factors of the patches on the list.
@compute @workgroup_size(GROUP)
fn search_patches_main(invocation: Invocation) {
    lane = invocation.local;
    let before = atomicLoad(&edge_factors[counter_at(SEARCHES_OVER)]);
    let list = next_list();
    let wanted = select(GOAL_REQUESTS, GOAL_GIVEN, list == GIVEN);
    begun = invocation.workgroup.x;
    var next = next_patch(list, invocation.workgroups.x);
    while any_team(next != NO_MORE) {
        let is_searched = next != NO_MORE;
        let index = select(0u, next, is_searched);
        var seen = load_seen(index);
        let known = known_from(atomicLoad(&edge_factors[known_at(index)]));
        let heights = select(BEYOND_LAST, heights_need(&seen, params.tolerance, params.partitioning).w, is_searched);
        let sought = Sought(known.edges, heights, known.inner, wanted);
        var found: Chosen;
        if SEARCHES_ROWS == 1u {
            found = fewest_rows(&seen, params.tolerance, sought);
        } else {
            found = fewest_triangles(&seen, params.tolerance, params.partitioning, sought);
        }
        if leads_team() && is_searched {
            let chosen = bitcast<f32>(inside_of(index));
            // What requests again has found an inside factor before.
            if list == GIVEN || before == 0u || found.inside != BEYOND_LAST {
                set_inside(index, found.inside);
                set_known(index, found.edges, found.inner);
            }
            if list == REQUESTING {
                request(index, found.edges, found.inside);
            } else if before + 1u < 2u * ROUNDS && needs_more(chosen, found) {
                search_later(REQUESTING, index, known.edges, heights);
            }
        }
        next = next_patch(list, invocation.workgroups.x);
    }
    // The last workgroup ends the search.
    if lane == 0u && atomicAdd(&edge_factors[counter_at(WORKGROUPS_DONE)], 1u) + 1u == invocation.workgroups.x {
        atomicStore(&edge_factors[list_counter_at(list, LARGE_PATCHES)], 0u);
        atomicStore(&edge_factors[list_counter_at(list, SMALL_PATCHES)], 0u);
        atomicStore(&edge_factors[counter_at(WORKGROUPS_DONE)], 0u);
        atomicAdd(&edge_factors[counter_at(SEARCHES_OVER)], 1u);
    }
}
