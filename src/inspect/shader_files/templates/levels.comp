#version 450
@HEADER@
// Compute shader. It runs before the patches are drawn, one invocation a patch. Each computes the factors of its patch's edges as
// the tessellation control stage does, and the mip levels that they need. Of all edges at a point the finest level is kept,
// whatever the order of the invocations. Patches that clipping leaves out count too.

@FUNCTIONS@

#ifdef VULKAN
layout(std140, set = 0, binding = 0) uniform Tessellation {
#else
layout(std140, binding = 0) uniform Tessellation {
#endif
    StageConstants constants;
};

#ifdef VULKAN
layout(std140, set = 0, binding = 1) uniform Heights {
#else
layout(std140, binding = 1) uniform Heights {
#endif
    HeightConstants height_constants;
};

// The first vertex buffer.
#ifdef VULKAN
layout(std430, set = 0, binding = 2) readonly buffer Vertices {
#else
layout(std430, binding = 2) readonly buffer Vertices {
#endif
    float vertices[];
};

#ifdef VULKAN
layout(std430, set = 0, binding = 3) readonly buffer Indices {
#else
layout(std430, binding = 3) readonly buffer Indices {
#endif
    uint indices[];
};

// The third vertex buffer: a number for each corner, of which those of dominant corners are written. It begins with zeros.
#ifdef VULKAN
layout(std430, set = 0, binding = 4) buffer Levels {
#else
layout(std430, binding = 4) buffer Levels {
#endif
    uint levels[];
};

const uint PATCH_INDICES = @INDICES@u;
const uint GROUP_SIZE = 64u;
// The most groups that a dispatch has in a direction.
const uint GROUPS_ACROSS = 65535u;

layout(local_size_x = 64) in;

// Returns the position of the corner at a place in the index buffer.
vec3 position_at(uint place) {
    uint at = 8u * indices[place];
    return vec3(vertices[at], vertices[at + 1u], vertices[at + 2u]);
}

vec3 normal_at(uint place) {
    uint at = 8u * indices[place] + 3u;
    return vec3(vertices[at], vertices[at + 1u], vertices[at + 2u]);
}

vec2 uv_at(uint place) {
    uint at = 8u * indices[place] + 6u;
    return vec2(vertices[at], vertices[at + 1u]);
}

void main() {
    uint patch_index = GROUP_SIZE * (GROUPS_ACROSS * gl_WorkGroupID.y + gl_WorkGroupID.x) + gl_LocalInvocationIndex;
    if (patch_index >= uint(indices.length()) / PATCH_INDICES) {
        return;
    }
    uint first = PATCH_INDICES * patch_index;
    for (uint k = 0u; k < 3u; k++) {
        uint next = (k + 1u) % 3u;
        uint across = first + 3u + 2u * k;
        uint dominant = first + 12u + 2u * k;
        SideNormals own_normals = SideNormals(normal_at(first + k), normal_at(first + next));
        SideNormals across_normals = SideNormals(normal_at(across), normal_at(across + 1u));
        precise HullSide side =
            hull_side(constants, position_at(first + k), position_at(first + next), own_normals, across_normals);
        precise float level = side_level(height_constants, side.factor, uv_at(dominant), uv_at(dominant + 1u));
        atomicMax(levels[indices[first + 9u + k]], kept_level(level));
        atomicMax(levels[indices[first + 9u + next]], kept_level(level));
    }
}
