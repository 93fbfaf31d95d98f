// LOD by error: every patch asks its edges for factors, of which they get the largest; then every patch takes the least inside
// factor that is enough beside them. Both take two passes: one with an invocation for each patch, which is enough for those
// that one triangle shows; and one in which a workgroup searches the factors of one of the other patches after another. On
// software drivers a pass between them has an invocation for each patch for which few triangles may be enough.
//
// Beside factors that other patches asked for, a patch may need a much larger inside factor than it has chosen, or find none
// that is enough. Such patches ask again, for no less than what their edges have, and all patches whose edges then have other
// factors take their inside factors anew. There are a few such rounds.

// The searches: for the factors that patches ask for, for their inside factors, and for what patches ask for again.
const SEARCH_ASKED: u32 = 0u;
const SEARCH_INSIDE: u32 = 1u;
const SEARCH_AGAIN: u32 = 2u;

// The counters: of large patches, beside which are those of small ones; and of rounds that are over.
const SMALL: u32 = 3u;
const ROUNDS_OVER: u32 = 6u;

// Where the `i`-th patch of a search is.
fn searched_at(search: u32, i: u32) -> u32 {
    return counter_at(SEARCH_COUNTERS) + select(0u, params.patch_count, search == SEARCH_AGAIN) + i;
}

fn clear_search(search: u32) {
    atomicStore(&edge_factors[counter_at(search)], 0u);
    atomicStore(&edge_factors[counter_at(search + SMALL)], 0u);
}

// Whether a search has any patches.
fn has_patches(search: u32) -> bool {
    return (atomicLoad(&edge_factors[counter_at(search)]) | atomicLoad(&edge_factors[counter_at(search + SMALL)])) > 0u;
}

// Some software drivers end the loops of an invocation after 65,535 turns, and take microseconds even for workgroups that have
// nothing to do. So there is one for each patch that is searched, up to as many as can be dispatched.
fn set_search_workgroups() {
    for (var search = 0u; search < 3u; search++) {
        let large = atomicLoad(&edge_factors[counter_at(search)]);
        let small = atomicLoad(&edge_factors[counter_at(search + SMALL)]);
        search_workgroups[search] = array<u32, 3>(min(large + small, MOST_WORKGROUPS), 1u, 1u);
    }
}

// Counts the workgroups of the search that is next, and of the patches that are looked at alone.
@compute @workgroup_size(1)
fn search_workgroups_main() {
    set_search_workgroups();
    search_workgroups[NEXT_PATCHES] = grid(alone_count());
}

// Counts the workgroups of the next round: once nothing is asked for again, nothing changes.
@compute @workgroup_size(1)
fn round_workgroups_main() {
    set_search_workgroups();
    let goes_on = has_patches(SEARCH_AGAIN);
    search_workgroups[NEXT_PATCHES] = grid(select(0u, params.patch_count, goes_on));
    search_workgroups[NEXT_EDGES] = grid(select(0u, params.factor_count, goes_on));
}

// How large a factor a pattern has that is searched by a whole workgroup.
const LARGE: f32 = 4.0;

// Puts a patch on the list of a search. These factors will be among its pattern's.
fn search_later(search: u32, patch_index: u32, edges: vec3<f32>, inside: f32) {
    if max(max(max(edges.x, edges.y), edges.z), inside) >= LARGE {
        let i = atomicAdd(&edge_factors[counter_at(search)], 1u);
        atomicStore(&edge_factors[searched_at(search, i)], patch_index);
    } else {
        let i = atomicAdd(&edge_factors[counter_at(search + SMALL)], 1u);
        atomicStore(&edge_factors[searched_at(search, params.patch_count - 1u - i)], patch_index);
    }
}

// How many triangles a pattern has at most that one invocation looks at; 0 if workgroups search all patterns, which takes a GPU
// less time.
override ALONE: u32 = 0u;

// The patches whose patterns one invocation looks at are where those that ask again will be.
fn alone_count() -> u32 {
    return atomicLoad(&edge_factors[counter_at(SEARCH_AGAIN)]);
}

