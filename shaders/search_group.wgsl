// A workgroup that searches the factors of one patch together. Whatever searches is called by all of its invocations with the
// same values, so that all of them take the same branches.

// How many triangles are looked at together, before those with one that isn't within the tolerance end the search.
const TOGETHER: u32 = 8u;

// The number of invocations of the workgroup: some TOGETHER, at most 16 times. The results don't depend on it.
override GROUP: u32 = 32u;

// This invocation's number in its workgroup.
var<private> lane: u32;
// The bits of the largest error that each TOGETHER of invocations have found in each part of a pattern. The order of bits is that
// of the numbers, since none is negative.
var<workgroup> found_errors: array<atomic<u32>, 64>;
var<workgroup> group_errors: vec4<f32>;

// Returns the largest errors in the parts of a pattern after every invocation has found one in one part: `before`, and what was
// found, each TOGETHER after the other. An error in a part that isn't within the tolerance counts no more, and none does once no
// wanted part is within the tolerance.
fn largest_of_group(part: u32, error: f32, before: vec4<f32>, wanted: vec4<bool>, tolerance: f32) -> vec4<f32> {
    atomicMax(&found_errors[4u * (lane / TOGETHER) + part], bitcast<u32>(error));
    workgroupBarrier();
    if lane == 0u {
        var worst = before;
        for (var first = 0u; first < GROUP / TOGETHER * 4u; first += 4u) {
            let found = vec4<f32>(
                bitcast<f32>(atomicExchange(&found_errors[first], 0u)),
                bitcast<f32>(atomicExchange(&found_errors[first + 1u], 0u)),
                bitcast<f32>(atomicExchange(&found_errors[first + 2u], 0u)),
                bitcast<f32>(atomicExchange(&found_errors[first + 3u], 0u)),
            );
            let within = worst <= vec4<f32>(tolerance);
            worst = select(worst, max(worst, found), within & vec4<bool>(any(wanted & within)));
        }
        group_errors = worst;
    }
    return workgroupUniformLoad(&group_errors);
}
