// A patch's control net from the buffers of the module that includes this: points, patches, curve_nets.
// Its centre is what `centers_main` of the nets pass has put behind the points.

fn load_net(patch_index: u32) -> ControlNet {
    var net: ControlNet;
    for (var k = 0u; k < 3u; k++) {
        let curve = patches[patch_index].curves[k];
        let curve_net = curve_nets[curve >> 1u];
        let reversed = (curve & 1u) == 1u;
        net.corners[k] = points[patches[patch_index].points[k]].xyz;
        net.edges[2u * k] = select(curve_net.ab, curve_net.ba, reversed);
        net.edges[2u * k + 1u] = select(curve_net.ba, curve_net.ab, reversed);
    }
    net.center = points[params.point_count + patch_index].xyz;
    return net;
}
