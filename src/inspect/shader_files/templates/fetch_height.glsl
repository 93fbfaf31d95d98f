// One number a texel, such as R32F or R16, with all mip levels. It is fetched, not filtered.
#ifdef VULKAN
layout(set = 0, binding = 2) uniform sampler2D heights;
#else
layout(binding = 2) uniform sampler2D heights;
#endif

// Returns the height of the px in column `at.x` and row `at.y` of a level.
float fetch_height(HeightMap map, uint level, uvec2 at) {
    return texelFetch(heights, ivec2(at), int(level)).x;
}
