// What points, edges and corners share where a mesh is displaced. When the mesh or its pose changes: the direction in which
// every point moves, and the gradients of the texture coordinates at every corner. When factors change: the level of the
// height image whose px are about as long as the segments of an edge, and for every point the finest level of its edges.
// With: height_list

// In storage, not a uniform: some software drivers compile a shader again for every value of a uniform that it branches on.
@group(0) @binding(0) var<storage, read> params: Params;
@group(0) @binding(1) var<storage, read> points: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> corners: array<Corner>;
@group(0) @binding(3) var<storage, read> patches: array<Patch>;
// The bits of the factors of edges; under LOD by error then what search_state.wgsl says.
@group(0) @binding(4) var<storage, read_write> edge_factors: array<u32>;
@group(0) @binding(5) var<storage, read> given_factors: array<vec4<u32>>;
@group(0) @binding(6) var<storage, read_write> shares: array<Share>;
// Where the list of each point starts in `parts`, and in `point_factors`, then where the last list ends.
@group(0) @binding(7) var<storage, read> part_starts: array<u32>;
@group(0) @binding(10) var<storage, read> factor_starts: array<u32>;
// A corner of the point, and the bits of its weight in the point's direction.
@group(0) @binding(8) var<storage, read> parts: array<vec2<u32>>;
// The factors of the point's edges.
@group(0) @binding(9) var<storage, read> point_factors: array<u32>;
// Where the list of each corner starts in `corner_patches`, and where it ends.
@group(0) @binding(11) var<storage, read> corner_ranges: array<vec2<u32>>;
@group(0) @binding(12) var<storage, read> corner_patches: array<u32>;

@compute @workgroup_size(256)
fn directions_main(invocation: Invocation) {
    let point = grid_index(invocation);
    if point >= params.point_count {
        return;
    }
    var sum = vec3<f32>(0.0);
    for (var i = part_starts[point]; i < part_starts[point + 1u]; i++) {
        sum += corners[parts[i].x].normal * bitcast<f32>(parts[i].y);
    }
    var dominant = vec3<f32>(0.0, 0.0, 1.0);
    if part_starts[point] < part_starts[point + 1u] {
        dominant = corners[parts[part_starts[point]].x].normal;
    }
    shares[point].direction = unit_or(sum, dominant);
}

@compute @workgroup_size(256)
fn frames_main(invocation: Invocation) {
    let corner = grid_index(invocation);
    if corner >= arrayLength(&corner_ranges) {
        return;
    }
    var u = vec3<f32>(0.0);
    var v = vec3<f32>(0.0);
    var area = 0.0;
    for (var i = corner_ranges[corner].x; i < corner_ranges[corner].y; i++) {
        let at = patches[corner_patches[i]].points;
        let positions = array<vec3<f32>, 3>(points[at[0]].xyz, points[at[1]].xyz, points[at[2]].xyz);
        let own = uv_gradients(positions, patch_uvs(corner_patches[i]));
        u += own.u;
        v += own.v;
        area += own.area;
    }
    let share = select(1.0, 1.0 / area, area > 0.0);
    let first = params.point_count + params.factor_count + 2u * corner;
    shares[first].direction = u * share;
    shares[first + 1u].direction = v * share;
}

// An edge's factor, clamped to those that there are. Of given factors it is that of the dominant side, and may be NaN; NaN is found by
// its bits, which as integers are in the order of the numbers if those aren't negative.
fn segments_of(index: u32, dominant: u32) -> f32 {
    var bits = bitcast<u32>(1.0);
    if params.lod != LOD_GIVEN {
        bits = edge_factors[index];
    } else {
        for (var i = 0u; i < 3u; i++) {
            if factor_side(params.convention, i) == dominant % 4u {
                bits = given_factors[dominant / 4u][i];
            }
        }
    }
    if bits > 0x7f800000u {
        return 1.0;
    }
    return bitcast<f32>(clamp(bits, bitcast<u32>(1.0), factor_upper_bound(params.partitioning)));
}

// The directions in which the corners of every patch move, for the searches of LOD by error.
@compute @workgroup_size(256)
fn patch_directions_main(invocation: Invocation) {
    let index = grid_index(invocation);
    if index >= params.patch_count {
        return;
    }
    let directions = corner_directions(index);
    for (var k = 0u; k < 3u; k++) {
        edge_factors[direction_place(index, k)] = pack_normal(directions[k]);
    }
}

@compute @workgroup_size(256)
fn factor_levels_main(invocation: Invocation) {
    let index = grid_index(invocation);
    if index >= params.factor_count {
        return;
    }
    let dominant = share_of_factor(index).dominant;
    let map = map_of(dominant / 4u);
    var level = 0.0;
    if map > 0u {
        let uvs = patch_uvs(dominant / 4u);
        let side = dominant % 4u;
        let texels = texel_length(maps[map - 1u], uvs[side], uvs[(side + 1u) % 3u]);
        level = segment_level(maps[map - 1u], texels, segments_of(index, dominant));
    }
    shares[params.point_count + index].level = level;
}

@compute @workgroup_size(256)
fn point_levels_main(invocation: Invocation) {
    let point = grid_index(invocation);
    if point >= params.point_count {
        return;
    }
    var finest = 3.4e38;
    for (var i = factor_starts[point]; i < factor_starts[point + 1u]; i++) {
        finest = min(finest, shares[params.point_count + point_factors[i]].level);
    }
    shares[point].level = finest;
}
