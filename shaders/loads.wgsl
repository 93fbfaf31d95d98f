// Functions that load_net.wgsl calls, for modules whose buffers are called `patches` and `curve_nets`.

fn patch_at(index: u32) -> Patch {
    return patches[index];
}

fn curve_net_at(index: u32) -> CurveNet {
    return curve_nets[index];
}
