#version 450
@HEADER@
// Tessellation control stage: control points and tessellation factors of a patch. Invocation k computes side k, which runs from
// corner k to corner (k + 1) % 3.

@FUNCTIONS@

#ifdef VULKAN
layout(std140, set = 0, binding = 0) uniform Tessellation {
#else
layout(std140, binding = 0) uniform Tessellation {
#endif
    StageConstants constants;
};

@D@#ifdef VULKAN
@D@layout(std140, set = 0, binding = 1) uniform Heights {
@D@#else
@D@layout(std140, binding = 1) uniform Heights {
@D@#endif
@D@    HeightConstants height_constants;
@D@};
@D@
layout(vertices = 3) out;

// The vertices of the patch's @INDICES@ indices.
layout(location = 0) in vec3 vertex_position[];
layout(location = 1) in vec3 vertex_normal[];
layout(location = 2) in vec2 vertex_uv[];
@U@// The unit vector along which a corner's point moves, the gradients of its texture coordinates, and the length of the point's
@U@// shortest edge in px of level 0.
@V@// The unit vector along which a corner's point moves, the gradients of its texture coordinates, and at dominant corners the mip
@V@// level of the point, as levels.comp keeps it.
@D@layout(location = 3) in vec3 vertex_direction[];
@D@layout(location = 4) in vec3 vertex_along_u[];
@D@layout(location = 5) in vec3 vertex_along_v[];
@U@layout(location = 6) in float vertex_texels[];
@V@layout(location = 6) in uint vertex_level[];

layout(location = 0) out vec3 corner_position[];
layout(location = 1) out vec3 corner_normal[];
layout(location = 2) out vec2 corner_uv[];
// The control points of side k near its start and near its end, and the factor of its edge.
layout(location = 3) precise out vec3 near_start[];
layout(location = 4) precise out vec3 near_end[];
layout(location = 5) precise out float side_factor[];
// The control point in the middle of the patch.
layout(location = 6) patch out vec3 center;
@D@layout(location = 7) out vec3 corner_direction[];
@D@layout(location = 8) out vec3 corner_along_u[];
@D@layout(location = 9) out vec3 corner_along_v[];
@D@// The dominant corner on the point of corner k.
@D@layout(location = 10) out vec2 dominant_uv[];
@D@layout(location = 11) out vec3 dominant_along_u[];
@D@layout(location = 12) out vec3 dominant_along_v[];
@D@// The corners of the dominant side of side k, at the start of side k and at its end.
@D@layout(location = 13) out vec4 side_uvs[];
@D@layout(location = 14) out vec3 start_along_u[];
@D@layout(location = 15) out vec3 start_along_v[];
@D@layout(location = 16) out vec3 end_along_u[];
@D@layout(location = 17) out vec3 end_along_v[];
@D@// The mip levels at the corners, on the sides, and inside.
@D@layout(location = 18) precise patch out vec3 corner_levels;
@D@layout(location = 19) precise patch out vec3 side_levels;
@D@layout(location = 20) precise patch out float inside_level;

void main() {
    int k = gl_InvocationID;
    int next = (k + 1) % 3;
    SideNormals own = SideNormals(vertex_normal[k], vertex_normal[next]);
    SideNormals across = @ACROSS@;
    precise HullSide side = hull_side(constants, vertex_position[k], vertex_position[next], own, across);
    corner_position[gl_InvocationID] = vertex_position[k];
    corner_normal[gl_InvocationID] = vertex_normal[k];
    corner_uv[gl_InvocationID] = vertex_uv[k];
    near_start[gl_InvocationID] = side.near_start;
    near_end[gl_InvocationID] = side.near_end;
    side_factor[gl_InvocationID] = side.factor;
@D@    corner_direction[gl_InvocationID] = vertex_direction[k];
@D@    corner_along_u[gl_InvocationID] = vertex_along_u[k];
@D@    corner_along_v[gl_InvocationID] = vertex_along_v[k];
@D@    dominant_uv[gl_InvocationID] = vertex_uv[9 + k];
@D@    dominant_along_u[gl_InvocationID] = vertex_along_u[9 + k];
@D@    dominant_along_v[gl_InvocationID] = vertex_along_v[9 + k];
@D@    side_uvs[gl_InvocationID] = vec4(vertex_uv[12 + 2 * k], vertex_uv[13 + 2 * k]);
@D@    start_along_u[gl_InvocationID] = vertex_along_u[12 + 2 * k];
@D@    start_along_v[gl_InvocationID] = vertex_along_v[12 + 2 * k];
@D@    end_along_u[gl_InvocationID] = vertex_along_u[13 + 2 * k];
@D@    end_along_v[gl_InvocationID] = vertex_along_v[13 + 2 * k];
    barrier();
    if (k == 0) {
        vec3 corners[3] = vec3[3](vertex_position[0], vertex_position[1], vertex_position[2]);
        vec3 edges[6] = vec3[6](near_start[0], near_end[0], near_start[1], near_end[1], near_start[2], near_end[2]);
        center = center_control_point(corners, edges);
        vec3 sides = vec3(side_factor[0], side_factor[1], side_factor[2]);
        vec4 factors = tessellation_factors(constants, ControlNet(corners, edges, center), sides);
        gl_TessLevelOuter[0] = factors.x;
        gl_TessLevelOuter[1] = factors.y;
        gl_TessLevelOuter[2] = factors.z;
        gl_TessLevelInner[0] = factors.w;
@D@        for (int i = 0; i < 3; i++) {
@U@            corner_levels[i] = corner_level(height_constants, constants.factor, vertex_texels[i]);
@V@            corner_levels[i] = level_of(vertex_level[9 + i]);
@D@            side_levels[i] = side_level(height_constants, sides[i], vertex_uv[12 + 2 * i], vertex_uv[13 + 2 * i]);
@D@        }
@D@        vec2 uvs[3] = vec2[3](vertex_uv[0], vertex_uv[1], vertex_uv[2]);
@D@        inside_level = level_inside(height_constants, segments_inside(factors), uvs);
    }
}
