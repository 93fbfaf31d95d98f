// Reads the heights of all maps from one texture, as the passes have them. Twin: src/geometry/tessellate/height_list.rs.

// The heights of all maps are one list, which fills the rows of the texture `heights`, each of this many texels.
const HEIGHTS_ACROSS: u32 = 8192u;

@group(0) @binding(20) var heights: texture_2d<f32>;

// Returns where the px of a mip level are: the index of its first height in the map's list, and its width.
fn level_place(map: HeightMap, level: u32) -> vec2<u32> {
    var start = 0u;
    for (var l = 0u; l < level; l++) {
        start += max(map.size.x >> l, 1u) * max(map.size.y >> l, 1u);
    }
    return vec2<u32>(start, max(map.size.x >> level, 1u));
}

// Returns the height of the px in column `at.x` and row `at.y` of a level.
fn fetch_height(map: HeightMap, place: vec2<u32>, at: vec2<u32>) -> f32 {
    let i = map.start + place.x + at.y * place.y + at.x;
    return textureLoad(heights, vec2<u32>(i % HEIGHTS_ACROSS, i / HEIGHTS_ACROSS), 0).r;
}
