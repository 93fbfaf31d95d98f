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

layout(vertices = 3) out;

// The vertices of the patch's @INDICES@ indices.
layout(location = 0) in vec3 vertex_position[];
layout(location = 1) in vec3 vertex_normal[];
layout(location = 2) in vec2 vertex_uv[];

layout(location = 0) out vec3 corner_position[];
layout(location = 1) out vec3 corner_normal[];
layout(location = 2) out vec2 corner_uv[];
// The control points of side k near its start and near its end, and the factor of its edge.
layout(location = 3) precise out vec3 near_start[];
layout(location = 4) precise out vec3 near_end[];
layout(location = 5) precise out float side_factor[];
// The control point in the middle of the patch.
layout(location = 6) patch out vec3 center;

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
    }
}