fn look_alone(patch_index: u32) {
    let i = atomicAdd(&edge_factors[counter_at(SEARCH_AGAIN)], 1u);
    atomicStore(&edge_factors[searched_at(SEARCH_AGAIN, i)], patch_index);
}

// An inside factor, and factors of the edges U == 0, V == 0 and W == 0 beside which it is enough.
struct Enough {
    edges: vec3<f32>,
    inside: f32,
}

// In place of a chosen inside factor that isn't enough.
const NONE_ENOUGH: u32 = 400u;

// Stores what a patch has chosen in place of its inside factor: whole numbers, and 65 for larger factors. All together are less
// than the bits of an inside factor alone.
fn set_chosen(patch_index: u32, edges: vec3<f32>, inside: f32) {
    let numbers = vec3<u32>(min(ceil(edges), vec3<f32>(65.0)));
    // Of rows the base, the diagonals and the width count from 0, so that 384 numbers are enough.
    let whole = u32(ceil(inside));
    let packed = (whole / ROW_BASE_STEP - 1u) * 64u + whole % ROW_BASE_STEP - 1u;
    let own = select(select(whole, packed, whole > ROW_BASE_STEP), NONE_ENOUGH, inside == BEYOND_LAST);
    let word = numbers.x | (numbers.y << 7u) | (numbers.z << 14u) | (own << 21u);
    atomicStore(&edge_factors[inside_at(patch_index)], word);
}

// Returns what a patch has chosen, or its inside factor beside no edges if that is known.
fn chosen_from(word: u32) -> Enough {
    if word >= bitcast<u32>(1.0) {
        return Enough(vec3<f32>(0.0), bitcast<f32>(word));
    }
    let numbers = (vec3<u32>(word) >> vec3<u32>(0u, 7u, 14u)) & vec3<u32>(127u);
    let own = word >> 21u;
    let of_rows = (own / 64u + 1u) * ROW_BASE_STEP + own % 64u + 1u;
    let inside = f32(select(own, of_rows, params.partitioning == PARTITIONING_ROWS));
    return Enough(min(vec3<f32>(numbers), vec3<f32>(BEYOND_LAST)), select(inside, BEYOND_LAST, own == NONE_ENOUGH));
}

fn ask(patch_index: u32, asked: vec3<f32>) {
    for (var i = 0u; i < 3u; i++) {
        let edge = patches[patch_index].factors[(i + 1u) % 3u] >> 3u;
        atomicMax(&edge_factors[edge], bitcast<u32>(asked[i]));
    }
}

// The inside factor of a patch that is one triangle.
fn inside_of_one() -> f32 {
    return select(1.0, f32(ROW_BASE_STEP + 1u), params.partitioning == PARTITIONING_ROWS);
}

// Patches that are left out ask, too: what others look like doesn't depend on it.
@compute @workgroup_size(256)
fn asked_factors_main(invocation: Invocation) {
    let index = grid_index(invocation);
    if index >= params.patch_count {
        return;
    }
    var seen = load_seen(index);
    let least = first_least(&seen, edges_of(index, params.factor_count));
    let inside = heights_inside(index);
    let within = BOUND_SHARE * surface_tolerance();
    atomicStore(&edge_factors[inner_at(index)], 0u);
    var chosen = 0.0;
    if params.surface == SURFACE_FLAT {
        chosen = whole_segments(params.partitioning, inside);
    } else if max(max(max(least.x, least.y), least.z), inside) > 64.0 {
        chosen = BEYOND_LAST;
    } else if single_suffices(&seen, within, params.partitioning, least, inside) {
        chosen = inside_of_one();
    } else if is_small(first_pattern(least, inside)) {
        look_alone(index);
        return;
    } else {
        search_later(SEARCH_ASKED, index, least, inside);
        return;
    }
    ask(index, least);
    set_chosen(index, least, chosen);
}

