// What `points` has of every patch behind the positions of points, as its w. The module declares the buffers `params` and `points`.

// Added to the number of the height image if the patch has a texture.
const TEXTURED: u32 = 512u;

fn patch_traits(patch_index: u32) -> u32 {
    return u32(points[params.point_count + patch_index].w);
}

// Returns the number of a patch's height image: 1 for the first, 0 for none.
fn map_of(patch_index: u32) -> u32 {
    return patch_traits(patch_index) % TEXTURED;
}

// Returns whether a patch's material has a texture.
fn is_textured(patch_index: u32) -> bool {
    return patch_traits(patch_index) >= TEXTURED;
}
