// Factors that functions of the user's own compute in place of LOD. They are written where those of a file would be. In the
// module that runs, the names of all files but lod_contract.wgsl begin with pnaen_ (src/gpu/user_functions.rs), so that they are none
// of the user's.

// In storage, not a uniform: some software drivers compile a shader again for every value of a uniform that it branches on.
@group(0) @binding(0) var<storage, read> params: Params;
@group(0) @binding(2) var<storage, read> points: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> patches: array<Patch>;
@group(0) @binding(4) var<storage, read> curve_nets: array<CurveNet>;
@group(0) @binding(5) var<storage, read> corner_attributes: array<Corner>;
// For every patch the bits of the factors of its edges, in the order of the convention, and of the one inside.
@group(0) @binding(8) var<storage, read_write> user_factors: array<u32>;
@group(0) @binding(9) var<storage, read_write> report: UserReport;

fn own_triangle(patch_index: u32) -> Triangle {
    let net = load_net(patch_index);
    let of_patch = patch_at(patch_index);
    let normals = array<vec3<f32>, 3>(
        corner_attributes[of_patch.corners[0]].normal,
        corner_attributes[of_patch.corners[1]].normal,
        corner_attributes[of_patch.corners[2]].normal,
    );
    return Triangle(patch_index, net.corners, normals, net.edges, net.center);
}

fn own_view() -> View {
    let of_lod = params.view;
    return View(of_lod.clip_from_object, of_lod.half_viewport * 2.0, of_lod.eye, of_lod.radius, of_lod.reach);
}

// Which factor of a patch is that of a side.
fn factor_of_side(side: u32) -> u32 {
    var written = 0u;
    for (var i = 1u; i < 3u; i++) {
        if factor_side(params.convention, i) == side {
            written = i;
        }
    }
    return written;
}

@compute @workgroup_size(1)
fn user_start_main() {
    clear_report();
}

// The factor of every side. One invocation for each, so that all sides run the same code: compilers may round differently in
// copies of it.
@compute @workgroup_size(256)
fn user_edges_main(invocation: Invocation) {
    let index = grid_index(invocation);
    if index >= 3u * params.patch_count || has_stopped() {
        return;
    }
    let patch_index = index / 3u;
    let side = index % 3u;
    let next = (side + 1u) % 3u;
    var triangle = own_triangle(patch_index);
    let edge = Edge(
        triangle.corners[side],
        triangle.corners[next],
        triangle.edges[2u * side],
        triangle.edges[2u * side + 1u],
        triangle.normals[side],
        triangle.normals[next],
        side,
    );
    user_factors[4u * patch_index + factor_of_side(side)] = bitcast<u32>(edge_factor(edge, triangle, own_view()));
}

// The inside factor of every patch.
@compute @workgroup_size(256)
fn user_insides_main(invocation: Invocation) {
    let index = grid_index(invocation);
    if index >= params.patch_count || has_stopped() {
        return;
    }
    let of_sides = vec3<f32>(
        bitcast<f32>(user_factors[4u * index + factor_of_side(0u)]),
        bitcast<f32>(user_factors[4u * index + factor_of_side(1u)]),
        bitcast<f32>(user_factors[4u * index + factor_of_side(2u)]),
    );
    user_factors[4u * index + 3u] = bitcast<u32>(inside_factor(own_triangle(index), of_sides, own_view()));
}

// Counts factors that are NaN. If there was too much work, makes every factor 1.
@compute @workgroup_size(256)
fn user_finish_main(invocation: Invocation) {
    let index = grid_index(invocation);
    if index >= params.patch_count {
        return;
    }
    let is_void = has_stopped();
    var not_numbers = 0u;
    for (var i = 4u * index; i < 4u * index + 4u; i++) {
        if is_void {
            user_factors[i] = bitcast<u32>(1.0);
        }
        not_numbers += u32((user_factors[i] & 0x7fffffffu) > 0x7f800000u);
    }
    if not_numbers > 0u {
        atomicAdd(&report.not_numbers, not_numbers);
    }
}