// Returns the factors with which the search of a patch begins. If their pattern is within the tolerance, the search ends with them,
// since no other pattern has fewer triangles.
fn first_pattern(least: vec3<f32>, least_inside: f32) -> PatchFactors {
    return process(params.partitioning, least, factor_from(params.partitioning, max(least_inside, 2.0)));
}

// Whether one invocation looks at a first pattern. Searches of rows begin otherwise.
fn is_small(factors: PatchFactors) -> bool {
    return params.partitioning != PARTITIONING_ROWS && triangle_count(factors) <= ALONE;
}

// Looks whether the first pattern of a patch is enough. Otherwise the patch is searched later.
@compute @workgroup_size(WORKGROUP)
fn first_patterns_main(invocation: Invocation) {
    let i = grid_index(invocation);
    if i >= alone_count() {
        return;
    }
    let index = atomicLoad(&edge_factors[searched_at(SEARCH_AGAIN, i)]);
    var seen = load_seen(index);
    let least = first_least(&seen, edges_of(index, params.factor_count));
    let heights = heights_inside(index);
    let factors = first_pattern(least, heights);
    let plan = domain_plan(factors);
    let within = BOUND_SHARE * surface_tolerance();
    for (var t = 0u; t < triangle_count(factors); t++) {
        if triangle_error_at(&seen, within, plan, t) > within {
            search_later(SEARCH_ASKED, index, least, heights);
            return;
        }
    }
    let inside = factor_from(params.partitioning, max(heights, 2.0));
    ask(index, least);
    set_chosen(index, least, inside);
    // Inner triangles were looked at with the others.
    atomicStore(&edge_factors[inner_at(index)], bitcast<u32>(select(0.0, inside, inside > 2.0)));
}

// The patches that the teams of a workgroup search.
var<workgroup> team_patches: array<u32, 16>;
var<workgroup> searched_counts: vec2<u32>;

const NO_MORE: u32 = 0xffffffffu;

// How many patches of a search the workgroups before this one and this one have begun.
var<private> begun: u32;

// Returns the next patch that this invocation's team searches, NO_MORE if there is none: of the large ones, each is for a whole
// workgroup; then of the small ones, one for each team.
fn next_patch(search: u32, workgroups: u32) -> u32 {
    if lane == 0u {
        searched_counts = vec2<u32>(
            min(atomicLoad(&edge_factors[counter_at(search)]), params.patch_count),
            min(atomicLoad(&edge_factors[counter_at(search + SMALL)]), params.patch_count),
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
            team_patches[team()] = atomicLoad(&edge_factors[searched_at(search, at)]);
        } else if small < counts.y {
            team_patches[team()] = atomicLoad(&edge_factors[searched_at(search, params.patch_count - 1u - small)]);
        }
    }
    workgroupBarrier();
    return team_patches[team()];
}

// Searches what patches ask for, or ask for again.
@compute @workgroup_size(GROUP)
fn search_asked_factors_main(invocation: Invocation) {
    lane = invocation.local;
    let search = select(SEARCH_ASKED, SEARCH_AGAIN, is_later_round());
    begun = invocation.workgroup.x;
    var next = next_patch(search, invocation.workgroups.x);
    while any_team(next != NO_MORE) {
        let is_searched = next != NO_MORE;
        let index = select(0u, next, is_searched);
        var seen = load_seen(index);
        var least = edges_of(index, params.factor_count);
        if search == SEARCH_ASKED {
            least = first_least(&seen, least);
        }
        let inside = select(BEYOND_LAST, heights_inside(index), is_searched);
        let inner = select(0.0, known_inner(index), is_searched);
        var asked: Chosen;
        if SEARCHES_ROWS == 1u {
            asked = asked_rows(&seen, surface_tolerance(), least, inside);
        } else {
            asked = asked_factors(&seen, surface_tolerance(), params.partitioning, least, inside, inner);
        }
        if leads_team() && is_searched {
            ask(index, asked.edges);
            // What asks again has found an inside factor before.
            if search == SEARCH_ASKED || asked.inside != BEYOND_LAST {
                set_chosen(index, asked.edges, asked.inside);
            }
            atomicStore(&edge_factors[inner_at(index)], bitcast<u32>(asked.inner));
        }
        next = next_patch(search, invocation.workgroups.x);
    }
}

