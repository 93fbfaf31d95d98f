// A workgroup that searches the factors of one patch together. Whatever searches is called by all of its invocations with the
// same values, so that all of them take the same branches.

// How many triangles are looked at together, before the first that isn't within the tolerance ends the search: one by each
// invocation of the workgroup.
const TOGETHER: u32 = 32u;

// This invocation's number in its workgroup.
var<private> lane: u32;
// The bits of the largest error that invocations found in each part of a pattern. The order of bits is that of the numbers, since
// none is negative.
var<workgroup> found_errors: array<atomic<u32>, 4>;
var<workgroup> group_errors: vec4<f32>;

// Returns the largest errors that the invocations of the workgroup have found in each part of a pattern, each an error in one
// part.
fn largest_of_group(part: u32, error: f32) -> vec4<f32> {
    atomicMax(&found_errors[part], bitcast<u32>(error));
    workgroupBarrier();
    if lane == 0u {
        for (var i = 0u; i < 4u; i++) {
            group_errors[i] = bitcast<f32>(atomicExchange(&found_errors[i], 0u));
        }
    }
    return workgroupUniformLoad(&group_errors);
}
