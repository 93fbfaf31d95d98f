@HEADER@
// Compute shader, shader model 5.0: levels_main. It runs before the patches are drawn, one invocation a patch. Each computes the
// factors of its patch's edges as the hull shader does, and the mip levels that they need. Of all edges at a point the finest
// level is kept, whatever the order of the invocations. Patches that clipping leaves out count too.

@FUNCTIONS@

cbuffer Tessellation : register(b0)
{
    StageConstants constants;
};

cbuffer Heights : register(b1)
{
    HeightConstants height_constants;
};

cbuffer Patches : register(b5)
{
    // How many patches the index buffer has.
    uint patch_count;
};

// The first vertex buffer and the index buffer.
ByteAddressBuffer vertices : register(t2);
ByteAddressBuffer indices : register(t3);
// The third vertex buffer: 4 bytes a corner, of which those of dominant corners are written. It begins with zeros.
RWByteAddressBuffer levels : register(u4);

static const uint PATCH_INDICES = @INDICES@;
static const uint GROUP_SIZE = 64;
// The most groups that a dispatch has in a direction.
static const uint GROUPS_ACROSS = 65535;

// Returns the number of the corner at a place in the index buffer.
uint corner_at(uint place)
{
    return indices.Load(4 * place);
}

float3 position_at(uint place)
{
    return asfloat(vertices.Load3(32 * corner_at(place)));
}

float3 normal_at(uint place)
{
    return asfloat(vertices.Load3(32 * corner_at(place) + 12));
}

float2 uv_at(uint place)
{
    return asfloat(vertices.Load2(32 * corner_at(place) + 24));
}

// Takes a level into account at the point of a dominant corner.
void keep_finest(uint corner, uint level)
{
    uint before;
    levels.InterlockedMax(4 * corner, level, before);
}

[numthreads(GROUP_SIZE, 1, 1)]
void levels_main(uint3 group : SV_GroupID, uint local : SV_GroupIndex)
{
    uint patch_index = GROUP_SIZE * (GROUPS_ACROSS * group.y + group.x) + local;
    if (patch_index >= patch_count)
    {
        return;
    }
    uint first = PATCH_INDICES * patch_index;
    for (uint k = 0; k < 3; k++)
    {
        uint next = (k + 1) % 3;
        uint across = first + 3 + 2 * k;
        uint dominant = first + 12 + 2 * k;
        SideNormals own_normals;
        own_normals.at_a = normal_at(first + k);
        own_normals.at_b = normal_at(first + next);
        SideNormals across_normals;
        across_normals.at_a = normal_at(across);
        across_normals.at_b = normal_at(across + 1);
        precise HullSide side =
            hull_side(constants, position_at(first + k), position_at(first + next), own_normals, across_normals);
        precise float level = side_level(height_constants, side.factor, uv_at(dominant), uv_at(dominant + 1));
        keep_finest(corner_at(first + 9 + k), kept_level(level));
        keep_finest(corner_at(first + 9 + next), kept_level(level));
    }
}
