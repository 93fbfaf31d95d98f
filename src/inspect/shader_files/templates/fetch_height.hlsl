// One number a texel, such as R32_FLOAT or R16_UNORM, with all mip levels. It is loaded, not filtered.
Texture2D<float> heights : register(t2);

// Returns the height of the px in column `at.x` and row `at.y` of a level.
float fetch_height(HeightMap map, uint level, uint2 at)
{
    return heights.Load(int3(at, level));
}
