// What load_net.wgsl reads, where the module that includes this has patches and curve_nets.

fn patch_at(index: u32) -> Patch {
    return patches[index];
}

fn curve_net_at(index: u32) -> CurveNet {
    return curve_nets[index];
}
