// LOD's factor of every edge. An edge whose sides don't all share one curve takes the largest factor of its curves. (As
// published, every side has a factor of its own, that of its one curve.) LOD by error has the least factor that an edge may
// get instead; pass_requests.wgsl goes on from there.

// In storage, not a uniform: some software drivers compile a shader again for every value of a uniform that it branches on.
@group(0) @binding(0) var<storage, read> params: Params;
@group(0) @binding(1) var<storage, read> points: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> curves: array<Curve>;
@group(0) @binding(3) var<storage, read> curve_net_words: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> factor_curves: array<u32>;
// The bits of the factors of edges; under LOD by error then what search_state.wgsl says.
@group(0) @binding(5) var<storage, read_write> edge_factors: array<u32>;

fn curve_factor(index: u32) -> f32 {
    let curve = curves[index];
    let a = points[curve.points[0]].xyz;
    let b = points[curve.points[1]].xyz;
    let net = CurveNet(curve_net_words[2u * index].xyz, curve_net_words[2u * index + 1u].xyz);
    let detail = counted_detail(u32(curve_net_words[2u * index].w) % CURVE_SURFACE_STEP);
    let view = magnified(params.view, detail);
    if params.lod == LOD_UNIFORM {
        // One number of segments everywhere.
        return select(params.factor * detail, params.factor, params.partitioning == PARTITIONING_SUBTRIANGULATION);
    }
    if params.lod == LOD_PAPER {
        return paper_edge_factor(view, params.pixels_per_segment, a, net.ab, net.ba, b);
    }
    if params.lod == LOD_DISTANCE {
        return distance_factor(view, params.factor * detail, params.near, params.far, a, b);
    }
    if params.lod == LOD_ERROR {
        if params.surface == SURFACE_FLAT {
            return 1.0;
        }
        return least_edge_factor(view, params.tolerance, params.partitioning, a, net.ab, net.ba, b);
    }
    if params.lod == LOD_EDGE_LENGTH {
        return edge_length_factor(view, params.pixels_per_segment, a, net.ab, net.ba, b);
    }
    // An LOD that has no branch above gets factors of 1, which no test takes for its own.
    return 1.0;
}

// LOD's factor of an edge, or under LOD by error the least that it may get.
fn lod_factor(index: u32) -> f32 {
    var factor = 1.0;
    for (var curve = factor_curves[index]; curve < factor_curves[index + 1u]; curve++) {
        factor = max(factor, curve_factor(curve));
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
            edge_factors[known_at(i)] = 0u;
        }
        edge_factors[index] = bitcast<u32>(whole_segments(params.partitioning, 1.0));
        edge_factors[params.factor_count + index] = bitcast<u32>(whole_segments(params.partitioning, factor));
    } else {
        let rounded = select(factor, round_pow2(factor), params.partitioning == PARTITIONING_POW2);
        edge_factors[index] = bitcast<u32>(rounded);
    }
}
