#version 450
@HEADER@
// Tessellation evaluation stage: a vertex of a patch.

@FUNCTIONS@

#ifdef VULKAN
layout(std140, set = 0, binding = 0) uniform Tessellation {
#else
layout(std140, binding = 0) uniform Tessellation {
#endif
    StageConstants constants;
};

// Triangles keep the winding of the mesh. Vulkan's domain has its origin at the upper left, OpenGL's at the lower left.
#ifdef VULKAN
layout(triangles, @SPACING@, cw) in;
#else
layout(triangles, @SPACING@, ccw) in;
#endif

layout(location = 0) in vec3 corner_position[];
layout(location = 1) in vec3 corner_normal[];
layout(location = 2) in vec2 corner_uv[];
layout(location = 3) in vec3 near_start[];
layout(location = 4) in vec3 near_end[];
layout(location = 6) patch in vec3 center;

// In object units; a unit vector; texture coordinates.
layout(location = 0) precise out vec3 position;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec2 uv;

void main() {
    vec3 corners[3] = vec3[3](corner_position[0], corner_position[1], corner_position[2]);
    vec3 edges[6] = vec3[6](near_start[0], near_end[0], near_start[1], near_end[1], near_start[2], near_end[2]);
    vec3 normals[3] = vec3[3](corner_normal[0], corner_normal[1], corner_normal[2]);
    vec2 uvs[3] = vec2[3](corner_uv[0], corner_uv[1], corner_uv[2]);
    StagePatch hull = StagePatch(ControlNet(corners, edges, center), normals, uvs);
    precise StageVertex made = stage_vertex(hull, fixed_location(gl_TessCoord));
    position = made.position;
    normal = made.normal;
    uv = made.uv;
    // The same bits on both sides of an edge give the same place on screen only if nothing is fused here either.
    precise vec4 place = constants.clip_from_object * vec4(position, 1.0);
    gl_Position = place;
}
