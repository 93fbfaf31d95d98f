// What passes of LOD by error read, and what they have found so far. That is in `edge_factors`, as bits of numbers, whose order is
// that of the numbers since none is negative. One after another:
// - the factors of edges;
// - the least factor of each edge;
// - the directions in which the corners of each patch move, packed, if it is displaced;
// - the inside factors of patches;
// - what each patch knows (see Known), 0 before it has been looked at;
// - the counters (SEARCH_COUNTERS in types.wgsl), 0 before a search: the numbers of large and of small patches on two lists, of
//   workgroups that are done, and of searches that are over; two words with the number of all triangles, and two with a bit for each
//   factor that isn't taken for all edges;
// - the two lists: large patches from the start, small ones from the end.
// Software drivers take time for what has nothing to do. There `search_workgroups` has the number of workgroups of the next search.

// In storage, not a uniform: some software drivers compile a shader again for every value of a uniform that it branches on.
@group(0) @binding(0) var<storage, read> params: Params;
@group(0) @binding(1) var<storage, read> points: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> patches: array<Patch>;
@group(0) @binding(3) var<storage, read> curve_nets: array<CurveNet>;
@group(0) @binding(4) var<storage, read_write> edge_factors: array<atomic<u32>>;
@group(0) @binding(5) var<storage, read> corners: array<Corner>;
// Of every patch, if heights displace the mesh.
@group(0) @binding(6) var<storage, read> reliefs: array<PatchRelief>;
@group(0) @binding(7) var<storage, read_write> search_workgroups: array<u32, 3>;

// The unit direction in which a corner of a patch moves.
fn corner_direction(patch_index: u32, corner: u32) -> vec3<f32> {
    return unpack_normal(atomicLoad(&edge_factors[direction_place(patch_index, corner)]));
}

// The factors of the edges U == 0, V == 0 and W == 0 of a patch: LOD takes each by the opposite corner, whatever the
// convention. They are those `first` places into `edge_factors`.
fn edges_of(patch_index: u32, first: u32) -> vec3<f32> {
    let own = patches[patch_index].factors;
    return vec3<f32>(
        bitcast<f32>(atomicLoad(&edge_factors[first + (own[1] >> 3u)])),
        bitcast<f32>(atomicLoad(&edge_factors[first + (own[2] >> 3u)])),
        bitcast<f32>(atomicLoad(&edge_factors[first + (own[0] >> 3u)])),
    );
}

// Where a counter is.
fn counter_at(counter: u32) -> u32 {
    return known_at(params.patch_count) + counter;
}

fn inside_of(patch_index: u32) -> u32 {
    return atomicLoad(&edge_factors[inside_at(patch_index)]);
}

fn set_inside(patch_index: u32, inside: f32) {
    atomicStore(&edge_factors[inside_at(patch_index)], bitcast<u32>(inside));
}
