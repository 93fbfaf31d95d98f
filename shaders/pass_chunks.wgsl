// Divides a slab into chunks of patches, and writes the indirect arguments of emission, and then those of draws.

@group(0) @binding(0) var<uniform> slab: Slab;
@group(0) @binding(1) var<storage, read> offsets: array<vec2<u32>>;
@group(0) @binding(2) var<storage, read> material_patches: array<vec2<u32>>;
@group(0) @binding(3) var<storage, read_write> chunks: array<Chunk>;
@group(0) @binding(4) var<storage, read_write> emit_args: array<EmitArgs>;
@group(0) @binding(5) var<storage, read_write> draw_args: array<DrawArgs>;

fn fits(first: u32, end: u32, vertices: u32, triangles: u32) -> bool {
    let size = offsets[end] - offsets[first];
    return size.x <= vertices && size.y <= triangles;
}

// The end of the longest run of patches from `first` on that fits a chunk. Patches are counted from the slab's start.
fn chunk_end(first: u32) -> u32 {
    // Usually all of them fit the arena.
    if first == 0u && fits(0u, slab.patch_count, slab.vertex_capacity, slab.triangle_capacity) {
        return slab.patch_count;
    }
    var low = first;
    var high = slab.patch_count;
    while low < high {
        let middle = (low + high + 1u) / 2u;
        if fits(first, middle, slab.chunk_vertices, slab.chunk_triangles) {
            low = middle;
        } else {
            high = middle - 1u;
        }
    }
    return low;
}

fn write_chunk(index: u32, first: u32, end: u32) {
    let base = offsets[first];
    let size = offsets[end] - base;
    chunks[index] = Chunk(slab.first_patch + first, slab.first_patch + end, base.x, base.y, size.x, size.y);
    let items = vec2<u32>(emit_items(size.x), emit_items(size.y));
    let workgroups = (size + items - 1u) / items;
    emit_args[index] = EmitArgs(workgroup_grid(workgroups.x), workgroup_grid(workgroups.y), grid(size.x));
}

fn write_draw(chunk_index: u32, material: u32) {
    let chunk = chunks[chunk_index];
    let range = material_patches[material];
    let first = clamp(range.x, chunk.first_patch, chunk.patch_end) - slab.first_patch;
    let end = max(clamp(range.y, chunk.first_patch, chunk.patch_end) - slab.first_patch, first);
    let first_index = (offsets[first].y - chunk.first_triangle) * 3u;
    let count = (offsets[end].y - offsets[first].y) * 3u;
    let index = chunk_index * slab.material_count + material;
    draw_args[index] = DrawArgs(count, 1u, first_index, 0, 0u, count, 1u, first_index, 0u);
}

var<workgroup> chunk_count: u32;

@compute @workgroup_size(256)
fn chunks_main(@builtin(local_invocation_index) local: u32) {
    if local == 0u {
        var first = 0u;
        while first < slab.patch_count && chunk_count < slab.chunk_capacity {
            let end = chunk_end(first);
            write_chunk(chunk_count, first, end);
            first = end;
            chunk_count += 1u;
        }
    }
    let used = workgroupUniformLoad(&chunk_count);
    for (var i = used + local; i < slab.chunk_capacity; i += WORKGROUP) {
        write_chunk(i, slab.patch_count, slab.patch_count);
    }
}

// One invocation for each material of each chunk.
@compute @workgroup_size(256)
fn draws_main(invocation: Invocation) {
    let index = grid_index(invocation);
    if index < slab.chunk_capacity * slab.material_count {
        write_draw(index / slab.material_count, index % slab.material_count);
    }
}