// Whether the first round is over.
fn is_later_round() -> bool {
    return atomicLoad(&edge_factors[counter_at(ROUNDS_OVER)]) > 0u;
}

@compute @workgroup_size(256)
fn inside_factors_main(invocation: Invocation) {
    let index = grid_index(invocation);
    if index >= params.patch_count {
        return;
    }
    let heights = heights_inside(index);
    let edges = edges_of(index, 0u);
    if index == 0u {
        // Those that asked have been searched.
        clear_search(SEARCH_AGAIN);
    }
    var inside = whole_segments(params.partitioning, heights);
    if params.surface != SURFACE_FLAT {
        // Most edges have what their patches have asked for, and in later rounds what they had.
        let chosen = chosen_from(inside_of(index));
        if all(edges == chosen.edges) {
            set_inside(index, chosen.inside);
            return;
        }
        if is_later_round() && all(edges == edges_of(index, params.factor_count)) {
            return;
        }
        var seen = load_seen(index);
        if single_suffices(&seen, BOUND_SHARE * surface_tolerance(), params.partitioning, edges, heights) {
            inside = inside_of_one();
        } else if max(max(max(edges.x, edges.y), edges.z), heights) > 64.0 {
            inside = BEYOND_LAST;
        } else {
            search_later(SEARCH_INSIDE, index, edges, heights);
            return;
        }
    }
    set_inside(index, inside);
}

// Whether a patch asks again, which has chosen something and found this inside factor beside these factors of its edges.
fn needs_more(patch_index: u32, chosen: Enough, edges: vec3<f32>, inside: f32) -> bool {
    if SEARCHES_ROWS != 1u {
        return asks_again(chosen.inside, inside);
    }
    // What was found in an earlier round was found beside what edges had then.
    let is_known = all(chosen.edges == vec3<f32>(0.0));
    let chosen_edges = select(chosen.edges, edges_of(patch_index, params.factor_count), is_known);
    return rows_ask_again(chosen_edges, chosen.inside, edges, inside);
}

// Searches the inside factors of patches beside what their edges have.
@compute @workgroup_size(GROUP)
fn search_inside_factors_main(invocation: Invocation) {
    lane = invocation.local;
    begun = invocation.workgroup.x;
    var next = next_patch(SEARCH_INSIDE, invocation.workgroups.x);
    while any_team(next != NO_MORE) {
        let is_searched = next != NO_MORE;
        let index = select(0u, next, is_searched);
        var seen = load_seen(index);
        let edges = edges_of(index, 0u);
        let least = select(BEYOND_LAST, heights_inside(index), is_searched);
        let inner = select(0.0, known_inner(index), is_searched);
        var inside: f32;
        if SEARCHES_ROWS == 1u {
            inside = rows_beside(&seen, surface_tolerance(), edges, least);
        } else {
            inside = least_inside_factor(&seen, surface_tolerance(), params.partitioning, edges, least, inner);
        }
        if leads_team() && is_searched {
            let word = atomicExchange(&edge_factors[inside_at(index)], bitcast<u32>(inside));
            if needs_more(index, chosen_from(word), edges, inside) {
                search_later(SEARCH_AGAIN, index, edges, least);
            }
        }
        next = next_patch(SEARCH_INSIDE, invocation.workgroups.x);
    }
}

// Ends a round: what edges have becomes the least that they may get.
@compute @workgroup_size(256)
fn keep_factors_main(invocation: Invocation) {
    let index = grid_index(invocation);
    if index == 0u {
        clear_search(SEARCH_INSIDE);
        atomicAdd(&edge_factors[counter_at(ROUNDS_OVER)], 1u);
    }
    if index < params.factor_count {
        atomicStore(&edge_factors[params.factor_count + index], atomicLoad(&edge_factors[index]));
    }
}
