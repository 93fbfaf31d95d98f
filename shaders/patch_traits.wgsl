// What `points` has of every patch behind the positions of points, as its w, and the height images that it names. The module
// declares the buffers `params` and `points`.

@group(0) @binding(21) var<uniform> maps: array<HeightMap, MAX_MAPS>;

// Added to the number of the height image if the patch has a texture.
const TEXTURED: u32 = 512u;

fn patch_traits(patch_index: u32) -> u32 {
    return u32(points[params.point_count + patch_index].w);
}

// Returns the number of a patch's height image: 1 for the first, 0 for none.
fn map_of(patch_index: u32) -> u32 {
    return patch_traits(patch_index) % TEXTURED;
}

// Returns how far white is above black in an image, in object units.
fn map_scale(map: HeightMap) -> f32 {
    return select(params.height_scale, map.scale, map.has_amount != 0u);
}

// Returns whether a patch's material has a texture.
fn is_textured(patch_index: u32) -> bool {
    return patch_traits(patch_index) >= TEXTURED;
}
