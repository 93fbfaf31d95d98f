// Reads heights in exported shaders: from one image with its mip levels, in place of height_list.wgsl.

// One number a texel, such as R32Float or R16Unorm, with all mip levels. It is fetched, not filtered.
@group(0) @binding(10) var heights: texture_2d<f32>;

// Returns where the px of a mip level are: in the level itself.
fn level_place(map: HeightMap, level: u32) -> u32 {
    return level;
}

// Returns the height of the px in column `at.x` and row `at.y` of a level.
fn fetch_height(map: HeightMap, level: u32, at: vec2<u32>) -> f32 {
    return textureLoad(heights, at, level).r;
}
