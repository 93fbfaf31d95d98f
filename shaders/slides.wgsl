// Flat patches under LOD by error. The module declares the buffers.

// Whether one triangle shows a patch within the tolerance though points of the surface slide: the patch is flat, and nothing on
// it depends on where they do.
fn slides(patch_index: u32, net: ControlNet) -> bool {
    let has_texture = ((textured[patch_index / 32u] >> (patch_index % 32u)) & 1u) == 1u;
    if params.displacement != 0u || has_texture {
        return false;
    }
    let own = patches[patch_index].corners;
    return normals_agree(corners[own[0]].normal, corners[own[1]].normal, corners[own[2]].normal)
        && flat_error(params.view, net) <= BOUND_SHARE * params.tolerance;
}
