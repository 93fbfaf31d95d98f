// Makes exclusive prefix sums of (vertices, triangles), in place, of those that counts left within blocks. All in u32,
// without atomics: the same sums in the same order on every run.

@group(0) @binding(0) var<uniform> slab: Slab;
@group(0) @binding(1) var<storage, read_write> offsets: array<vec2<u32>>;

@compute @workgroup_size(256)
fn scan_main(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    var sum = vec2<u32>(0u);
    for (var block = local; block < workgroup.x; block += WORKGROUP) {
        sum += offsets[slab.patch_count + 1u + block];
    }
    let base = workgroup_sum(local, sum);
    let index = workgroup.x * WORKGROUP + local;
    if index <= slab.patch_count {
        offsets[index] += base;
    }
}
