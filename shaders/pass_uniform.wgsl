// LOD by error: if one factor for all edges keeps the tolerance with fewer triangles than what patches have requested, all edges
// get the least such factor.

// The counters: the low word of the number of all triangles, beside which is the high one; and the first of two words with a
// bit for each factor that isn't taken.
const TRIANGLES: u32 = 6u;
const NOT_TAKEN: u32 = 8u;

// Adds up the triangles of all patches. Each invocation takes several, since the waiting in a workgroup takes longer.
@compute @workgroup_size(WORKGROUP)
fn sum_triangles_main(invocation: Invocation) {
    var own = 0u;
    let first = invocation.workgroup.x * WORKGROUP + invocation.local;
    for (var index = first; index < params.patch_count; index += invocation.workgroups.x * WORKGROUP) {
        own += triangle_count(process(params.partitioning, edges_of(index, 0u), bitcast<f32>(inside_of(index))));
    }
    let sum = workgroup_sum(invocation.local, vec2<u32>(own, 0u)).x;
    if invocation.local == 0u {
        let before = atomicAdd(&edge_factors[counter_at(TRIANGLES)], sum);
        if before + sum < before {
            atomicAdd(&edge_factors[counter_at(TRIANGLES + 1u)], 1u);
        }
    }
}

// Returns whether a partitioning has a factor without fractions, and all patches have fewer triangles with it. With 1 none has.
fn is_candidate(factor: f32) -> bool {
    if factor == 1.0 || factor > last_factor(params.partitioning) || whole_segments(params.partitioning, factor) != factor {
        return false;
    }
    // The product of the two counts has two words.
    let each = triangle_count(process(params.partitioning, vec3<f32>(factor), factor));
    let middle = each * (params.patch_count >> 16u);
    let low = each * (params.patch_count & 0xffffu);
    let sum = low + (middle << 16u);
    let high = (middle >> 16u) + u32(sum < low);
    let all_low = atomicLoad(&edge_factors[counter_at(TRIANGLES)]);
    let all_high = atomicLoad(&edge_factors[counter_at(TRIANGLES + 1u)]);
    return high < all_high || (high == all_high && sum < all_low);
}

// The bits of the factors up to this one, in two words.
fn bits_up_to(factor: u32) -> vec2<u32> {
    let bits = vec2<u32>(min(factor, 32u), max(factor, 32u) - 32u);
    return select((vec2<u32>(1u) << bits) - vec2<u32>(1u), vec2<u32>(0xffffffffu), bits == vec2<u32>(32u));
}

fn not_taken() -> vec2<u32> {
    return vec2<u32>(
        atomicLoad(&edge_factors[counter_at(NOT_TAKEN)]),
        atomicLoad(&edge_factors[counter_at(NOT_TAKEN + 1u)]),
    );
}

fn dont_take(factors: vec2<u32>) {
    atomicOr(&edge_factors[counter_at(NOT_TAKEN)], factors.x);
    atomicOr(&edge_factors[counter_at(NOT_TAKEN + 1u)], factors.y);
}

// Leaves out the factors that aren't candidates.
@compute @workgroup_size(64)
fn candidates_main(@builtin(local_invocation_index) local: u32) {
    let is_flat = params.surface == SURFACE_FLAT && params.displacement == 0u;
    if is_flat || !is_candidate(f32(local + 1u)) {
        dont_take(bits_up_to(local + 1u) & ~bits_up_to(local));
    }
}

var<workgroup> left: vec2<u32>;

// Returns a bit for each factor that may still be taken for all edges, the same for all of the workgroup.
fn factors_left() -> vec2<u32> {
    workgroupBarrier();
    if lane == 0u {
        left = ~not_taken();
    }
    return workgroupUniformLoad(&left);
}

// Finds the factors that aren't enough for all patches. Workgroups go through the patches as long as any factor is left. Errors
// don't fall steadily, so they try all that are left.
@compute @workgroup_size(GROUP)
fn search_uniform_factor_main(invocation: Invocation) {
    lane = invocation.local;
    team_size = GROUP;
    var index = invocation.workgroup.x;
    var factors = factors_left();
    while any(factors != vec2<u32>(0u)) && index < params.patch_count {
        var seen = load_seen(index);
        let wanted = factors;
        var tried = vec2<u32>(0u);
        while any(factors != vec2<u32>(0u)) {
            let factor = 1u + select(firstLeadingBit(factors.x), 32u + firstLeadingBit(factors.y), factors.y != 0u);
            let own = bits_up_to(factor) & ~bits_up_to(factor - 1u);
            factors &= ~own;
            tried |= own;
            if !uniform_suffices(&seen, params.tolerance, params.partitioning, f32(factor)) && lane == 0u {
                dont_take(own);
            }
        }
        // Some software drivers end the loops of an invocation after 65,535 turns of all of them. What hasn't been looked at may
        // not be enough, nor what was looked at last. Of `factors` compilers know that none is left after the loop.
        if lane == 0u && any(tried != wanted) {
            dont_take(wanted);
        }
        index += invocation.workgroups.x;
        factors = factors_left();
    }
    if lane == 0u && index < params.patch_count {
        dont_take(factors);
    }
}

// Gives all edges the least factor that is left, if there is one.
@compute @workgroup_size(WORKGROUP)
fn take_uniform_factor_main(invocation: Invocation) {
    let index = grid_index(invocation);
    let factors = ~not_taken();
    if index < params.factor_count && any(factors != vec2<u32>(0u)) {
        let first = 1u + select(32u + firstTrailingBit(factors.y), firstTrailingBit(factors.x), factors.x != 0u);
        atomicStore(&edge_factors[index], bitcast<u32>(f32(first)));
    }
}
