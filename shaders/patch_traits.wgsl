// What `points` has of every patch behind the positions of points, as its w, and the height images that it names. The module
// declares the buffers `params` and `points`.

@group(0) @binding(21) var<uniform> maps: array<HeightMap, MAX_MAPS>;

// Added to the number of the height image if the patch has a texture.
const TEXTURED: u32 = 512u;

// What the count of the detail of the patch's part is multiplied by, so that it stands above these.
const DETAIL_STEP: u32 = 1024u;

// The least detail, in which details are counted; none stands for a detail of 1. See src/geometry/mesh/part_style.rs.
const LEAST_DETAIL: f32 = 1.0 / 64.0;

fn patch_traits(patch_index: u32) -> u32 {
    return u32(points[params.point_count + patch_index].w) % DETAIL_STEP;
}

fn counted_detail(count: u32) -> f32 {
    return select(f32(count) * LEAST_DETAIL, 1.0, count == 0u);
}

// Returns how many times as fine as others LOD makes a patch.
fn detail_of(patch_index: u32) -> f32 {
    return counted_detail(u32(points[params.point_count + patch_index].w) / DETAIL_STEP);
}

// Returns the view in which lengths are so many times as many px.
fn magnified(view: LodView, times: f32) -> LodView {
    var own = view;
    own.half_viewport *= times;
    return own;
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
