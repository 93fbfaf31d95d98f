// A workgroup that searches the factors of one patch together. Whatever searches is called by all of its invocations with the
// same values, so that all of them take the same branches.

// How many triangles are looked at together, before the first that isn't within the tolerance ends the search: one by each
// invocation of the workgroup.
const TOGETHER: u32 = 32u;

// This invocation's number in its workgroup.
var<private> lane: u32;
// The error that each invocation found, and the largest of them.
var<workgroup> lane_errors: array<f32, TOGETHER>;
var<workgroup> group_error: f32;

// Returns the largest error that an invocation of the workgroup has found.
fn largest_of_group(error: f32) -> f32 {
    lane_errors[lane] = error;
    workgroupBarrier();
    if lane == 0u {
        var largest = 0.0;
        for (var i = 0u; i < TOGETHER; i++) {
            largest = max(largest, lane_errors[i]);
        }
        group_error = largest;
    }
    return workgroupUniformLoad(&group_error);
}
