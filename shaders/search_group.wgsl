// A workgroup that searches the factors of patches. It is split into teams of invocations, and each team searches one patch: all
// of the workgroup one whose pattern is large, or several that are small. Teams wait for each other, so that all of them call
// whatever has a barrier; those that are done do nothing in it.

// How many triangles are looked at together, before those with one that isn't within the tolerance end the search.
const TOGETHER: u32 = 8u;

// The number of invocations of the workgroup: some TOGETHER, at most 16 times. The results don't depend on it.
override GROUP: u32 = 32u;

// This invocation's number in its workgroup.
var<private> lane: u32;
// The number of invocations of a team: GROUP or TOGETHER, the same in all of the workgroup.
var<private> team_size: u32;
// The bits of the largest error that each TOGETHER of invocations have found in each part of a pattern. The order of bits is that
// of the numbers, since none is negative.
var<workgroup> found_errors: array<atomic<u32>, 64>;
var<workgroup> team_errors: array<vec4<f32>, 16>;
var<workgroup> teams_going_on: array<u32, 16>;
var<workgroup> group_goes_on: u32;

// This invocation's team.
fn team() -> u32 {
    return lane / team_size;
}

// Whether this invocation writes what its team has found.
fn leads_team() -> bool {
    return lane % team_size == 0u;
}

// Returns whether any team goes on, the same for all of the workgroup. `goes_on` says it of this invocation's team.
fn any_team(goes_on: bool) -> bool {
    if leads_team() {
        teams_going_on[team()] = u32(goes_on);
    }
    workgroupBarrier();
    if lane == 0u {
        group_goes_on = 0u;
        for (var i = 0u; i < GROUP / team_size; i++) {
            group_goes_on |= teams_going_on[i];
        }
    }
    return workgroupUniformLoad(&group_goes_on) != 0u;
}

// Returns the largest errors in the parts of a pattern after every invocation of a team has found one in one part: `before`, and
// what was found, each TOGETHER after the other. An error in a part that isn't within the tolerance counts no more, and none does
// once no wanted part is within the tolerance.
fn largest_of_team(part: u32, error: f32, before: vec4<f32>, wanted: vec4<bool>, tolerance: f32) -> vec4<f32> {
    atomicMax(&found_errors[4u * (lane / TOGETHER) + part], bitcast<u32>(error));
    workgroupBarrier();
    if leads_team() {
        var worst = before;
        let end = 4u * ((lane + team_size) / TOGETHER);
        for (var first = 4u * (lane / TOGETHER); first < end; first += 4u) {
            let found = vec4<f32>(
                bitcast<f32>(atomicExchange(&found_errors[first], 0u)),
                bitcast<f32>(atomicExchange(&found_errors[first + 1u], 0u)),
                bitcast<f32>(atomicExchange(&found_errors[first + 2u], 0u)),
                bitcast<f32>(atomicExchange(&found_errors[first + 3u], 0u)),
            );
            let within = worst <= vec4<f32>(tolerance);
            worst = select(worst, max(worst, found), within & vec4<bool>(any(wanted & within)));
        }
        team_errors[team()] = worst;
    }
    workgroupBarrier();
    return team_errors[team()];
}
