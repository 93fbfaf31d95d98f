// Sums over the invocations of a workgroup.

var<workgroup> shared_sums: array<vec2<u32>, 256>;

// The sum of the values of all invocations before this one (Hillis and Steele 1986).
fn workgroup_scan(local: u32, value: vec2<u32>) -> vec2<u32> {
    shared_sums[local] = value;
    workgroupBarrier();
    for (var step = 1u; step < WORKGROUP; step *= 2u) {
        var sum = shared_sums[local];
        if local >= step {
            sum += shared_sums[local - step];
        }
        workgroupBarrier();
        shared_sums[local] = sum;
        workgroupBarrier();
    }
    return shared_sums[local] - value;
}

// The sum of the values of all invocations.
fn workgroup_sum(local: u32, value: vec2<u32>) -> vec2<u32> {
    _ = workgroup_scan(local, value);
    return shared_sums[WORKGROUP - 1u];
}
