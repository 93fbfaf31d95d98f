// Exclusive prefix sums of (vertices, triangles), in place: blocks, then the blocks' sums, then both added. All in u32,
// without atomics: the same sums in the same order on every run.

@group(0) @binding(0) var<uniform> slab: Slab;
@group(0) @binding(1) var<storage, read_write> offsets: array<vec2<u32>>;
@group(0) @binding(2) var<storage, read_write> block_sums: array<vec2<u32>>;

// Items a thread, and a workgroup.
const RUN: u32 = 4u;
const BLOCK: u32 = 1024u;

fn load_item(index: u32, count: u32) -> vec2<u32> {
    if index < count {
        return offsets[index];
    }
    return vec2<u32>(0u);
}

@compute @workgroup_size(256)
fn scan_blocks_main(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let count = slab.patch_count + 1u;
    let first = workgroup.x * BLOCK + local * RUN;
    var items: array<vec2<u32>, 4>;
    var sum = vec2<u32>(0u);
    for (var i = 0u; i < RUN; i++) {
        items[i] = load_item(first + i, count);
        sum += items[i];
    }
    var running = workgroup_scan(local, sum);
    for (var i = 0u; i < RUN; i++) {
        if first + i < count {
            offsets[first + i] = running;
        }
        running += items[i];
    }
    if local == WORKGROUP - 1u {
        block_sums[workgroup.x] = running;
    }
}

@compute @workgroup_size(256)
fn scan_sums_main(@builtin(local_invocation_index) local: u32) {
    let blocks = (slab.patch_count + BLOCK) / BLOCK;
    let first = local * RUN;
    var items: array<vec2<u32>, 4>;
    var sum = vec2<u32>(0u);
    for (var i = 0u; i < RUN; i++) {
        items[i] = vec2<u32>(0u);
        if first + i < blocks {
            items[i] = block_sums[first + i];
        }
        sum += items[i];
    }
    var running = workgroup_scan(local, sum);
    for (var i = 0u; i < RUN; i++) {
        if first + i < blocks {
            block_sums[first + i] = running;
        }
        running += items[i];
    }
}

@compute @workgroup_size(256)
fn scan_add_main(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let count = slab.patch_count + 1u;
    let base = block_sums[workgroup.x];
    for (var i = 0u; i < RUN; i++) {
        let index = workgroup.x * BLOCK + i * WORKGROUP + local;
        if index < count {
            offsets[index] += base;
        }
    }
}
