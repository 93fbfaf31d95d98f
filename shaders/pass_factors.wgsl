// LOD's factor of every edge. An edge whose sides don't all share one curve takes the largest factor of its curves. (As
// published, every side has a factor of its own, that of its one curve.) LOD by error has the least factor that an edge may
// get instead; pass_requests.wgsl goes on from there.

// In storage, not a uniform: some software drivers compile a shader again for every value of a uniform that it branches on.
@group(0) @binding(0) var<storage, read> params: Params;
@group(0) @binding(1) var<storage, read> points: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> curves: array<Curve>;
@group(0) @binding(3) var<storage, read> curve_nets: array<CurveNet>;
@group(0) @binding(4) var<storage, read> factor_curves: array<u32>;
// The factors of edges; under LOD by error then what search_state.wgsl says.
@group(0) @binding(5) var<storage, read_write> edge_factors: array<f32>;
// Only of meshes with heights: see Share in types.wgsl.
@group(0) @binding(6) var<storage, read> shares: array<Share>;
@group(0) @binding(7) var<storage, read> patches: array<Patch>;
// How far each mip level of each height image is at most from its level 0: four levels in each vector.
@group(0) @binding(22) var<uniform> details: array<array<vec4<f32>, 4>, MAX_MAPS>;

// In place of the number of one height image: all of them.
const ALL_MAPS: u32 = 0xffffffffu;

fn curve_factor(index: u32) -> f32 {
    let curve = curves[index];
    let a = points[curve.points[0]].xyz;
    let b = points[curve.points[1]].xyz;
    let net = curve_nets[index];
    if params.lod == LOD_PAPER {
        return paper_edge_factor(params.view, params.pixels_per_segment, a, net.ab, net.ba, b);
    }
    if params.lod == LOD_DISTANCE {
        return distance_factor(params.view, params.factor, params.near, params.far, a, b);
    }
    if params.lod == LOD_ERROR {
        if params.surface == SURFACE_FLAT {
            return 1.0;
        }
        let tolerance = params.tolerance * select(1.0, SURFACE_SHARE, params.displacement != 0u);
        return least_edge_factor(params.view, tolerance, params.partitioning, a, net.ab, net.ba, b);
    }
    if params.lod == LOD_EDGE_LENGTH {
        return edge_length_factor(params.view, params.pixels_per_segment, a, net.ab, net.ba, b);
    }
    // An LOD that has no branch above gets factors of 1, which no test takes for its own.
    return 1.0;
}

// The factor that the heights along a curve need: those of one height image, or of all images on its edge's sides.
fn heights_factor(index: u32, curve_index: u32, map: u32) -> f32 {
    let curve = curves[curve_index];
    let a = points[curve.points[0]].xyz;
    let b = points[curve.points[1]].xyz;
    let net = curve_nets[curve_index];
    let bounds = edge_bounds(params.view, a, net.ab, net.ba, b);
    let turn = distance(shares[curve.points[0]].direction, shares[curve.points[1]].direction);
    let scale = abs(params.height_scale);
    var factor = 1.0;
    var at = params.point_count + index;
    loop {
        let own = shares[at];
        if own.map > 0u && (map == ALL_MAPS || map == own.map) {
            let detail = details[own.map - 1u];
            factor = max(factor, displacement_factor(params.view, bounds, params.tolerance, own.texels, turn, scale, detail));
        }
        at = own.next;
        if at == 0u {
            break;
        }
    }
    return factor;
}

// The factor that the heights along an edge need: those of one height image, or of all images on its sides.
fn edge_heights_factor(index: u32, map: u32) -> f32 {
    var factor = 1.0;
    for (var curve = factor_curves[index]; curve < factor_curves[index + 1u]; curve++) {
        factor = max(factor, heights_factor(index, curve, map));
    }
    return factor;
}

// LOD's factor of an edge, or under LOD by error the least that it may get.
fn lod_factor(index: u32) -> f32 {
    if params.lod == LOD_UNIFORM {
        return params.factor;
    }
    var factor = 1.0;
    for (var curve = factor_curves[index]; curve < factor_curves[index + 1u]; curve++) {
        factor = max(factor, curve_factor(curve));
    }
    if params.lod == LOD_ERROR && params.displacement != 0u {
        factor = max(factor, edge_heights_factor(index, ALL_MAPS));
    }
    return factor;
}

@compute @workgroup_size(256)
fn edge_factors_main(invocation: Invocation) {
    let index = grid_index(invocation);
    if index >= params.factor_count {
        return;
    }
    let factor = lod_factor(index);
    if params.lod == LOD_ERROR {
        // No patch is searched yet.
        for (var i = index; i < params.patch_count + SEARCH_COUNTERS; i += params.factor_count) {
            edge_factors[2u * (params.factor_count + params.patch_count) + i] = 0.0;
        }
        edge_factors[index] = whole_segments(params.partitioning, 1.0);
        edge_factors[params.factor_count + index] = whole_segments(params.partitioning, factor);
    } else {
        edge_factors[index] = select(factor, round_pow2(factor), params.partitioning == PARTITIONING_POW2);
    }
}

// The factor that the heights of every patch need inside it: the largest that its own height image needs along its sides.
@compute @workgroup_size(256)
fn heights_inside_main(invocation: Invocation) {
    let index = grid_index(invocation);
    if index >= params.patch_count {
        return;
    }
    let own = u32(points[params.point_count + index].w);
    var inside = 1.0;
    for (var k = 0u; k < 3u; k++) {
        inside = max(inside, edge_heights_factor(patches[index].factors[k] >> 3u, own));
    }
    edge_factors[2u * params.factor_count + index] = inside;
}
