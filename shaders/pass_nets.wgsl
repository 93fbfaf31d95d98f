// The control points of every curve, with what types.wgsl says behind the first, then the one at the centre of every patch.

// In storage, not a uniform: some software drivers compile a shader again for every value of a uniform that it branches on.
@group(0) @binding(0) var<storage, read> params: Params;
// Points; then, for every patch, the control point at its centre, with the number of its height image as w.
@group(0) @binding(1) var<storage, read_write> points: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> corners: array<Corner>;
@group(0) @binding(3) var<storage, read> curves: array<Curve>;
@group(0) @binding(4) var<storage, read> curve_sides: array<vec2<u32>>;
@group(0) @binding(5) var<storage, read> patches: array<Patch>;
@group(0) @binding(6) var<storage, read_write> curve_net_words: array<vec4<f32>>;
// The same once they are written.
@group(0) @binding(7) var<storage, read> curve_nets: array<CurveNet>;

@compute @workgroup_size(256)
fn curve_nets_main(invocation: Invocation) {
    let index = grid_index(invocation);
    if index >= params.curve_count {
        return;
    }
    let curve = curves[index];
    let style = curve_net_words[2u * index].w;
    let own = u32(style) / CURVE_SURFACE_STEP;
    let surface = select(own - 1u, params.chosen_surface, own == 0u);
    let a = points[curve.points[0]].xyz;
    let b = points[curve.points[1]].xyz;
    // The mean over the curve's sides of each side's own proposal.
    var ab = vec3<f32>(0.0);
    var ba = vec3<f32>(0.0);
    var around_a: DistinctNormals;
    var around_b: DistinctNormals;
    for (var i = 0u; i < curve.side_count; i++) {
        let side = curve_sides[curve.first_side + i];
        let at_a = corners[side.x].normal;
        let at_b = corners[side.y].normal;
        let proposed = side_control_points(surface, params.alpha, a, b, at_a, at_b);
        ab += proposed[0];
        ba += proposed[1];
        around_a = add_normal(around_a, at_a);
        around_b = add_normal(around_b, at_b);
    }
    let share = 1.0 / f32(curve.side_count);
    var net = CurveNet(ab * share, ba * share);
    if surface == SURFACE_PN_CREASE {
        net = CurveNet(crease_control_point(a, b, around_a, net.ab), crease_control_point(b, a, around_b, net.ba));
    }
    curve_net_words[2u * index] = vec4<f32>(net.ab, style);
    curve_net_words[2u * index + 1u] = vec4<f32>(net.ba, 0.0);
}

@compute @workgroup_size(256)
fn centers_main(invocation: Invocation) {
    let index = grid_index(invocation);
    if index >= params.patch_count {
        return;
    }
    let net = load_net(index);
    // What is beside it, the patch's height map, stays.
    let center = center_control_point(net.corners, net.edges);
    points[params.point_count + index] = vec4<f32>(center, points[params.point_count + index].w);
}
