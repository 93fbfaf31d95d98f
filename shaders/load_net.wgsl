// A patch's control net. The module declares the buffers `params` and `points` and the functions patch_at and curve_net_at.
//
// The loops are unrolled by hand, since some compilers keep loops, and then keep the arrays that they index in memory.

// Returns the control net of a patch.
fn load_net(patch_index: u32) -> ControlNet {
    let own = patch_at(patch_index);
    let curves = array<CurveNet, 3>(
        curve_net_at(own.curves[0] >> 1u),
        curve_net_at(own.curves[1] >> 1u),
        curve_net_at(own.curves[2] >> 1u),
    );
    let reversed = vec3<bool>((own.curves[0] & 1u) == 1u, (own.curves[1] & 1u) == 1u, (own.curves[2] & 1u) == 1u);
    var net: ControlNet;
    net.corners[0] = points[own.points[0]].xyz;
    net.corners[1] = points[own.points[1]].xyz;
    net.corners[2] = points[own.points[2]].xyz;
    net.edges[0] = select(curves[0].ab, curves[0].ba, reversed.x);
    net.edges[1] = select(curves[0].ba, curves[0].ab, reversed.x);
    net.edges[2] = select(curves[1].ab, curves[1].ba, reversed.y);
    net.edges[3] = select(curves[1].ba, curves[1].ab, reversed.y);
    net.edges[4] = select(curves[2].ab, curves[2].ba, reversed.z);
    net.edges[5] = select(curves[2].ba, curves[2].ab, reversed.z);
    // centers_main in pass_nets.wgsl writes the centres behind the points.
    net.center = points[params.point_count + patch_index].xyz;
    return net;
}
