// Where `edge_factors` has, under LOD by error, what other passes than its searches write or read: see search_state.wgsl. The module
// declares `params`.

// Where the direction is in which a corner of a patch moves.
fn direction_place(patch_index: u32, corner: u32) -> u32 {
    return 2u * params.factor_count + 3u * patch_index + corner;
}

// Where the inside factor of a patch is.
fn inside_at(patch_index: u32) -> u32 {
    return 2u * params.factor_count + 3u * params.patch_count + patch_index;
}

// Where that is which a patch knows.
fn known_at(patch_index: u32) -> u32 {
    return inside_at(params.patch_count + patch_index);
}
